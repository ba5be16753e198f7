// Warnings about how the parts, compartments and tanks of bodies are arranged, each with the volume that it
// is about: see scene_warnings().
#pragma once

#include <vector>

#include "scene/scene.h"

namespace buoyancy {

// Smaller shares of the smaller mesh's volume are not reported: they are rounding where faces touch.
inline constexpr double kReportedVolumeShare = 1e-6;

// Warns about parts of a body that overlap, whose common volume displaces water twice, about compartments and
// tanks that stick out of the body's mesh or overlap each other, in the order of the bodies. Volumes are
// within some 1e-3 of the smaller mesh's, see geometry/common_volume.h. Complexity: some 20 ms for each
// pair of meshes whose bounding boxes meet, and for each compartment and tank; equal pairs count once.
std::vector<Warning> subdivision_warnings(const Scene& scene);

}  // namespace buoyancy
