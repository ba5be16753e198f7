// Finds where the simulation of a body starts: at the pose in [body.client] or, with start = "equilibrium",
// afloat at rest, at the stable attitude to which the body turns from its `orientation` while its energy
// decreases.
//
// The condition of compartments and tanks is that of the scene file, and the water is at rest, also in a
// scene with waves. The horizontal position is that in [body.client]; its part along up is not used. The
// heading is kept: that of the body's x axis, projected on the horizontal plane; where |up . x| > 0.9 before
// or after, that of its y axis, then of its z axis.
#pragma once

#include <map>

#include "flotation/equilibrium.h"
#include "scene/body_key.h"
#include "scene/scene.h"

namespace buoyancy {

// The equilibrium to which a body turns from its `orientation`.
struct ReachedEquilibrium {
  FlotationOutcome outcome = FlotationOutcome::kOutOfRange;
  std::optional<Equilibrium> equilibrium;  // set where it floats
  double mass = 0.0;                       // [kg], with the liquids in its tanks
  double displaced = 0.0;  // [kg], of the water displaced fully submerged; a mere scale for an open mesh
};

// Returns a warning, without a subject, that says why a body cannot start at equilibrium. outcome: not
// kFloats. mass, displaced: as in ReachedEquilibrium.
Warning not_afloat(const Body& body, FlotationOutcome outcome, double mass, double displaced);

// The pose of an equilibrium at the horizontal position and with the heading of [body.client].
Pose placed_pose(const Equilibrium& equilibrium, const DynamicsSpec& dynamics, const Water& water);

class StartFinder {
 public:
  explicit StartFinder(const Scene& scene) : scene_(&scene), keys_(scene) {}  // scene outlives this object

  // body: of the scene. Returns [body.client] with the position and the orientation at which the body starts,
  // unchanged without start = "equilibrium". Errors: those of mass_of_body(); a body that sinks, is neutrally
  // buoyant, or takes in water before it floats.
  Expected<DynamicsSpec> start_of(const Body& body);

  // Returns nullptr where mass_of_body() fails. The pointer is valid as long as this object. Equal bodies
  // are computed once. Complexity: that of find_equilibrium_from().
  const ReachedEquilibrium* reached_from_orientation(const Body& body);

 private:
  const Scene* scene_;
  BodyKeys keys_;
  MeshesWithTrees meshes_;
  std::map<BodyKey, ReachedEquilibrium> known_;
};

}  // namespace buoyancy
