// The threads of ThreadPool: a oneTBB arena, or the caller's thread without oneTBB at build time.
//
// tbb_arena.cpp is a separate file because it is compiled without ThreadSanitizer, which does not see the
// synchronisation inside TBB's library and reports false races. ThreadPool makes that synchronisation
// visible.
#pragma once

#include <cstddef>
#include <memory>

namespace buoyancy {

class TbbArena {
 public:
  explicit TbbArena(unsigned threads);  // see ThreadPool
  TbbArena(TbbArena&&) noexcept;
  TbbArena& operator=(TbbArena&&) noexcept;
  ~TbbArena();

  unsigned thread_count() const;
  // Calls task(context, begin, end) for ranges that partition [0, count) into parts of about grain, on any
  // thread, and returns when all calls have returned. Task is no std::function, because ThreadSanitizer would
  // not see how the fields of one are passed on.
  using Task = void (*)(void* context, std::size_t begin, std::size_t end);
  void run(std::size_t count, std::size_t grain, Task task, void* context);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace buoyancy
