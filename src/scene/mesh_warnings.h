// Warnings about meshes that a scene may have, but that are likely mistakes: they lie on their side, or are
// in another unit than metres. Programs print these when they load a scene; scene_warnings() has them too.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "scene/up_axis.h"

namespace buoyancy {

// Of up_axis_warnings() with this check, then of bodies larger than 1 km, and of those whose [body.client]
// gives a density that nothing has, or a mass that over the volume of the mesh is one, with the scale that
// would make it plausible. A warning about equal bodies appears once.
std::vector<Warning> mesh_warnings(const Scene& scene, const UpAxisCheck& up = {});

}  // namespace buoyancy
