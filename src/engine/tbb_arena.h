// The threads behind ThreadPool: oneTBB where it was there at build time, the caller's thread elsewhere.
//
// By itself in a file, because ThreadSanitizer cannot see into TBB's library and takes what its templates
// hand over for races: this file alone is compiled without it. ThreadPool makes the hand-over visible.
#pragma once

#include <cstddef>
#include <memory>

namespace buoyancy {

class TbbArena {
 public:
  explicit TbbArena(unsigned threads);  // as ThreadPool
  TbbArena(TbbArena&&) noexcept;
  TbbArena& operator=(TbbArena&&) noexcept;
  ~TbbArena();

  unsigned thread_count() const;
  // Calls task(context, begin, end) for parts of [0, count) of about grain, on any thread; returns when all
  // are done. No std::function: its own fields would be handed over unseen.
  using Task = void (*)(void* context, std::size_t begin, std::size_t end);
  void run(std::size_t count, std::size_t grain, Task task, void* context);

 private:
  struct Threads;
  std::unique_ptr<Threads> of_tbb_;
};

}  // namespace buoyancy
