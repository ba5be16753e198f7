// Runs buoyancy-ping as a process: against the real buoyancyd, and against fake services that misbehave.
#include <atomic>
#include <csignal>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "cli/command_line.h"
#include "tests/client/fake_service.h"
#include "tests/ping/two_scenes.h"
#include "tests/service/running_service.h"
#include "tests/support/build_paths.h"
#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"

namespace buoyancy::ping {
namespace {

using Arguments = std::vector<std::string>;

// A scene of two bodies in water at rest.
const std::string kScene = SceneText{}.text();

std::string scene_with(const std::string& old_part, const std::string& new_part) {
  std::string text = kScene;
  text.replace(text.find(old_part), old_part.size(), new_part);
  return text;
}

// A directory with the scene file of buoyancy-ping, and its runs.
class PingRun {
 public:
  explicit PingRun(const std::string& scene = kScene) : scene_(directory_.write("here.toml", scene)) {}

  Arguments command(const Arguments& options) const {
    Arguments arguments{built_program("buoyancy-ping"), "--scene", scene_};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return arguments;
  }
  FinishedProcess run(const Arguments& options = {}) const {
    return run_to_end(command_of(command(options)), kRunTimeout);
  }
  std::string path(const std::string& name) const { return directory_.path(name); }
  std::string write(const std::string& name, const std::string& text) const {
    return directory_.write(name, text);
  }

 private:
  TempDir directory_;
  std::string scene_;
};

// Responds as a service with this scene does, before `change` is applied to the bytes of each response.
class ChangedResponses {
 public:
  using Change = std::function<Responses(std::vector<std::uint8_t> response, int request)>;

  explicit ChangedResponses(Change change)
      : scene_(scene_of(kScene)),
        handler_(scene_, {.threads = 1}),
        change_(std::move(change)),
        service_([this](const WrenchRequest& request) {
          return change_(copy_of(handler_.handle(encoded(request))), count_++);
        }) {}

  int requests() const { return service_.requests(); }

