// Keeps the sea of each time: that of the scene, or those that were received.
//
// A received sea holds for requests from its utime on. One that is received later replaces what held from its
// own utime on, so that a sender that starts over starts a new timeline. A sea that is received again, as
// senders do once a second, changes nothing. Only the last kMaxSeas different ones are kept.
//
// It is a value: copies share the seas themselves, which are immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/error.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "wave_loads/prepared_sea.h"

namespace buoyancy {

// A sea, and from when on it holds.
struct SeaPeriod {
  std::int64_t from_utime = 0;             // [us]
  Water water;                             // at rest
  std::shared_ptr<const PreparedSea> sea;  // nullptr: the water is at rest
  std::vector<std::uint8_t> message;       // of a received sea
};

class SeaTimeline {
 public:
  static constexpr std::size_t kMaxSeas = 16;

  // Begins with the sea of the scene, which always holds, or without one where the scene receives its sea.
  explicit SeaTimeline(const Scene& scene);

  // Receives a sea_state_t. scene: the one that this timeline is for, which receives its sea. Errors: bytes
  // that are no such message, and a sea that cannot be used in this scene; then nothing changes. Complexity:
  // O(bytes); about 1 us per component and heap memory for a sea other than the one that holds.
  Expected<void> receive(Bytes message, const Scene& scene);

  // Returns the sea that holds at this time; nullptr: none has been received for it. The pointer is valid
  // until the next call of receive().
  const std::shared_ptr<const SeaPeriod>* at(std::int64_t utime) const;

 private:
  using Periods = std::vector<std::shared_ptr<const SeaPeriod>>;

  Periods periods_;  // from_utime ascends
};

}  // namespace buoyancy
