#include "tests/e2e/closed_loop.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/build_paths.h"
#include "tests/support/json.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

ChildCommand command(std::string_view program, const std::string& scene, const Options& options) {
  ChildCommand command;
  command.arguments = {built_program(program), "--scene", scene};
  command.arguments.insert(command.arguments.end(), options.begin(), options.end());
  return command;
}

}  // namespace

ChildCommand client_command(const std::string& scene, const Options& options) {
  return command("buoyancy-client", scene, options);
}

ChildCommand service_command(const std::string& scene, const Options& options) {
  return command("buoyancyd", scene, options);
}

nlohmann::json simulate_with_warnings(const std::string& scene, const Options& options) {
  ChildCommand command = client_command(scene, options);
  command.arguments.emplace_back("--json");
  const FinishedProcess finished = run_to_end(command, kRunTimeout);
  EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
  if (finished.exit_code != 0) return nullptr;
  nlohmann::json summary = nlohmann::json::parse(finished.standard_output);
  std::string warnings;
  for (const std::string warning : summary["warnings"]) {
    warnings += "buoyancy-client: warning: " + warning + "\n";
  }
  EXPECT_EQ(finished.standard_error, warnings);
  return summary;
}

nlohmann::json simulate(const std::string& scene, const Options& options) {
  nlohmann::json summary = simulate_with_warnings(scene, options);
  if (summary.is_object()) {
    EXPECT_EQ(summary["warnings"], nlohmann::json::array());
  }
  return summary;
}

std::uintmax_t size_of(const std::filesystem::path& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

bool grows_to(const std::filesystem::path& path, std::uintmax_t bytes, ChildProcess& program) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kRunTimeout);
  while (size_of(path) < bytes) {
    if (program.wait(0.001) || std::chrono::steady_clock::now() >= deadline) return false;
  }
  return true;
}

nlohmann::json interrupt(ChildProcess& client) {
  client.send_signal(SIGINT);
  EXPECT_EQ(client.wait(kWaitTimeout), 1) << client.standard_error();
  nlohmann::json summary = nlohmann::json::parse(client.standard_output(), nullptr, false);
  EXPECT_TRUE(summary.is_object()) << client.standard_error();
  if (!summary.is_object()) return nullptr;
  EXPECT_EQ(summary["interrupted"], true);
  return summary;
}

std::string embedded_csv(const TempDir& directory, const std::string& scene, std::int64_t steps,
                         const std::string& step) {
  const std::string csv = directory.path("embedded.csv");
  const double duration = static_cast<double>(steps) * std::stod(step);
  simulate(scene, {"--embedded", "--duration", std::to_string(duration), "--step", step, "--csv", csv});
  return read_file(csv);
}

nlohmann::json body(const nlohmann::json& summary, int id) {
  if (summary.is_object()) {
    for (const nlohmann::json& candidate : summary["bodies"]) {
      if (candidate["id"] == id) return candidate;
    }
  }
  ADD_FAILURE() << "no body " << id << " in " << summary;
  return {{"draft", NAN}, {"roll_deg", NAN}, {"energy_range", NAN}, {"energy_drift", NAN}};
}

}  // namespace buoyancy
