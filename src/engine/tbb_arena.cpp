#include "engine/tbb_arena.h"

#ifdef BUOYANCY_WITH_TBB
#include <optional>
#include <thread>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace buoyancy {

#ifdef BUOYANCY_WITH_TBB

struct TbbArena::Impl {
  tbb::task_arena arena;
  // Set for more threads than the hardware has: TBB would warn about them on standard error otherwise.
  std::optional<tbb::global_control> raised_limit;
};

TbbArena::TbbArena(unsigned threads)
    : impl_(new Impl{tbb::task_arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)),
                     {}}) {
  if (threads > std::thread::hardware_concurrency()) {
    impl_->raised_limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
  }
}

unsigned TbbArena::thread_count() const {
  return static_cast<unsigned>(impl_->arena.max_concurrency());
}

void TbbArena::run(std::size_t count, std::size_t grain, Task task, void* context) {
  impl_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [&](const tbb::blocked_range<std::size_t>& range) { task(context, range.begin(), range.end()); });
  });
}

#else

struct TbbArena::Impl {};

TbbArena::TbbArena(unsigned /*threads*/) {}

unsigned TbbArena::thread_count() const {
  return 1;
}

void TbbArena::run(std::size_t count, std::size_t /*grain*/, Task task, void* context) {
  task(context, 0, count);
}

#endif

TbbArena::TbbArena(TbbArena&&) noexcept = default;
TbbArena& TbbArena::operator=(TbbArena&&) noexcept = default;
TbbArena::~TbbArena() = default;

}  // namespace buoyancy
