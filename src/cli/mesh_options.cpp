#include "cli/mesh_options.h"

#include <utility>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/csv_field.h"
#include "scene/up_axis.h"

namespace buoyancy {

void add_scale_option(CLI::App& app, std::string& scale, CLI::Option* mesh) {
  CLI::Option* const option = app.add_option("--scale", scale,
                                             std::string(mesh == nullptr ? "Factor" : "With --mesh: factor") +
                                                 " on its coordinates, or one for each; negative ones mirror")
                                  ->option_text("FACTOR|X,Y,Z [1]");
  if (mesh != nullptr) option->needs(mesh);
}

void add_up_option(CLI::App& app, std::optional<std::string>& up, CLI::Option* mesh) {
  CLI::Option* const option =
      app.add_option(
             "--up", up,
             std::string(mesh == nullptr ? "Turn the mesh" : "With --mesh: turn it") +
                 " so that this axis of the file is up: x, y, z, --up=-x ... (default: coordinates as "
                 "the file has them)")
          ->option_text("AXIS");
  if (mesh != nullptr) option->needs(mesh);
}

Expected<Vec3> parse_scale(const std::string& text) {
  double factor = 0.0;
  if (parse_finite(trim(text), factor) && factor > 0.0) return Vec3(Vec3::Constant(factor));
  const std::optional<Vec3> factors = parse_vector(text);
  if (factors && (factors->array() != 0.0).all()) return *factors;
  std::string hint = "For millimetres write --scale 0.001";
  if (factor < 0.0) hint = "Mirror with a factor for each axis, such as --scale=-1,1,1";
  return make_error({"--scale", quote(text),
                     "a number above 0, or factors X,Y,Z of the three axes of which none is 0",
                     factors ? "a mesh without an extent" : "", std::move(hint)});
}

Expected<Vec3> parse_axis(const std::string& subject, const std::string& text) {
  if (const std::optional<Vec3> axis = axis_from_name(text)) return *axis;
  return make_error({subject, quote(text), "one of x y z -x -y -z, an axis of the mesh", "",
                     "Write a negative axis with an equals sign: " + subject + "=-x"});
}

std::optional<Vec3> parse_vector(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ',');
  Vec3 vector;
  if (parts.size() != 3) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!parse_finite(parts[i], vector[static_cast<Eigen::Index>(i)])) return std::nullopt;
  }
  return vector;
}

Expected<MeshPlacement> placement_of(const std::string& scale, const std::optional<std::string>& up) {
  const Expected<Vec3> factors = parse_scale(scale);
  if (!factors) return tl::unexpected(factors.error());
  MeshPlacement placement{.scale = *factors};
  if (!up) return placement;
  const Expected<Vec3> axis = parse_axis("--up", *up);
  if (!axis) return tl::unexpected(axis.error());
  placement.orientation_B = orientation_with_up(*axis, placement.scale);
  return placement;
}

}  // namespace buoyancy
