// A hash by which programs notice that they have loaded different scenes.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace buoyancy {

// Hashes what decides the wrenches of a scene's bodies: the meshes as prepared, the components of the waves,
// and everything that the scene file states besides [body.client], the names of mesh files and comments. The
// order of keys, and a whole number in the place of a real one, make no difference; a default that is written
// down does. It detects mistakes, not forgery. Complexity: O(scene), some GB/s.
std::int64_t scene_fingerprint(const Scene& scene);

}  // namespace buoyancy
