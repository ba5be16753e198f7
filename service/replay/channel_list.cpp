#include "service/replay/channel_list.h"

#include <algorithm>
#include <map>
#include <utility>

#include <spdlog/fmt/fmt.h>

#include "base/csv_field.h"
#include "base/json.h"
#include "messages/type_name.h"

namespace buoyancy::service {
namespace {

constexpr std::size_t kMaxChannelsInLine = 20;
constexpr std::size_t kFingerprintSize = 8;  // [bytes]

std::string seconds_text(std::int64_t utime) {
  return fmt::format("{:.6f}", static_cast<double>(utime) * 1e-6);
}

std::string type_of_table(const ReplayInput& input) {
  return input.table() != nullptr ? input.table()->description() : "CSV of body_states_t";
}

// Names in a log may hold any byte.
std::string printable(const std::string& name) {
  const std::string quoted = quote(name);
  return quoted.substr(1, quoted.size() - 2);
}

}  // namespace

Expected<ChannelList> list_channels(const std::filesystem::path& path, FileFormat format,
                                    const TableOptions& table) {
  Expected<ReplayInput> input = ReplayInput::open(
      path, format, [](std::string_view /*channel*/) { return true; }, table);
  if (!input) return tl::unexpected(input.error());
  ChannelList list;
  std::map<std::string, ListedChannel> channels;  // by name, NUL and fingerprint
  std::string key;
  while (true) {
    const LogItem item = input->next();
    if (std::holds_alternative<EndOfLog>(item)) break;
    if (std::holds_alternative<CorruptSection>(item)) ++list.corrupt_sections;
    const auto* event = std::get_if<RecordedEvent>(&item);
    if (event == nullptr) continue;
    const Bytes fingerprint = event->bytes.first(std::min(event->bytes.size(), kFingerprintSize));
    key.assign(event->channel).push_back('\0');
    key.append(fingerprint.begin(), fingerprint.end());
    auto found = channels.find(key);
    if (found == channels.end()) {
      if (channels.size() == kMaxListedChannels) {
        ++list.others;
        continue;
      }
      ListedChannel channel;
      channel.channel = format == FileFormat::kCsv ? "-" : std::string(event->channel);
      channel.type = format == FileFormat::kCsv ? type_of_table(*input) : type_name(event->bytes);
      channel.first_utime = event->timestamp;
      channel.last_utime = event->timestamp;
      found = channels.emplace(key, std::move(channel)).first;
    }
    ListedChannel& channel = found->second;
    ++channel.messages;
    channel.bytes += static_cast<std::int64_t>(event->bytes.size());
    channel.first_utime = std::min(channel.first_utime, event->timestamp);
    channel.last_utime = std::max(channel.last_utime, event->timestamp);
  }
  if (input->read_error()) return make_error(*input->read_error());
  for (auto& [name, channel] : channels) {
    if (format == FileFormat::kCsv) channel.bytes = input->size();
    list.channels.push_back(std::move(channel));
  }
  return list;
}

std::string list_text(const ChannelList& list) {
  std::size_t name_width = 8;
  std::size_t type_width = 5;
  for (const ListedChannel& channel : list.channels) {
    name_width = std::max(name_width, printable(channel.channel).size() + 1);
    type_width = std::max(type_width, channel.type.size() + 1);
  }
  std::string text = fmt::format("{:<{}}{:<{}}{:>10}{:>14}{:>20}{:>20}\n", "channel", name_width, "type",
                                 type_width, "messages", "bytes", "first, s", "last, s");
  for (const ListedChannel& channel : list.channels) {
    text += fmt::format("{:<{}}{:<{}}{:>10}{:>14}{:>20}{:>20}\n", printable(channel.channel), name_width,
                        channel.type, type_width, channel.messages, channel.bytes,
                        seconds_text(channel.first_utime), seconds_text(channel.last_utime));
  }
  if (list.others > 0) text += fmt::format("{} messages on further channels\n", list.others);
  if (list.corrupt_sections > 0) text += fmt::format("{} corrupt sections\n", list.corrupt_sections);
  return text;
}

std::string list_json(const ChannelList& list) {
  Json channels = Json::array();
  for (const ListedChannel& channel : list.channels) {
    channels.push_back({{"channel", channel.channel},
                        {"type", channel.type},
                        {"messages", channel.messages},
                        {"bytes", channel.bytes},
                        {"first_utime", channel.first_utime},
                        {"last_utime", channel.last_utime}});
  }
  return json_lines(Json{
      {"channels", channels}, {"other_messages", list.others}, {"corrupt_sections", list.corrupt_sections}});
}

std::string list_line(const ChannelList& list) {
  std::string text;
  for (const ListedChannel& channel : list.channels) {
    if (&channel - list.channels.data() == kMaxChannelsInLine) {
      return text + fmt::format(" and {} more", list.channels.size() - kMaxChannelsInLine);
    }
    text += (text.empty() ? "" : ", ") + printable(channel.channel) + " (" + channel.type + ")";
  }
  return text.empty() ? "no channel" : text;
}

}  // namespace buoyancy::service