 private:
  Scene scene_;
  RequestHandler handler_;
  Change change_;
  int count_ = 0;
  FakeService service_;  // its thread uses what is declared before it
};

TEST(PingProgram, AgreesBitForBitWithServiceOfSameScene) {
  SceneText hydrostatics;
  hydrostatics.outputs = kWithHydrostatics;
  SceneText loads;
  loads.outputs = kWithLoads;
  loads.body = kDrag + "[body.added_mass]\nmatrix = [5, 126, 126, 0.1, 33, 33]\n";
  loads.water = "current = { velocity = [0.5, 0, 0] }";
  SceneText waves;
  waves.water = kWaves;
  waves.tolerance = "0.001";
  for (const std::string& scene : {kScene, hydrostatics.text(), loads.text(), waves.text()}) {
    const RunningService service({}, scene);
    const FinishedProcess ping =
        PingRun(scene).run({"--json", "--identical", "--count", "60", "--retries", "10000"});
    ASSERT_EQ(ping.exit_code, kSuccess) << ping.standard_error << scene;
    EXPECT_EQ(ping.standard_error, "");
    const nlohmann::json json = parse_json(ping.standard_output);
    EXPECT_EQ(json["agrees"], true);
    EXPECT_EQ(json["requests"], 60);
    EXPECT_EQ(json["replies"], 60);
    EXPECT_EQ(json["identical"], 60);
    EXPECT_GT(json["round_trip"]["min"].get<double>(), 0.0);
    EXPECT_LE(json["round_trip"]["median"].get<double>(), json["round_trip"]["max"].get<double>());
  }
}

TEST(PingProgram, AgreesInModeLatestAndPrintsTable) {
  const RunningService service({"--mode", "latest"}, kScene);
  const FinishedProcess ping = PingRun().run({"--rate", "200", "--count", "20", "--retries", "10000"});
  EXPECT_EQ(ping.exit_code, kSuccess) << ping.standard_error;
  for (const char* const part : {"20 sent", "20 compared, 20 of them identical", "median", "p90", "agrees"}) {
    EXPECT_TRUE(contains(ping.standard_output, part)) << part << "\n" << ping.standard_output;
  }
}

TEST(PingProgram, NamesDensityOfService) {
  const RunningService service({}, scene_with("density = 1025", "density = 1000"));
  const PingRun here;
  const FinishedProcess ping = here.run({"--json", "--junit", here.path("ping.xml")});
  EXPECT_EQ(ping.exit_code, kFailure);
  for (const char* const part :
       {"body 1", "force", "off by 122.583 N", "a density of 1000 instead of 1025"}) {
    EXPECT_TRUE(contains(ping.standard_error, part)) << part << "\n" << ping.standard_error;
  }
  EXPECT_FALSE(contains(ping.standard_error, "volume"));
  const nlohmann::json json = parse_json(ping.standard_output);
  EXPECT_EQ(json["agrees"], false);
  EXPECT_EQ(json["service"]["scene_bodies"], 2);
  EXPECT_EQ(json["bodies"][0]["checks"]["status"]["failed"], 0);
  EXPECT_GT(json["bodies"][0]["checks"]["force"]["failed"].get<int>(), 0);
  const std::string xml = read_file(here.path("ping.xml"));
  EXPECT_TRUE(contains(xml, "failures=\"4\"")) << xml;  // force and torque of both bodies
}

// In waves the bounds are wide: they hide a density that differs by little.
TEST(PingProgram, FailsOnHiddenDifferenceIfItMustBeIdentical) {
  SceneText here;
  here.water = kWaves;
  here.tolerance = "0.01";
  std::string there = here.text();
  const std::size_t density = there.find("density = 1025");
  ASSERT_NE(density, std::string::npos) << there;
  there.replace(density, 14, "density = 1025.01");
  const RunningService service({}, there);
  const FinishedProcess lenient = PingRun(here.text()).run({"--count", "20"});
  EXPECT_EQ(lenient.exit_code, kSuccess) << lenient.standard_error;
  EXPECT_TRUE(contains(lenient.standard_output, "but not to the last bit")) << lenient.standard_output;
  const FinishedProcess strict = PingRun(here.text()).run({"--count", "20", "--identical"});
  EXPECT_EQ(strict.exit_code, kFailure);
  EXPECT_TRUE(contains(strict.standard_error, "not identical to the last bit")) << strict.standard_error;
}

TEST(PingProgram, NamesBodyThatServiceLacks) {
  const RunningService service({}, kOneBoxScene);
  const FinishedProcess ping = PingRun().run();
  EXPECT_EQ(ping.exit_code, kFailure);
  EXPECT_TRUE(contains(ping.standard_error, "received UNKNOWN_BODY")) << ping.standard_error;
  EXPECT_TRUE(contains(ping.standard_error, "another scene file: its scene has no body 7"));
  EXPECT_TRUE(contains(ping.standard_error, "with 1 body, here 2 bodies"));
}

TEST(PingProgram, NamesMissingOutputOfService) {
  SceneText text;
  text.outputs = kWithHydrostatics;
  const RunningService service({}, kScene);
  const FinishedProcess ping = PingRun(text.text()).run({"--timeout", "0.05", "--retries", "20"});
  EXPECT_EQ(ping.exit_code, kFailure);
  EXPECT_TRUE(contains(ping.standard_error, "no hydrostatics")) << ping.standard_error;
  EXPECT_TRUE(contains(ping.standard_error, "BUOYANCY_HYDROSTATICS"));
  EXPECT_FALSE(contains(ping.standard_error, "differ")) << ping.standard_error;
}

TEST(PingProgram, SaysWhatWasTriedWhereNobodyResponds) {
  const PingRun here;
  const FinishedProcess ping =
      here.run({"--json", "--timeout", "0.02", "--retries", "2", "--junit", here.path("ping.xml")});
  EXPECT_EQ(ping.exit_code, kFailure);
  for (const char* const part : {"request 0: no response", "2 retries", "udpm://239.255.76.67:7667",
                                 "BUOYANCY_STATES", "BUOYANCY_WRENCHES", "not running", "ttl=1"}) {
    EXPECT_TRUE(contains(ping.standard_error, part)) << part << "\n" << ping.standard_error;
  }
  const nlohmann::json json = parse_json(ping.standard_output);
  EXPECT_EQ(json["requests"], 1);
  EXPECT_EQ(json["unanswered"], 1);
  EXPECT_EQ(json["retries"], 2);
  EXPECT_TRUE(contains(read_file(here.path("ping.xml")), "no response"));
}

TEST(PingProgram, NamesRunningServiceOnOtherChannels) {
  const RunningService service({}, kScene);
  const FinishedProcess ping =
      PingRun().run({"--timeout", "0.2", "--retries", "9", "--states-channel", "OTHER"});
  EXPECT_EQ(ping.exit_code, kFailure);
  EXPECT_TRUE(contains(ping.standard_error, "a service runs here")) << ping.standard_error;
  EXPECT_TRUE(contains(ping.standard_error, "other channels than OTHER"));
}

TEST(PingProgram, FailsOnDamagedResponses) {
  const auto cut = [](std::vector<std::uint8_t> response, int) {
    response.resize(response.size() - 8);
    return Responses{response};
  };
  const auto other_fingerprint = [](std::vector<std::uint8_t> response, int) {
    response[3] ^= 1U;
    return Responses{response};
  };
  const std::vector<std::pair<ChangedResponses::Change, std::string>> changes{
      {cut, "of 236 bytes on channel BUOYANCY_WRENCHES, where a response has 244: length does not fit"},
      {other_fingerprint, "fingerprint of another type or version"}};
  for (const auto& [change, expected] : changes) {
    const ChangedResponses service(change);
    const FinishedProcess ping = PingRun().run({"--timeout", "0.05", "--retries", "12"});
    EXPECT_EQ(ping.exit_code, kFailure);
    EXPECT_TRUE(contains(ping.standard_error, expected)) << ping.standard_error;
    EXPECT_TRUE(contains(ping.standard_error, "could not be decoded"));
    EXPECT_TRUE(contains(ping.standard_error, "no response"));
  }
}

// A retry gets an intact response, but the damaged one is not forgotten.
TEST(PingProgram, FailsOnOneDamagedResponseAmongMany) {
  const ChangedResponses service([](std::vector<std::uint8_t> response, int request) {
    if (request == 7) response.pop_back();
    return Responses{response};
  });
  const FinishedProcess ping =
      PingRun().run({"--json", "--count", "20", "--timeout", "0.1", "--retries", "10000"});
  EXPECT_EQ(ping.exit_code, kFailure);
  const nlohmann::json json = parse_json(ping.standard_output);
  EXPECT_EQ(json["replies"], 20);
  EXPECT_EQ(json["identical"], 20);
  EXPECT_EQ(json["undecodable"], 1);
  EXPECT_GE(json["retries"].get<int>(), 1);
  EXPECT_TRUE(contains(ping.standard_error, "1 message could not be decoded")) << ping.standard_error;
}

TEST(PingProgram, RetriesLostResponsesAndAgrees) {
  const ChangedResponses service([](std::vector<std::uint8_t> response, int request) {
    return request % 4 == 0 ? Responses{} : Responses{response};
  });
  const FinishedProcess ping =
      PingRun().run({"--json", "--count", "12", "--timeout", "0.05", "--retries", "10000"});
  EXPECT_EQ(ping.exit_code, kSuccess) << ping.standard_error;
  const nlohmann::json json = parse_json(ping.standard_output);
  EXPECT_GE(json["retries"].get<int>(), 3);
  EXPECT_EQ(json["unanswered"], 0);
}

TEST(PingProgram, FailsOnSecondResponseWithOtherContents) {
  const ChangedResponses service([](const std::vector<std::uint8_t>& response, int) {
    std::vector<std::uint8_t> other = response;
    other.back() ^= 1U;  // the last bit of a bound
    return Responses{response, other};
  });
  const FinishedProcess ping = PingRun().run({"--count", "20", "--retries", "10000"});
  EXPECT_EQ(ping.exit_code, kFailure);
  EXPECT_TRUE(contains(ping.standard_error, "a second response with other contents")) << ping.standard_error;
  EXPECT_TRUE(contains(ping.standard_error, "several services"));
}

TEST(PingProgram, EndsSoonAfterServiceStalls) {
  const ChangedResponses service([](std::vector<std::uint8_t> response, int) {
    return response_id(response).seq < 5 ? Responses{response} : Responses{};
  });
  const FinishedProcess ping = PingRun().run({"--json", "--timeout", "0.2", "--retries", "2"});
  EXPECT_EQ(ping.exit_code, kFailure);
  const nlohmann::json json = parse_json(ping.standard_output);
  EXPECT_EQ(json["replies"], 5);
  EXPECT_EQ(json["unanswered"], 3);
  EXPECT_TRUE(contains(ping.standard_error, "request 5: no response")) << ping.standard_error;
  EXPECT_TRUE(contains(ping.standard_error, "3 requests got no response"));
}

TEST(PingProgram, PrintsTableSoFarWhenInterrupted) {
  const ChangedResponses service([](std::vector<std::uint8_t> response, int) { return Responses{response}; });
  const PingRun here;
  for (const int signal : {SIGINT, SIGTERM}) {
    const int before = service.requests();
    ChildProcess ping(
        command_of(here.command({"--rate", "100", "--count", "1000000", "--retries", "10000"})));
    const auto limit = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
    while (service.requests() < before + 3 && std::chrono::steady_clock::now() < limit) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ping.send_signal(signal);
    EXPECT_EQ(ping.wait(kWaitTimeout), kFailure);
    EXPECT_TRUE(contains(ping.standard_output(), "round trip")) << ping.standard_output();
    EXPECT_TRUE(contains(ping.standard_error(), "of 1000000 requests")) << ping.standard_error();
  }
}

TEST(PingProgram, PublishesSeaForSceneThatReceivesIt) {
  SceneText received;
  received.water = "waves = \"received\"";
  received.tolerance = "0.001";
  SceneText waves = received;
  waves.water = kWaves;
  const PingRun here(received.text());
  const std::string sea = here.write("sea.toml", waves.text());
  const RunningService service({}, received.text());
  const FinishedProcess ping = here.run({"--json", "--sea", sea, "--count", "20", "--retries", "10000"});
  EXPECT_EQ(ping.exit_code, kSuccess) << ping.standard_error;
  EXPECT_EQ(parse_json(ping.standard_output)["identical"], 20);
}

TEST(PingProgram, RefusesWrongArgumentsWithExitCode2) {
  SceneText received;
  received.water = "waves = \"received\"";
  received.tolerance = "0.001";
  const PingRun here;
  const PingRun with_received_sea(received.text());
  const std::vector<std::pair<FinishedProcess, std::string>> runs{
      {here.run({"--count", "0"}), "--count"},
      {here.run({"--rate", "nan"}), "--rate"},
      {here.run({"--wrenches-channel", "BUOYANCY_STATES"}), "BUOYANCY_STATES"},
      {here.run({"-l", "tcpq://localhost"}), "tcpq"},
      {here.run({"--junit", here.path("here.toml")}), "here.toml"},
      {here.run({"--sea", here.path("here.toml")}), "--sea"},
      {with_received_sea.run(), "--sea FILE"},
      {with_received_sea.run({"--sea", here.path("here.toml")}), "describes no waves"},
      {run_program("buoyancy-ping", {"--scene", here.path("none.toml")}), "none.toml"}};
  for (const auto& [ping, expected] : runs) {
    EXPECT_EQ(ping.exit_code, kUsageError) << expected;
    EXPECT_TRUE(contains(ping.standard_error, expected)) << expected << "\n" << ping.standard_error;
    EXPECT_EQ(ping.standard_output, "");
  }
}

TEST(PingProgram, ReportsJunitFileThatCannotBeWritten) {
  const ChangedResponses service([](std::vector<std::uint8_t> response, int) { return Responses{response}; });
  const PingRun here;
  const FinishedProcess ping =
      here.run({"--count", "2", "--retries", "10000", "--junit", here.path("none/ping.xml")});
  EXPECT_EQ(ping.exit_code, kFailure);
  EXPECT_TRUE(contains(ping.standard_error, "none/ping.xml")) << ping.standard_error;
  EXPECT_TRUE(contains(ping.standard_output, "agrees"));
}

}  // namespace
}  // namespace buoyancy::ping
