// Runs independent tasks on several threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace buoyancy {

// Returns the number of threads that is worth using for work of some milliseconds.
inline std::size_t max_parallel_tasks() {
  return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, 8);
}

// Calls work(i) for every i below `count`, on at most `threads` threads including the caller's; on fewer if
// the system does not provide them. Returns when all calls have returned. An exception of a call is thrown to
// the caller once the other threads have finished.
template <typename Work>
void run_parallel_tasks(std::size_t count, std::size_t threads, const Work& work) {
  std::atomic<std::size_t> next{0};
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::future<void>> others;
  try {
    for (std::size_t i = 1; i < std::min(threads, count); ++i) {
      others.push_back(std::async(std::launch::async, run));
    }
  } catch (const std::system_error&) {
    // The threads that did start share the work.
  }
  run();
  for (std::future<void>& other : others) other.get();
}

// Calls work(begin, end) for every range of kParallelRange numbers, the last one perhaps shorter, of those
// below `count`, on several threads if there are more than two ranges. See run_parallel_tasks().
inline constexpr std::size_t kParallelRange = 8192;
template <typename Work>
void run_parallel_ranges(std::size_t count, const Work& work) {
  const std::size_t tasks = (count + kParallelRange - 1) / kParallelRange;
  run_parallel_tasks(tasks, tasks > 2 ? max_parallel_tasks() : 1, [&](std::size_t task) {
    work(task * kParallelRange, std::min(count, (task + 1) * kParallelRange));
  });
}

}  // namespace buoyancy
