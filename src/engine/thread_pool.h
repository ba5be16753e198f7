// Runs a loop on several threads. Without oneTBB at build time, the loop runs on the caller's thread.
#pragma once

#include <cstddef>
#include <functional>

#include "engine/tbb_arena.h"

namespace buoyancy {

class ThreadPool {
 public:
  // threads: 0 means the number of hardware threads. Threads start when they are first needed.
  explicit ThreadPool(unsigned threads) : arena_(threads) {}

  unsigned thread_count() const { return arena_.thread_count(); }  // 1 without oneTBB

  // Calls task(i) once for every i in [0, count), in any order and on any of the threads, and returns when
  // all calls have returned. grain: number of calls that make up one unit of work, >= 1. If a task throws, an
  // unspecified part of the others is not called, and one of the exceptions is thrown on.
  void run(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& task);

 private:
  TbbArena arena_;
};

// Do several threads pay for this many calls of this time [ns]? Dispatching work to them costs about 10 us.
inline bool pays_in_parallel(std::size_t count, double time_each) {
  constexpr double kMinParallelWork = 5e4;  // [ns]
  return count > 1 && time_each * static_cast<double>(count) >= kMinParallelWork;
}

// Calls task(begin, end) for ranges that partition [0, count), on several threads if that pays.
// time_each: [ns], estimated, > 0. No heap allocation.
void run_chunks(ThreadPool& pool, std::size_t count, double time_each,
                const std::function<void(std::size_t, std::size_t)>& task);

}  // namespace buoyancy
