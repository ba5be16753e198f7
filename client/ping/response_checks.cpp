#include "client/ping/response_checks.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/format.h"
#include "engine/loads_comparison.h"
#include "messages/conversions.h"

namespace buoyancy::ping {
namespace {

// "request 17: off by 245 N, limit 1.1e-09 N: expected (0, 0, 10051), received (0, 0, 9806)".
// expected, received: formatted.
std::string difference_text(std::int64_t seq, double difference, double limit, std::string_view unit,
                            std::string_view expected, std::string_view received) {
  return format_text("request {}: off by {:6}{}, limit {:3}{}: expected {}, received {}", seq, difference,
                     unit, limit, unit, expected, received);
}
std::string difference_text(std::int64_t seq, double difference, double limit, std::string_view unit,
                            const std::array<double, 3>& expected, const std::array<double, 3>& received) {
  return difference_text(seq, difference, limit, unit, format_text("({})", to_vec3(expected)),
                         format_text("({})", to_vec3(received)));
}

// in_bounds: the ratio of the difference to its limit. make_failure is called if it is the largest so far.
template <typename MakeFailure>
bool record(CheckResult& result, double in_bounds, const MakeFailure& make_failure) {
  ++result.compared;
  const bool failed = !(in_bounds <= 1.0);
  if (failed) ++result.failed;
  if (in_bounds > result.worst) {
    result.worst = in_bounds;
    if (failed) result.failure = make_failure();
  }
  return !failed;
}

void record_status(CheckResult& result, std::int64_t seq, BodyStatus expected, BodyStatus received) {
  ++result.compared;
  if (expected == received) return;
  ++result.failed;
  result.worst = std::numeric_limits<double>::infinity();
  if (!result.failure.empty()) return;
  result.failure =
      format_text("request {}: expected {}, received {}", seq, to_string(expected), to_string(received));
}

// Records the fields of a message that have tolerances of their own.
void record_fields(CheckResult& result, std::int64_t seq, const MessageDifferences& differences) {
  record(result, differences.in_bounds, [&] {
    return format_text("request {}: {} is off by {:3} times its tolerance", seq, differences.worst_field,
                       differences.in_bounds);
  });
}

bool same_id(const RequestId& a, const RequestId& b) {
  return a.utime == b.utime && a.session_id == b.session_id && a.seq == b.seq;
}

template <typename Message>
std::string describe_ids(const Message& message) {
  constexpr std::size_t kMaxShown = 8;
  std::string text = format_text("utime {} and bodies", message.id.utime);
  for (std::size_t i = 0; i < std::min(kMaxShown, message.bodies.size()); ++i) {
    text += format_text(" {}", message.bodies[i].body_id);
  }
  if (message.bodies.size() > kMaxShown) text += " ...";
  if (message.bodies.empty()) text += " none";
  return text;
}

template <typename Message>
void decode_own(Bytes bytes, Message& message) {
  [[maybe_unused]] const auto error = decode(bytes, message);
  assert(!error);  // the link or the request handler has checked it
}

}  // namespace

std::string_view to_string(Check check) {
  switch (check) {
    case Check::kStatus:
      return "status";
    case Check::kForce:
      return "force";
    case Check::kTorque:
      return "torque";
    case Check::kVolume:
      return "submerged volume";
    case Check::kCenter:
      return "center of buoyancy";
    case Check::kHydrostatics:
      return "hydrostatics";
    case Check::kLoads:
      return "loads";
  }
  return "";
}

ResponseChecks::ResponseChecks(const Scene& scene) : scene_(&scene), water_(scene) {
  for (const Body& body : scene.bodies()) {
    BodyChecks& checks = bodies_.emplace_back();
    checks.body_id = body.id;
    checks.name = body.name;
  }
}

bool ResponseChecks::all_passed() const {
  return wrong_ids_ == 0 && std::ranges::all_of(bodies_, [](const BodyChecks& body) {
           return std::ranges::all_of(body.results,
                                      [](const CheckResult& check) { return check.failed == 0; });
         });
}

template <typename Message>
bool ResponseChecks::has_same_ids(const RequestId& id, const Message& expected, const Message& received,
                                  std::string_view what) {
  const bool same_bodies = std::ranges::equal(
      expected.bodies, received.bodies, [](const auto& a, const auto& b) { return a.body_id == b.body_id; });
  if (same_bodies && same_id(expected.id, received.id)) return true;
  if (wrong_ids_++ == 0) {
    first_wrong_ids_ = format_text("request {}: {} with {}; expected {}", id.seq, what,
                                   describe_ids(received), describe_ids(expected));
  }
  return false;
}

void ResponseChecks::add(const RequestId& id, const std::vector<BodyState>& states,
                         const ExpectedReply& expected, const Reply& received) {
  ++replies_;
  const bool same_outputs =
      (received.hydrostatics.empty() || received.hydrostatics == expected.hydrostatics) &&
      (received.loads.empty() || received.loads == expected.loads);
  if (received.wrenches == expected.wrenches && same_outputs) ++identical_;
  decode_own(expected.wrenches, expected_wrenches_);
  decode_own(received.wrenches, received_wrenches_);
  if (!has_same_ids(id, expected_wrenches_, received_wrenches_, "a response")) return;
  for (std::size_t i = 0; i < states.size(); ++i) {
    compare_wrench(id, states[i], i, expected_wrenches_.bodies[i], received_wrenches_.bodies[i]);
  }
  if (!received.hydrostatics.empty()) {
    decode_own(expected.hydrostatics, expected_hydrostatics_);
    decode_own(received.hydrostatics, received_hydrostatics_);
    compare_hydrostatics_of(id, expected_hydrostatics_, received_hydrostatics_);
  }
  if (!received.loads.empty()) {
    decode_own(expected.loads, expected_loads_);
    decode_own(received.loads, received_loads_);
    compare_loads_of(id, expected_loads_, received_loads_);
  }
}

double ResponseChecks::volume_limit(const RequestId& id, const BodyState& state, const Body& body,
                                    const BodyWrench& expected, const BodyWrench& received) {
  const double rounding = kRounding * body.solver.mesh().volume;
  const WaterState water = water_.move_to(id.utime, 0.0).water;
  if (water.waves == nullptr) {
    const double weight = scene_->water().density * scene_->water().gravity;  // [N/m^3]
    if (!(weight > 0.0)) return body.solver.tolerance() * body.solver.mesh().volume + rounding;
    return (expected.force_error_bound + received.force_error_bound) / weight + rounding;
  }
  BodyOutcome outcome;
  evaluate(body, water, validate_pose(state, 0.0), outcome);
  const double own = outcome.in_waves.volume_error_bound;
  const double larger = expected.force_error_bound > 0.0
                            ? std::max(1.0, received.force_error_bound / expected.force_error_bound)
                            : 1.0;
  return own * (1.0 + larger) + rounding;
}

void ResponseChecks::compare_wrench(const RequestId& id, const BodyState& state, std::size_t body,
                                    const BodyWrench& expected, const BodyWrench& received) {
  BodyChecks& checks = bodies_[body];
  const Body& of = scene_->bodies()[body];
  record_status(checks.at(Check::kStatus), id.seq, expected.status, received.status);
  DifferingWrench differing{&of, state, id.seq, expected, received};
  if (expected.status != received.status) {
    if (differing_.size() < kMaxDiffering) differing_.push_back(differing);
    return;
  }
  if (expected.status != BodyStatus::kOk) return;

  const WrenchDifferences differences = compare_wrenches(received, expected);
  checks.largest.update(differences);
  const auto limit = [](double difference, double ratio) {
    return ratio > 0.0 && std::isfinite(ratio) ? difference / ratio : 0.0;
  };
  differing.force_differs = !record(checks.at(Check::kForce), differences.force_in_bounds, [&] {
    return difference_text(id.seq, differences.force, limit(differences.force, differences.force_in_bounds),
                           " N", expected.force, received.force);
  });
  differing.torque_differs = !record(checks.at(Check::kTorque), differences.torque_in_bounds, [&] {
    return difference_text(id.seq, differences.torque,
                           limit(differences.torque, differences.torque_in_bounds), " N m", expected.torque,
                           received.torque);
  });
  double allowed = 0.0;
  double volume_ratio = 0.0;
  if (differences.volume > 0.0) {
    allowed = volume_limit(id, state, of, expected, received);
    volume_ratio = in_bounds(differences.volume, allowed);
  }
  differing.volume_differs = !record(checks.at(Check::kVolume), volume_ratio, [&] {
    return difference_text(id.seq, differences.volume, allowed, " m^3",
                           format_number(expected.submerged_volume),
                           format_number(received.submerged_volume));
  });
  differing.center_differs = !record(checks.at(Check::kCenter), differences.center_in_bounds, [&] {
    return difference_text(id.seq, differences.center,
                           limit(differences.center, differences.center_in_bounds), " m",
                           expected.center_of_buoyancy, received.center_of_buoyancy);
  });
  const bool differs = differing.force_differs || differing.torque_differs || differing.volume_differs ||
                       differing.center_differs;
  if (differs && differing_.size() < kMaxDiffering) differing_.push_back(differing);
}

void ResponseChecks::compare_hydrostatics_of(const RequestId& id, const BodiesHydrostatics& expected,
                                             const BodiesHydrostatics& received) {
  if (!has_same_ids(id, expected, received, "hydrostatics")) return;
  for (std::size_t i = 0; i < expected.bodies.size(); ++i) {
    const BodyHydrostatics& own = expected.bodies[i];
    const std::size_t body = scene_->index_of(own.body_id).value();
    CheckResult& result = bodies_[body].at(Check::kHydrostatics);
    if (own.status != received.bodies[i].status) {
      record_status(result, id.seq, own.status, received.bodies[i].status);
      continue;
    }
    MessageDifferences differences;
    if (own.status == BodyStatus::kOk) {
      compare_hydrostatics(received.bodies[i], own, scene_->bodies()[body], scene_->water(), differences);
    }
    record_fields(result, id.seq, differences);
  }
}

void ResponseChecks::compare_loads_of(const RequestId& id, const BodiesLoads& expected,
                                      const BodiesLoads& received) {
  if (!has_same_ids(id, expected, received, "loads")) return;
  for (std::size_t i = 0; i < expected.bodies.size(); ++i) {
    const BodyLoads& own = expected.bodies[i];
    const BodyLoads& other = received.bodies[i];
    const std::size_t body = scene_->index_of(own.body_id).value();
    CheckResult& result = bodies_[body].at(Check::kLoads);
    if (own.status != other.status) {
      record_status(result, id.seq, own.status, other.status);
      continue;
    }
    MessageDifferences differences;
    if (own.status == BodyStatus::kOk) {
      const WrenchLimits limits = limits_of(received_wrenches_.bodies[body], expected_wrenches_.bodies[body]);
      compare_loads(other, own, limits, scene_->bodies()[body], *scene_, differences);
      if (!(differences.in_bounds <= 1.0)) {
        loads_differ_ = true;
        const bool same_buoyancy = distance(other.buoyancy_force, own.buoyancy_force) <=
                                       limits.force + kRounding * length_of(own.buoyancy_force) &&
                                   distance(other.buoyancy_torque, own.buoyancy_torque) <=
                                       limits.torque + kRounding * length_of(own.buoyancy_torque);
        buoyancy_in_loads_differs_ = buoyancy_in_loads_differs_ || !same_buoyancy;
      }
    }
    record_fields(result, id.seq, differences);
  }
}

}  // namespace buoyancy::ping
