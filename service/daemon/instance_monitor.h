// Other services on our bus, known by the status messages that they send as we do. Two that answer the same
// channels answer every request twice, perhaps from different scenes, and nobody notices: so it is said.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "messages/status.h"

namespace buoyancy {

class InstanceMonitor {
 public:
  // Instances told apart; of more nothing is said, so that forged statuses fill neither memory nor log.
  static constexpr std::size_t kMost = 16;

  explicit InstanceMonitor(std::int64_t own_instance_id) : own_(own_instance_id) {}

  // A message on the status channel. Our own and what is no status are ignored.
  void observe(Bytes message);

  // The instance_id of each that was first heard since the last call.
  std::vector<std::int64_t> take_new();

 private:
  std::int64_t own_;
  std::vector<std::int64_t> known_;
  std::vector<std::int64_t> new_;
  ServiceStatus status_;  // reused
};

}  // namespace buoyancy
