// The latest status of a service in the text format of Prometheus (version 0.0.4), for monitoring without a
// screen.
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "messages/status.h"

namespace buoyancy::view {

// Each field of service_status_t under its name with "buoyancy_" in front: counters with "_total" behind,
// times with "_seconds". buoyancy_up is 1, and buoyancy_info has the labels version, scene, injected_faults,
// instance_id and scene_fingerprint. status: nullptr: none has arrived recently; buoyancy_up is 0 and alone.
std::string metrics_text(const ServiceStatus* status);

// The text that is served: one thread sets it, others read it.
class Metrics {
 public:
  void set(std::string text) {
    const std::lock_guard lock(mutex_);
    text_ = std::move(text);
  }
  std::string text() const {
    const std::lock_guard lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string text_ = metrics_text(nullptr);
};

}  // namespace buoyancy::view
