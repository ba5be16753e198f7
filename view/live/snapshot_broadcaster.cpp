#include "view/live/snapshot_broadcaster.h"

#include <utility>

namespace buoyancy::view {

SnapshotBroadcaster::Listener::Listener(SnapshotBroadcaster& broadcaster, int max_listeners)
    : broadcaster_(broadcaster) {
  const std::lock_guard lock(broadcaster_.mutex_);
  admitted_ = broadcaster_.listeners_ < max_listeners;
  if (!admitted_) return;
  ++broadcaster_.listeners_;
  received_ = broadcaster_.latest_.number;  // skips a snapshot that may be old
}

SnapshotBroadcaster::Listener::~Listener() {
  const std::lock_guard lock(broadcaster_.mutex_);
  if (admitted_) --broadcaster_.listeners_;
}

SnapshotBroadcaster::Published SnapshotBroadcaster::Listener::next() {
  std::unique_lock lock(broadcaster_.mutex_);
  broadcaster_.changed_.wait(
      lock, [this] { return broadcaster_.closed_ || broadcaster_.latest_.number > received_; });
  if (broadcaster_.closed_) return {};
  received_ = broadcaster_.latest_.number;
  return broadcaster_.latest_;
}

void SnapshotBroadcaster::publish(std::string history, std::string snapshot, Text sea) {
  Published next{0, std::make_shared<const std::string>(std::move(history)),
                 std::make_shared<const std::string>(std::move(snapshot)), std::move(sea)};
  {
    const std::lock_guard lock(mutex_);
    next.number = latest_.number + 1;
    latest_ = std::move(next);
  }
  changed_.notify_all();
}

int SnapshotBroadcaster::listeners() const {
  const std::lock_guard lock(mutex_);
  return listeners_;
}

void SnapshotBroadcaster::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
}

}  // namespace buoyancy::view
