#include "hydrodynamics/hydrodynamic_load.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/hydrodynamics/random_matrices.h"
#include "tests/hydrostatics/climb.h"

namespace buoyancy {
namespace {

HydrodynamicCoefficients random_coefficients(RandomPoses& random) {
  HydrodynamicCoefficients coefficients;
  coefficients.drag = {.linear = 20.0 * random_semidefinite(random),
                       .quadratic = 30.0 * random_semidefinite(random),
                       .center_B = random_vec3(random)};
  coefficients.added_mass = {.matrix = 50.0 * random_semidefinite(random), .center_B = random_vec3(random)};
  return coefficients;
}

HydrodynamicState random_state(RandomPoses& random) {
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

// The formulas of the header once more, in long double.
using LongVec3 = Vec3T<long double>;
using LongVec6 = Eigen::Matrix<long double, 6, 1>;

LongVec6 true_load(const HydrodynamicCoefficients& coefficients, const Vec3& reference_B,
                   const HydrodynamicState& state) {
  const Mat3T<long double> R_WB = state.motion.R_WB.cast<long double>();
  const auto in_B = [&](const Vec3& v_W) { return LongVec3(R_WB.transpose() * v_W.cast<long double>()); };
  const LongVec3 w = in_B(state.motion.angular_velocity_W);
  const auto velocity = [&](const Vec3& center_B, const FlowAtBody& water) {
    const LongVec3 through_water_W =
        state.motion.velocity_W.cast<long double>() - water.velocity_W.cast<long double>();
    return LongVec3(R_WB.transpose() * through_water_W + w.cross(LongVec3(center_B.cast<long double>())));
  };
  const auto at_reference_W = [&](const LongVec3& force, const LongVec3& torque, const Vec3& center_B,
                                  double immersion) {
    const LongVec3 lever = center_B.cast<long double>() - reference_B.cast<long double>();
    LongVec6 load;
    load << R_WB * force, R_WB * LongVec3(torque + lever.cross(force));
    return LongVec6(static_cast<long double>(immersion) * load);
  };
  const DragCoefficients& drag = *coefficients.drag;
  LongVec6 nu;
  nu << velocity(drag.center_B, state.at_drag.water), w;
  const LongVec6 drag_B = -drag.linear.cast<long double>() * nu -
                          drag.quadratic.cast<long double>() * LongVec6(nu.cwiseAbs().cwiseProduct(nu));
  const AddedMassCoefficients& added = *coefficients.added_mass;
  const FlowAtBody& water = state.at_added_mass.water;
  const LongVec3 v = velocity(added.center_B, water);
  nu << v, w;
  const LongVec6 momentum = added.matrix.cast<long double>() * nu;
  const LongVec3 p = momentum.head<3>();
  const LongVec3 l = momentum.tail<3>();
  const LongVec6 of_water = added.matrix.leftCols<3>().cast<long double>() *
                            LongVec3(in_B(water.acceleration_W) - w.cross(in_B(water.velocity_W)));
  return at_reference_W(drag_B.head<3>(), drag_B.tail<3>(), drag.center_B, state.at_drag.immersion.value) +
         at_reference_W(of_water.head<3>() - w.cross(p), of_water.tail<3>() - v.cross(p) - w.cross(l),
                        added.center_B, state.at_added_mass.immersion.value);
}

// What may be off in a load's input; nothing but rounding in the last case.
enum class Source { kImmersion, kVelocity, kAcceleration, kRounding };

// Coefficients and motions of any size, of drag or added mass alone or of both.
struct LoadCase {
  HydrodynamicCoefficients coefficients;
  HydrodynamicState state;
  Vec3 reference_B;
};

LoadCase random_load_case(RandomPoses& random, Source source) {
  LoadCase one{random_coefficients(random), random_state(random), random_vec3(random)};
  const auto scaled = [&random](Mat6& matrix) {
    Vec6 scale;
    for (double& number : scale) number = random.power_of_ten(-3.0, 0.0);
    matrix = (scale.asDiagonal() * matrix * scale.asDiagonal()).eval();
  };
  for (Mat6* const matrix : {&one.coefficients.drag->linear, &one.coefficients.drag->quadratic,
                             &one.coefficients.added_mass->matrix}) {
    scaled(*matrix);
    if (random.pick(3) == 0) matrix->setZero();
  }
  one.reference_B *= random.power_of_ten(-3.0, 3.0);
  one.coefficients.drag->center_B *= random.power_of_ten(-3.0, 1.0);
  one.coefficients.added_mass->center_B *= random.power_of_ten(-3.0, 1.0);
  one.state.motion.angular_velocity_W *= random.power_of_ten(-3.0, 1.0);
  one.state.motion.velocity_W *= random.power_of_ten(-3.0, 1.0);
  if (source == Source::kRounding) {
    // A body that drifts with a fast current: what counts is a small difference.
    const double speed = random.power_of_ten(-4.0, 4.0);
    const Vec3 drift = speed * random_vec3(random);
    one.state.motion.velocity_W += drift;
    one.state.at_drag.water.velocity_W += drift;
    one.state.at_added_mass.water.velocity_W += drift;
  }
  return one;
}

// The error of force or torque over its bound where one source of errors is far above the others.
double bound_ratio(RandomPoses& random, Source source, bool of_torque) {
  const LoadCase truth = random_load_case(random, source);
  HydrodynamicState off = truth.state;
  for (Surroundings* surroundings : {&off.at_drag, &off.at_added_mass}) {
    const Vec3 by = 1e-3 * random_vec3(random);
    if (source == Source::kImmersion) {
      surroundings->immersion.value += by.x();
      surroundings->immersion.error = std::abs(by.x());
    } else if (source == Source::kVelocity) {
      surroundings->water.velocity_W += by;
      surroundings->water.velocity_error = by.norm();
    } else if (source == Source::kAcceleration) {
      surroundings->water.acceleration_W += by;
      surroundings->water.acceleration_error = by.norm();
    }
  }
  const HydrodynamicLoad load = HydrodynamicModel(truth.coefficients, truth.reference_B).load(off);
  const LongVec6 error =
      total(load).cast<long double>() - true_load(truth.coefficients, truth.reference_B, truth.state);
  return of_torque ? static_cast<double>(error.tail<3>().norm()) / load.torque_error_bound
                   : static_cast<double>(error.head<3>().norm()) / load.force_error_bound;
}

// The bound holds, and errors that are climbed to come as near to it as this: it is no larger by far.
TEST(HydrodynamicLoad, IsWithinItsBoundAndComesNearToIt) {
  struct Row {
    Source source;
    double force, torque;
  };
  for (const Row& row : {Row{Source::kImmersion, 0.8, 0.8}, Row{Source::kVelocity, 0.8, 0.5},
                         Row{Source::kAcceleration, 0.8, 0.8}, Row{Source::kRounding, 0.01, 0.01}}) {
    for (const bool of_torque : {false, true}) {
      SCOPED_TRACE(testing::Message()
                   << "source " << static_cast<int>(row.source) << ", torque " << of_torque);
      const double reached =
          highest(11, {.draws = 3000, .climbs = 3, .steps = 3000},
                  [&](RandomPoses& random) { return bound_ratio(random, row.source, of_torque); });
      EXPECT_LE(reached, 1.0);
      EXPECT_GE(reached, of_torque ? row.torque : row.force);
    }
  }
}

TEST(HydrodynamicLoad, DampingIsTheDerivative) {
  RandomPoses random(13);
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
  RandomPoses random(14);
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
  RandomPoses random(15);
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
  RandomPoses random(16);
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
  RandomPoses random(17);
  const HydrodynamicModel model{random_coefficients(random), random_vec3(random)};
  HydrodynamicState state = random_state(random);
  state.at_drag.immersion = state.at_added_mass.immersion = {0.0, 0.0};
  for (const double velocity : {1.0, 5e306}) {
    state.motion.velocity_W = Vec3(velocity, 0.0, -velocity);
    const HydrodynamicLoad load = model.load(state);
    EXPECT_EQ(total(load), Vec6::Zero());
    EXPECT_EQ(load.force_error_bound, 0.0);
    EXPECT_EQ(load.torque_error_bound, 0.0);
    const HydrodynamicMatrices matrices = model.matrices(state);
    EXPECT_EQ(matrices.damping_W, Mat6::Zero());
    EXPECT_EQ(matrices.added_mass_W, Mat6::Zero());
  }
}

}  // namespace
}  // namespace buoyancy
