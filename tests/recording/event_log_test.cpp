#include "recording/event_log.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <lcm/eventlog.h>

#include "messages/wire.h"
#include "messages/wire_layout.h"
#include "tests/support/byte_vector.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::vector<std::uint8_t> request(std::int64_t seq, std::size_t bodies = 1) {
  WrenchRequest request;
  request.id = {1'000 + seq, 7, seq};
  request.bodies.resize(bodies);
  for (std::size_t i = 0; i < bodies; ++i) request.bodies[i].body_id = static_cast<std::int32_t>(i);
  return encoded(request);
}

// A log of encoded events and the offset of each.
struct Log {
  std::string bytes;
  std::vector<std::size_t> starts;

  void add(const std::string& channel, const std::vector<std::uint8_t>& data) {
    std::vector<std::uint8_t> event;
    const auto number = static_cast<std::int64_t>(starts.size());
    encode_event(number, 1'000'000 + number, channel, data, event);
    starts.push_back(bytes.size());
    bytes.append(event.begin(), event.end());
  }
};

Log log_of_requests(int count) {
  Log log;
  for (int i = 0; i < count; ++i) log.add("BUOYANCY_STATES", request(i));
  return log;
}

struct LogContents {
  std::vector<std::int64_t> seqs;
  std::vector<std::string> corrupt_sections;
};

LogContents read_all(const std::string& bytes) {
  const TempDir directory;
  auto reader = EventLogReader::open(directory.write("x.lcmlog", bytes), only_channel("BUOYANCY_STATES"));
  if (!reader) throw std::runtime_error(reader.error().message());
  LogContents contents;
  while (true) {
    const LogItem item = reader->next();
    if (std::holds_alternative<EndOfLog>(item)) break;
    if (const auto* corrupt = std::get_if<CorruptSection>(&item)) {
      contents.corrupt_sections.push_back(corrupt->description);
    } else {
      const auto id = peek_request_id(std::get<RecordedEvent>(item).bytes);
      contents.seqs.push_back(id ? id->seq : -1);
    }
  }
  EXPECT_EQ(reader->offset(), reader->size());
  return contents;
}

using Seqs = std::vector<std::int64_t>;

TEST(EventLog, WritesEventsThatLiblcmReads) {
  const TempDir directory;
  const std::string path = directory.write("x.lcmlog", log_of_requests(2).bytes);
  lcm_eventlog_t* log = lcm_eventlog_create(path.c_str(), "r");
  ASSERT_NE(log, nullptr);
  for (int i = 0; i < 2; ++i) {
    lcm_eventlog_event_t* event = lcm_eventlog_read_next_event(log);
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, i);
    EXPECT_EQ(event->timestamp, 1'000'000 + i);
    EXPECT_STREQ(event->channel, "BUOYANCY_STATES");
    const auto* data = static_cast<const std::uint8_t*>(event->data);
    EXPECT_EQ(std::vector<std::uint8_t>(data, data + event->datalen), request(i));
    lcm_eventlog_free_event(event);
  }
  EXPECT_EQ(lcm_eventlog_read_next_event(log), nullptr);
  lcm_eventlog_destroy(log);
}

TEST(EventLog, ReadsEventsThatLiblcmWrote) {
  const TempDir directory;
  const std::string path = directory.path("x.lcmlog");
  lcm_eventlog_t* log = lcm_eventlog_create(path.c_str(), "w");
  ASSERT_NE(log, nullptr);
  std::string channel = "BUOYANCY_STATES";
  std::vector<std::uint8_t> data = request(5);
  lcm_eventlog_event_t event{};
  event.timestamp = 77;
  event.channellen = static_cast<std::int32_t>(channel.size());
  event.channel = channel.data();
  event.datalen = static_cast<std::int32_t>(data.size());
  event.data = data.data();
  ASSERT_EQ(lcm_eventlog_write_event(log, &event), 0);
  lcm_eventlog_destroy(log);

  auto reader = EventLogReader::open(path, only_channel("BUOYANCY_STATES"));
  ASSERT_TRUE(reader);
  const LogItem item = reader->next();
  const auto& read = std::get<RecordedEvent>(item);
  EXPECT_EQ(read.timestamp, 77);
  EXPECT_EQ(std::vector<std::uint8_t>(read.bytes.begin(), read.bytes.end()), data);
  EXPECT_TRUE(std::holds_alternative<EndOfLog>(reader->next()));
}

