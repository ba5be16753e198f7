#include "scene/mesh_warnings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "base/format.h"
#include "scene/body_warning_list.h"

namespace buoyancy {
namespace {

// [kg/m^3], of bodies: from foam and thin hulls to tungsten.
constexpr double kMinDensity = 20.0;
constexpr double kMaxDensity = 20'000.0;

// Factors from common units of mesh files to metres, and back.
constexpr std::array<double, 8> kUnits{0.001,        0.01,         0.0254, 0.3048,
                                       1.0 / 0.3048, 1.0 / 0.0254, 100.0,  1000.0};

// Returns the scale that makes this density [kg/m^3] most like a floating body's; 0 if none is plausible.
double plausible_scale(double density) {
  constexpr double kUsual = 700.0;
  const auto of = [density](double scale) { return density / (scale * scale * scale); };
  const auto distance = [&](double scale) { return std::abs(std::log(of(scale) / kUsual)); };
  const double best = *std::ranges::min_element(kUnits, {}, distance);
  return of(best) >= kMinDensity && of(best) <= kMaxDensity ? best : 0.0;
}

void warn_of_size(const Body& body, BodyWarningList& list) {
  constexpr double kLargest = 1000.0;  // [m]
  const double size = body.prepared_mesh->mesh.diagonal;
  if (size <= kLargest) return;
  list.add(body, {"", "the diagonal of its bounding box is " + format_number(size, 4) + " m",
                  "at most " + format_number(kLargest) + " m", "a mesh in another unit, such as millimetres",
                  "Set scale = 0.001 for a mesh in millimetres"});
}

void warn_of_density(const Body& body, BodyWarningList& list) {
  if (!body.dynamics.density) return;
  const double density = *body.dynamics.density;
  if (density >= kMinDensity && density <= kMaxDensity) return;
  list.add(body, {"", "density = " + format_number(density, 6) + " kg/m^3",
                  format_number(kMinDensity) + " to " + format_number(kMaxDensity) + " kg/m^3",
                  "grams per cubic centimetre, or a mass", "Give kg/m^3, or the key mass (kg)"});
}

void warn_of_unit(const Body& body, BodyWarningList& list) {
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  if (!body.dynamics.mass || mesh.is_open() || !(mesh.volume > 0.0)) return;
  const double density = *body.dynamics.mass / mesh.volume;
  if (density >= kMinDensity && density <= kMaxDensity) return;
  const double scale = plausible_scale(density);
  std::string hint = "Correct the mass, or the size of the mesh";
  if (scale != 0.0) {
    hint = format_text("scale = {:4} gives {:3} kg/m^3; where a scale is set, multiply it by that", scale,
                       density / (scale * scale * scale));
  }
  list.add(body, {"",
                  format_text("mass over volume = {:4} kg / {:4} m^3 = {:3} kg/m^3", *body.dynamics.mass,
                              mesh.volume, density),
                  format_text("{} to {} kg/m^3", kMinDensity, kMaxDensity),
                  "a mesh in another unit than metres, such as millimetres", std::move(hint)});
}

void warn_of_water(const Scene& scene, std::vector<Warning>& warnings) {
  // Fresh to salt water in grams per cubic centimetre. Air at sea level, of airships, is above.
  const double density = scene.water().density;
  if (density < 0.9 || density > 1.15) return;
  warnings.push_back({scene.name() + ": water.density", format_number(density, 6) + " kg/m^3",
                      "about 1000 kg/m^3", "grams per cubic centimetre",
                      "Give kg/m^3, such as 1025 for sea water"});
}

}  // namespace

std::vector<Warning> mesh_warnings(const Scene& scene, const UpAxisCheck& up) {
  std::vector<Warning> warnings = up_axis_warnings(scene, up);
  warn_of_water(scene, warnings);
  BodyWarningList units;
  for (const Body& body : scene.bodies()) {
    warn_of_size(body, units);
    warn_of_density(body, units);
    warn_of_unit(body, units);
  }
  std::ranges::move(units.with_subjects(scene.name()), std::back_inserter(warnings));
  return warnings;
}

}  // namespace buoyancy
