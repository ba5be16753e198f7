// The load of the water on a moving body besides buoyancy: drag, and those added-mass terms that are forces.
//
// At a centre, in B's axes, with nu = (R^T (v_center - v_water), R^T w) the twist relative to the water, D1
// and D2 the drag matrices, A the added mass, and s the immersion (coefficients.h):
//
//   drag         -s (D1 + D2 diag(|nu|)) nu
//   added mass   -C_A(nu) nu + s A nu_dot_water,  nu_dot_water = (R^T a_water - R^T w x R^T v_water, 0)
//
// C_A is the Coriolis matrix of s A (base/spatial.h); its moment is the Munk moment, which turns a slender
// body broadside on. The inertial part -s A nu_dot is not among the forces, since one step late it diverges
// as soon as the added mass exceeds the body's mass; the matrix s A is for the simulator's mass matrix
// instead. The rate of change of s A, as when a body enters the water, is neglected. See T. I. Fossen,
// Handbook of Marine Craft Hydrodynamics and Motion Control (2011), sections 6.3, 6.4 and 8.1.
//
// v_water is the velocity that the water would have at the centre without the body, uniform over the body.
#pragma once

#include "hydrodynamics/coefficients.h"

namespace buoyancy {

// The undisturbed water at a point.
struct FlowAtBody {
  Vec3 velocity_W = Vec3::Zero();      // [m/s]
  Vec3 acceleration_W = Vec3::Zero();  // [m/s^2]
  double velocity_error = 0.0;         // [m/s], bound on the norm of the error
  double acceleration_error = 0.0;     // [m/s^2]
};

struct BodyMotion {
  Mat3 R_WB = Mat3::Identity();
  Vec3 velocity_W = Vec3::Zero();          // [m/s], of B's origin
  Vec3 angular_velocity_W = Vec3::Zero();  // [rad/s]
};

// The immersion s and a bound on its error.
struct ImmersionFactor {
  double value = 1.0;  // 0 to 1
  double error = 0.0;
};

// The flow and the immersion for one set of coefficients.
struct Surroundings {
  FlowAtBody water;  // at the centre
  ImmersionFactor immersion;
};

struct HydrodynamicState {
  BodyMotion motion;
  Surroundings at_drag;
  Surroundings at_added_mass;
};

// Wrenches are in W's axes, with torques about the reference point.
struct HydrodynamicLoad {
  Vec6 drag_W = Vec6::Zero();        // [N, N m]
  Vec6 added_mass_W = Vec6::Zero();  // [N, N m]
  double force_error_bound = 0.0;    // [N], of the sum of both, with what the bound of s contributes
  double torque_error_bound = 0.0;   // [N m]
};

// Matrices are in W's axes, about the reference point, and act on its velocity and on w.
struct HydrodynamicMatrices {
  Mat6 added_mass_W = Mat6::Zero();  // s A [kg, kg m, kg m^2]
  // -d(force, torque)/d(velocity, angular velocity) of drag and added mass together [N/(m/s), ...].
  Mat6 damping_W = Mat6::Zero();
};

// The coefficients of a body, prepared for the loads at many poses. It is immutable, and a query allocates
// nothing. Complexity: O(1), a tenth of a microsecond.
class HydrodynamicModel {
 public:
  // The coefficients have passed coefficient_checks.h. reference_B: [m], the point that torques are about.
  HydrodynamicModel(const HydrodynamicCoefficients& coefficients, const Vec3& reference_B);
  HydrodynamicModel(const HydrodynamicModel&) = delete;
  HydrodynamicModel& operator=(const HydrodynamicModel&) = delete;
  ~HydrodynamicModel() = default;

  HydrodynamicLoad load(const HydrodynamicState& state) const;
  HydrodynamicMatrices matrices(const HydrodynamicState& state) const;

  const HydrodynamicCoefficients& coefficients() const { return coefficients_; }
  const Vec3& reference_B() const { return reference_B_; }

  // The point that a matrix is about, and what scales the matrix.
  struct Placement {
    Vec3 center_B = Vec3::Zero();        // [m]
    Vec3 to_reference_B = Vec3::Zero();  // [m], from the centre to the reference point
    double center_distance = 0.0;        // [m], |center_B|
    double lever = 0.0;                  // [m], |to_reference_B|
    ImmersionScaling immersion = ImmersionScaling::kVolume;
  };
  // nullptr: the body has none.
  const Placement* drag_placement() const { return drag_.matrices == nullptr ? nullptr : &drag_.placement; }
  const Placement* added_mass_placement() const {
    return added_mass_.matrices == nullptr ? nullptr : &added_mass_.placement;
  }

 private:
  // A matrix prepared for loads: its diagonal, whether it has other elements (most have none), and the
  // Frobenius norms of its blocks, which bound rounding errors.
  struct MatrixTerms {
    explicit MatrixTerms(const Mat6& matrix);
    MatrixTerms() = default;

    Vec6 diagonal = Vec6::Zero();
    double force_v = 0.0, force_w = 0.0, torque_v = 0.0, torque_w = 0.0;
    bool is_diagonal = true;
  };
  // What every pose reads is stored together, apart from the whole matrices, because a request for many
  // bodies spends much of its time waiting for memory.
  struct DragTerms {
    const DragCoefficients* matrices = nullptr;
    Placement placement;
    MatrixTerms linear, quadratic;
  };
  struct AddedMassTerms {
    const AddedMassCoefficients* matrices = nullptr;
    Placement placement;
    MatrixTerms matrix;
  };

  void add_drag(const HydrodynamicState& state, HydrodynamicLoad& load) const;
  void add_added_mass(const HydrodynamicState& state, HydrodynamicLoad& load) const;

  DragTerms drag_;
  AddedMassTerms added_mass_;
  Vec3 reference_B_;
  HydrodynamicCoefficients coefficients_;
};

// Returns nu at a centre: the twist relative to the water, in B's axes.
Vec6 relative_twist_B(const BodyMotion& motion, const Vec3& center_B, const Vec3& water_velocity_W);

}  // namespace buoyancy
