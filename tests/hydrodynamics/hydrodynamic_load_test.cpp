#include "hydrodynamics/hydrodynamic_load.h"

#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "tests/hydrodynamics/random_matrices.h"

namespace buoyancy {
namespace {

HydrodynamicCoefficients random_coefficients(std::mt19937& random) {
  HydrodynamicCoefficients coefficients;
  coefficients.drag = {.linear = 20.0 * random_semidefinite(random),
                       .quadratic = 30.0 * random_semidefinite(random),
                       .center_B = random_vec3(random)};
  coefficients.added_mass = {.matrix = 50.0 * random_semidefinite(random), .center_B = random_vec3(random)};
  return coefficients;
}

HydrodynamicState random_state(std::mt19937& random) {
  HydrodynamicState state;
  state.motion = {random_rotation(random), 2.0 * random_vec3(random), 3.0 * random_vec3(random)};
  for (Surroundings* surroundings : {&state.at_drag, &state.at_added_mass}) {
    surroundings->water.velocity_W = random_vec3(random);
    surroundings->water.acceleration_W = random_vec3(random);
    surroundings->immersion.value = 0.5 + 0.5 * random_number(random);
  }
  return state;
}

Vec6 total(const HydrodynamicLoad& load) {
  return load.drag_W + load.added_mass_W;
}

// The formulas of the header once more, number by number and in long double.
using Long3 = std::array<long double, 3>;
struct LongWrench {
  Long3 force{}, torque{};
};

Long3 cross(const Long3& a, const Long3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Long3 operator+(const Long3& a, const Long3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Long3 operator-(const Long3& a, const Long3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Long3 to_long(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Long3 turned(const Mat3& R, const Long3& v, bool back) {
  Long3 result{};
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      result[static_cast<std::size_t>(i)] +=
          static_cast<long double>(back ? R(j, i) : R(i, j)) * v[static_cast<std::size_t>(j)];
    }
  }
  return result;
}

LongWrench product(const Mat6& matrix, const Long3& v, const Long3& w) {
  LongWrench result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(j);
      result.force[i] += matrix(row, column) * v[j] + matrix(row, column + 3) * w[j];
      result.torque[i] += matrix(row + 3, column) * v[j] + matrix(row + 3, column + 3) * w[j];
    }
  }
  return result;
}

struct LongTwist {
  Long3 v{}, w{};
};

LongTwist relative(const BodyMotion& motion, const Vec3& center_B, const Vec3& water_W) {
  LongTwist twist;
  twist.w = turned(motion.R_WB, to_long(motion.angular_velocity_W), true);
  twist.v = turned(motion.R_WB, to_long(motion.velocity_W) - to_long(water_W), true) +
            cross(twist.w, to_long(center_B));
  return twist;
}

LongWrench to_reference_W(const LongWrench& load_B, const Vec3& center_B, const Vec3& reference_B,
                          const Mat3& R_WB, long double s) {
  LongWrench result = load_B;
  result.torque = result.torque + cross(to_long(center_B) - to_long(reference_B), load_B.force);
  result.force = turned(R_WB, result.force, false);
  result.torque = turned(R_WB, result.torque, false);
  for (std::size_t i = 0; i < 3; ++i) {
    result.force[i] *= s;
    result.torque[i] *= s;
  }
  return result;
}

LongWrench true_load(const HydrodynamicCoefficients& coefficients, const Vec3& reference_B,
                     const HydrodynamicState& state) {
  const Mat3& R = state.motion.R_WB;
  const DragCoefficients& drag = *coefficients.drag;
  const LongTwist nu = relative(state.motion, drag.center_B, state.at_drag.water.velocity_W);
  LongTwist squares;
  for (std::size_t i = 0; i < 3; ++i) {
    squares.v[i] = std::abs(nu.v[i]) * nu.v[i];
    squares.w[i] = std::abs(nu.w[i]) * nu.w[i];
  }
  const LongWrench linear = product(drag.linear, nu.v, nu.w);
  const LongWrench quadratic = product(drag.quadratic, squares.v, squares.w);
  const Long3 zero{};
  const LongWrench drag_B{zero - linear.force - quadratic.force, zero - linear.torque - quadratic.torque};
  const LongWrench drag_W =
      to_reference_W(drag_B, drag.center_B, reference_B, R, state.at_drag.immersion.value);

  const AddedMassCoefficients& added = *coefficients.added_mass;
  const WaterMotion& water = state.at_added_mass.water;
  const LongTwist relative_twist = relative(state.motion, added.center_B, water.velocity_W);
  const LongWrench momentum = product(added.matrix, relative_twist.v, relative_twist.w);
  const Long3 water_rate = turned(R, to_long(water.acceleration_W), true) -
                           cross(relative_twist.w, turned(R, to_long(water.velocity_W), true));
  const LongWrench of_water = product(added.matrix, water_rate, zero);
  const LongWrench added_B{
      of_water.force - cross(relative_twist.w, momentum.force),
      of_water.torque - cross(relative_twist.v, momentum.force) - cross(relative_twist.w, momentum.torque)};
  const LongWrench added_W =
      to_reference_W(added_B, added.center_B, reference_B, R, state.at_added_mass.immersion.value);
  return {drag_W.force + added_W.force, drag_W.torque + added_W.torque};
}

long double distance(const Long3& a, const Vec3& b) {
  const Long3 d = a - to_long(b);
  return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

TEST(HydrodynamicLoad, IsWithinItsBound) {
  std::mt19937 random(11);
  double largest = 0.0;
  for (int i = 0; i < 3000; ++i) {
    const HydrodynamicCoefficients coefficients = random_coefficients(random);
    const Vec3 reference_B = random_vec3(random);
    HydrodynamicState state = random_state(random);
    // A body that drifts with a fast current: what counts is a small difference.
    const double speed = std::pow(10.0, 4.0 * random_number(random));
    const Vec3 drift = speed * random_vec3(random);
    state.motion.velocity_W += drift;
    state.at_drag.water.velocity_W += drift;
    state.at_added_mass.water.velocity_W += drift;
    const HydrodynamicLoad load = HydrodynamicModel(coefficients, reference_B).load(state);
    const LongWrench truth = true_load(coefficients, reference_B, state);
    const Vec6 found = total(load);
    const auto force_error = static_cast<double>(distance(truth.force, found.head<3>()));
    const auto torque_error = static_cast<double>(distance(truth.torque, found.tail<3>()));
    EXPECT_LE(force_error, load.force_error_bound);
    EXPECT_LE(torque_error, load.torque_error_bound);
    largest =
        std::max({largest, force_error / load.force_error_bound, torque_error / load.torque_error_bound});
  }
  EXPECT_GT(largest, 1e-4) << "the bound is far too large";
}

TEST(HydrodynamicLoad, BoundContainsTheErrorOfImmersionAndWater) {
  // One source of errors at a time, so that none hides behind another.
  std::mt19937 random(12);
  for (int i = 0; i < 3000; ++i) {
    const double immersion_error = i % 3 == 0 ? 0.01 : 0.0;
    const double velocity_scale = i % 3 == 1 ? 1e-3 : 0.0;
    const double acceleration_scale = i % 3 == 2 ? 1e-3 : 0.0;
    const HydrodynamicModel model(random_coefficients(random), random_vec3(random));
    const HydrodynamicState truth = random_state(random);
    HydrodynamicState off = truth;
    for (Surroundings* surroundings : {&off.at_drag, &off.at_added_mass}) {
      surroundings->immersion.value = std::min(1.0, surroundings->immersion.value * (1.0 + immersion_error));
      surroundings->immersion.error = immersion_error;
      const Vec3 velocity_error = velocity_scale * random_vec3(random);
      const Vec3 acceleration_error = acceleration_scale * random_vec3(random);
      surroundings->water.velocity_W += velocity_error;
      surroundings->water.velocity_error = velocity_error.norm();
      surroundings->water.acceleration_W += acceleration_error;
      surroundings->water.acceleration_error = acceleration_error.norm();
    }
    const HydrodynamicLoad load = model.load(off);
    const Vec6 error = total(load) - total(model.load(truth));
    EXPECT_LE(error.head<3>().norm(), load.force_error_bound);
    EXPECT_LE(error.tail<3>().norm(), load.torque_error_bound);
  }
}

TEST(HydrodynamicLoad, DampingIsTheDerivative) {
  std::mt19937 random(13);
  for (int i = 0; i < 300; ++i) {
    const Vec3 reference_B = random_vec3(random);
    const HydrodynamicModel model(random_coefficients(random), reference_B);
    const HydrodynamicState state = random_state(random);
    const Mat6 damping_W = model.matrices(state).damping_W;
    for (Eigen::Index column = 0; column < 6; ++column) {
      const auto load_at = [&](double change) {
        Vec6 twist = Vec6::Zero();  // of the reference point
        twist[column] = change;
        const Vec6 of_origin = twist_at(twist, -(state.motion.R_WB * reference_B));
        HydrodynamicState moved = state;
        moved.motion.velocity_W += of_origin.head<3>();
        moved.motion.angular_velocity_W += of_origin.tail<3>();
        return total(model.load(moved));
      };
      constexpr double kChange = 1e-6;
      const Vec6 difference = -(load_at(kChange) - load_at(-kChange)) / (2.0 * kChange);
      EXPECT_LE((damping_W.col(column) - difference).norm(), 1e-6 * (1.0 + damping_W.norm()));
    }
  }
}

TEST(HydrodynamicLoad, AddedMassMatrixIsTheInertiaAboutTheReferencePoint) {
  std::mt19937 random(14);
  const HydrodynamicCoefficients coefficients = random_coefficients(random);
  const AddedMassCoefficients& added = *coefficients.added_mass;
  const Vec3 reference_B = random_vec3(random);
  const HydrodynamicState state = random_state(random);
  const Mat6 mass_W = HydrodynamicModel(coefficients, reference_B).matrices(state).added_mass_W;
  EXPECT_LE((mass_W - mass_W.transpose()).norm(), 1e-13 * mass_W.norm());
  // The kinetic energy of the water does not depend on the point that the matrix is about.
  const Vec6 twist_W = random_vec6(random);  // of the reference point
  const Mat3& R = state.motion.R_WB;
  Vec6 twist_B;
  twist_B << R.transpose() * twist_W.head<3>(), R.transpose() * twist_W.tail<3>();
  const Vec6 at_center = twist_at(twist_B, added.center_B - reference_B);
  const double s = state.at_added_mass.immersion.value;
  EXPECT_NEAR(twist_W.dot(mass_W * twist_W), s * at_center.dot(added.matrix * at_center),
              1e-12 * mass_W.norm());
}

TEST(HydrodynamicLoad, MunkMomentTurnsASlenderBodyBroadsideOn) {
  HydrodynamicCoefficients coefficients;
  coefficients.added_mass.emplace();
  coefficients.added_mass->matrix.diagonal() << 5.0, 126.0, 100.0, 0.0, 0.0, 0.0;
  HydrodynamicState state;
  state.motion.velocity_W = {2.0, 0.3, 0.0};
  const HydrodynamicLoad load = HydrodynamicModel(coefficients, Vec3::Zero()).load(state);
  EXPECT_NEAR(load.added_mass_W[5], -(126.0 - 5.0) * 2.0 * 0.3, 1e-12);
  EXPECT_LT(load.added_mass_W.head<5>().norm(), 1e-12);
}

TEST(HydrodynamicLoad, AddedMassDoesNoWorkInStillWater) {
  std::mt19937 random(15);
  for (int i = 0; i < 100; ++i) {
    HydrodynamicCoefficients coefficients = random_coefficients(random);
    coefficients.drag.reset();
    HydrodynamicState state = random_state(random);
    state.at_added_mass.water = {};
    const Vec3 reference_B = random_vec3(random);
    const Vec6 load_W = HydrodynamicModel(coefficients, reference_B).load(state).added_mass_W;
    Vec6 origin_twist;
    origin_twist << state.motion.velocity_W, state.motion.angular_velocity_W;
    const Vec6 twist = twist_at(origin_twist, state.motion.R_WB * reference_B);
    EXPECT_LE(std::abs(load_W.dot(twist)), 1e-12 * load_W.norm() * twist.norm());
  }
}

// What a current adds to the inertial force A nu_dot of a body that turns, the published terms take away.
TEST(HydrodynamicLoad, IsTheSameInAFrameThatDriftsWithTheWater) {
  std::mt19937 random(16);
  for (int i = 0; i < 100; ++i) {
    const HydrodynamicCoefficients coefficients = random_coefficients(random);
    const AddedMassCoefficients& added = *coefficients.added_mass;
    HydrodynamicState state = random_state(random);
    const Vec3 current_W = random_vec3(random);
    state.at_drag.water = {.velocity_W = current_W};
    state.at_added_mass.water = {.velocity_W = current_W};
    HydrodynamicState drifting = state;
    drifting.motion.velocity_W -= current_W;
    drifting.at_drag.water = drifting.at_added_mass.water = {};
    const HydrodynamicModel model(coefficients, added.center_B);
    const Mat3& R = state.motion.R_WB;
    const Vec3 rate_B = (R.transpose() * state.motion.angular_velocity_W).cross(R.transpose() * current_W);
    const Vec6 inertial_B = state.at_added_mass.immersion.value * (added.matrix.leftCols<3>() * rate_B);
    Vec6 inertial_W;
    inertial_W << R * inertial_B.head<3>(), R * inertial_B.tail<3>();
    const Vec6 expected = total(model.load(drifting)) - inertial_W;
    EXPECT_LE((total(model.load(state)) - expected).norm(), 1e-12 * (1.0 + expected.norm()));
  }
}

TEST(HydrodynamicLoad, DragOpposesMotionAlongEachAxis) {
  HydrodynamicCoefficients coefficients;
  coefficients.drag.emplace();
  coefficients.drag->linear.diagonal() << 1, 2, 3, 4, 5, 6;
  coefficients.drag->quadratic.diagonal() << 10, 20, 30, 40, 50, 60;
  const HydrodynamicModel model(coefficients, Vec3::Zero());
  for (Eigen::Index axis = 0; axis < 6; ++axis) {
    for (const double speed : {-2.0, 0.5}) {
      HydrodynamicState state;
      (axis < 3 ? state.motion.velocity_W : state.motion.angular_velocity_W)[axis % 3] = speed;
      state.at_drag.immersion.value = 0.5;
      const Vec6 drag = model.load(state).drag_W;
      const auto n = static_cast<double>(axis + 1);
      EXPECT_DOUBLE_EQ(drag[axis], -0.5 * (n + 10.0 * n * std::abs(speed)) * speed);
      EXPECT_DOUBLE_EQ(drag.norm(), std::abs(drag[axis]));
    }
  }
}

TEST(HydrodynamicLoad, DryBodyHasNone) {
  std::mt19937 random(17);
  const HydrodynamicModel model(random_coefficients(random), random_vec3(random));
  HydrodynamicState state = random_state(random);
  state.at_drag.immersion = state.at_added_mass.immersion = {0.0, 0.0};
  const HydrodynamicLoad load = model.load(state);
  EXPECT_EQ(total(load), Vec6::Zero());
  EXPECT_EQ(load.force_error_bound, 0.0);
  EXPECT_EQ(load.torque_error_bound, 0.0);
}

}  // namespace
}  // namespace buoyancy
