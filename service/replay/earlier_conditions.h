// The conditions of compartments and tanks that a log has received before a part of it.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/error.h"
#include "engine/condition_timeline.h"
#include "recording/event_log.h"
#include "scene/scene.h"
#include "service/replay/replay_channels.h"

namespace buoyancy::service {

// Reads the log up to the cut for an offset [bytes]. Messages that are rejected, and corrupt sections, belong
// to earlier parts, which report them. Errors: not readable. Complexity: reads all bytes before the offset.
Expected<ConditionTimeline> conditions_before(std::int64_t offset, const std::filesystem::path& log,
                                              ReplayChannels& channels, const Scene& scene);

}  // namespace buoyancy::service
