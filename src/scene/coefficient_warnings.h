// Warnings about drag and added mass that a scene may have, but that are likely mistakes: see
// scene_warnings().
#pragma once

#include <vector>

#include "scene/scene.h"

namespace buoyancy {

// How many full quadratic drag matrices of a scene are searched for twists that they drive, at most: each
// search takes milliseconds.
inline constexpr std::size_t kMaxSearchedMatrices = 256;

// Warns in the order of the bodies. A warning that applies to several of them appears once and counts them.
std::vector<Warning> coefficient_warnings(const Scene& scene);

}  // namespace buoyancy
