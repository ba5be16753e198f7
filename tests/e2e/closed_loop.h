// The real programs as a test runs them: a scene file and a CSV in a directory of the test's own, buoyancyd
// and buoyancy-client as processes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {

// Two buses that do not hear each other: the port tells them apart.
inline constexpr const char* kServiceUrl = "udpm://239.255.76.67:7667?ttl=0";
inline constexpr const char* kClientUrl = "udpm://239.255.76.67:7668?ttl=0";

std::uintmax_t size_of(const std::filesystem::path& path);  // 0 where there is no such file yet

// Waits until the file that the program writes has so many bytes; false where the program ends before, or
// does not get so far.
bool grows_to(const std::filesystem::path& path, std::uintmax_t bytes, ChildProcess& program);

using Options = std::vector<std::string>;

ChildCommand client_command(const std::string& scene, const Options& options);
ChildCommand service_command(const std::string& scene, const Options& options);

// Runs buoyancy-client --json to its end, which the test expects to be a success, and to be silent but for
// the warnings that are in the table too; null after a failure.
nlohmann::json simulate_with_warnings(const std::string& scene, const Options& options);
// The same where the test expects no warnings.
nlohmann::json simulate(const std::string& scene, const Options& options);

// Ends a run of buoyancy-client --json, which the test expects to go on until then; its table, or null after
// a failure.
nlohmann::json interrupt(ChildProcess& client);

// What a run of so many steps, in one process and without a network, writes into its CSV.
std::string embedded_csv(const TempDir& directory, const std::string& scene, std::int64_t steps,
                         const std::string& step);

// The run's table: the body with this id.
nlohmann::json body(const nlohmann::json& summary, int id);

// A column of the CSV, one number per row.
std::vector<double> csv_column(const std::string& csv, const std::string& name);

}  // namespace buoyancy
