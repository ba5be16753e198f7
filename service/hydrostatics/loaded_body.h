// The body of buoyancy-hydrostatics: one of a scene, or a mesh with a mass.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "flotation/floating_body.h"
#include "scene/scene.h"
#include "service/hydrostatics/hydrostatics_options.h"

namespace buoyancy::service {

struct LoadedBody {
  std::string name;  // of the scene's file and the body, or of the mesh's file
  Scene scene;
  std::shared_ptr<const HydrostaticMesh> mesh;  // with its tree
  FloatingBody body;                            // of `mesh`
  ShipAxes axes;                                // where its heel and trim are 0, unless options say otherwise
  bool knows_mass = true;                       // false: that of `body` is any
  std::optional<Warning> assumed_mass = {};     // set: the scene does not say what the body weighs

  const Water& water() const { return scene.water(); }
};

// Errors: those of the scene, a body that it lacks, several bodies and none named, and for a command that
// needs it a body without a mass.
Expected<LoadedBody> load_body(const HydrostaticsOptions& options, const HydrostaticsPlan& plan);

}  // namespace buoyancy::service
