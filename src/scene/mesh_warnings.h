// Warnings about meshes that a scene may have, but that are likely mistakes: they lie on their side, or are
// in another unit than metres. Programs print these when they load a scene; scene_warnings() has them too.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "scene/up_axis.h"

namespace buoyancy {

// Returns up_axis_warnings() with this check, then warns about bodies larger than 1 km, and about those whose
// density in [body.client], or whose mass over the volume of the mesh, is implausible, with the scale that
// would make it plausible, and about water whose density is likely in g/cm^3. A warning about equal bodies
// appears once.
std::vector<Warning> mesh_warnings(const Scene& scene, const UpAxisCheck& up = {});

}  // namespace buoyancy
