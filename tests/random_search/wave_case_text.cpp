#include <string>
#include <variant>

#include "base/format.h"
#include "tests/random_search/wave_case.h"

namespace buoyancy {
namespace {

std::string number(double value) {
  return format_shortest(value);
}

std::string numbers(const Vec3& v) {
  return format_vector(v, 17);
}

std::string describe(const WaveSystem& system) {
  std::string text;
  if (const auto* irregular = std::get_if<IrregularWaves>(&system)) {
    text = "  irregular: significant_wave_height " + number(irregular->significant_wave_height) +
           ", peak_period " + number(irregular->peak_period) + ", gamma " +
           (irregular->gamma ? number(*irregular->gamma) : "default") + ", direction " +
           number(irregular->direction) + ", spreading " + number(irregular->spreading.value_or(0.0)) +
           ", cutoff " + number(irregular->cutoff) + ", seed " + std::to_string(irregular->seed) + "\n";
  }
  if (const auto* components = std::get_if<WaveComponents>(&system)) {
    for (const WaveComponent& wave : *components) {
      text += "  amplitude " + number(wave.amplitude) + ", angular_frequency " +
              number(wave.angular_frequency) + ", direction " + number(wave.direction) + ", phase " +
              number(wave.phase) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string_view to_string(SeaKind kind) {
  switch (kind) {
    case SeaKind::kRegular:
      return "regular";
    case SeaKind::kSeveral:
      return "2 to 16 components";
    case SeaKind::kIrregular:
      return "irregular, 200 components";
    case SeaKind::kShort:
      return "short";
    case SeaKind::kSteep:
      return "steep";
    case SeaKind::kLong:
      return "very long";
  }
  return "";
}

std::string describe(const WaveRequest& request) {
  const Eigen::Quaterniond& q = request.pose.q_WB;
  const SeaDescription& sea = request.description;
  std::string text = "  " + std::string(to_string(request.kind)) + ", " + request.placement + ", pressure " +
                     std::string(to_string(sea.pressure)) + ", tolerance " + number(request.tolerance) +
                     "\n  depth " + number(sea.depth) + ", time_origin " + std::to_string(sea.time_origin) +
                     ", ramp " + number(sea.ramp) + "\n";
  for (const WaveSystem& system : sea.systems) text += describe(system);
  text += "  up " + numbers(request.water.up_W) + ", level " + number(request.water.level) + ", gravity " +
          number(request.water.gravity) + "\n  utime " + std::to_string(request.utime) + ", lead_time " +
          number(request.lead_time) + "\n  p_WB " + numbers(request.pose.p_WB) + "\n  q_WB " + number(q.w()) +
          ", " + numbers(q.vec()) + "\n  reference_B " + numbers(request.reference_B) + "\n";
  return text;
}

}  // namespace buoyancy
