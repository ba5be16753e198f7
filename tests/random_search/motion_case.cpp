#include "tests/random_search/motion_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>

#include "geometry/shapes.h"
#include "hydrodynamics/coefficient_checks.h"
#include "hydrodynamics/linear_algebra.h"
#include "simulation/natural_frequency.h"
#include "simulation/run_warnings.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {
namespace {

constexpr double kDensity = 1000.0;  // [kg/m^3], of the water
constexpr double kMaxStep = 0.1;     // [s]

Mat6 random_matrix(RandomPoses& random) {
  Mat6 matrix;
  for (Eigen::Index i = 0; i < 36; ++i) matrix(i / 6, i % 6) = random.uniform(-1.0, 1.0);
  return matrix;
}

// Symmetric and positive semidefinite, of a random rank, with a largest eigenvalue of 1.
Mat6 random_semidefinite(RandomPoses& random) {
  const Mat6 factor = random_matrix(random);
  const auto rank = static_cast<Eigen::Index>(1 + random.pick(6));
  const Mat6 square = factor.leftCols(rank) * factor.leftCols(rank).transpose();
  return square / symmetric_eigen<6>(square, Mat6::Identity()).values[5];
}

Mat6 random_diagonal(RandomPoses& random) {
  Mat6 matrix = Mat6::Zero();
  for (Eigen::Index i = 0; i < 6; ++i) matrix(i, i) = random.pick(4) == 0 ? 0.0 : random.uniform(0.0, 1.0);
  return matrix;
}

ImmersionScaling random_scaling(RandomPoses& random) {
  constexpr ImmersionScaling kAll[] = {ImmersionScaling::kVolume, ImmersionScaling::kVolume,
                                       ImmersionScaling::kWettedArea, ImmersionScaling::kNone};
  return kAll[random.pick(4)];
}

struct ShapeAndSize {
  Shape shape;
  double size = 1.0;  // [m]
};

ShapeAndSize random_shape(RandomPoses& random) {
  const double size = random.log_uniform(0.1, 5.0);
  const double a = random.uniform(0.2, 1.0);
  const double b = random.uniform(0.2, 1.0);
  switch (random.pick(4)) {
    case 0:
      return {SphereShape{0.5 * size, 8}, size};
    case 1:
      return {CylinderShape{0.5 * a * size, size, 12, 1}, size};
    case 2:
      return {ConeShape{0.5 * a * size, size, 12, 1}, size};
    default:
      return {BoxShape{{size, a * size, b * size}, {1, 1, 1}}, size};
  }
}

// Square roots of the body's masses and moments of inertia about its axes: they make random matrices of
// numbers to matrices of the body.
Vec6 mass_scale(const RigidBody& rigid) {
  const Mat3 inertia =
      rigid.principal_axes_B * rigid.principal_inertia.asDiagonal() * rigid.principal_axes_B.transpose();
  Vec6 scale;
  scale.head<3>().setConstant(std::sqrt(rigid.mass));
  scale.tail<3>() = inertia.diagonal().cwiseSqrt();
  return scale;
}

// rate: [1/s], of the decay.
DragDescription random_drag(RandomPoses& random, const Vec6& scale, double rate, const Vec6& twist,
                            double size) {
  DragDescription drag;
  drag.linear = random_diagonal(random);
  if (random.pick(2) == 0) {
    const Mat6 any = random_matrix(random);
    drag.linear = random_semidefinite(random);
    drag.linear += random.uniform(0.0, 1.0) * (any - any.transpose());
  }
  drag.linear = rate * scale.asDiagonal() * drag.linear * scale.asDiagonal();
  if (random.pick(3) > 0) {
    const Mat6 diagonal = random_diagonal(random);
    const auto scaled = [&](const Mat6& matrix) -> Mat6 {
      const Vec6 per_speed = scale.cwiseQuotient((twist.cwiseAbs().array() + 0.1).matrix());
      return rate * scale.asDiagonal() * matrix * per_speed.asDiagonal();
    };
    drag.quadratic = scaled(diagonal);
    const double share = random.uniform(0.0, 0.3);
    const Mat6 full = scaled(diagonal + share * random_matrix(random));
    const bool resists = !find_drag_fault(full) && !find_driving_twist(full);
    if (random.pick(3) == 0 && resists) drag.quadratic = full;
  }
  if (random.pick(2) == 0) drag.center_B = random.vector(0.0, 0.3 * size);
  drag.immersion = random_scaling(random);
  return drag;
}

AddedMassDescription random_added_mass(RandomPoses& random, const Vec6& scale, double size) {
  AddedMassDescription added;
  const Mat6 matrix = random.pick(2) == 0 ? random_semidefinite(random) : random_diagonal(random);
  added.matrix = random.log_uniform(0.1, 50.0) * (scale.asDiagonal() * matrix * scale.asDiagonal());
  added.matrix = (0.5 * (added.matrix + added.matrix.transpose())).eval();
  if (random.pick(2) == 0) added.center_B = random.vector(0.0, 0.2 * size);
  added.immersion = random_scaling(random);
  return added;
}

}  // namespace

