// The largest messages about a scene, the limits of LCM over UDP that they meet, and the report of
// `buoyancyd --check`, which includes both.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"
#include "transport/message_limits.h"

namespace buoyancy::service {

struct ChannelNames;

struct LargestMessage {
  std::string subject;  // "request for all 3 bodies"
  std::string channel;
  std::size_t bytes = 0;
  std::size_t packets = 0;
};

// A request for all bodies of a scene, its response, and its hydrostatics and loads if a body has that
// output.
struct LargestMessages {
  LargestMessage request, response;
  std::optional<LargestMessage> hydrostatics, loads;
};

LargestMessages largest_messages(const Scene& scene, const ChannelNames& channels);

// Warnings about a request, hydrostatics or loads that no receiver accepts, and about a request that may lose
// packets because the receive buffer of the service is too small for it. The response is smaller than the
// request.
std::vector<Warning> size_warnings(const LargestMessages& messages, const ReceiveBuffer& buffer);

// The receive buffer that the service would get for these messages on this machine with this LCM URL; nullopt
// for memq://.
std::optional<ReceiveBuffer> expected_receive_buffer(const LargestMessages& messages,
                                                     const std::string& lcm_url);

// The reports of scene_report.h with the messages and the warnings. buffer: nullopt for memq://. drafts: of
// SceneReportOptions.
std::string check_report_text(const Scene& scene, const LargestMessages& messages,
                              const std::optional<ReceiveBuffer>& buffer,
                              const std::vector<double>& drafts = {});
// In addition to scene_report_json(): "messages", an object with "request", "response", "hydrostatics" and
// "loads" (each of these two is null if no body has that output), each with "bytes" and "packets";
// "receive_buffer" [bytes], null for memq://; "warnings", an array of texts.
std::string check_report_json(const Scene& scene, const LargestMessages& messages,
                              const std::optional<ReceiveBuffer>& buffer,
                              const std::vector<double>& drafts = {});

}  // namespace buoyancy::service
