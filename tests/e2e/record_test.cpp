// buoyancy-record beside a run, and beside a sender that is faster than it.
#include <csignal>
#include <fstream>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

#include "messages/wire.h"
#include "recording/event_log.h"
#include "tests/e2e/closed_loop.h"
#include "tests/support/build_paths.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"
#include "transport/lcm_connection.h"

namespace buoyancy {
namespace {

class Record : public testing::Test {
 protected:
  ChildCommand recorder(const std::string& url = kServiceUrl) const {
    return command_of({built_program("buoyancy-record"), log_, "-l", url});
  }

  // The ids of all requests of the log.
  std::vector<RequestId> recorded_requests() const {
    std::vector<RequestId> ids;
    auto reader = EventLogReader::open(log_, only_channel(std::string(kStatesChannel))).value();
    for (LogItem item = reader.next(); std::holds_alternative<RecordedEvent>(item); item = reader.next()) {
      ids.push_back(peek_request_id(std::get<RecordedEvent>(item).bytes).value());
    }
    return ids;
  }

  // Ends the recorder as a user does. Returns its exit code.
  static std::optional<int> end(RunningProgram& recorder) {
    recorder.send_signal(SIGINT);
    return recorder.wait(kWaitTimeout);
  }

  // As after a recorder that missed some requests and other responses.
  void expect_that_a_replay_agrees_despite_holes(const std::string& scene) const {
    const std::string holes = directory_.path("holes.lcmlog");
    std::ofstream file(holes, std::ios::binary);
    auto reader = EventLogReader::open(log_, [](std::string_view) { return true; }).value();
    std::vector<std::uint8_t> event;
    WrenchResponse response;
    for (LogItem item = reader.next(); std::holds_alternative<RecordedEvent>(item); item = reader.next()) {
      const auto& recorded = std::get<RecordedEvent>(item);
      if (const auto request = peek_request_id(recorded.bytes)) {
        if (request->seq >= 100 && request->seq < 103) continue;
      } else if (!decode(recorded.bytes, response) && response.id.seq >= 200 && response.id.seq < 205) {
        continue;
      }
      encode_event(0, recorded.timestamp, recorded.channel, recorded.bytes, event);
      file.write(reinterpret_cast<const char*>(event.data()), static_cast<std::streamsize>(event.size()));
    }
    file.close();
    const FinishedProcess replay = run_program(
        "buoyancy-replay", {"--scene", scene, "--compare", holes, holes, directory_.path("replayed.lcmlog")},
        kRunTimeout);
    EXPECT_EQ(replay.exit_code, 0) << replay.standard_output << replay.standard_error;
    for (const char* const expected :
         {": 3 requests missing, seq 100 to 102\n",
          "8 messages were not recorded, between others of their session\n", "agree with the baseline"}) {
      EXPECT_TRUE(contains(replay.standard_output, expected));
    }
  }

  TempDir directory_;
  std::string log_ = directory_.path("run.lcmlog");
};

TEST_F(Record, HasEveryMessageOfALockstepRun) {
  const std::string scene = directory_.write("scene.toml", R"(
[[body]]
id = 1
shape = { type = "box" }
[body.client]
density = 500
position = [0, 0, 0.3]
)");
  const RunningProgram service(service_command(scene, {"-l", kServiceUrl}));
  RunningProgram recording(recorder());
  const nlohmann::json summary = simulate(scene, {"-l", kServiceUrl, "--duration", "5", "--step", "0.001"});
  EXPECT_EQ(end(recording), 0) << recording.standard_output() << recording.standard_error();
  EXPECT_TRUE(contains(recording.standard_output(), " 0 requests and 0 responses missing"));
  expect_that_a_replay_agrees_despite_holes(scene);
  const auto sent = summary["requests"].get<std::int64_t>() + summary["retries"].get<std::int64_t>();
  EXPECT_EQ(static_cast<std::int64_t>(recorded_requests().size()), sent);
}

// The recorder is stopped while requests arrive, more than its small receive buffer holds.
TEST_F(Record, CountsWhatItMissed) {
  RunningProgram recording(recorder("udpm://239.255.76.67:7667?ttl=0&recv_buf_size=20000"));
  LcmConnection sender = LcmConnection::open(kServiceUrl).value();
  std::vector<std::uint8_t> bytes;
  const auto send = [&](std::int64_t seq) {
    encode(BorrowedRequest({1000 * seq, 5, seq}, 0.0, {}), bytes);
    ASSERT_TRUE(sender.publish(std::string(kStatesChannel), bytes));
  };
  const auto is_recorded = [&](std::int64_t seq) {
    for (const RequestId& id : recorded_requests()) {
      if (id.seq == seq) return true;
    }
    return false;
  };
  // Until the message is on the disk.
  const auto send_until_recorded = [&](std::int64_t seq) {
    for (int i = 0; i < static_cast<int>(20 * kWaitTimeout) && !is_recorded(seq); ++i) {
      send(seq);
      usleep(50'000);
    }
    ASSERT_TRUE(is_recorded(seq));
  };

  send_until_recorded(0);
  recording.send_signal(SIGSTOP);
  for (std::string state; state != "T";) {
    std::string pid;
    std::string name;
    std::ifstream("/proc/" + std::to_string(recording.pid()) + "/stat") >> pid >> name >> state;
  }
  constexpr std::int64_t kLast = 3000;
  for (std::int64_t seq = 1; seq < kLast; ++seq) send(seq);
  recording.send_signal(SIGCONT);
  send_until_recorded(kLast);
  EXPECT_EQ(end(recording), 1) << "an incomplete recording is a failure";

  std::set<std::int64_t> recorded;
  for (const RequestId& id : recorded_requests()) recorded.insert(id.seq);
  const std::int64_t missing = kLast + 1 - static_cast<std::int64_t>(recorded.size());
  EXPECT_GT(missing, 1000);
  const std::string output = recording.standard_output();
  EXPECT_TRUE(contains(
      output, "; " + std::to_string(missing) + " requests and 0 responses missing; the kernel dropped "))
      << missing << '\n'
      << output;
  EXPECT_TRUE(contains(output, "session 5: " + std::to_string(missing) + " requests missing, seq "));
  EXPECT_TRUE(contains(recording.standard_error(), "its receive buffer was full"));
}

TEST_F(Record, RefusesWhatItCannotWrite) {
  const FinishedProcess folder = run_program("buoyancy-record", {directory_.path("")});
  EXPECT_EQ(folder.exit_code, 1);
  EXPECT_TRUE(contains(folder.standard_error, "buoyancy-record: "));
  const FinishedProcess twice = run_program("buoyancy-record", {log_, "--channel", "A", "--channel", "A"});
  EXPECT_EQ(twice.exit_code, 2);
}

}  // namespace
}  // namespace buoyancy
