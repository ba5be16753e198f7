#include "hydrodynamics/hydrodynamic_load.h"

#include <limits>

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
// Several times the longest chain of operations that leads to a component of a load.
constexpr double kRoundings = 64.0;

// Magnitudes that bound a load and its error at a centre.
struct Magnitudes {
  double v = 0.0;        // [m/s], sum of what the relative velocity consists of
  double w = 0.0;        // [rad/s]
  double v_error = 0.0;  // [m/s], of the relative velocity
};

// center_distance: [m], from B's origin.
Magnitudes magnitudes_of(const BodyMotion& motion, double center_distance, const FlowAtBody& water) {
  Magnitudes m;
  m.w = motion.angular_velocity_W.norm();
  m.v = motion.velocity_W.norm() + m.w * center_distance + water.velocity_W.norm();
  m.v_error = water.velocity_error + 16.0 * kEpsilon * m.v;
  return m;
}

// Bounds on the norms of a load about its centre at s = 1, and on their errors by those of its input.
struct PartBound {
  double force = 0.0, torque = 0.0;              // [N], [N m]
  double force_error = 0.0, torque_error = 0.0;  // [N], [N m]
};

// lever: [m], from the centre to the reference point.
void add_error(const PartBound& part, const ImmersionFactor& s, double lever, HydrodynamicLoad& load) {
  const double rounding = kRoundings * kEpsilon * s.value;
  const double force = s.value * part.force_error + (rounding + s.error) * part.force;
  const double torque = s.value * part.torque_error + (rounding + s.error) * part.torque;
  load.force_error_bound += force;
  load.torque_error_bound += torque + lever * force;
}

// Converts a wrench in B's axes about a centre to W's axes and the reference point.
Vec6 to_reference_W(const Vec6& wrench_B, const Vec3& center_to_reference_B, const Mat3& R_WB) {
  const Vec6 moved = wrench_about(wrench_B, center_to_reference_B);
  Vec6 wrench_W;
  wrench_W.head<3>() = R_WB * moved.head<3>();
  wrench_W.tail<3>() = R_WB * moved.tail<3>();
  return wrench_W;
}

Mat6 drag_matrix(const DragCoefficients& drag, const Vec6& twist, double quadratic_factor) {
  return drag.linear + drag.quadratic * (quadratic_factor * twist.cwiseAbs()).asDiagonal();
}

}  // namespace

HydrodynamicModel::MatrixTerms::MatrixTerms(const Mat6& matrix)
    : diagonal(matrix.diagonal()),
      force_v(matrix.topLeftCorner<3, 3>().norm()),
      force_w(matrix.topRightCorner<3, 3>().norm()),
      torque_v(matrix.bottomLeftCorner<3, 3>().norm()),
      torque_w(matrix.bottomRightCorner<3, 3>().norm()),
      is_diagonal(matrix == Mat6(diagonal.asDiagonal())) {}

HydrodynamicModel::HydrodynamicModel(const HydrodynamicCoefficients& coefficients, const Vec3& reference_B)
    : reference_B_(reference_B), coefficients_(coefficients) {
  const auto placement = [&](const Vec3& center_B, ImmersionScaling immersion) {
    const Vec3 to_reference_B = reference_B - center_B;
    return Placement{center_B, to_reference_B, center_B.norm(), to_reference_B.norm(), immersion};
  };
  if (coefficients_.drag) {
    const DragCoefficients& drag = *coefficients_.drag;
    drag_ = {&drag, placement(drag.center_B, drag.immersion), MatrixTerms(drag.linear),
             MatrixTerms(drag.quadratic)};
  }
  if (coefficients_.added_mass) {
    const AddedMassCoefficients& added = *coefficients_.added_mass;
    added_mass_ = {&added, placement(added.center_B, added.immersion), MatrixTerms(added.matrix)};
  }
}

Vec6 relative_twist_B(const BodyMotion& motion, const Vec3& center_B, const Vec3& water_velocity_W) {
  Vec6 twist;
  twist.tail<3>() = motion.R_WB.transpose() * motion.angular_velocity_W;
  twist.head<3>() =
      motion.R_WB.transpose() * (motion.velocity_W - water_velocity_W) + twist.tail<3>().cross(center_B);
  return twist;
}

HydrodynamicLoad HydrodynamicModel::load(const HydrodynamicState& state) const {
  HydrodynamicLoad load;
  const auto may_be_wet = [](const ImmersionFactor& s) { return s.value > 0.0 || s.error > 0.0; };
  if (drag_.matrices != nullptr && may_be_wet(state.at_drag.immersion)) add_drag(state, load);
  if (added_mass_.matrices != nullptr && may_be_wet(state.at_added_mass.immersion))
    add_added_mass(state, load);
  return load;
}

