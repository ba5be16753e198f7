// The body of buoyancy-hydrostatics: one of a scene, or a mesh with a mass.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "flotation/floating_body.h"
#include "scene/scene.h"
#include "service/hydrostatics/hydrostatics_options.h"

namespace buoyancy::service {

// A scene and one of its bodies, which needs no mass.
struct LoadedScene {
  std::string name;  // of the scene's file and the body, or of the mesh's file
  Scene scene;
  const Body* body = nullptr;  // of `scene`, also after a move
  bool is_of_scene = true;     // false: a mesh file

  // Where its heel and trim are 0, unless options say otherwise.
  ShipAxes axes() const { return is_of_scene ? body->axes : ShipAxes{}; }
};

// Errors: those of the scene, a body that it lacks, several bodies and none named.
Expected<LoadedScene> load_scene(const HydrostaticsOptions& options, const HydrostaticsPlan& plan);

// The parts and open compartments of a body as terms of their own, where it has any.
struct BodyShares {
  std::vector<std::shared_ptr<const HydrostaticMesh>> meshes;  // with their trees
  std::vector<std::string> names;                              // of body.volumes()
  FloatingBody body;                                           // as a whole the same one
};

struct LoadedBody {
  std::string name;  // of the scene's file and the body, or of the mesh's file
  Scene scene;
  const Body* scene_body = nullptr;             // of `scene`, also after a move
  std::shared_ptr<const HydrostaticMesh> mesh;  // with its tree
  FloatingBody body;                            // of `mesh`
  std::optional<BodyShares> shares = {};        // of the command equilibrium
  bool knows_mass = true;                       // false: that of `body` is any
  std::optional<Warning> assumed_mass = {};     // set: the scene does not say what the body weighs

  const Water& water() const { return scene.water(); }
};

// Errors: for a command that needs it, a body without a mass.
Expected<LoadedBody> load_body(LoadedScene loaded, const HydrostaticsPlan& plan);

}  // namespace buoyancy::service
