// The manifest of a part: a JSON file beside it, from which the join learns that the part is complete, what
// it was computed from and what it has counted. "wrenches.part-3-of-7.lcmlog.json" belongs to
// "wrenches.part-3-of-7.lcmlog".
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"
#include "service/replay/replay.h"
#include "service/replay/replay_options.h"
#include "service/replay/replay_part.h"

namespace buoyancy::service {

// Everything besides INPUT's bytes that the responses depend on, as names and values: the version of the
// program, the instruction set, the scene file, the scene's fingerprint, the options, the size of INPUT. Only
// parts with equal facts can be joined.
using ReplayFacts = std::vector<std::pair<std::string, std::string>>;

// Names of facts that the join uses itself.
inline constexpr const char* kInstructionSetFact = "instruction set";
inline constexpr const char* kWrenchesChannelFact = "--wrenches-channel";
inline constexpr const char* kHydrostaticsChannelFact = "--hydrostatics-channel";
inline constexpr const char* kLoadsChannelFact = "--loads-channel";

// channels: those of plan_routes(), so that a body counts as the same by its id and by its name. Errors: the
// scene file is not readable.
Expected<ReplayFacts> replay_facts(const ReplayOptions& options, const Scene& scene,
                                   const std::vector<PoseChannel>& channels, std::int64_t input_size);

struct PartManifest {
  Part part;
  ReplayFacts facts;
  std::int64_t input_begin = 0;  // [bytes], of the range that the part was computed from
  std::int64_t input_end = 0;
  std::string input_hash;  // of that range; both hashes as ContentHash formats them
  std::int64_t output_bytes = 0;
  std::string output_hash;
  std::int64_t output_events = 0;  // of a log
  // The number of requests that the replay made itself in each session (replay_part.h).
  std::map<std::int64_t, std::int64_t> numbered_requests;
  ReplaySummary summary;
  std::vector<std::string> input_errors;     // the first ones
  std::vector<std::string> unseen_channels;  // see ReplayChannels
};

std::filesystem::path manifest_path(const std::filesystem::path& part);

// Removes the manifest, if there is one: a part without it does not count as complete.
void remove_manifest(const std::filesystem::path& part);
// Writes the manifest as a whole or not at all. Errors: not writable.
Expected<void> write_manifest(const std::filesystem::path& part, const PartManifest& manifest);
// Errors: not readable, not a manifest of this version.
Expected<PartManifest> read_manifest(const std::filesystem::path& part);

}  // namespace buoyancy::service
