// What every program does alike with its command line: exit codes, and CLI11's many ways of
// failing turned into one line on stderr and exit code 2.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>

#include <CLI/App.hpp>

#include "base/error.h"

namespace buoyancy {

enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,     // it ran and failed
  kUsageError = 2,  // wrong arguments, scene or mesh
};

// nullopt: parsed, go on. Else the exit code: kSuccess after --help and --version, kUsageError after one line
// on stderr.
std::optional<ExitCode> parse_command_line(CLI::App& app, int argc, const char* const* argv);

// Errors: output, there already, is one of the files that are read. An empty path is none.
Expected<void> check_output_is_its_own(const std::filesystem::path& output,
                                       std::initializer_list<std::filesystem::path> read);

// One line on stderr: "<program>: <message>"; for the journal with its level in front (journal.h).
void print_error(const CLI::App& app, const std::string& message);
void print_error(const CLI::App& app, const Error& error);

// Writes text to stdout. False, after one line on stderr: it could not be written, a full disk for instance.
bool print_output(const CLI::App& app, const std::string& text);

}  // namespace buoyancy
