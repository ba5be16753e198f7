// Logs damaged at random, one place each, given to buoyancy-replay as a program: it never crashes, and
// answers every event before and behind the damage as in the log that is whole.
#include <algorithm>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages/wire.h"
#include "recording/event_log.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

constexpr int kEvents = 60;
constexpr unsigned kLogs = 100;
constexpr const char* kScene = "[[body]]\nid = 1\nshape = { type = \"rock\", frequency = 4 }\n";

struct Log {
  std::string bytes;
  std::vector<std::size_t> starts;  // of the events, and behind the last one
};

std::vector<std::uint8_t> request(int number) {
  BodyState state;
  state.body_id = 1;
  state.position = {1.0 * number, 0.0, 0.01 * number - 0.3};
  state.quaternion_wxyz = {0.8, 0.6, 0.0, 0.0};
  std::vector<std::uint8_t> bytes;
  // Of several lengths, so that no damage happens to leave the events in step.
  encode(WrenchRequest{.key = {number, 7, number},
                       .lead_time = 0.0,
                       .bodies = std::vector<BodyState>(static_cast<std::size_t>(1 + number % 3), state)},
         bytes);
  return bytes;
}

Log whole_log() {
  Log log;
  std::vector<std::uint8_t> event;
  for (int number = 0; number < kEvents; ++number) {
    const bool ours = number % 5 != 4;
    encode_event(number, number, ours ? "BUOYANCY_STATES" : "SOMEBODY_ELSES", request(number), event);
    log.starts.push_back(log.bytes.size());
    log.bytes.append(event.begin(), event.end());
  }
  log.starts.push_back(log.bytes.size());
  return log;
}

// The bytes [begin, end) of the whole log are replaced.
struct CorruptSection {
  std::string kind;
  std::size_t begin = 0, end = 0;
  std::string replacement;
};

CorruptSection damage_of(const Log& log, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&random](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  const auto garbage = [&](std::size_t size) {
    std::string bytes(size, '\0');
    for (char& value : bytes) value = static_cast<char>(below(256));
    return bytes;
  };
  CorruptSection damage;
  damage.begin = below(log.bytes.size());
  damage.end = std::min(damage.begin + 1 + below(600), log.bytes.size());
  switch (seed % 6) {
    case 0:
      damage.kind = "a bit";
      damage.end = damage.begin + 1;
      damage.replacement = {static_cast<char>(log.bytes[damage.begin] ^ (1 << below(8)))};
      break;
    case 1:
      damage.kind = "overwritten";
      damage.replacement = garbage(damage.end - damage.begin);
      break;
    case 2:
      damage.kind = "zeros, as after a crash of the machine";
      damage.replacement = std::string(damage.end - damage.begin, '\0');
      break;
    case 3:
      damage.kind = "inserted";
      damage.end = damage.begin;
      damage.replacement = garbage(1 + below(2000));
      break;
    case 4:
      damage.kind = "missing";
      break;
    default:
      damage.kind = "cut off";
      damage.end = log.bytes.size();
      break;
  }
  return damage;
}

// The responses of a CSV by their request's utime.
using Responses = std::map<int, std::string>;

class MutatedLogs : public testing::Test {
 protected:
  FinishedProcess replay(const std::string& log) const {
    return run_to_end(command_of({BUOYANCY_REPLAY, "--scene", scene_, directory_.write("in.lcmlog", log),
                                  directory_.path("out.csv")}),
                      kWaitTimeout);
  }

  Responses responses() const {
    Responses result;
    std::istringstream lines(read_file(directory_.path("out.csv")));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) result[std::stoi(line)] += line + "\n";
    return result;
  }

  TempDir directory_;
  std::string scene_ = directory_.write("scene.toml", kScene);
};

TEST_F(MutatedLogs, AreAnsweredBeforeAndBehindTheDamageAsIfThereWereNone) {
  const Log log = whole_log();
  ASSERT_EQ(replay(log.bytes).exit_code, 0);
  const Responses whole = responses();
  ASSERT_EQ(whole.size(), std::size_t{kEvents} * 4 / 5);
  int damaged = 0;
  for (unsigned seed = 0; seed < kLogs; ++seed) {
    const CorruptSection damage = damage_of(log, seed);
    std::string bytes = log.bytes;
    bytes.replace(damage.begin, damage.end - damage.begin, damage.replacement);
    const FinishedProcess finished = replay(bytes);
    const std::string what = damage.kind + " at byte " + std::to_string(damage.begin) + " to " +
                             std::to_string(damage.end) + ", seed " + std::to_string(seed);
    ASSERT_TRUE(finished.exit_code == 0 || finished.exit_code == 1)
        << what << ": " << finished.standard_error;
    if (finished.exit_code == 1) ++damaged;
    const Responses found = responses();
    for (int number = 0; number < kEvents; ++number) {
      const auto place = static_cast<std::size_t>(number);
      const bool before = log.starts[place + 1] <= damage.begin;
      const bool behind = log.starts[place] >= damage.end;
      if ((!before && !behind) || whole.count(number) == 0) continue;
      ASSERT_EQ(found.count(number), 1U)
          << "event " << number << " at byte " << log.starts[place] << "; " << what;
      EXPECT_EQ(found.at(number), whole.at(number)) << "event " << number << "; " << what;
    }
  }
  EXPECT_GT(damaged, static_cast<int>(kLogs) / 2) << "most corrupt_sections are reported";
}

}  // namespace
}  // namespace buoyancy
