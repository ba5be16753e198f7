// Where the simulation of a body starts: at the pose in [body.client] or, with start = "equilibrium", afloat
// at rest, at the stable attitude that the body turns to from its `orientation` when its energy can only
// fall.
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

// What a body turns to from its `orientation`.
struct ReachedEquilibrium {
  FlotationOutcome outcome = FlotationOutcome::kOutOfRange;
  std::optional<Equilibrium> equilibrium;  // set where it floats
  double mass = 0.0;                       // [kg], with the liquids in its tanks
  double displaced = 0.0;  // [kg], of the water that it displaces fully submerged; of an open mesh a scale
};

// Why a body does not start at equilibrium, without a subject; worth a warning even if it need not. outcome:
// not kFloats. mass, displaced: as above.
Warning not_afloat(const Body& body, FlotationOutcome outcome, double mass, double displaced);

// The pose of an equilibrium at the horizontal position and with the heading of [body.client].
Pose placed_pose(const Equilibrium& equilibrium, const DynamicsSpec& dynamics, const Water& water);

class StartFinder {
 public:
  explicit StartFinder(const Scene& scene) : scene_(&scene), keys_(scene) {}  // scene outlives this object

  // body: of the scene. Returns [body.client] with the position and the orientation at which the body starts:
  // its own without start = "equilibrium". Errors: those of mass_of_body(); a body that sinks, is neutrally
  // buoyant, or takes in water before it floats.
  Expected<DynamicsSpec> start_of(const Body& body);

  // nullptr: mass_of_body() has none. Valid as long as this object. Equal bodies are computed once.
  // Complexity: find_equilibrium_from().
  const ReachedEquilibrium* reached_from_orientation(const Body& body);

 private:
  const Scene* scene_;
  BodyKeys keys_;
  MeshesWithTrees meshes_;
  std::map<BodyKey, ReachedEquilibrium> known_;
};

}  // namespace buoyancy
