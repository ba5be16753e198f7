#include "service/daemon/grid_preparer.h"

#include <new>
#include <utility>

#include <sys/eventfd.h>

namespace buoyancy::service {
namespace {

Expected<void> prepare(Bytes message, ElevationSpline& surface) {
  try {
    return set_surface(message, surface);
  } catch (const std::bad_alloc&) {
    return make_error({"the received grid of the sea", "out of memory", "enough memory for its surface", "",
                       "Send a smaller grid, around the bodies"});
  }
}

}  // namespace

GridPreparer::GridPreparer()
    : done_event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)), thread_([this] { run(); }) {}

GridPreparer::~GridPreparer() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  work_.notify_one();
  thread_.join();
}

bool GridPreparer::push(const SeaGridHeader& header, Bytes message, std::shared_ptr<ElevationSpline> surface,
                        double arrival) {
  if (pushed_ - polled_ == kMaxPending) return false;
  Job& job = jobs_[pushed_ % kMaxPending];
  job.message.assign(message.begin(), message.end());
  job.header = header;
  job.surface = std::move(surface);
  job.arrival = arrival;
  ++pushed_;
  {
    const std::lock_guard lock(mutex_);
    todo_ = pushed_;
  }
  work_.notify_one();
  return true;
}

std::optional<GridPreparer::Prepared> GridPreparer::poll() {
  {
    const std::lock_guard lock(mutex_);
    if (polled_ == done_) {
      ::eventfd_t finished = 0;
      ::eventfd_read(done_event_.value(), &finished);
      return std::nullopt;
    }
  }
  Job& job = jobs_[polled_++ % kMaxPending];
  std::shared_ptr<ElevationSpline> surface = std::move(job.surface);
  if (!job.result) return Prepared{job.header, tl::unexpected(std::move(job.result.error()))};
  return Prepared{job.header, std::move(surface)};
}

void GridPreparer::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    work_.wait(lock, [this] { return stop_ || done_ != todo_; });
    if (stop_) return;
    Job& job = jobs_[done_ % kMaxPending];
    lock.unlock();
    job.result = prepare(job.message, *job.surface);
    lock.lock();
    ++done_;
    ::eventfd_write(done_event_.value(), 1);
  }
}

}  // namespace buoyancy::service
