// Finds meshes that lie on their side: coordinates are used as in the file, whichever of its axes is up.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "geometry/mesh_report.h"
#include "scene/scene.h"

namespace buoyancy {

// The unit vector of "x", "+x", "-y" and so on; nullopt for other names, such as "not stated".
std::optional<Vec3> axis_from_name(std::string_view name);
// The name of an axis of coordinates, "-y" for instance; the components of another direction.
std::string axis_name(const Vec3& direction);

// Returns the orientation of a mesh that turns an axis of its file up. axis: of the file; up_B: in the frame
// of the body; both unit length. scale: of the mesh's placement, whose negative factors turn axes round.
Eigen::Quaterniond orientation_with_up(const Vec3& axis, const Vec3& scale, const Vec3& up_B = Vec3::UnitZ());

// The advice of a warning beside the `orientation` of a mesh in a scene file.
enum class UpRemedy {
  kNone,
  kOption,    // --up, which turns the mesh by orientation_with_up()
  kShipAxis,  // --up, which turns nothing and states the ship's upward axis in the frame of the body
  kArgument,  // up of Python's Mesh, which turns as kOption does
};

// How a program checks which direction is up.
struct UpAxisCheck {
  // Unit length; nullopt: up of the water, at the orientation with which a body starts ([body.client]).
  std::optional<Vec3> up_B{};
  UpRemedy remedy = UpRemedy::kNone;
};

// Returns a warning, without a subject, if the file states an up axis more than 45 degrees from up, with the
// `orientation` that sets the mesh upright. scale: of its placement; up_B: in the frame of the body, unit
// length.
std::optional<Warning> up_axis_warning(const MeshReport& report, const Vec3& scale, const Vec3& up_B,
                                       UpRemedy remedy);

// Warns about all meshes of a scene, in the order of its bodies. A warning about equal bodies appears once.
std::vector<Warning> up_axis_warnings(const Scene& scene, const UpAxisCheck& check = {});

}  // namespace buoyancy
