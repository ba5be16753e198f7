// Keeps the condition of the compartments and tanks of a scene's bodies over time: that of the scene file, or
// what was received in messages.
//
// A change of a compartment or tank holds for requests from its utime on. One that is received later replaces
// what held from its own utime on for the same compartment or tank, so that a sender that starts over starts
// a new timeline; the others keep theirs. A change to what holds anyway, as senders repeat it in case of
// loss, adds nothing. The last kMaxChanges of each are kept; the last one before these holds before them.
//
// A change that cannot be used takes effect too: from its utime on the condition is unknown, and the body has
// no wrench, until a usable change of the same compartment or tank holds. Where the message names none that
// the body has, any usable change of the body ends it.
//
// It is a value: copies share nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "base/error.h"
#include "messages/condition_change.h"
#include "messages/wire.h"
#include "scene/scene.h"

namespace buoyancy {

// The times from `first` to `last` [us], both included.
struct UtimeRange {
  std::int64_t first = std::numeric_limits<std::int64_t>::min();
  std::int64_t last = std::numeric_limits<std::int64_t>::max();

  bool contains(std::int64_t utime) const { return first <= utime && utime <= last; }
};

// What was received for one compartment or tank, in the order of time.
class ConditionHistory {
 public:
  static constexpr std::size_t kMaxChanges = 64;

  struct Change {
    std::int64_t from_utime = 0;  // [us]
    double value = 0.0;           // flooded, or the volume of liquid [m^3]; 0 if not usable
    bool usable = true;
  };

  bool empty() const { return changes_.empty() && !dropped_; }
  // Replaces what holds from change.from_utime on. O(kMaxChanges); no heap once as many are kept.
  void add(const Change& change);
  // Returns what holds at this time; nullptr if nothing has been received for it. Shortens `range` to where
  // that holds. The pointer is valid until the next add(). O(log kMaxChanges).
  const Change* at(std::int64_t utime, UtimeRange& range) const;

 private:
  std::vector<Change> changes_;    // from_utime ascends
  std::optional<Change> dropped_;  // holds before the first of changes_
};

class ConditionTimeline {
 public:
  // All bodies have the condition of the scene file at all times. O(bodies).
  explicit ConditionTimeline(const Scene& scene);

  // Receives a body_condition_t. scene: the one that this timeline is for. Errors: bytes that are no such
  // message, and a body that is unknown, or has neither compartments nor tanks: then nothing changes; an
  // unknown kind or index, and a value that is not finite or out of range: then see above. A volume above
  // that of its tank by rounding alone counts as the tank's. O(log bodies + kMaxChanges).
  Expected<void> receive(Bytes message, const Scene& scene);

  // Returns the timeline for another scene. before: the one that this timeline is for. A body keeps what was
  // received if `scene` has a body of its id with the same compartments and tanks, by number, by name and,
  // for tanks, by volume; other bodies begin with the condition of the scene file.
  ConditionTimeline for_scene(const Scene& before, const Scene& scene) const;

  // The bodies with compartments or tanks, in the order of the scene.
  std::size_t size() const { return bodies_.size(); }
  // Index of the i-th of them into the scene's bodies.
  std::size_t body(std::size_t i) const { return bodies_[i].body; }

  // Replaces `condition` by that of the i-th of these bodies at this time, and shortens `range` to where it
  // stays the same. Returns false if it is unknown; `condition` is then unspecified. No heap once the vectors
  // of `condition` are as long as those of the largest body. O(compartments and tanks * log kMaxChanges).
  bool condition_at(std::int64_t utime, std::size_t i, const Scene& scene, BodyCondition& condition,
                    UtimeRange& range) const;

 private:
  // The place of a body's histories: those of its compartments, of its tanks, and then one of messages that
  // name none of them, whose changes hold no value.
  struct BodyHistories {
    std::size_t body = 0;  // index into the scene's
    std::size_t first = 0;
    std::size_t compartments = 0;
    std::size_t tanks = 0;

    std::size_t unnamed() const { return first + compartments + tanks; }
  };

  // Returns nullptr for a body with neither compartments nor tanks.
  const BodyHistories* find(std::size_t body) const;

  std::vector<BodyHistories> bodies_;  // body ascends
  std::vector<ConditionHistory> histories_;
};

}  // namespace buoyancy
