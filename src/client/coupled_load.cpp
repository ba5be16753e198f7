#include "client/coupled_load.h"

#include "messages/conversions.h"

namespace buoyancy {
namespace {

Mat6 to_matrix(const std::array<std::array<double, 6>, 6>& fields) {
  Mat6 matrix;
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column)) = fields[row][column];
    }
  }
  return matrix;
}

}  // namespace

Vec6 wrench_of(const BodyWrench& wrench) {
  Vec6 vector;
  vector.head<3>() = to_vec3(wrench.force);
  vector.tail<3>() = to_vec3(wrench.torque);
  return vector;
}

HydrodynamicMatrices matrices_of(const BodyLoads& loads) {
  return {to_matrix(loads.added_mass), to_matrix(loads.damping)};
}

CoupledBody coupled_body(const RigidBodyMass& mass, const Vec3& reference_B, const BodyState& state,
                         const BodyLoads& loads) {
  const auto& [w, x, y, z] = state.quaternion_wxyz;
  CoupledBody body;
  body.mass = mass;
  body.reference_B = reference_B;
  body.motion = {Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix(),
                 to_vec3(state.linear_velocity), to_vec3(state.angular_velocity)};
  body.water = matrices_of(loads);
  return body;
}

}  // namespace buoyancy
