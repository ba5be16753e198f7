#include "engine/thread_pool.h"

#include <algorithm>
#include <atomic>

namespace buoyancy {

void ThreadPool::run(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& task) {
  // The caller's writes happen-before the tasks, and the tasks happen-before the return. TbbArena guarantees
  // this; the two flags repeat it where ThreadSanitizer can observe it (see tbb_arena.h).
  struct Loop {
    const std::function<void(std::size_t)>& task;
    std::atomic<bool> started{false};
    std::atomic<bool> finished{false};
  } loop{task};
  const auto run_part = [](void* context, std::size_t begin, std::size_t end) {
    Loop& shared = *static_cast<Loop*>(context);
    shared.started.load(std::memory_order_acquire);
    for (std::size_t i = begin; i < end; ++i) shared.task(i);
    shared.finished.exchange(true, std::memory_order_acq_rel);
  };
  loop.started.store(true, std::memory_order_release);
  arena_.run(count, grain, run_part, &loop);
  loop.finished.load(std::memory_order_acquire);
}

void run_chunks(ThreadPool& pool, std::size_t count, double time_each,
                const std::function<void(std::size_t, std::size_t)>& task) {
  constexpr double kMinTaskWork = 2e4;  // [ns]
  if (!pays_in_parallel(count, time_each) || pool.thread_count() == 1) {
    if (count > 0) task(0, count);
    return;
  }
  // Chunks are small enough to share the work evenly, and large enough to be worth a task.
  const std::size_t least = static_cast<std::size_t>(kMinTaskWork / time_each) + 1;
  const std::size_t even = count / (std::size_t{16} * pool.thread_count()) + 1;
  const std::size_t chunk = std::max(least, even);
  const auto run_chunk = [&](std::size_t i) { task(i * chunk, std::min(count, (i + 1) * chunk)); };
  pool.run((count + chunk - 1) / chunk, 1, std::cref(run_chunk));  // a copy would need the heap
}

}  // namespace buoyancy
