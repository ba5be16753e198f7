// The command line of buoyancy-ping.
#pragma once

#include <cstdint>
#include <filesystem>

#include <CLI/App.hpp>

#include "base/error.h"
#include "client/ping/service_link.h"
#include "client/retry_policy.h"
#include "scene/scene.h"

namespace buoyancy::ping {

inline constexpr std::int64_t kMaxCount = 1'000'000;  // of requests; every round trip is kept

struct PingOptions {
  std::filesystem::path scene;
  LinkOptions link;
  RetryPolicy retry_policy;
  std::int64_t count = 100;
  double rate = 0.0;  // [Hz]; 0: not given
  std::uint64_t seed = 1;
  std::filesystem::path sea;
  bool identical = false;
  bool json = false;
  std::filesystem::path junit;
};

// Declares the options on app; parsing fills options, which must live as long.
void add_options(CLI::App& app, PingOptions& options);

// Errors: an invalid URL or channel, two channels of one name, an output that is an input.
Expected<void> check_options(const PingOptions& options);

// The sea_state_t to publish: that of the scene file --sea; no bytes for a scene that has its own sea or
// none. Errors: --sea is missing or not wanted, cannot be read, describes no sea, or one that the scene
// cannot use.
Expected<ByteVector> sea_to_publish(const PingOptions& options, const Scene& scene);

}  // namespace buoyancy::ping
