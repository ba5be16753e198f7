// A scene as Python holds it, and its bodies by id or name.
#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "scene/scene.h"

namespace buoyancy::python {

struct SceneObject {
  std::shared_ptr<const Scene> scene;
};

// The scene of a file, read without the interpreter's lock. file: its path. Warns of its meshes.
std::shared_ptr<const Scene> load_scene(pybind11::handle file);

// id: an int or a name. Throws a KeyError that lists the bodies, a TypeError for other objects.
const Body& find_body(const Scene& scene, pybind11::handle id);

}  // namespace buoyancy::python
