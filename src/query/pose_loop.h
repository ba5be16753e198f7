// Internal to src/query: loops over many poses on several threads, and the sea at the time of each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "wave_loads/prepared_sea.h"

namespace buoyancy {

// A sea that moves from the time of one pose to that of the next. Use it from one thread.
class MovingSea {
 public:
  // sea: nullptr for water at rest; must outlive this object.
  explicit MovingSea(const PreparedSea* sea) : sea_(sea) {}

  // Returns the waves at this time [us]; nullptr: the water is at rest, or its ramp has not begun.
  const SeaAtTime* at(std::int64_t utime) {
    if (sea_ == nullptr) return nullptr;
    if (!now_) {
      now_.emplace(*sea_, utime);
    } else if (utime != utime_) {
      now_->set_time(utime, 0.0);
    }
    utime_ = utime;
    return now_->amplitude_factor() > 0.0 ? &*now_ : nullptr;
  }

 private:
  const PreparedSea* sea_;
  std::optional<SeaAtTime> now_;
  std::int64_t utime_ = 0;
};

// Calls task(begin, end) for ranges that partition [0, count), on several threads if that pays.
// time_each: [ns], estimated. threads: 0 for the number of hardware threads.
void run_chunks(std::size_t count, double time_each, unsigned threads,
                const std::function<void(std::size_t, std::size_t)>& task);

}  // namespace buoyancy
