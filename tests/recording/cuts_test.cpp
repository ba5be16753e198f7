// Pieces of a recording, read on their own, hold the items of the whole, wherever it is cut and whatever is
// corrupt in it.
#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "messages/wire.h"
#include "recording/event_log.h"
#include "recording/state_csv.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}

  std::size_t below(std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random_);
  }
  bool one_in(std::size_t n) { return below(n) == 0; }
  std::string bytes(std::size_t size) {
    std::string bytes(size, '\0');
    for (char& value : bytes) value = static_cast<char>(below(256));
    return bytes;
  }

 private:
  std::mt19937 random_;
};

// The items of a piece. Each is the event's contents, or the description of a corrupt section.
struct Piece {
  std::vector<std::string> items;
  std::int64_t start = 0;  // [bytes]
  std::int64_t end = 0;    // [bytes]
};

std::string text_of(const RecordedEvent& event) {
  std::string text = std::to_string(event.timestamp);
  text += ' ';
  text += event.channel;
  text += ' ';
  text.append(event.bytes.begin(), event.bytes.end());
  return text;
}

template <typename Reader>
Piece read_until(Reader& reader, std::int64_t limit) {
  Piece piece;
  piece.start = reader.position();
  while (true) {
    const LogItem item = reader.next(limit);
    if (const auto* event = std::get_if<RecordedEvent>(&item)) {
      piece.items.push_back(text_of(*event));
    } else if (const auto* corrupt = std::get_if<CorruptSection>(&item)) {
      piece.items.push_back(corrupt->description);
    } else {
      EXPECT_TRUE(std::holds_alternative<EndOfLog>(item) || reader.reached(limit));
      break;
    }
  }
  piece.end = reader.position();
  return piece;
}

// ---- Logs

const ChannelFilter kWanted = [](std::string_view channel) { return channel != "OTHER"; };

EventLogReader open_log(const std::string& path) {
  auto reader = EventLogReader::open(path, kWanted);
  if (!reader) throw std::runtime_error(reader.error().message());
  return *std::move(reader);
}

std::string event(const std::string& channel, std::int64_t number, const std::string& data) {
  std::vector<std::uint8_t> bytes;
  encode_event(number, number, channel,
               Bytes(reinterpret_cast<const std::uint8_t*>(data.data()), data.size()), bytes);
  return {bytes.begin(), bytes.end()};
}

std::string request(std::int64_t seq, std::size_t bodies) {
  std::vector<std::uint8_t> bytes;
  encode(WrenchRequest{.id = {seq, 7, seq}, .lead_time = 0.0, .bodies = std::vector<BodyState>(bodies)},
         bytes);
  return {bytes.begin(), bytes.end()};
}

enum class Data { kPlain, kWithLogs };  // kWithLogs: some messages hold events, as a whole or in part

std::string random_log(Random& random, Data data, int events) {
  std::string log;
  for (int i = 0; i < events; ++i) {
    if (random.one_in(3)) {
      log += event("OTHER", i, std::string(random.below(200), 'x'));
    } else if (data == Data::kWithLogs && random.one_in(3)) {
      std::string inner = random_log(random, Data::kPlain, 4);
      if (random.one_in(2)) inner.resize(random.below(inner.size()));
      if (random.one_in(2)) inner.erase(0, random.below(inner.size() + 1));
      log += event(random.one_in(2) ? "OTHER" : "COPIED", i, inner);
    } else {
      log += event("BUOYANCY_STATES", i, request(i, random.below(3)));
    }
  }
  return log;
}

void damage(Random& random, std::string& bytes) {
  const std::size_t at = random.below(bytes.size());
  const std::size_t size = random.below(300);
  switch (random.below(7)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << random.below(8)));
      break;
    case 1:
      bytes.replace(at, size, random.bytes(size));
      break;
    case 2:
      bytes.replace(at, size, std::string(size, '\0'));
      break;
    case 3:
      bytes.insert(at, random.bytes(size));
      break;
    case 4:
      bytes.insert(at, "\xED\xA1\xDA\x01");
      break;
    case 5:
      bytes.erase(at, size);
      break;
    default:
      bytes.resize(at + 1);
      break;
  }
}

