// Reads and encodes LCM log files in the format of lcm-logger: a sequence of events, each
//   int32 0xEDA1DA01; int64 number; int64 timestamp [us]; int32 channel length; int32 data length;
//   the channel, not terminated; the data                                   (all big-endian)
//
// liblcm's own reader is not used: it loses the intact event before a corrupt section, allocates and skips as
// many bytes as a corrupt length states, and does not distinguish corruption from the end of the file.
// Contract of this reader: an event is valid if the header of another event or the end of the file follows
// it. So is an event of a wanted channel that holds a complete request or pose and no event header. The
// reader skips anything else up to the next header and reports it.
//
// The reader's only state is its offset, and the next offset depends on this one and the file alone. Reading
// a log thus follows a chain of offsets from 0 to the log's size. The cut (log_item.h) for an offset is the
// first offset of this chain at or after it, where next() stops. To be fast, seek() follows another chain,
// from the first event header in the kSeekDistance bytes before its argument. Two chains that share one
// offset are the same from there on. That header belongs to the log's own chain unless it lies in the data of
// an event (a log inside a message); even then its chain as a rule joins the log's at the next event. The two
// can stay apart only around an event longer than kSeekDistance, around damage that looks like such an event,
// or in a log made for that purpose. A piece is therefore known to be right only if it starts at 0 or where
// the piece before it ended; otherwise it must be read again from there, with seek_to().
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/wire.h"
#include "recording/file_window.h"
#include "recording/log_item.h"

namespace buoyancy {

// Returns whether the events of a channel are wanted. The reader calls it for every event of a log.
using ChannelFilter = std::function<bool(std::string_view channel)>;
ChannelFilter only_channel(std::string channel);

// [bytes], longer than any event that LCM's UDP multicast delivers: its receivers assemble at most 16 MB.
inline constexpr std::int64_t kSeekDistance = 17'000'000;

class EventLogReader {
 public:
  // Reads the events of the wanted channels and skips the others.
  static Expected<EventLogReader> open(const std::filesystem::path& path, ChannelFilter wanted);

  // Once file().broken_off(), returns EndOfLog.
  LogItem next(std::int64_t limit = kNoLimit);
  bool reached(std::int64_t limit) const { return offset_ >= limit; }
  std::int64_t position() const { return offset_; }
  std::int64_t offset() const { return offset_; }  // read so far [bytes]
  std::int64_t size() const { return file_.size(); }
  const FileWindow& file() const { return file_; }
  FileWindow& file() { return file_; }

  // Moves to the cut for `offset`, as far as the events of the `distance` bytes before show it. O(distance).
  void seek(std::int64_t offset, std::int64_t distance = kSeekDistance);
  // Moves to an offset at which another reader of this log, with the same filter, stopped.
  void seek_to(std::int64_t position) { offset_ = position; }

 private:
  struct Frame {
    std::int64_t timestamp = 0;
    bool wanted = false;
    std::size_t data_start = 0;  // offset from the event's start
    std::size_t data_size = 0;
    std::int64_t next = 0;  // file offset after the event
  };

  EventLogReader(FileWindow file, ChannelFilter wanted);
  LogItem read_next(std::int64_t limit);                           // wrong once file().broken_off()
  tl::expected<Frame, std::string> frame_at(std::int64_t offset);  // or the reason why it is invalid
  bool header_or_end_at(std::int64_t offset);
  void find_header();  // moves to the first header at or after the offset, or to the end
  CorruptSection skip_corrupt_section(const std::string& reason);

  FileWindow file_;
  ChannelFilter wanted_;
  std::int64_t offset_ = 0;
};

// Replaces bytes by an encoded event.
void encode_event(std::int64_t number, std::int64_t timestamp, std::string_view channel, Bytes data,
                  std::vector<std::uint8_t>& bytes);

// Changes the number of an encoded event.
void renumber_event(std::int64_t number, std::span<std::uint8_t> event);

// The parts of an encoded event begin or end at these offsets from its start [bytes].
struct EventLayout {
  std::size_t channel = 0;
  std::size_t data = 0;
  std::size_t end = 0;
};
inline constexpr std::size_t kEventHeaderSize = 28;  // [bytes], of all that precedes the channel
// Reads the lengths in the event header at the start of bytes; nullopt if no complete and valid one is there.
std::optional<EventLayout> event_layout(Bytes bytes);

}  // namespace buoyancy
