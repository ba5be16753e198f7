#include "view/common/sea_json.h"

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "view/page/base64.h"
#include "waves/sea_snapshot.h"

namespace buoyancy::view {
namespace {

std::size_t coefficient_count(const ElevationSpline& spline) {
  return spline.stride() * (static_cast<std::size_t>(spline.axis(1).cells) + 3);
}

bool are_on_same_grid(const ElevationSpline& a, const ElevationSpline& b) {
  const auto agree = [](const ElevationSpline::Axis& one, const ElevationSpline::Axis& other) {
    return one.origin == other.origin && one.spacing == other.spacing && one.cells == other.cells &&
           one.periodic == other.periodic;
  };
  return agree(a.axis(0), b.axis(0)) && agree(a.axis(1), b.axis(1));
}

Json part_json(const ElevationSpline& spline, double share, const std::vector<float>& coefficients) {
  const auto& [along_1, along_2] = std::pair(spline.axis(0), spline.axis(1));
  return {{"share", share},
          {"origin", {along_1.origin, along_2.origin}},
          {"spacing", {along_1.spacing, along_2.spacing}},
          {"cells", {along_1.cells, along_2.cells}},
          {"periodic", along_1.periodic},
          {"coefficients", base64_of(std::span(coefficients))}};
}

Json parts_json(const ElevationBlend& surface) {
  Json parts = Json::array();
  std::vector<float> coefficients;
  for (std::size_t n = 0; n < surface.count; ++n) {
    const auto& [spline, share] = surface.parts[n];
    const std::size_t count = coefficient_count(*spline);
    if (count > kMaxDrawnCoefficients) return Json::array();
    const bool is_together =
        surface.count == 2 && are_on_same_grid(*surface.parts[0].spline, *surface.parts[1].spline);
    coefficients.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      const double own = spline->coefficients()[i];
      coefficients[i] = static_cast<float>(
          is_together ? share * own + surface.parts[1].share * surface.parts[1].spline->coefficients()[i]
                      : own);
    }
    parts.push_back(part_json(*spline, is_together ? 1.0 : share, coefficients));
    if (is_together) break;
  }
  return parts;
}

}  // namespace

Json sea_json(const Sea& sea) {
  const PreparedComponents& components = sea.prepared();
  return {{"e1", sea.axes().e1_W},
          {"e2", sea.axes().e2_W},
          {"up", sea.water().up_W},
          {"level", sea.water().level},
          {"depth", std::isinf(sea.depth()) ? std::nullopt : std::optional(sea.depth())},
          {"time_origin", sea.time_origin()},
          {"ramp", sea.ramp()},
          {"pressure", to_string(sea.pressure())},
          {"amplitude", components.amplitude},
          {"apparent_frequency", components.apparent_frequency},
          {"wave_number", components.wave_number},
          {"k1", components.k1},
          {"k2", components.k2},
          {"phase", components.phase}};
}

Json sea_json(const SeaPeriod& period) {
  if (period.sea) return sea_json(*period.sea);
  return sea_json(Sea::make({}, period.water).value());
}

Json surface_json(const SeaPeriod& period, std::int64_t utime, double lead_time) {
  const ElevationBlend surface = SeaSnapshot(*period.sea, utime, lead_time).surface();
  Json json = sea_json(*period.sea);
  json["surface"] = {{"rise", surface.rise}, {"parts", parts_json(surface)}};
  return json;
}

double sea_time(const Sea& sea, std::int64_t utime, double lead_time) {
  // Subtracts seconds and microseconds apart, since the difference of two int64 may exceed an int64.
  constexpr std::int64_t kSecond = 1'000'000;
  const std::int64_t origin = sea.time_origin();
  const std::int64_t seconds = utime / kSecond - origin / kSecond;
  const std::int64_t microseconds = utime % kSecond - origin % kSecond;
  return static_cast<double>(seconds) + 1e-6 * static_cast<double>(microseconds) + lead_time;
}

double sea_time(const SeaPeriod& period, std::int64_t utime, double lead_time) {
  return period.sea ? sea_time(*period.sea, utime, lead_time) : 0.0;
}

}  // namespace buoyancy::view
