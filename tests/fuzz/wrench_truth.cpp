#include "tests/fuzz/wrench_truth.h"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include "tests/hydrostatics/exact_oracle-inl.h"

namespace buoyancy {
namespace {

using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<512, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

double distance(const Vec3& found, const Vec3T<Wide>& truth) {
  const Vec3T<Wide> difference = found.cast<Wide>() - truth;
  return static_cast<double>(Wide(sqrt(Wide(difference.dot(difference)))));
}

}  // namespace

struct TrueWrench::Numbers {
  Wide volume;
  Vec3T<Wide> force_W, torque_W;
};

TrueWrench::TrueWrench(const TriangleMesh& mesh, const Pose& pose, const Water& water,
                       const Vec3& reference_B) {
  const auto displaced = exact_displacement<Wide>(mesh, pose, water);
  const Wide weight = Wide(water.density) * Wide(water.gravity);  // [N/m^3]
  auto numbers = std::make_unique<Numbers>();
  numbers->volume = displaced.volume;
  numbers->force_W = water.up_W.cast<Wide>() * Wide(weight * displaced.volume);
  numbers->torque_W = exactly_in_world<Wide>(pose, displaced.torque(reference_B)) * weight;
  numbers_ = std::move(numbers);
}

TrueWrench::~TrueWrench() = default;

double TrueWrench::volume_error(double volume) const {
  return static_cast<double>(Wide(abs(Wide(volume) - numbers_->volume)));
}

double TrueWrench::force_error(const Vec3& force_W) const {
  return distance(force_W, numbers_->force_W);
}

double TrueWrench::torque_error(const Vec3& torque_W) const {
  return distance(torque_W, numbers_->torque_W);
}

}  // namespace buoyancy
