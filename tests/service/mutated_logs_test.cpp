// Runs buoyancy-replay on logs with one random mutation each: it never crashes, and handles every event
// before and after the mutation as in the original log.
#include <algorithm>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/recorded_log.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

constexpr int kEvents = 60;
constexpr unsigned kLogs = 100;
constexpr const char* kScene = "[[body]]\nid = 1\nshape = { type = \"rock\", frequency = 4 }\n";

struct Log {
  std::string bytes;
  std::vector<std::size_t> starts;  // of the events, and the end of the last one
};

std::vector<std::uint8_t> request(int number) {
  BodyState state;
  state.body_id = 1;
  state.position = {1.0 * number, 0.0, 0.01 * number - 0.3};
  state.quaternion_wxyz = {0.8, 0.6, 0.0, 0.0};
  // Different lengths, so that no mutation leaves the following events aligned by chance.
  return encoded(
      WrenchRequest{.id = {number, 7, number},
                    .lead_time = 0.0,
                    .bodies = std::vector<BodyState>(static_cast<std::size_t>(1 + number % 3), state)});
}

Log original_log() {
  RecordedLog log;
  std::vector<std::size_t> starts;
  for (int number = 0; number < kEvents; ++number) {
    starts.push_back(log.text().size());
    log.add(number, number % 5 != 4 ? "BUOYANCY_STATES" : "SOMEBODY_ELSES", request(number));
  }
  starts.push_back(log.text().size());
  return {log.text(), starts};
}

// Replaces the bytes [begin, end) of the original log.
struct Mutation {
  std::string kind;
  std::size_t begin = 0, end = 0;
  std::string replacement;
};

Mutation make_mutation(const Log& log, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&random](std::size_t limit) {
    return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
  };
  const auto garbage = [&](std::size_t size) {
    std::string bytes(size, '\0');
    for (char& value : bytes) value = static_cast<char>(below(256));
    return bytes;
  };
  Mutation mutation;
  mutation.begin = below(log.bytes.size());
  mutation.end = std::min(mutation.begin + 1 + below(600), log.bytes.size());
  switch (seed % 6) {
    case 0:
      mutation.kind = "a bit";
      mutation.end = mutation.begin + 1;
      mutation.replacement = {static_cast<char>(log.bytes[mutation.begin] ^ (1 << below(8)))};
      break;
    case 1:
      mutation.kind = "overwritten";
      mutation.replacement = garbage(mutation.end - mutation.begin);
      break;
    case 2:
      mutation.kind = "zeros, as after a crash of the machine";
      mutation.replacement = std::string(mutation.end - mutation.begin, '\0');
      break;
    case 3:
      mutation.kind = "inserted";
      mutation.end = mutation.begin;
      mutation.replacement = garbage(1 + below(2000));
      break;
    case 4:
      mutation.kind = "missing";
      break;
    default:
      mutation.kind = "cut off";
      mutation.end = log.bytes.size();
      break;
  }
  return mutation;
}

// The rows of a CSV by the utime of their request.
using Responses = std::map<int, std::string>;

class ReplayMutatedLogs : public testing::Test {
 protected:
  FinishedProcess replay(const std::string& log) const {
    return run_program("buoyancy-replay",
                       {"--scene", scene_, directory_.write("in.lcmlog", log), directory_.path("out.csv")});
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

TEST_F(ReplayMutatedLogs, KeepsResponsesBeforeAndAfterMutation) {
  const Log log = original_log();
  ASSERT_EQ(replay(log.bytes).exit_code, 0);
  const Responses expected = responses();
  ASSERT_EQ(expected.size(), std::size_t{kEvents} * 4 / 5);
  int reported = 0;
  for (unsigned seed = 0; seed < kLogs; ++seed) {
    const Mutation mutation = make_mutation(log, seed);
    std::string bytes = log.bytes;
    bytes.replace(mutation.begin, mutation.end - mutation.begin, mutation.replacement);
    const FinishedProcess finished = replay(bytes);
    const std::string description = mutation.kind + " at byte " + std::to_string(mutation.begin) + " to " +
                                    std::to_string(mutation.end) + ", seed " + std::to_string(seed);
    ASSERT_TRUE(finished.exit_code == 0 || finished.exit_code == 1)
        << description << ": " << finished.standard_error;
    if (finished.exit_code == 1) ++reported;
    const Responses found = responses();
    for (int number = 0; number < kEvents; ++number) {
      const auto index = static_cast<std::size_t>(number);
      const bool before = log.starts[index + 1] <= mutation.begin;
      const bool after = log.starts[index] >= mutation.end;
      if ((!before && !after) || expected.count(number) == 0) continue;
      ASSERT_EQ(found.count(number), 1U)
          << "event " << number << " at byte " << log.starts[index] << "; " << description;
      EXPECT_EQ(found.at(number), expected.at(number)) << "event " << number << "; " << description;
    }
  }
  EXPECT_GT(reported, static_cast<int>(kLogs) / 2) << "most mutations are reported";
}

}  // namespace
}  // namespace buoyancy
