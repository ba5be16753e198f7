// Detects other services on the same status channel by the instance_id of their status messages. Two services
// on the same request channel send two responses to every request, perhaps computed from different scenes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "messages/status.h"

namespace buoyancy::service {

class InstanceMonitor {
 public:
  // Further instances are ignored, so that forged status messages fill neither memory nor log.
  static constexpr std::size_t kMaxInstances = 16;

  explicit InstanceMonitor(std::int64_t own_instance_id) : own_(own_instance_id) {}

  // message: received on the status channel. Own status messages and invalid ones are ignored.
  void observe(Bytes message);

  struct Instance {
    std::int64_t id = 0;
    std::int64_t scene_fingerprint = 0;  // when it was first observed
  };
  // Returns those first observed since the last call.
  std::vector<Instance> take_new();
  // The number of all that were observed, at most kMaxInstances.
  std::size_t count() const { return known_.size(); }

 private:
  std::int64_t own_;
  std::vector<std::int64_t> known_;
  std::vector<Instance> new_;
  ServiceStatus status_;  // reused
};

}  // namespace buoyancy::service
