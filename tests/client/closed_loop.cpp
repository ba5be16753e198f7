#include "tests/client/closed_loop.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

// Far beyond what any run takes, also under sanitizers: a run that hangs fails.

ChildCommand command(const char* program, const std::string& scene, const Options& options) {
  ChildCommand command;
  command.arguments = {program, "--scene", scene};
  command.arguments.insert(command.arguments.end(), options.begin(), options.end());
  return command;
}

}  // namespace

TemporaryDirectory::TemporaryDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "buoyancy_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) std::abort();
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string TemporaryDirectory::write(const std::string& name, const std::string& contents) const {
  std::ofstream(path(name)) << contents;
  return path(name);
}

std::string read_file(const std::filesystem::path& path) {
  std::ostringstream contents;
  contents << std::ifstream(path, std::ios::binary).rdbuf();
  return contents.str();
}

ChildCommand client_command(const std::string& scene, const Options& options) {
  return command(BUOYANCY_CLIENT, scene, options);
}

ChildCommand service_command(const std::string& scene, const Options& options) {
  return command(BUOYANCYD, scene, options);
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

nlohmann::json body(const nlohmann::json& summary, int id) {
  if (summary.is_object()) {
    for (const nlohmann::json& candidate : summary["bodies"]) {
      if (candidate["id"] == id) return candidate;
    }
  }
  ADD_FAILURE() << "no body " << id << " in " << summary;
  return {{"draft", NAN}, {"roll_deg", NAN}, {"energy_range", NAN}, {"energy_drift", NAN}};
}

std::vector<double> csv_column(const std::string& csv, const std::string& name) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::size_t at = ("," + line + ",").find("," + name + ",");
  EXPECT_NE(at, std::string::npos) << name;
  const auto column = std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(at), ',');
  std::vector<double> values;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    std::string field;
    for (std::ptrdiff_t i = 0; i <= column; ++i) std::getline(fields, field, ',');
    values.push_back(std::stod(field));
  }
  return values;
}

}  // namespace buoyancy
