#include "query/pose_loop.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>

#include <pthread.h>

#include "engine/thread_pool.h"

namespace buoyancy {
namespace {

// [ns]. Dispatching work to other threads costs about 10 us.
constexpr double kMinParallelWork = 5e4;
constexpr double kMinTaskWork = 2e4;

// A child of fork() has none of its parent's threads, and what they held stays locked, in oneTBB too, so
// that it works on one thread. A child of a program that has no pool yet finds nothing locked.
std::atomic<bool> is_forked_child{false};

// Pools live as long as the program: starting threads takes as long as thousands of queries. A pool may run
// several loops at once.
ThreadPool& pool_with(unsigned threads) {
  static const int registered = pthread_atfork(nullptr, nullptr, [] { is_forked_child = true; });
  static_cast<void>(registered);
  static std::mutex mutex;
  static std::map<unsigned, std::unique_ptr<ThreadPool>> pools;
  const std::lock_guard lock(mutex);
  std::unique_ptr<ThreadPool>& pool = pools[threads];
  if (pool == nullptr) pool = std::make_unique<ThreadPool>(threads);
  return *pool;
}

}  // namespace

void run_chunks(std::size_t count, double time_each, unsigned threads,
                const std::function<void(std::size_t, std::size_t)>& task) {
  const double work = time_each * static_cast<double>(count);
  if (threads == 1 || count < 2 || work < kMinParallelWork || is_forked_child) {
    if (count > 0) task(0, count);
    return;
  }
  ThreadPool& pool = pool_with(threads);
  // Chunks are small enough to share the work evenly, and large enough to be worth a task.
  const std::size_t least = static_cast<std::size_t>(kMinTaskWork / time_each) + 1;
  const std::size_t even = count / (std::size_t{16} * pool.thread_count()) + 1;
  const std::size_t chunk = std::max(least, even);
  pool.run((count + chunk - 1) / chunk, 1,
           [&](std::size_t i) { task(i * chunk, std::min(count, (i + 1) * chunk)); });
}

}  // namespace buoyancy
