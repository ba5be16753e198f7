#include "query/pose_loop.h"

#include <atomic>
#include <map>
#include <memory>
#include <mutex>

#include <pthread.h>

#include "engine/thread_pool.h"

namespace buoyancy {
namespace {

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
  if (threads == 1 || !pays_in_parallel(count, time_each) || is_forked_child) {
    if (count > 0) task(0, count);
    return;
  }
  run_chunks(pool_with(threads), count, time_each, task);
}

}  // namespace buoyancy
