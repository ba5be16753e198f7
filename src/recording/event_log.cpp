#include "recording/event_log.h"

#include <algorithm>
#include <array>

#include "messages/bot_core.h"
#include "messages/wire_layout.h"

namespace buoyancy {
namespace {

constexpr std::array<std::uint8_t, 4> kMagic{0xED, 0xA1, 0xDA, 0x01};
constexpr std::int32_t kMaxChannelLength = 999;            // liblcm's own limit for logs
constexpr std::int32_t kMaxMessageBytes = 64 * 1'048'576;  // LCM itself delivers at most 16 MB

bool starts_with_magic(Bytes bytes) {
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

std::string_view as_text(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Returns whether data is complete by itself, whatever follows it.
bool is_request_or_pose(Bytes data) {
  return peek_request(data).has_value() || decode_bot_pose(data).has_value();
}

// Returns whether the data holds an event header: a message that lost bytes is filled up with the next event.
bool is_truncated(Bytes data) {
  return std::search(data.begin(), data.end(), kMagic.begin(), kMagic.end()) != data.end();
}

}  // namespace

ChannelFilter only_channel(std::string channel) {
  return [channel = std::move(channel)](std::string_view other) { return other == channel; };
}

Expected<EventLogReader> EventLogReader::open(const std::filesystem::path& path, ChannelFilter wanted) {
  Expected<FileWindow> file = FileWindow::open(path);
  if (!file) return tl::unexpected(file.error());
  return EventLogReader(std::move(*file), std::move(wanted));
}

EventLogReader::EventLogReader(FileWindow file, ChannelFilter wanted)
    : file_(std::move(file)), wanted_(std::move(wanted)) {}

LogItem EventLogReader::next(std::int64_t limit) {
  LogItem item = read_next(limit);
  if (file_.broken_off()) return EndOfLog{};
  return item;
}

LogItem EventLogReader::read_next(std::int64_t limit) {
  while (offset_ < size() && !file_.broken_off()) {
    if (reached(limit)) return LimitReached{};
    const tl::expected<Frame, std::string> frame = frame_at(offset_);
    if (!frame) return skip_corrupt_section(frame.error());
    const std::int64_t start = offset_;
    if (!frame->wanted) {
      if (!header_or_end_at(frame->next)) return skip_corrupt_section("no event follows");
      offset_ = frame->next;
      continue;
    }
    const std::size_t event_size = frame->data_start + frame->data_size;
    const Bytes event = file_.read_at(start, event_size + kMagic.size());
    if (event.size() < event_size) break;
    const Bytes data = event.subspan(frame->data_start, frame->data_size);
    const bool followed = frame->next == size() || starts_with_magic(event.subspan(event_size));
    if (!followed && (is_truncated(data) || !is_request_or_pose(data))) {
      return skip_corrupt_section("no event follows");
    }
    offset_ = frame->next;
    const Bytes channel = event.subspan(kEventHeaderSize, frame->data_start - kEventHeaderSize);
    return RecordedEvent{frame->timestamp, as_text(channel), data};
  }
  return EndOfLog{};
}

tl::expected<EventLogReader::Frame, std::string> EventLogReader::frame_at(std::int64_t offset) {
  using Reason = tl::unexpected<std::string>;
  const Bytes header = file_.read_at(offset, kEventHeaderSize + kMaxChannelLength);
  if (!starts_with_magic(header)) return Reason("no event header");
  if (header.size() < kEventHeaderSize) return Reason("the file ends within an event header");
  std::int64_t number = 0;
  std::int32_t channel_size = 0;
  std::int32_t data_size = 0;
  Frame frame;
  BigEndianReader reader(header.data() + kMagic.size());
  reader(number, frame.timestamp, channel_size, data_size);
  if (channel_size <= 0 || channel_size > kMaxChannelLength) {
    return Reason("a channel length of " + std::to_string(channel_size));
  }
  if (data_size < 0) return Reason("a data length of " + std::to_string(data_size));
  frame.data_start = kEventHeaderSize + static_cast<std::size_t>(channel_size);
  frame.data_size = static_cast<std::size_t>(data_size);
  frame.next = offset + static_cast<std::int64_t>(frame.data_start + frame.data_size);
  if (frame.next > size()) {
    return Reason("the file ends within an event: " + std::to_string(frame.next - size()) +
                  " bytes are missing");
  }
  frame.wanted = wanted_(as_text(header.subspan(kEventHeaderSize, static_cast<std::size_t>(channel_size))));
  if (frame.wanted && data_size > kMaxMessageBytes) {
    return Reason("a message of " + std::to_string(data_size) + " bytes");
  }
  return frame;
}

bool EventLogReader::header_or_end_at(std::int64_t offset) {
  return offset == size() || starts_with_magic(file_.read_at(offset, kMagic.size()));
}

void EventLogReader::seek(std::int64_t offset, std::int64_t distance) {
  offset_ = std::max<std::int64_t>(offset - distance, 0);
  if (offset_ > 0) find_header();
  while (true) {
    const LogItem item = next(offset);
    if (std::holds_alternative<LimitReached>(item) || std::holds_alternative<EndOfLog>(item)) return;
  }
}

void EventLogReader::find_header() {
  while (offset_ < size()) {
    const Bytes window = file_.read_at(offset_, kMagic.size());
    const auto found = std::search(window.begin(), window.end(), kMagic.begin(), kMagic.end());
    offset_ += found - window.begin();
    if (found != window.end()) return;
    // The window may end within the first bytes of a header, which are then searched again. It is shorter
    // than those only at the end of the file or where that is broken off.
    const bool more = offset_ < size() && window.size() >= kMagic.size();
    offset_ = more ? offset_ - static_cast<std::int64_t>(kMagic.size()) + 1 : size();
  }
}

CorruptSection EventLogReader::skip_corrupt_section(const std::string& reason) {
  const std::int64_t start = offset_++;
  find_header();
  return {"corrupt at byte " + std::to_string(start) + ": " + reason + "; " +
          std::to_string(offset_ - start) + " bytes skipped"};
}

void encode_event(std::int64_t number, std::int64_t timestamp, std::string_view channel, Bytes data,
                  std::vector<std::uint8_t>& bytes) {
  bytes.resize(kEventHeaderSize + channel.size() + data.size());
  std::copy(kMagic.begin(), kMagic.end(), bytes.begin());
  BigEndianWriter writer(bytes.data() + kMagic.size());
  writer(number, timestamp, static_cast<std::int32_t>(channel.size()),
         static_cast<std::int32_t>(data.size()));
  const auto after_header = bytes.begin() + static_cast<std::ptrdiff_t>(kEventHeaderSize);
  const auto after_channel = std::copy(channel.begin(), channel.end(), after_header);
  std::copy(data.begin(), data.end(), after_channel);
}

void renumber_event(std::int64_t number, std::span<std::uint8_t> event) {
  BigEndianWriter{event.data() + kMagic.size()}(number);
}

std::optional<EventLayout> event_layout(Bytes bytes) {
  if (bytes.size() < kEventHeaderSize || !starts_with_magic(bytes)) return std::nullopt;
  std::int64_t number = 0;
  std::int64_t timestamp = 0;
  std::int32_t channel_size = 0;
  std::int32_t data_size = 0;
  BigEndianReader reader(bytes.data() + kMagic.size());
  reader(number, timestamp, channel_size, data_size);
  if (channel_size < 0 || data_size < 0) return std::nullopt;
  const std::size_t data = kEventHeaderSize + static_cast<std::size_t>(channel_size);
  return EventLayout{kEventHeaderSize, data, data + static_cast<std::size_t>(data_size)};
}

}  // namespace buoyancy
