// The results of buoyancy-ping for people and programs: a table, JSON, and JUnit XML.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "client/ping/ping.h"

namespace buoyancy::ping {

// One line per failure and per likely cause, for standard error; none if the service agrees.
std::vector<std::string> failure_lines(const PingResult& result);

// "2 of 5 replies differ; " and the message of the worst failure.
std::string describe_check(const CheckResult& check);

std::string to_text(const PingTask& task, const PingResult& result);
std::string to_json(const PingTask& task, const PingResult& result);  // one object

// A test suite with a test case per check of the run and per check of each body, as CI systems read it. A
// check that compared nothing is skipped, and left out where the scene does not request it.
std::string to_junit(const PingTask& task, const PingResult& result);

// Writes a file that appears under its name when it is complete. Errors: not writable, the disk is full.
Expected<void> write_file(const std::filesystem::path& path, const std::string& text);

}  // namespace buoyancy::ping
