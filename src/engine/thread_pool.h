// Several threads for one loop, where oneTBB was there at build time; this thread alone elsewhere.
#pragma once

#include <cstddef>
#include <functional>

#include "engine/tbb_arena.h"

namespace buoyancy {

class ThreadPool {
 public:
  // threads: 1 or more; 0: as many as the processor runs at once. None is started before it is needed.
  explicit ThreadPool(unsigned threads) : arena_(threads) {}

  unsigned thread_count() const { return arena_.thread_count(); }  // 1 without oneTBB

  // Calls task(i) once for every i below count, in any order and on any of the threads, and returns when all
  // are done. grain: how many are worth handing over to another thread; >= 1. task throws nothing.
  void run(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& task);

 private:
  TbbArena arena_;
};

}  // namespace buoyancy
