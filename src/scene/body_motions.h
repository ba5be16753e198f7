// Computes how a body moves in water at rest: where it floats, how fast it sinks or rises, its natural
// periods, and the largest step of an explicit integrator.
//
// All of it is for the attitude at which a simulation of the body starts (start_pose.h), and for the
// condition of compartments and tanks in the scene file: the liquids in the tanks are frozen as they lie
// there, but for their free surfaces, which reduce K. The axes are E = (e1, e2, up), with e1 the body's x
// axis projected on the horizontal plane (its y axis where |up . x| > 0.9) and e2 = up x e1: heave is along
// up, roll about e1, pitch about e2, about the centre of mass C. M is the mass and the inertia about C, s A
// the added mass about C with s of the present immersion, D = s (D1 + 2 D2 diag(|nu|)) the damping, K the
// hydrostatic stiffness about C (hydrostatics/hydrostatics.h), to which weight adds nothing.
//
// The drag is that of [body.drag] alone: the damping keys of [body.client] do not describe the water. The
// formulas are in hydrodynamics/small_motions.h and docs/mathematics.md, "Small motions".
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/body_mass.h"
#include "scene/floating_pose.h"
#include "scene/scene.h"

namespace buoyancy {

// Heave, roll or pitch.
struct NaturalMotion {
  double frequency = 0.0;      // [rad/s], with added mass; 0: nothing restores the motion, and no ratios
  double damping_ratio = 0.0;  // of the linear drag
  double amplitude = 0.0;      // [m] or [rad]: L / 20 for heave, with L the mesh's diagonal; 0.1 rad
  double damping_ratio_at_amplitude = 0.0;  // of linear and quadratic drag

  double period() const;  // [s]; infinity where nothing restores the motion
};

struct NaturalMotions {
  NaturalMotion heave, roll, pitch;
};

enum class VerticalBalance {
  kFloats,   // lighter than the water that it can displace
  kSinks,    // heavier
  kNeutral,  // equal within 1e-9
  kUnknown,  // an open mesh whose volume is unknown, and that takes in water before it floats
};

// A state that limits the step of an explicit integrator.
enum class StepLimit { kNone, kFloating, kSubmerged, kTerminalVelocity };

struct BodyMotions {
  VerticalBalance balance = VerticalBalance::kUnknown;
  std::optional<double> draft;  // [m], where the body floats
  // [m], horizontal distance of the centre of buoyancy from C there: above 0, the body turns.
  double turning_lever = 0.0;
  // The motions of the body afloat or, if it does not float, fully submerged, in layered water in the deepest
  // layer; unset if neither is known.
  std::optional<NaturalMotions> natural;

  // The velocity along up at which the drag on the fully submerged body, which does not turn, balances weight
  // less buoyancy, to rounding. It is above 0 for a body that rises, below 0 for one that sinks, and 0 for a
  // neutrally buoyant one; unset without drag along up, and for an open mesh.
  std::optional<double> terminal_velocity;  // [m/s]

  // [s], the smallest max_explicit_step() of the body afloat and fully submerged at the velocity of
  // [body.client] relative to the current, and fully submerged at its terminal velocity. Infinity: no limit.
  double max_explicit_step = 0.0;
  StepLimit step_limit = StepLimit::kNone;

  // max_mass_ratio() of the whole A; 0 without one.
  double added_mass_ratio = 0.0;
};

// mesh: the body's, with its tree. current_W: [m/s], at the centre of the drag where the body starts. The
// attitude is that of the body's `orientation`. Returns nullopt without
// a mass, and where a number is beyond double's range. Complexity: O(vertices).
std::optional<BodyMotions> body_motions(const Body& body, const HydrostaticMesh& mesh, const Water& water,
                                        const Vec3& current_W);

// Returns the velocity [m/s] along up, relative to the water, at which the drag on a fully submerged body
// that does not turn balances `force` [N], its buoyancy less its weight, along up; nullopt without drag along
// up, unless the force is 0. up_B: unit.
std::optional<double> terminal_velocity_of(const Body& body, const Vec3& up_B, double force);

// The motions of a body of a scene.
struct MotionsOfBody {
  std::shared_ptr<const BodyMotions> motions;  // null: body_motions() has none, or [body.client] is absent
  bool left_out = false;                       // not computed, because of max_vertices; null then, too
};

// Returns one element per body, in the order of the scene; equal bodies share one. Distinct bodies are
// computed as long as their meshes have at most max_vertices in total, once per distinct body.
std::vector<MotionsOfBody> scene_motions(const Scene& scene, std::size_t max_vertices = 100'000'000);

}  // namespace buoyancy
