// A disk that fails, and a file that is truncated, while a recording is read. The functions below stand in
// for the C library's, so that any read of this program can fail.
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "recording/event_log.h"
#include "recording/state_csv.h"
#include "tests/support/recorded_log.h"
#include "tests/support/temp_dir.h"

namespace {

using ::testing::HasSubstr;
int reads_until_failure = -1;  // negative: none fails
}  // namespace

extern "C" ssize_t pread(int file, void* bytes, std::size_t count, off_t offset) {
  if (reads_until_failure == 0) {
    errno = EIO;
    return -1;
  }
  if (reads_until_failure > 0) --reads_until_failure;
  return ::syscall(SYS_pread64, file, bytes, count, offset);
}

namespace buoyancy {
namespace {

constexpr std::int64_t kEvents = 300;
constexpr std::size_t kDataBytes = 600'000;  // three events in two windows of the reader

std::string write_log(const TempDir& directory) {
  RecordedLog log;
  const std::vector<std::uint8_t> data(kDataBytes, 7);
  for (std::int64_t i = 0; i < kEvents; ++i) log.add(i, "A", data);
  return directory.write("events.lcmlog", log.text());
}

std::string write_rows(const TempDir& directory) {
  std::string rows = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";
  for (int i = 0; i < 40'000; ++i)
    rows += std::to_string(i / 2) + ",1,0,0,0,1,0,0,0" + std::string(40, ' ') + "\n";
  return directory.write("rows.csv", rows);
}

class ReadError : public testing::Test {
 protected:
  ~ReadError() override { reads_until_failure = -1; }
  TempDir directory_;
};

// Returns the number of events, each of which must be whole, up to the end that must come.
template <typename Reader>
std::int64_t events_of(Reader& reader) {
  std::int64_t events = 0;
  for (std::int64_t items = 0; items < 100'000; ++items) {
    const LogItem item = reader.next();
    if (std::holds_alternative<EndOfLog>(item)) return events;
    EXPECT_TRUE(std::holds_alternative<RecordedEvent>(item));
    ++events;
  }
  ADD_FAILURE() << "the reader does not end";
  return events;
}

TEST_F(ReadError, EndsLogAtEvent) {
  const std::string file = write_log(directory_);
  std::int64_t before = -1;
  for (const int reads : {0, 1, 100}) {
    auto reader = EventLogReader::open(file, only_channel("A"));
    ASSERT_TRUE(reader);
    reads_until_failure = reads;
    const std::int64_t events = events_of(*reader);
    reads_until_failure = -1;
    EXPECT_GT(events, before);
    EXPECT_LT(events, kEvents);
    before = events;
    ASSERT_TRUE(reader->file().read_error());
    EXPECT_THAT(reader->file().read_error()->message(), HasSubstr("Input/output error"));
    EXPECT_EQ(events_of(*reader), 0) << "the end stays";
  }
}

TEST_F(ReadError, EndsSearchForEventsOfPart) {
  const std::string file = write_log(directory_);
  auto reader = EventLogReader::open(file, only_channel("A"));
  ASSERT_TRUE(reader);
  reads_until_failure = 2;
  reader->seek(100'000'000);
  EXPECT_EQ(events_of(*reader), 0);
  EXPECT_TRUE(reader->file().read_error());
}

TEST_F(ReadError, EndsCsvAtRequest) {
  const std::string file = write_rows(directory_);
  for (const int reads : {0, 1}) {  // after that of the header
    reads_until_failure = -1;
    auto reader = StateCsvReader::open(file);
    ASSERT_TRUE(reader);
    reads_until_failure = reads;
    EXPECT_LT(events_of(*reader), 20'000);
    EXPECT_TRUE(reader->file().read_error());
  }
}

TEST_F(ReadError, NamesTruncationWhileReading) {
  const std::string file = write_log(directory_);
  auto reader = EventLogReader::open(file, only_channel("A"));
  ASSERT_TRUE(reader);
  ASSERT_TRUE(std::holds_alternative<RecordedEvent>(reader->next()));
  std::filesystem::resize_file(file, 3'000'000);
  EXPECT_EQ(events_of(*reader), 3);  // of the five that it holds, one is read, and one has no header after it
  ASSERT_TRUE(reader->file().read_error());
  EXPECT_EQ(reader->file().read_error()->actual, "ends at byte 3000000");
}

TEST_F(ReadError, StopsWithinDamage) {
  const std::string file = directory_.write("zeros.lcmlog", "");
  std::filesystem::resize_file(file, 20'000'000'000);
  auto reader = EventLogReader::open(file, only_channel("A"));
  ASSERT_TRUE(reader);
  int asked = 0;
  reader->file().stop_when([&asked] { return ++asked > 10; });
  EXPECT_TRUE(std::holds_alternative<EndOfLog>(reader->next()));
  EXPECT_TRUE(reader->file().stopped());
  EXPECT_FALSE(reader->file().read_error());
  EXPECT_EQ(asked, 11);
}

}  // namespace
}  // namespace buoyancy
