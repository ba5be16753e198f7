// Compares the responses of a replay with those of an earlier one, the baseline, body by body.
//
// Every response carries an error bound. Two correct results differ by at most the sum of both bounds, so
// this sum is the limit of a difference and no tolerance has to be chosen. Hydrostatics carry no bounds: they
// are exact to rounding, and their tolerances are the rounding errors for a body of that size. Loads are the
// parts of a wrench, within its bounds (docs/replay.md).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "base/error.h"
#include "engine/loads_comparison.h"
#include "engine/result_comparison.h"
#include "messages/request.h"
#include "messages/wire.h"
#include "recording/event_log.h"
#include "recording/sequence_gaps.h"
#include "scene/scene.h"
#include "service/replay/replay_output.h"

namespace buoyancy::service {

// The largest differences of one body.
struct BodyDifferences {
  std::int64_t responses = 0;       // compared
  std::int64_t status_changes = 0;  // of them, with different statuses
  WrenchDifferences largest;
  std::int64_t worst_utime = 0;  // [us], of the response with the largest ratio to its bounds
  MessageDifferences hydrostatics, loads;

  bool within_bounds() const {
    return status_changes == 0 && std::isfinite(largest.volume) && largest.in_bounds() <= 1.0 &&
           hydrostatics.in_bounds <= 1.0 && loads.in_bounds <= 1.0;
  }
};

class ReplayComparison {
 public:
  // baseline: an LCM log with the messages on the channels of layout. scene: the scene of the replay; it must
  // outlive the comparison. Errors: not readable.
  static Expected<ReplayComparison> open(const std::filesystem::path& baseline, const OutputLayout& layout,
                                         const Scene& scene);

  // Compares the replay's next response, the bytes of a body_wrenches_t, with its counterpart: the one with
  // the same utime, session_id and seq among the next kMatchWindow responses of the baseline.
  void add(Bytes response);
  // The same for a bodies_hydrostatics_t.
  void add_hydrostatics(Bytes hydrostatics);
  // The same for a bodies_loads_t, whose response add() has had. Loads come in the order of the responses.
  void add_loads(Bytes loads);
  // Call this after the last response: counts the rest of the baseline as unmatched.
  void finish();

  // Ends the baseline once stop() is true; see FileWindow.
  void stop_when(const std::function<bool()>& stop);
  bool stopped() const;
  std::optional<Error> read_error() const;  // the baseline could not be read to its end

  const std::map<std::int32_t, BodyDifferences>& bodies() const { return bodies_; }  // by id
  // Responses, hydrostatics and loads without a counterpart, other than those of not_recorded().
  std::int64_t unmatched_new() const {
    return responses_.unmatched_new + hydrostatics_.unmatched_new + loads_.unmatched_new;
  }
  std::int64_t unmatched_baseline() const {
    return responses_.unmatched_baseline + hydrostatics_.unmatched_baseline + loads_.unmatched_baseline;
  }
  // Messages without a counterpart whose numbers the other side lacks between others of their session: a
  // recorder missed a request, or its response. They are no disagreement.
  std::int64_t not_recorded() const {
    return responses_.not_recorded + hydrostatics_.not_recorded + loads_.not_recorded;
  }
  // Corrupt sections and invalid messages of the baseline.
  std::int64_t decode_errors() const {
    return responses_.corrupt_sections + responses_.invalid_messages + hydrostatics_.invalid_messages +
           loads_.invalid_messages;
  }
  // Is every message matched and decoded, and every body within its bounds?
  bool agrees() const;

 private:
  static constexpr std::size_t kMatchWindow = 4096;

  // One channel of the baseline.
  template <typename Message>
  struct Channel {
    EventLogReader baseline;
    std::deque<Message> ahead{};  // read but not yet matched; at most kMatchWindow
    Message now{};                // the new message; reused
    SequenceGaps baseline_gaps{}, new_gaps{};
    std::int64_t not_recorded = 0;
    std::int64_t unmatched_new = 0;
    std::int64_t unmatched_baseline = 0;
    std::int64_t corrupt_sections = 0;  // of the whole log: equal for all channels
    std::int64_t invalid_messages = 0;

    void count_skipped(std::size_t count);  // the first ones of ahead have no counterpart
    bool read_one();                        // into ahead; false: the log has ended
    // Removes the counterpart of `now` and all messages before it from `ahead` and returns the counterpart.
    // nullopt: there is none, and `ahead` keeps its messages.
    std::optional<Message> pop_counterpart();
    void finish();
  };

  struct BodyLimits {
    std::int32_t body_id = 0;
    WrenchLimits limits;
  };

  ReplayComparison(EventLogReader responses, EventLogReader hydrostatics, EventLogReader loads,
                   const Scene& scene)
      : scene_(&scene),
        responses_{std::move(responses)},
        hydrostatics_{std::move(hydrostatics)},
        loads_{std::move(loads)} {}
  template <typename Message, typename CompareBody>
  void add(Channel<Message>& channel, Bytes bytes, const CompareBody& compare_body);

  std::array<const FileWindow*, 3> files() const {
    return {&responses_.baseline.file(), &hydrostatics_.baseline.file(), &loads_.baseline.file()};
  }

  const Scene* scene_;
  Channel<WrenchResponse> responses_;
  Channel<BodiesHydrostatics> hydrostatics_;
  Channel<BodiesLoads> loads_;
  // For each response whose loads are still to come, its bodies with this output, in their order.
  std::deque<std::vector<BodyLimits>> limits_;
  std::map<std::int32_t, BodyDifferences> bodies_;
};

}  // namespace buoyancy::service
