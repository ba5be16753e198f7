#include "scene/up_axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

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

std::string quaternion_text(const Eigen::Quaterniond& q) {
  const auto plain = [](double value) { return std::abs(value) < 1e-12 ? 0.0 : value; };
  return format_text("[{:12}, {:12}, {:12}, {:12}]", plain(q.w()), plain(q.x()), plain(q.y()), plain(q.z()));
}

// Says which argument to pass to a program. report: of a mesh whose file states its up axis.
std::string remedy_text(const MeshReport& report, UpRemedy remedy) {
  const std::string axis = remedy == UpRemedy::kShipAxis ? axis_name(*report.up_B) : report.source.up_axis;
  if (remedy == UpRemedy::kArgument) return "Pass up=\"" + axis + "\"";
  return (axis.starts_with('-') ? "Pass --up=" : "Pass --up ") + axis;
}

}  // namespace

std::optional<Vec3> axis_from_name(std::string_view name) {
  if (name.starts_with('+')) name.remove_prefix(1);
  const auto found = std::ranges::find(kAxes, name);
  if (found == kAxes.end()) return std::nullopt;
  return axis(static_cast<std::size_t>(found - kAxes.begin()));
}

std::string axis_name(const Vec3& direction) {
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    if (direction.isApprox(axis(i), 1e-9)) return std::string(kAxes[i]);
  }
  return format_text("[{:4}]", direction);
}

Eigen::Quaterniond orientation_with_up(const Vec3& axis, const Vec3& scale, const Vec3& up_B) {
  const Vec3 from = axis.cwiseProduct(scale).normalized();
  // Half a turn is about x where possible, so that the bow of a hull stays in front.
  if (from.isApprox(-up_B) && from.x() == 0.0) return {0.0, 1.0, 0.0, 0.0};
  // With two equal components a quarter turn exchanges coordinates without rounding them.
  if (const Vec3 about = from.cross(up_B); from.dot(up_B) == 0.0) {
    return Eigen::Quaterniond(1.0, about.x(), about.y(), about.z()).normalized();
  }
  return rotation_between(from, up_B);
}

std::optional<Warning> up_axis_warning(const MeshReport& report, const Vec3& scale, const Vec3& up_B,
                                       UpRemedy remedy) {
  constexpr double kHalfRightAngle = 0.70710678;  // its cosine
  const std::optional<Vec3> up_of_file = axis_from_name(report.source.up_axis);
  if (!up_of_file || !report.up_B || report.up_B->dot(up_B) > kHalfRightAngle) return std::nullopt;
  // The advised orientation is for a scene file, where z is up whatever the ship's upward axis is.
  const bool is_of_ship = remedy == UpRemedy::kShipAxis;
  const Eigen::Quaterniond upright =
      orientation_with_up(*up_of_file, scale, is_of_ship ? Vec3(Vec3::UnitZ()) : up_B);
  std::string hint = "orientation = " + quaternion_text(upright) + " (w, x, y, z) of the mesh stands it up";
  if (remedy != UpRemedy::kNone) hint.insert(0, remedy_text(report, remedy) + "; in a scene file, ");
  return Warning{"",
                 "mesh '" + report.name + "' has " + report.source.up_axis + " up in its file, which is " +
                     axis_name(*report.up_B) + " of the body",
                 axis_name(up_B) + " of the body, which is " +
                     (is_of_ship ? "the ship's upward axis" : "up in the water"),
                 "coordinates are those of the file, turned by nothing but the mesh's orientation",
                 std::move(hint)};
}

std::vector<Warning> up_axis_warnings(const Scene& scene, const UpAxisCheck& check) {
  BodyWarningList list;
  for (const Body& body : scene.bodies()) {
    const Eigen::Quaterniond q_WB =
        body.dynamics.given ? body.dynamics.orientation : Eigen::Quaterniond::Identity();
    const Vec3 up_B = check.up_B.value_or(q_WB.conjugate() * scene.water().up_W);
    const auto check_mesh = [&](const PreparedMesh& mesh) {
      if (std::optional<Warning> warning = up_axis_warning(mesh.report, mesh.scale, up_B, check.remedy))
        list.add(body, *std::move(warning));
    };
    check_mesh(*body.prepared_mesh);
    if (body.parts != nullptr) {
      for (const BodyPart& part : *body.parts) check_mesh(*part.prepared_mesh);
    }
    if (body.subdivision == nullptr) continue;
    for (const BodyCompartment& compartment : body.subdivision->compartments)
      check_mesh(*compartment.prepared_mesh);
    for (const BodyTank& tank : body.subdivision->tanks) check_mesh(*tank.prepared_mesh);
  }
  return list.with_subjects(scene.name());
}

}  // namespace buoyancy
