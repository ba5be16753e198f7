#include "view/common/sea_json.h"

#include <cmath>

namespace buoyancy::view {
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
