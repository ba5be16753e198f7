// Meshes that lie on their side: coordinates are used as their file has them, whichever of its axes is up.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_report.h"
#include "scene/scene.h"

namespace buoyancy {

// The unit vector of "x", "-y" and so on; nullopt for other names, such as "not stated".
std::optional<Vec3> axis_from_name(const std::string& name);

// A warning without a subject if the file states an up axis that lies more than 45 degrees from up, with the
// `orientation` that stands the mesh up. up_B: in the frame of the body, unit length.
std::optional<Warning> up_axis_warning(const MeshReport& report, const Vec3& up_B);

// Of all meshes of a scene, in the order of its bodies. Up is that of the water, at the orientation with
// which a body starts ([body.client]). A warning about equal bodies appears once.
std::vector<Warning> up_axis_warnings(const Scene& scene);

}  // namespace buoyancy