void HydrodynamicModel::add_drag(const HydrodynamicState& state, HydrodynamicLoad& load) const {
  const auto& [matrices, placement, linear, quadratic] = drag_;
  const auto& [water, s] = state.at_drag;
  const Vec6 nu = relative_twist_B(state.motion, placement.center_B, water.velocity_W);
  const Vec6 squares = nu.cwiseAbs().cwiseProduct(nu);
  const Vec6 linear_B =
      linear.is_diagonal ? Vec6(linear.diagonal.cwiseProduct(nu)) : Vec6(matrices->linear * nu);
  const Vec6 quadratic_B = quadratic.is_diagonal ? Vec6(quadratic.diagonal.cwiseProduct(squares))
                                                 : Vec6(matrices->quadratic * squares);
  load.drag_W =
      to_reference_W(-s.value * (linear_B + quadratic_B), placement.to_reference_B, state.motion.R_WB);

  const Magnitudes m = magnitudes_of(state.motion, placement.center_distance, water);
  PartBound bound;
  bound.force =
      (linear.force_v + quadratic.force_v * m.v) * m.v + (linear.force_w + quadratic.force_w * m.w) * m.w;
  bound.torque =
      (linear.torque_v + quadratic.torque_v * m.v) * m.v + (linear.torque_w + quadratic.torque_w * m.w) * m.w;
  bound.force_error = (linear.force_v + 2.0 * quadratic.force_v * (m.v + m.v_error)) * m.v_error;
  bound.torque_error = (linear.torque_v + 2.0 * quadratic.torque_v * (m.v + m.v_error)) * m.v_error;
  add_error(bound, s, placement.lever, load);
}

void HydrodynamicModel::add_added_mass(const HydrodynamicState& state, HydrodynamicLoad& load) const {
  const auto& [matrices, placement, A] = added_mass_;
  const auto& [water, s] = state.at_added_mass;
  const Vec6 nu = relative_twist_B(state.motion, placement.center_B, water.velocity_W);
  const Vec3 v = nu.head<3>();
  const Vec3 w = nu.tail<3>();
  const Vec3 water_v = state.motion.R_WB.transpose() * water.velocity_W;
  const Vec3 water_a = state.motion.R_WB.transpose() * water.acceleration_W - w.cross(water_v);
  Vec6 momentum;
  Vec6 load_B = Vec6::Zero();
  if (A.is_diagonal) {
    momentum = A.diagonal.cwiseProduct(nu);
    load_B.head<3>() = A.diagonal.head<3>().cwiseProduct(water_a);
  } else {
    momentum = matrices->matrix * nu;
    load_B = matrices->matrix.leftCols<3>() * water_a;
  }
  load_B.head<3>() -= w.cross(momentum.head<3>());
  load_B.tail<3>() -= v.cross(momentum.head<3>()) + w.cross(momentum.tail<3>());
  load_B *= s.value;
  load.added_mass_W = to_reference_W(load_B, placement.to_reference_B, state.motion.R_WB);

  const Magnitudes m = magnitudes_of(state.motion, placement.center_distance, water);
  const double p = A.force_v * m.v + A.force_w * m.w;
  const double l = A.torque_v * m.v + A.torque_w * m.w;
  const double a = water.acceleration_W.norm() + m.w * water.velocity_W.norm();
  const double a_error = water.acceleration_error + m.w * water.velocity_error;
  const double p_error = A.force_v * m.v_error;
  PartBound bound;
  bound.force = m.w * p + A.force_v * a;
  bound.torque = m.v * p + m.w * l + A.torque_v * a;
  bound.force_error = m.w * p_error + A.force_v * a_error;
  bound.torque_error =
      m.v_error * (p + p_error) + m.v * p_error + m.w * A.torque_v * m.v_error + A.torque_v * a_error;
  add_error(bound, s, placement.lever, load);
}

HydrodynamicMatrices HydrodynamicModel::matrices(const HydrodynamicState& state) const {
  HydrodynamicMatrices matrices;
  const Mat3& R_WB = state.motion.R_WB;
  Mat6 damping_B = Mat6::Zero();  // about the reference point
  // A dry body's terms are left out, since a factor of 0 times a velocity that overflows is NaN.
  if (coefficients_.drag && state.at_drag.immersion.value > 0.0) {
    const DragCoefficients& drag = *coefficients_.drag;
    const auto& [water, s] = state.at_drag;
    const Vec6 nu = relative_twist_B(state.motion, drag.center_B, water.velocity_W);
    damping_B = matrix_at(s.value * drag_matrix(drag, nu, 2.0), reference_B_ - drag.center_B);
  }
  if (coefficients_.added_mass && state.at_added_mass.immersion.value > 0.0) {
    const AddedMassCoefficients& added = *coefficients_.added_mass;
    const auto& [water, s] = state.at_added_mass;
    const Vec6 nu = relative_twist_B(state.motion, added.center_B, water.velocity_W);
    const Mat6 mass_B = s.value * added.matrix;
    // -s A (w x v_water) varies with w as well: its derivative is s A [v_water].
    Mat6 derivative = coriolis_derivative(mass_B, nu);
    derivative.rightCols<3>() -= mass_B.leftCols<3>() * cross_matrix(R_WB.transpose() * water.velocity_W);
    const Vec3 lever_B = reference_B_ - added.center_B;
    matrices.added_mass_W = rotated(matrix_at(mass_B, lever_B), R_WB);
    damping_B += matrix_at(derivative, lever_B);
  }
  matrices.damping_W = rotated(damping_B, R_WB);
  return matrices;
}

}  // namespace buoyancy
