#include "engine/thread_pool.h"

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

}  // namespace buoyancy
