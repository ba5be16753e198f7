#include "view/live/snapshot_broadcaster.h"

#include <utility>

namespace buoyancy {

SnapshotBroadcaster::Listener::Listener(SnapshotBroadcaster& hub, int most) : hub_(hub) {
  const std::lock_guard lock(hub_.mutex_);
  admitted_ = hub_.listeners_ < most;
  if (!admitted_) return;
  ++hub_.listeners_;
  seen_ = hub_.newest_.number;  // made before this one came, perhaps long before
}

SnapshotBroadcaster::Listener::~Listener() {
  const std::lock_guard lock(hub_.mutex_);
  if (admitted_) --hub_.listeners_;
}

SnapshotBroadcaster::Published SnapshotBroadcaster::Listener::next() {
  std::unique_lock lock(hub_.mutex_);
  hub_.published_anew_.wait(lock, [this] { return hub_.closed_ || hub_.newest_.number > seen_; });
  if (hub_.closed_) return {};
  seen_ = hub_.newest_.number;
  return hub_.newest_;
}

void SnapshotBroadcaster::publish(std::string history, std::string snapshot) {
  Published next{0, std::make_shared<const std::string>(std::move(history)),
                 std::make_shared<const std::string>(std::move(snapshot))};
  {
    const std::lock_guard lock(mutex_);
    next.number = newest_.number + 1;
    newest_ = std::move(next);
  }
  published_anew_.notify_all();
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
  published_anew_.notify_all();
}

}  // namespace buoyancy