// Cuts the log at every `step`-th offset. Returns the number of cuts that seek() did not find.
int check_log(const std::string& bytes, std::int64_t step, std::int64_t distance) {
  const TempDir directory;
  const std::string path = directory.write("x.lcmlog", bytes);
  EventLogReader all = open_log(path);
  const Piece whole = read_until(all, kNoLimit);
  int missed = 0;
  for (std::int64_t cut = 0; cut <= static_cast<std::int64_t>(bytes.size()); cut += step) {
    EventLogReader front = open_log(path);
    Piece joined = read_until(front, cut);
    EXPECT_GE(joined.end, cut);
    EventLogReader back = open_log(path);
    back.seek(cut, distance);
    EXPECT_GE(back.position(), cut);
    if (back.position() != joined.end) {
      ++missed;
      back = open_log(path);
      back.seek_to(joined.end);
    }
    const Piece rest = read_until(back, kNoLimit);
    joined.items.insert(joined.items.end(), rest.items.begin(), rest.items.end());
    EXPECT_EQ(joined.items, whole.items) << "cut for byte " << cut;
    EXPECT_EQ(rest.end, whole.end);
  }
  return missed;
}

TEST(LogCuts, AreFoundAnywhereInIntactLogs) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    Random random(seed);
    const std::string log = random_log(random, Data::kPlain, 12);
    for (const std::int64_t distance : {0, 1, 100, 1'000'000})
      EXPECT_EQ(check_log(log, 1, distance), 0) << seed;
  }
}

TEST(LogCuts, AreFoundBesideEventsInsideMessages) {
  constexpr std::int64_t kLongerThanAnyEvent = 2'000;
  for (unsigned seed = 0; seed < 30; ++seed) {
    Random random(seed);
    const std::string log = random_log(random, Data::kWithLogs, 40);
    EXPECT_EQ(check_log(log, 13, kLongerThanAnyEvent), 0) << seed;
  }
}

TEST(LogCuts, AreMissedInsideMessageThatHoldsEventsAndExceedsDistance) {
  Random random(1);
  std::string log = event("OTHER", 1, random_log(random, Data::kPlain, 20));
  log += random_log(random, Data::kPlain, 5);
  EXPECT_GT(check_log(log, 7, 100), 0);  // and check_log() still joins the pieces
  EXPECT_EQ(check_log(log, 7, static_cast<std::int64_t>(log.size())), 0);
}

TEST(LogCuts, JoinPiecesOfDamagedLogs) {
  int cuts = 0;
  int missed = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    Random random(seed);
    std::string log = random_log(random, seed % 2 == 0 ? Data::kPlain : Data::kWithLogs, 30);
    for (std::size_t i = 0; i <= seed % 4; ++i) damage(random, log);
    missed += check_log(log, 37, 2'000);
    cuts += static_cast<int>(log.size() / 37 + 1);
  }
  EXPECT_LT(missed, cuts / 100) << "of " << cuts;
}

