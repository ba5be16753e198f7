#include "client/ping/service_causes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "base/format.h"
#include "messages/sea_state.h"
#include "scene/scene_fingerprint.h"
#include "transport/udpm_url.h"

namespace buoyancy::ping {
namespace {

void add_if_other(const char* name, double expected, double received, const char* unit,
                  std::vector<std::string>& causes) {
  const double size = std::max(std::abs(expected), std::abs(received));  // infinite: the depth of deep water
  if (expected == received || (std::isfinite(size) && std::abs(expected - received) <= 1e-12 * size)) return;
  causes.push_back(format_text("the service's sea has another {}: {:6} instead of {:6}{}", name, received,
                               expected, unit));
}

void add_sea_causes(const SeaState& expected, const SeaState& received, std::vector<std::string>& causes) {
  add_if_other("level", expected.level, received.level, " m", causes);
  add_if_other("depth", expected.depth, received.depth, " m", causes);
  add_if_other("gravity", expected.gravity, received.gravity, " m/s^2", causes);
  add_if_other("ramp", expected.ramp, received.ramp, " s", causes);
  add_if_other("time_origin", static_cast<double>(expected.time_origin),
               static_cast<double>(received.time_origin), " us", causes);
  for (std::size_t i = 0; i < 3; ++i) {
    add_if_other("current", expected.current[i], received.current[i], " m/s", causes);
  }
  if (expected.wave_pressure != received.wave_pressure) {
    causes.emplace_back("the service's sea has another wave_pressure");
  }
  if (expected.amplitude != received.amplitude || expected.angular_frequency != received.angular_frequency ||
      expected.direction != received.direction || expected.phase != received.phase) {
    causes.push_back(
        "the service has other waves: " +
        pluralize(static_cast<std::int64_t>(received.amplitude.size()), "component", "components") +
        " against " + std::to_string(expected.amplitude.size()) + " of this scene, or others");
  }
}

}  // namespace

std::vector<std::string> causes_from_service(const Scene& scene, const ServiceInfo& service) {
  std::vector<std::string> causes;
  if (service.instance_ids.size() > 1) {
    causes.push_back(
        std::to_string(service.instance_ids.size()) +
        " services respond on these channels, perhaps with different scenes: stop the others, or "
        "give each an LCM URL or channels of its own");
  }
  if (service.status) {
    const ServiceStatus& status = *service.status;
    if (static_cast<std::size_t>(std::max(status.scene_bodies, 0)) != scene.bodies().size()) {
      causes.push_back("the service has another scene file: " + status.scene + " with " +
                       pluralize(status.scene_bodies, "body", "bodies") + ", here " +
                       pluralize(static_cast<std::int64_t>(scene.bodies().size()), "body", "bodies"));
    }
    if (status.scene_fingerprint != scene_fingerprint(scene)) {
      causes.push_back("the service has another scene than this file, or other meshes: " + status.scene);
    }
    if (status.version != BUOYANCY_VERSION) {
      causes.push_back("the service is version " + status.version + ", this program " BUOYANCY_VERSION);
    }
  }
  if (service.status && scene.bodies_with_subdivision() > 0) {
    const ServiceCounters& counters = service.status->counters;
    const std::int64_t conditions = counters.conditions_received + counters.conditions_rejected;
    if (conditions > 0) {
      causes.push_back("the service has received " + pluralize(conditions, "condition", "conditions") +
                       " of compartments and tanks, which need not be as in the scene file: restart it, or "
                       "send them as they are there");
    }
  }
  if (scene.sea() == nullptr && !scene.receives_sea() && service.sea) {
    causes.emplace_back("the service has waves, and this scene has none");
  } else if (scene.sea() != nullptr && service.sea) {
    add_sea_causes(to_sea_state(*scene.sea(), 0), *service.sea, causes);
  } else if (scene.sea() != nullptr && service.status) {
    causes.emplace_back("the service publishes no sea: its scene may have no waves");
  }
  return causes;
}

std::vector<Warning> service_warnings(const Scene& scene, const ServiceInfo& service) {
  std::vector<Warning> warnings;
  if (!service.status) return warnings;
  const ServiceStatus& status = *service.status;
  const std::string subject = "the service (instance " + std::to_string(status.instance_id) + ")";
  const std::string log = "Its log names session, body and likely cause";
  const std::int64_t others = std::max(status.other_services, std::ssize(service.instance_ids) - 1);
  if (others > 0) {
    warnings.push_back(
        {subject, pluralize(others, "other service", "other services") + " on the channel of its status",
         "one service", "another one was not stopped: every request gets two responses",
         "Stop it, or give each an LCM URL or channels of its own"});
  }
  if (status.scene_fingerprint != scene_fingerprint(scene)) {
    warnings.push_back({subject, "its scene " + status.scene + " is not that of " + scene.name(),
                        "the same scene", "another file, or one that was changed since the service loaded it",
                        "Give both the same file, and reload the service with SIGHUP after a change"});
  }
  const ServiceCounters& counters = status.counters;
  if (counters.motions_contradicting > 0) {
    warnings.push_back({subject,
                        pluralize(counters.motions_contradicting, "velocity that contradicts",
                                  "velocities that contradict") +
                            " the motion of its body, since its start",
                        "velocities in the world frame, in m/s and rad/s",
                        "a simulator uses another frame or unit", log});
  }
  if (counters.quaternions_xyzw > 0) {
    warnings.push_back({subject,
                        pluralize(counters.quaternions_xyzw, "session", "sessions") +
                            " with quaternions that look like x, y, z, w, since its start",
                        "the order w, x, y, z", "a simulator sends its own order", log});
  }
  return warnings;
}

std::string cause_of_silence(const LinkOptions& options, const std::string& url, const ServiceInfo& service) {
  if (service.status) {
    return "a service runs here (scene " + service.status->scene + ", version " + service.status->version +
           "), but it stalls, or it uses other channels than " + options.states_channel + " and " +
           options.wrenches_channel + ", which it logs in its line with ready:";
  }
  std::string cause =
      "buoyancyd is not running, is still loading its meshes, stalls, or uses another LCM URL or other "
      "channels: start it with the same ones, and compare with what it logs in its line with ready:";
  const Expected<UdpmUrl> parsed = parse_udpm_url(url);
  if (parsed && parsed->ttl == 0) {
    cause += "; or it is on another machine, which needs ttl=1 in the URL on both, and a multicast route";
  }
  return cause;
}

}  // namespace buoyancy::ping
