// Warnings about drag and added mass that a scene may have, but that are likely mistakes: see
// scene_warnings().
#pragma once

#include <vector>

#include "scene/scene.h"

namespace buoyancy {

// The full quadratic drag matrices of a scene that are searched for twists that they drive: each search takes
// milliseconds.
inline constexpr std::size_t kMaxSearchedMatrices = 256;

// In the order of the bodies; a warning that applies to several bodies alike appears once and counts them.
std::vector<Warning> coefficient_warnings(const Scene& scene);

}  // namespace buoyancy