TEST(LogCuts, LieAtFirstHeaderAfterGarbage) {
  Random random(3);
  const std::string before = random_log(random, Data::kPlain, 5);
  const std::string after = random_log(random, Data::kPlain, 5);
  const TempDir directory;
  const std::string path = directory.write("x.lcmlog", before + std::string(5'000, '\xED') + after);
  for (const std::size_t offset : {before.size() + 1, before.size() + 3'000, before.size() + 5'000}) {
    EventLogReader reader = open_log(path);
    reader.seek(static_cast<std::int64_t>(offset), 100);
    EXPECT_EQ(reader.position(), static_cast<std::int64_t>(before.size() + 5'000));
  }
}

// ---- CSV

StateCsvReader open_csv(const std::string& path) {
  auto reader = StateCsvReader::open(path);
  if (!reader) throw std::runtime_error(reader.error().message());
  return *std::move(reader);
}

const std::string kHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";

std::string random_csv(Random& random, int lines) {
  std::string csv = kHeader;
  std::int64_t utime = 0;
  for (int i = 0; i < lines; ++i) {
    if (random.one_in(2)) ++utime;
    if (random.one_in(8)) csv += "\n \n";
    if (random.one_in(10)) csv += "malformed\r\n";
    if (random.one_in(40)) csv.append(5'000, 'x') += '\n';
    csv += std::to_string(utime) + "," + std::to_string(i) + ",0,0,0,1,0,0,0\n";
  }
  if (random.one_in(3)) csv.pop_back();
  return csv;
}

// The items without what counts from the start of a piece: the numbers of requests and lines.
std::vector<std::string> without_counts(const Piece& piece) {
  std::vector<std::string> items;
  for (std::string item : piece.items) {
    if (item.starts_with("line ")) {
      item = item.substr(item.find(':'));
    } else {
      constexpr std::size_t kSeq = 24;  // after fingerprint, utime and session_id
      item.replace(item.find("  ") + 2 + kSeq, 8, 8, '#');
    }
    items.push_back(item);
  }
  return items;
}

void check_csv(const std::string& csv, std::size_t step) {
  const TempDir directory;
  const std::string path = directory.write("x.csv", csv);
  StateCsvReader all = open_csv(path);
  const Piece whole = read_until(all, kNoLimit);
  for (std::size_t cut = 0; cut <= csv.size(); cut += step) {
    StateCsvReader front = open_csv(path);
    Piece joined = read_until(front, static_cast<std::int64_t>(cut));
    StateCsvReader back = open_csv(path);
    back.seek(static_cast<std::int64_t>(cut));
    const Piece rest = read_until(back, kNoLimit);
    EXPECT_EQ(rest.start, joined.end) << "cut for byte " << cut;
    joined.items.insert(joined.items.end(), rest.items.begin(), rest.items.end());
    EXPECT_EQ(without_counts(joined), without_counts(whole)) << "cut for byte " << cut;
  }
}

TEST(CsvCuts, JoinPiecesOfAnyCsv) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(seed);
    check_csv(random_csv(random, 30), 1 + seed % 7);
  }
}

TEST(CsvCuts, JoinPiecesOfCsvWithoutRows) {
  for (const std::string csv : {"", "\n", "\n\n\n", "x\n", "x", "1,1,0,0,0,1,0,0,0"})
    check_csv(kHeader + csv, 1);
  check_csv("", 1);
}

// A run of rows is a request per 65,536 rows, counted from its first row, which a later piece cannot know.
TEST(CsvCuts, NeverDivideRowsWithEqualUtime) {
  const std::string row = "1,1,0,0,0,1,0,0,0\n";
  for (const std::size_t rows : {kMaxRowsPerRequest - 1, kMaxRowsPerRequest, kMaxRowsPerRequest + 1}) {
    std::string csv = kHeader;
    for (std::size_t i = 0; i < rows; ++i) csv += row;
    for (int i = 2; i < 6; ++i) csv += std::to_string(i) + row.substr(1);
    check_csv(csv, csv.size() / 3 + 1);
    check_csv(csv, csv.size() - 40);
  }
}

TEST(CsvCuts, CountsLinesFromPiecesStart) {
  const TempDir directory;
  const std::string rows = "1,1,0,0,0,1,0,0,0\n2,1,0,0,0,1,0,0,0\n";
  StateCsvReader reader = open_csv(directory.write("x.csv", kHeader + rows + "x\n" + rows));
  reader.seek(static_cast<std::int64_t>(kHeader.size() + rows.size()));
  const Piece piece = read_until(reader, kNoLimit);
  ASSERT_EQ(piece.items.size(), 3U);
  EXPECT_EQ(
      piece.items[0].rfind("line 1 after byte " + std::to_string(kHeader.size() + rows.size()) + ": ", 0), 0U)
      << piece.items[0];
}

}  // namespace
}  // namespace buoyancy
