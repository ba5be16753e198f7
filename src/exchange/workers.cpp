#include "exchange/workers.h"

#ifdef BUOYANCY_WITH_TBB
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#endif

namespace buoyancy {

#ifdef BUOYANCY_WITH_TBB

class Workers::Arena {
 public:
  explicit Arena(unsigned threads)
      : arena_(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)) {}

  unsigned threads() const { return static_cast<unsigned>(arena_.max_concurrency()); }

  void run(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& task) {
    arena_.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                        [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i != range.end(); ++i) task(i);
                        });
    });
  }

 private:
  tbb::task_arena arena_;
};

#else

class Workers::Arena {
 public:
  explicit Arena(unsigned /*threads*/) {}
  static unsigned threads() { return 1; }
  static void run(std::size_t count, std::size_t /*grain*/, const std::function<void(std::size_t)>& task) {
    for (std::size_t i = 0; i < count; ++i) task(i);
  }
};

#endif

Workers::Workers(unsigned threads) : arena_(std::make_unique<Arena>(threads)) {}
Workers::Workers(Workers&&) noexcept = default;
Workers& Workers::operator=(Workers&&) noexcept = default;
Workers::~Workers() = default;

unsigned Workers::threads() const {
  return arena_->threads();
}

void Workers::run(std::size_t count, std::size_t grain, const std::function<void(std::size_t)>& task) {
  arena_->run(count, grain, task);
}

}  // namespace buoyancy
