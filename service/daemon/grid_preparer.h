// Sets the surfaces of received grids on a background thread: a grid of 256 x 256 samples takes more than a
// millisecond, in which no request would be handled.
//
// All members belong to the caller's thread. The thread has nothing but the message and the surface of a grid
// between push() and poll(). No heap allocation once a message is no larger than those before it.
#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "base/error.h"
#include "base/unique_fd.h"
#include "messages/sea_grid.h"
#include "waves/elevation_spline.h"

namespace buoyancy::service {

class GridPreparer {
 public:
  static constexpr std::size_t kMaxPending = 8;
  // Grids of fewer samples take less than a millisecond: it costs more to hand them over.
  static constexpr std::size_t kMinSamples = 32'768;

  struct Prepared {
    SeaGridHeader header;
    Expected<std::shared_ptr<ElevationSpline>> surface;
  };

  // Starts the thread, which inherits the caller's signal mask.
  GridPreparer();
  GridPreparer(const GridPreparer&) = delete;
  GridPreparer& operator=(const GridPreparer&) = delete;
  ~GridPreparer();  // waits for the grid that is being prepared

  // header: of the message. surface: to be set. arrival: [s], of any monotonic clock. Returns false if
  // kMaxPending grids are pending; then nothing happens.
  bool push(const SeaGridHeader& header, Bytes message, std::shared_ptr<ElevationSpline> surface,
            double arrival);
  // Is there a grid that poll() has not returned yet?
  bool is_busy() const { return pushed_ != polled_; }
  // The arrival of the first of them; infinite if there is none.
  double first_arrival() const {
    return is_busy() ? jobs_[polled_ % kMaxPending].arrival : std::numeric_limits<double>::infinity();
  }
  // A descriptor for poll(2), readable when poll() has a result. Negative: the system provided none.
  int fileno() const { return done_event_.value(); }
  // The next grid, in the order of push(); nullopt: none is ready.
  std::optional<Prepared> poll();

 private:
  struct Job {
    SeaGridHeader header;
    std::vector<std::uint8_t> message;
    std::shared_ptr<ElevationSpline> surface;
    double arrival = 0.0;
    Expected<void> result;
  };

  void run();

  UniqueFd done_event_;                // an eventfd
  std::array<Job, kMaxPending> jobs_;  // a ring; those from done_ to pushed_ belong to the thread
  std::uint64_t pushed_ = 0, polled_ = 0;
  std::mutex mutex_;
  std::condition_variable work_;
  std::uint64_t todo_ = 0, done_ = 0;  // mutex_ guards these and the next
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace buoyancy::service
