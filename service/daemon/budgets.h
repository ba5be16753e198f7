// What requests may cost the service: docs/operations.md lists these budgets with their counters.
#pragma once

#include <chrono>
#include <cstddef>

#include "engine/request_handler.h"
#include "transport/message_limits.h"

namespace buoyancy::service {

// After this time a request waits while signals, the watchdog, the status and other requests have their turn.
// The evaluation of one body is not interrupted.
inline constexpr std::chrono::milliseconds kSlice{10};

inline constexpr std::size_t kMaxExtraBodies = 10'000;
inline constexpr std::size_t kMaxRetainedBytes = std::size_t{256} << 20U;
inline constexpr std::chrono::seconds kMaxComputing{60};
inline constexpr RequestBudgets kBudgets{.extra_bodies = kMaxExtraBodies,
                                         .message_bytes = kMaxMessageBytes,
                                         .retained_bytes = kMaxRetainedBytes,
                                         .computing = kMaxComputing};

// Requests that wait because their session has one in progress, or RequestHandler::kMaxInProgress sessions
// have; in mode latest, the newest ones of all sessions.
inline constexpr std::size_t kMaxWaiting = 1'024;
inline constexpr std::size_t kMaxWaitingBytes = std::size_t{64} << 20U;

}  // namespace buoyancy::service
