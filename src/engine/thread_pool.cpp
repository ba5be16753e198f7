#include "engine/thread_pool.h"

#include <atomic>

namespace buoyancy {

void ThreadPool::run(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& task) {
  // What was written before happens before the tasks, and they before what follows. The arena sees to that;
  // the two flags say it once more, where ThreadSanitizer can see it (tbb_arena.h).
  struct Loop {
    const std::function<void(std::size_t)>& task;
    std::atomic<bool> handed_over{false};
    std::atomic<bool> handed_back{false};
  } loop{task};
  const auto run_part = [](void* context, std::size_t begin, std::size_t end) {
    Loop& of = *static_cast<Loop*>(context);
    of.handed_over.load(std::memory_order_acquire);
    for (std::size_t i = begin; i < end; ++i) of.task(i);
    of.handed_back.exchange(true, std::memory_order_acq_rel);
  };
  loop.handed_over.store(true, std::memory_order_release);
  arena_.run(count, grain, run_part, &loop);
  loop.handed_back.load(std::memory_order_acquire);
}

}  // namespace buoyancy
