// Keeps the sea of each time: that of the scene, or those that were received.
//
// A received sea holds for requests from its utime on. One that is received later replaces what held from its
// own utime on, so that a sender that starts over starts a new timeline. A sea that is received again, as
// senders do once a second, changes nothing. Only the last kMaxSeas different ones are kept.
//
// A received grid is the surface at its utime. Between two grids the surface is linear in time; before the
// first and after the last one there is none. A grid takes the place of one with the same utime. Only the
// kMaxSeas with the latest utimes are kept. One of another instance_id starts afresh.
//
// It is a value: copies share the seas themselves, which are immutable.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/error.h"
#include "messages/sea_grid.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "wave_loads/prepared_sea.h"

namespace buoyancy {

// A sea, and from when on it holds.
struct SeaPeriod {
  std::int64_t from_utime = 0;             // [us]; on grids until the utime of the last of its surfaces
  Water water;                             // at rest
  std::shared_ptr<const PreparedSea> sea;  // nullptr: the water is at rest
  std::vector<std::uint8_t> message;       // of a received sea_state_t
};

// The memory of received grids, which is used again when nobody else refers to it. All references to what it
// returns must belong to one thread.
class GridMemory {
 public:
  // A surface that may be set. No heap allocation once as many exist as are referred to at a time.
  std::shared_ptr<ElevationSpline> surface();
  // A period of these surfaces over a level [m]. water: always the same but for its level. Likewise.
  std::shared_ptr<const SeaPeriod> period(std::int64_t from_utime, std::span<const TimedElevation> surfaces,
                                          const Water& water, double level);

 private:
  struct Period {
    std::shared_ptr<SeaPeriod> period;
    std::shared_ptr<PreparedSea> sea;  // of the period
  };

  std::vector<std::shared_ptr<ElevationSpline>> surfaces_;
  std::vector<Period> periods_;
};

class SeaTimeline {
 public:
  static constexpr std::size_t kMaxSeas = 16;

  // Begins with the sea of the scene, which always holds, or without one where the scene receives its sea.
  explicit SeaTimeline(const Scene& scene);

  // Receives a sea_state_t, or a sea_grid_t for a scene that receives grids. scene: the one that this
  // timeline is for, which receives its sea. Errors: bytes that are no such message, and a sea that cannot be
  // used in this scene; then nothing changes. Complexity: O(bytes); about 1 us per component and heap memory
  // for a sea other than the one that holds; 25 ns per sample of a grid.
  Expected<void> receive(Bytes message, const Scene& scene, GridMemory& memory);
  Expected<void> receive(Bytes message, const Scene& scene) {
    GridMemory fresh;
    return receive(message, scene, fresh);
  }
  // Receives a grid whose surface has been set. No heap allocation but in GridMemory. Complexity: O(1).
  void add(const SeaGridHeader& header, std::shared_ptr<const ElevationSpline> surface, const Scene& scene,
           GridMemory& memory);

  // Returns the sea that holds at this time [us]; nullptr: none has been received for it. The pointer is
  // valid until the next call of receive(). lead_time: [s], added to it where the sea comes on grids; one
  // that is not finite counts as 0.
  const std::shared_ptr<const SeaPeriod>* at(std::int64_t utime, double lead_time = 0.0) const;

 private:
  using Periods = std::vector<std::shared_ptr<const SeaPeriod>>;

  bool on_grids_;
  std::int64_t instance_id_ = 0;  // of the sender of the grids
  // Their from_utime ascends. On grids: each ends with a grid, and begins with the one before it.
  Periods periods_;
};

}  // namespace buoyancy
