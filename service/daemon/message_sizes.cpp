#include "service/daemon/message_sizes.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/format.h"
#include "base/json.h"
#include "messages/wire.h"
#include "scene/scene_report.h"
#include "service/daemon/daemon.h"
#include "transport/lcm_connection.h"
#include "transport/udpm_url.h"

namespace buoyancy::service {
namespace {

LargestMessage make_message(const std::string& name, std::size_t bodies, std::size_t bytes,
                            const std::string& channel) {
  return {.subject = name + " for all " + pluralize(static_cast<std::int64_t>(bodies), "body", "bodies"),
          .channel = channel,
          .bytes = bytes,
          .packets = packet_count(bytes, channel)};
}

std::string to_text(const LargestMessage& message) {
  return format_text("  {}: {} bytes in {}\n", message.subject, message.bytes,
                     pluralize(static_cast<std::int64_t>(message.packets), "packet", "packets"));
}

Json to_json(const std::optional<LargestMessage>& message) {
  if (!message) return nullptr;
  return {{"bytes", message->bytes}, {"packets", message->packets}};
}

std::vector<Warning> warnings_of(const Scene& scene, const std::vector<FlotationOfBody>& flotation,
                                 const LargestMessages& messages,
                                 const std::optional<ReceiveBuffer>& buffer) {
  std::vector<Warning> warnings = scene_warnings(scene);
  std::ranges::move(flotation_warnings(scene, flotation), std::back_inserter(warnings));
  if (buffer) std::ranges::move(size_warnings(messages, *buffer), std::back_inserter(warnings));
  return warnings;
}

}  // namespace

LargestMessages largest_messages(const Scene& scene, const ChannelNames& channels) {
  const std::size_t bodies = scene.bodies().size();
  const std::size_t with_hydrostatics = scene.bodies_with_hydrostatics();
  LargestMessages messages{
      .request = make_message("request", bodies, request_size(bodies), channels.states),
      .response = make_message("response", bodies, response_size(bodies), channels.wrenches),
      .hydrostatics = std::nullopt,
      .loads = std::nullopt};
  if (with_hydrostatics > 0) {
    messages.hydrostatics = make_message("hydrostatics", with_hydrostatics,
                                         hydrostatics_size(with_hydrostatics), channels.hydrostatics);
  }
  if (const std::size_t with_loads = scene.bodies_with_loads(); with_loads > 0) {
    messages.loads = make_message("loads", with_loads, loads_size(with_loads), channels.loads);
  }
  return messages;
}

std::vector<Warning> size_warnings(const LargestMessages& messages, const ReceiveBuffer& buffer) {
  std::vector<Warning> warnings;
  const auto fits = [&warnings](const LargestMessage& message) {
    Expected<void> checked = check_message_size(message.subject, message.bytes);
    if (!checked) warnings.push_back(std::move(checked.error()));
    return checked.has_value();
  };
  const LargestMessage& request = messages.request;
  if (fits(request)) {
    const std::optional<Warning> warning =
        receive_buffer_warning(request.subject, request.bytes, request.channel, buffer);
    if (warning) warnings.push_back(*warning);
  }
  if (messages.hydrostatics) fits(*messages.hydrostatics);
  if (messages.loads) fits(*messages.loads);
  return warnings;
}

std::optional<ReceiveBuffer> expected_receive_buffer(const LargestMessages& messages,
                                                     const std::string& lcm_url) {
  const Expected<UdpmUrl> url = parse_udpm_url(resolve_lcm_url(lcm_url));
  if (!url) return std::nullopt;  // memq://, since the options have been checked
  const std::optional<std::int32_t> fixed = url->recv_buf_size;
  const std::size_t requested =
      fixed ? static_cast<std::size_t>(*fixed) : receive_buffer_for(messages.request.bytes);
  return ReceiveBuffer{.max_message = grantable_receive_buffer(requested),
                       .requested = requested,
                       .fixed_by_url = fixed.has_value()};
}

std::string check_report_text(const Scene& scene, const LargestMessages& messages,
                              const std::optional<ReceiveBuffer>& buffer, const std::vector<double>& drafts) {
  const std::vector<FlotationOfBody> flotation = scene_flotation(scene);
  std::string text =
      scene_report_text(scene, {.motions = true, .flotation = &flotation, .drafts = drafts}) + "\nmessages\n";
  text += to_text(messages.request) + to_text(messages.response);
  if (messages.hydrostatics) text += to_text(*messages.hydrostatics);
  if (messages.loads) text += to_text(*messages.loads);
  if (buffer) {
    text +=
        format_text("  receive buffer that this machine grants this user: {} bytes\n", buffer->max_message);
  }
  for (const Warning& warning : warnings_of(scene, flotation, messages, buffer)) {
    text += "warning: " + warning.message() + "\n";
  }
  return text;
}

std::string check_report_json(const Scene& scene, const LargestMessages& messages,
                              const std::optional<ReceiveBuffer>& buffer, const std::vector<double>& drafts) {
  const std::vector<FlotationOfBody> flotation = scene_flotation(scene);
  Json report =
      Json::parse(scene_report_json(scene, {.motions = true, .flotation = &flotation, .drafts = drafts}));
  report["messages"] = {{"request", to_json(messages.request)},
                        {"response", to_json(messages.response)},
                        {"hydrostatics", to_json(messages.hydrostatics)},
                        {"loads", to_json(messages.loads)}};
  report["receive_buffer"] = buffer ? std::optional(buffer->max_message) : std::nullopt;
  report["warnings"] = Json::array();
  for (const Warning& warning : warnings_of(scene, flotation, messages, buffer)) {
    report["warnings"].push_back(warning.message());
  }
  return json_lines(report);
}

}  // namespace buoyancy::service
