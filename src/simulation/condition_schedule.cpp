#include "simulation/condition_schedule.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

// Returns how many copies of an event are sent with each request that announces it.
std::int64_t copies_of(const ConditionSchedule::Event& event) {
  const std::int64_t requests = event.step - event.announced_from + 1;
  return (kMinAnnouncements + requests - 1) / requests;
}

bool is_same_target(const ConditionChange& a, const ConditionChange& b) {
  return a.body_id == b.body_id && a.kind == b.kind && a.index == b.index;
}

ConditionChange change_of(const Body& body, const ConditionEvent& event, double value, std::int64_t utime) {
  ConditionChange change{.utime = utime, .body_id = body.id, .index = event.index};
  if (event.is_tank) {
    change.kind = ConditionKind::kTank;
    change.liquid_volume = value;
  } else {
    change.flooded = value;
  }
  return change;
}

double initial_value(const Body& body, const ConditionEvent& event) {
  const auto index = static_cast<std::size_t>(event.index);
  return event.is_tank ? body.subdivision->tanks[index].liquid_volume
                       : body.subdivision->compartments[index].flooded;
}

// Returns the first step that is not before a time, apart from rounding.
std::int64_t step_of(double time, double step) {
  constexpr double kRounding = 1e-9;  // of a step
  return static_cast<std::int64_t>(std::ceil(std::min(time / step, 1e15) - kRounding));
}

}  // namespace

ConditionSchedule::ConditionSchedule(const Scene& scene, double step) {
  for (const Body& body : scene.bodies()) {
    if (!body.dynamics.given) continue;
    for (const ConditionEvent& event : body.dynamics.events) {
      const std::int64_t at = std::max<std::int64_t>(step_of(event.time, step), 1);
      const std::int64_t utime = std::llround(static_cast<double>(at) * step * 1e6);
      Event scheduled{&body, at, std::max<std::int64_t>(at - kAnnouncedSteps, 0),
                      change_of(body, event, event.value, utime)};
      const auto earlier = std::find_if(events_.rbegin(), events_.rend(), [&](const Event& other) {
        return is_same_target(other.change, scheduled.change);
      });
      if (earlier == events_.rend()) {
        initial_.push_back({&body, 0, 0, change_of(body, event, initial_value(body, event), 0)});
      } else if (earlier->step == at) {
        earlier->change = scheduled.change;  // of several at one step, the last counts
        continue;
      } else {
        scheduled.announced_from = std::max(scheduled.announced_from, earlier->step + 1);
      }
      events_.push_back(scheduled);
    }
  }
  std::ranges::stable_sort(events_, {}, &Event::step);
}

std::span<const ConditionSchedule::Event> ConditionSchedule::events_at(std::int64_t step) {
  while (next_ < events_.size() && events_[next_].step < step) ++next_;
  std::size_t end = next_;
  while (end < events_.size() && events_[end].step == step) ++end;
  return std::span(events_).subspan(next_, end - next_);
}

void ConditionSchedule::add_holding(std::int64_t step, std::vector<ConditionChange>& changes) const {
  for (const Event& initial : initial_) {
    const Event* holds = &initial;
    for (const Event& event : events_) {
      if (event.step <= step && is_same_target(event.change, initial.change)) holds = &event;
    }
    changes.push_back(holds->change);
  }
}

const std::vector<ConditionChange>& ConditionSchedule::announced_at(std::int64_t step) {
  announced_.clear();
  const std::int64_t renewals = step == 0 ? kMinAnnouncements : step % kRenewedSteps == 0 ? 1 : 0;
  for (std::int64_t copy = 0; copy < renewals; ++copy) add_holding(step, announced_);
  for (const Event& event : events_) {
    if (event.announced_from > step || step > event.step) continue;
    announced_.insert(announced_.end(), static_cast<std::size_t>(copies_of(event)), event.change);
  }
  return announced_;
}

const std::vector<ConditionChange>& ConditionSchedule::repeated_at(std::int64_t step) {
  repeated_.clear();
  add_holding(step, repeated_);
  for (const Event& event : events_) {
    if (event.announced_from <= step && step < event.step) repeated_.push_back(event.change);
  }
  return repeated_;
}

}  // namespace buoyancy
