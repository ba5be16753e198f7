// A replay's answers beside those of an earlier one: what changed since then, body by body.
//
// Every response says how far it can be from the truth. Two right ones are never farther from each other than
// both bounds together; so that is what a difference is held to, and no tolerance has to be chosen.
// Hydrostatics carry no bounds: they are exact to rounding, and held to what rounding makes of the body's
// size.
#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "messages/request.h"
#include "messages/wire.h"
#include "recording/event_log.h"
#include "scene/scene.h"

namespace buoyancy {

// The largest differences of one body.
struct BodyDifferences {
  std::int64_t responses = 0;       // compared
  std::int64_t status_changes = 0;  // of them, where one is OK and the other is not, or not in the same way
  double force = 0.0;               // N
  double torque = 0.0;              // N m
  double volume = 0.0;              // m^3
  double center = 0.0;              // m, of the centres of buoyancy
  double force_in_bounds = 0.0;     // difference over the sum of both bounds: at most 1 where both are right
  double torque_in_bounds = 0.0;
  // Likewise. A centre is known to 2 torque bound / force: it is the volume's first moment by the volume.
  double center_in_bounds = 0.0;
  std::int64_t worst_utime = 0;         // us: of the answer with the largest of these three
  std::int64_t hydrostatics = 0;        // messages' bodies compared
  double hydrostatics_in_bounds = 0.0;  // the largest difference of any field over its tolerance
  std::string_view worst_field;         // of the hydrostatics; empty: no difference

  bool within_bounds() const {
    return status_changes == 0 && std::isfinite(volume) && force_in_bounds <= 1.0 &&
           torque_in_bounds <= 1.0 && center_in_bounds <= 1.0 && hydrostatics_in_bounds <= 1.0;
  }
};

class ReplayComparison {
 public:
  // earlier: an LCM log with body_wrenches_t on wrenches_channel and bodies_hydrostatics_t on
  // hydrostatics_channel. scene: what the replay answers from; outlives the comparison. Errors: not readable.
  static Expected<ReplayComparison> open(const std::filesystem::path& earlier,
                                         const std::string& wrenches_channel,
                                         const std::string& hydrostatics_channel, const Scene& scene);

  // The replay's next response: bytes of a body_wrenches_t. Its counterpart has the same utime, session_id
  // and seq, and is looked for among the earlier log's next kMatchWindow answers.
  void add(Bytes response);
  // The same of a bodies_hydrostatics_t.
  void take_hydrostatics(Bytes hydrostatics);
  // After the last one.
  void finish();

  const std::map<std::int32_t, BodyDifferences>& bodies() const { return bodies_; }  // by id
  // Answers and hydrostatics without counterpart.
  std::int64_t unmatched_new() const { return responses_.unmatched_new + hydrostatics_.unmatched_new; }
  std::int64_t unmatched_baseline() const {
    return responses_.unmatched_baseline + hydrostatics_.unmatched_baseline;
  }
  std::int64_t unreadable() const {  // places and messages of the earlier log
    return responses_.corrupt_sections + responses_.unreadable + hydrostatics_.unreadable;
  }
  // Nothing lost, nothing new, and no body beyond its bounds.
  bool agrees() const;

 private:
  static constexpr std::size_t kMatchWindow = 4096;

  // One channel of the earlier log.
  template <typename Message>
  struct Channel {
    EventLogReader earlier;
    std::deque<Message> ahead{};  // read, not yet matched; at most kMatchWindow
    Message now{};                // reused
    std::int64_t unmatched_new = 0;
    std::int64_t unmatched_baseline = 0;
    std::int64_t corrupt_sections = 0;  // of the log: the same for each channel
    std::int64_t unreadable = 0;

    bool read_one();  // into ahead; false: the log has ended
    // The counterpart of `now`, and only that, is taken out of `ahead`. nullopt: it has none.
    std::optional<Message> find();
    void finish();
  };

  ReplayComparison(EventLogReader responses, EventLogReader hydrostatics, const Scene& scene)
      : scene_(&scene), responses_{std::move(responses)}, hydrostatics_{std::move(hydrostatics)} {}
  template <typename Message, typename CompareBody>
  void add(Channel<Message>& channel, Bytes bytes, const CompareBody& compare_body);

  const Scene* scene_;
  Channel<WrenchResponse> responses_;
  Channel<BodiesHydrostatics> hydrostatics_;
  std::map<std::int32_t, BodyDifferences> bodies_;
};

}  // namespace buoyancy
