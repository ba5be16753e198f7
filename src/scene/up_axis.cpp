#include "scene/up_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/format.h"
#include "geometry/rotation_between.h"
#include "scene/body_warning_list.h"

namespace buoyancy {
namespace {

constexpr std::array<std::string_view, 6> kAxes{"x", "y", "z", "-x", "-y", "-z"};

Vec3 axis(std::size_t i) {
  const Vec3 unit = Vec3::Unit(static_cast<Eigen::Index>(i % 3));
  return i < 3 ? unit : Vec3(-unit);
}

std::string direction_text(const Vec3& direction) {
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    if (direction.isApprox(axis(i), 1e-9)) return std::string(kAxes[i]);
  }
  std::string text = "[";
  text += format_vector(direction, 4);
  return text += "]";
}

// Half a turn is one about x, where that serves: a hull keeps its bow.
Eigen::Quaterniond standing_up(const Vec3& from, const Vec3& to) {
  if (from.isApprox(-to) && from.x() == 0.0) return {0.0, 1.0, 0.0, 0.0};
  return rotation_between(from, to);
}

std::string quaternion_text(const Eigen::Quaterniond& q) {
  std::string text = "[";
  for (const double value : {q.w(), q.x(), q.y(), q.z()}) {
    if (text.size() > 1) text += ", ";
    text += format_number(std::abs(value) < 1e-12 ? 0.0 : value, 12);
  }
  return text += "]";
}

}  // namespace

std::optional<Vec3> axis_from_name(const std::string& name) {
  const auto found = std::ranges::find(kAxes, name);
  if (found == kAxes.end()) return std::nullopt;
  return axis(static_cast<std::size_t>(found - kAxes.begin()));
}

std::optional<Warning> up_axis_warning(const MeshReport& report, const Vec3& up_B) {
  constexpr double kHalfRightAngle = 0.70710678;  // its cosine
  const std::optional<Vec3> up_of_file = axis_from_name(report.source.up_axis);
  if (!up_of_file || !report.up_B || report.up_B->dot(up_B) > kHalfRightAngle) return std::nullopt;
  return Warning{"",
                 "mesh '" + report.name + "' has " + report.source.up_axis + " up in its file, which is " +
                     direction_text(*report.up_B) + " of the body",
                 direction_text(up_B) + " of the body, which is up in the water",
                 "coordinates are used as the file has them and are not turned",
                 "orientation = " + quaternion_text(standing_up(*up_of_file, up_B)) +
                     " (w, x, y, z) of the mesh stands it up"};
}

std::vector<Warning> up_axis_warnings(const Scene& scene) {
  BodyWarningList list;
  for (const Body& body : scene.bodies()) {
    const Eigen::Quaterniond q_WB =
        body.dynamics.given ? body.dynamics.orientation : Eigen::Quaterniond::Identity();
    const Vec3 up_B = q_WB.conjugate() * scene.water().up_W;
    const auto check = [&](const PreparedMesh& mesh) {
      if (std::optional<Warning> warning = up_axis_warning(mesh.report, up_B))
        list.add(body, *std::move(warning));
    };
    check(*body.prepared_mesh);
    if (body.parts != nullptr) {
      for (const BodyPart& part : *body.parts) check(*part.prepared_mesh);
    }
    if (body.subdivision == nullptr) continue;
    for (const BodyCompartment& compartment : body.subdivision->compartments)
      check(*compartment.prepared_mesh);
    for (const BodyTank& tank : body.subdivision->tanks) check(*tank.prepared_mesh);
  }
  return list.with_subjects(scene.name());
}

}  // namespace buoyancy
