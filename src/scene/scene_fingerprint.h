// A number by which programs notice that they have loaded different scenes.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace buoyancy {

// Equal for scenes whose bodies get the same wrenches: of the meshes as prepared, of the components of the
// waves, and of everything that the scene file states besides [body.client], the names of mesh files and
// comments. The order of keys, and a whole number in the place of a real one, make no difference; a default
// that is written down does. It detects mistakes, not forgery. Complexity: O(scene), some GB/s.
std::int64_t scene_fingerprint(const Scene& scene);

}  // namespace buoyancy
