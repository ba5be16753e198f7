// Limits how often and for how long LockstepClient and FreeRunningClient wait for a response.
//
// Contract of both clients: a response holds as many bodies as its request, in the same order, and is valid
// until the next call; so are its loads of the bodies with this output, where the client waits for them.
// Errors of both: no response in time, or none with loads, a failure of the transport (in lock-step mode only
// once the retries are used up), a response with other bodies than requested, cancellation while waiting.
#pragma once

#include <cstdint>

namespace buoyancy {

// A request is sent at most 1 + max_retries times, `timeout` apart.
struct RetryPolicy {
  double timeout = 0.1;           // [s], > 0
  std::int64_t max_retries = 50;  // >= 0

  double total_timeout() const { return timeout * static_cast<double>(1 + max_retries); }  // [s]
};

}  // namespace buoyancy
