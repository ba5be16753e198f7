// Runs buoyancyd and buoyancy-client as processes, with scene files and CSV files in a directory of the test.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/support/child_process.h"
#include "tests/support/csv.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {

// Two LCM networks that are separated by their ports.
inline constexpr const char* kServiceUrl = "udpm://239.255.76.67:7667?ttl=0";
inline constexpr const char* kClientUrl = "udpm://239.255.76.67:7668?ttl=0";

std::uintmax_t size_of(const std::filesystem::path& path);  // 0 if the file does not exist yet

// Waits until the file that the program writes has at least `bytes` bytes. False: the program ended before,
// or the wait timed out.
bool grows_to(const std::filesystem::path& path, std::uintmax_t bytes, ChildProcess& program);

using Options = std::vector<std::string>;

ChildCommand client_command(const std::string& scene, const Options& options);
ChildCommand service_command(const std::string& scene, const Options& options);

// Runs buoyancy-client --json to its end and returns its summary. Expects success, and nothing on standard
// error but the warnings of the summary; null after a failure.
nlohmann::json simulate_with_warnings(const std::string& scene, const Options& options);
// Same, and expects no warnings.
nlohmann::json simulate(const std::string& scene, const Options& options);

// Interrupts a run of buoyancy-client --json, which must still be in progress. Returns its summary, or null
// after a failure.
nlohmann::json interrupt(ChildProcess& client);

// Contents of the CSV file of an --embedded run of `steps` steps.
std::string embedded_csv(const TempDir& directory, const std::string& scene, std::int64_t steps,
                         const std::string& step);

// The body with this id in a summary.
nlohmann::json body(const nlohmann::json& summary, int id);

}  // namespace buoyancy
