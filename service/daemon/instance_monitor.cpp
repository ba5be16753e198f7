#include "service/daemon/instance_monitor.h"

#include <algorithm>
#include <utility>

namespace buoyancy::service {

void InstanceMonitor::observe(Bytes message) {
  if (known_.size() == kMaxInstances || decode(message, status_)) return;
  const std::int64_t id = status_.instance_id;
  if (id == own_ || std::ranges::find(known_, id) != known_.end()) return;
  known_.push_back(id);
  new_.push_back({id, status_.scene_fingerprint});
}

std::vector<InstanceMonitor::Instance> InstanceMonitor::take_new() {
  return std::exchange(new_, {});
}

}  // namespace buoyancy::service
