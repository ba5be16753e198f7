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

}  // namespace buoyancy