TEST(EventLog, SkipsOtherChannelsOfAnySize) {
  Log log;
  log.add("OTHER", std::vector<std::uint8_t>(5'000'000, 0xED));
  log.add("BUOYANCY_STATES", request(1));
  log.add("BUOYANCY_STATES_2", request(2));
  log.add("BUOYANCY_STATE", request(3));
  log.add("BUOYANCY_STATES", request(4, 100'000));
  log.add("OTHER", {});
  const LogContents contents = read_all(log.bytes);
  EXPECT_EQ(contents.seqs, (Seqs{1, 4}));
  EXPECT_TRUE(contents.corrupt_sections.empty());
  EXPECT_TRUE(read_all("").seqs.empty());
}

TEST(EventLog, ReturnsEveryIntactEventAroundGarbage) {
  Log log = log_of_requests(4);
  // In the last three cases the header after the garbage crosses the end of the first megabyte, which is read
  // at once.
  const std::size_t megabyte_left = 1'048'576 - log.starts[2];
  for (const std::size_t length :
       {std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{27}, std::size_t{100'000},
        std::size_t{3'000'000}, megabyte_left - 1, megabyte_left - 2, megabyte_left - 3}) {
    std::string bytes = log.bytes;
    bytes.insert(log.starts[2], std::string(length, '\xED'));
    const LogContents contents = read_all(bytes);
    EXPECT_EQ(contents.seqs, (Seqs{0, 1, 2, 3})) << length;
    ASSERT_EQ(contents.corrupt_sections.size(), 1U) << length;
    EXPECT_THAT(contents.corrupt_sections[0], AllOf(HasSubstr("at byte " + std::to_string(log.starts[2])),
                                                    HasSubstr(std::to_string(length) + " bytes skipped")));
  }
}

TEST(EventLog, LosesOnlyEventsWithCorruptHeader) {
  constexpr std::size_t kChannelLength = 20;
  constexpr std::size_t kDataLength = 24;
  const Log log = log_of_requests(4);
  for (const std::size_t field : {std::size_t{0}, kChannelLength, kDataLength}) {
    for (const char value : {'\x00', '\x01', '\x7F', '\xFF'}) {
      for (const std::size_t byte : {std::size_t{0}, std::size_t{3}}) {
        std::string bytes = log.bytes;
        char& changed = bytes[log.starts[1] + field + byte];
        if (changed == value) continue;
        changed = value;
        const LogContents contents = read_all(bytes);
        EXPECT_EQ(contents.seqs, (Seqs{0, 2, 3})) << field + byte << " = " << int{value};
        EXPECT_EQ(contents.corrupt_sections.size(), 1U) << field + byte << " = " << int{value};
      }
    }
  }
}

TEST(EventLog, ReportsTruncatedTailAndKeepsEarlierEvents) {
  const Log log = log_of_requests(3);
  for (std::size_t length = log.starts[2] + 1; length < log.bytes.size(); ++length) {
    const LogContents contents = read_all(log.bytes.substr(0, length));
    EXPECT_EQ(contents.seqs, (Seqs{0, 1})) << length;
    ASSERT_EQ(contents.corrupt_sections.size(), 1U) << length;
    EXPECT_THAT(contents.corrupt_sections[0], HasSubstr("at byte " + std::to_string(log.starts[2])));
  }
}

TEST(EventLog, LeavesDataToCaller) {
  Log log;
  log.add("BUOYANCY_STATES", {1, 2, 3});  // no valid request
  const Log inner = log_of_requests(1);
  log.add("OTHER", {inner.bytes.begin(), inner.bytes.end()});
  log.add("BUOYANCY_STATES", request(9));
  EXPECT_EQ(read_all(log.bytes).seqs, (Seqs{-1, 9}));
}

// Where it says so, the limit itself is an event.
TEST(EventLog, LimitsChannelsAndWantedMessages) {
  constexpr std::size_t kMaxChannel = 999;
  constexpr std::size_t kMaxMessage = 64 * 1'048'576;
  struct Case {
    std::size_t channel;
    std::size_t message;
    bool wanted;
    std::string corrupt;  // empty: an event
  };
  for (const Case& c :
       {Case{1, 0, true, ""}, Case{0, 10, true, "a channel length of 0"}, Case{kMaxChannel, 10, true, ""},
        Case{kMaxChannel + 1, 10, true, "a channel length of 1000"}, Case{1, kMaxMessage, true, ""},
        Case{1, kMaxMessage + 1, true, "a message of 67108865 bytes"}, Case{1, kMaxMessage + 1, false, ""}}) {
    const TempDir directory;
    std::vector<std::uint8_t> event;
    encode_event(1, 2, std::string(c.channel, 'A'), {}, event);
    BigEndianWriter{event.data() + kEventHeaderSize - 4}(static_cast<std::int32_t>(c.message));
    const std::string path = directory.write("x.lcmlog", std::string(event.begin(), event.end()));
    std::filesystem::resize_file(path, event.size() + c.message);  // zeros, which take no space
    auto reader = EventLogReader::open(path, [&](std::string_view) { return c.wanted; });
    ASSERT_TRUE(reader);
    const LogItem item = reader->next();
    if (!c.corrupt.empty()) {
      ASSERT_TRUE(std::holds_alternative<CorruptSection>(item)) << c.corrupt;
      EXPECT_THAT(std::get<CorruptSection>(item).description, HasSubstr(c.corrupt));
    } else if (c.wanted) {
      ASSERT_TRUE(std::holds_alternative<RecordedEvent>(item)) << c.channel << " " << c.message;
      EXPECT_EQ(std::get<RecordedEvent>(item).bytes.size(), c.message);
    } else {
      EXPECT_TRUE(std::holds_alternative<EndOfLog>(item));
    }
  }
}

TEST(EventLog, FindsLayoutOfEncodedEvents) {
  std::vector<std::uint8_t> event;
  encode_event(1, 2, "CHANNEL", std::vector<std::uint8_t>(5), event);
  const auto layout = event_layout(event);
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->channel, kEventHeaderSize);
  EXPECT_EQ(layout->data, kEventHeaderSize + 7);
  EXPECT_EQ(layout->end, event.size());
  EXPECT_TRUE(event_layout(Bytes(event).first(kEventHeaderSize))) << "the header is enough";
  EXPECT_FALSE(event_layout(Bytes(event).first(kEventHeaderSize - 1)));
  EXPECT_FALSE(event_layout(Bytes(event).subspan(1)));
  event[kEventHeaderSize - 4] = 0x80;
  EXPECT_FALSE(event_layout(event)) << "a negative length";
}

TEST(EventLog, RejectsPathsThatAreNotRegularFiles) {
  const TempDir directory;
  EXPECT_FALSE(EventLogReader::open(directory.path("missing.lcmlog"), only_channel("A")));
  EXPECT_FALSE(EventLogReader::open(directory.path("."), only_channel("A")));
  EXPECT_FALSE(EventLogReader::open("/dev/null", only_channel("A")));
}

}  // namespace
}  // namespace buoyancy