SceneDescription MotionCase::scene_without_drag() const {
  SceneDescription undamped = scene;
  DragDescription& drag = *undamped.bodies.front().drag;
  drag.linear.setZero();
  drag.quadratic.setZero();
  return undamped;
}

std::string MotionCase::text() const {
  const BodyDescription& body = scene.bodies.front();
  std::ostringstream text;
  text.precision(6);
  text << (kind == MotionKind::kSubmerged ? "submerged " : "piercing ")
       << type_name(std::get<Shape>(body.mesh.source)) << ", " << to_string(options.integrator) << ", step "
       << options.step << " s, " << steps << " steps, density " << *body.dynamics.density << " kg/m^3\n"
       << "velocity " << body.dynamics.linear_velocity.transpose() << ", angular velocity "
       << body.dynamics.angular_velocity.transpose() << "\nlinear drag\n"
       << body.drag->linear << "\nquadratic drag\n"
       << body.drag->quadratic << "\nadded mass\n"
       << (body.added_mass ? body.added_mass->matrix : Mat6(Mat6::Zero())) << "\n";
  return text.str();
}

MotionCase random_motion_case(std::uint64_t seed, std::int64_t number) {
  RandomPoses random(seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(number));
  MotionCase result;
  result.kind = number % 2 == 0 ? MotionKind::kSubmerged : MotionKind::kPiercing;
  result.steps = 200;
  result.options.integrator =
      random.pick(4) == 0 ? Integrator::kSemiImplicitEuler : Integrator::kVelocityVerlet;
  const bool piercing = result.kind == MotionKind::kPiercing;

  result.scene.name = "motion";
  result.scene.water.density = kDensity;
  BodyDescription& body = result.scene.bodies.emplace_back();
  const auto [shape, size] = random_shape(random);
  body.id = 1;
  body.name = "body";
  body.mesh.source = shape;
  body.reference_B = random.vector(0.0, size);
  DynamicsSpec& dynamics = body.dynamics;
  dynamics.given = true;
  dynamics.density = piercing ? kDensity * random.uniform(0.05, 0.95) : kDensity;
  dynamics.position = {0.0, 0.0, piercing ? random.uniform(-0.3, 0.3) * size : -1000.0};
  dynamics.orientation = random.rotation();
  const double speed = random.log_uniform(0.01, piercing ? 1.0 : 5.0);
  dynamics.linear_velocity = random.vector(0.0, piercing ? speed * std::sqrt(size) : speed);
  dynamics.angular_velocity = random.vector(0.0, random.log_uniform(0.01, piercing ? 1.0 : 5.0));

  // Mass and inertia follow from the mesh.
  body.drag.emplace();
  const auto scene = [&] { return Scene::prepare(result.scene).value(); };
  const Scene plain = scene();
  const RigidBody rigid = make_rigid_body(plain.bodies().front(), plain.water()).value();
  const Vec6 scale = mass_scale(rigid);
  if (random.pick(8) > 0) body.added_mass = random_added_mass(random, scale, size);

  result.options.step = random.log_uniform(1e-4, kMaxStep);
  if (piercing) {
    const Scene with_added_mass = scene();
    const Body& prepared = with_added_mass.bodies().front();
    const double frequency =
        highest_natural_frequency(prepared, rigid, initial_state(rigid, dynamics), with_added_mass.water())
            .frequency;
    const double largest = frequency > 0.0 ? kAccuracyLimit / frequency : kMaxStep;
    result.options.step = std::min(kMaxStep, largest * random.log_uniform(0.02, 1.0));
  }
  Vec6 twist;
  twist << dynamics.linear_velocity, dynamics.angular_velocity;
  const double rate = random.log_uniform(1e-3, 1e3) / result.options.step;
  body.drag = random_drag(random, scale, rate, twist, size);
  return result;
}

}  // namespace buoyancy
