// Decides when the simulator applies and announces the events of a scene ([[body.client.event]]).
//
// An event takes effect at the first step whose time is not before its own, and holds from that step's utime
// on. It is announced with the request of that step and of the kAnnouncedSteps before, so that the loss of
// messages does not change a run. An event of the same compartment or tank is announced only after the one
// before has taken effect, since repeating the earlier change would replace the later one. Where this leaves
// fewer than kMinAnnouncements, it is sent several times with each request. At step 0 the condition of the
// scene file is announced, in place of what an earlier run left in the service. The current condition is
// announced again every kRenewedSteps, for a service that has been restarted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "messages/condition_change.h"
#include "scene/scene.h"

namespace buoyancy {

inline constexpr std::int64_t kAnnouncedSteps = 16;
inline constexpr std::int64_t kMinAnnouncements = 6;
inline constexpr std::int64_t kRenewedSteps = 64;

class ConditionSchedule {
 public:
  struct Event {
    const Body* body = nullptr;       // of the scene
    std::int64_t step = 0;            // at which it takes effect
    std::int64_t announced_from = 0;  // the first step with whose request it is announced
    ConditionChange change;
  };

  // Schedules the events of the bodies with [body.client]. step: [s].
  ConditionSchedule(const Scene& scene, double step);

  bool empty() const { return events_.empty(); }

  // Returns the events that take effect at a step. Steps ascend from call to call.
  std::span<const Event> events_at(std::int64_t step);

  // Returns what is sent with the request of a step, some of it several times; valid until the next call.
  // Complexity: at most O(events^2), at the steps at which the current condition is announced again.
  const std::vector<ConditionChange>& announced_at(std::int64_t step);
  // Returns what is sent with a retry of that request, perhaps to a service that has been restarted: this
  // includes the condition at the step.
  const std::vector<ConditionChange>& repeated_at(std::int64_t step);

 private:
  // Adds the condition that holds at a step.
  void add_holding(std::int64_t step, std::vector<ConditionChange>& changes) const;

  std::vector<Event> initial_;  // the scene file's values of what events change
  std::vector<Event> events_;   // by step
  std::size_t next_ = 0;        // index in events_ of the first that has not taken effect
  std::vector<ConditionChange> announced_, repeated_;
};

}  // namespace buoyancy
