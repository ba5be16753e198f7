// Command-line behaviour common to all programs: exit codes, and one line on standard error with exit code 2
// for every way in which CLI11 can reject the arguments.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>

#include <CLI/App.hpp>

#include "base/error.h"

namespace buoyancy {

enum ExitCode : int {
  kSuccess = 0,
  kFailure = 1,     // runtime error
  kUsageError = 2,  // invalid arguments, scene or mesh
};

// The meaning of each exit code in a program's description; the defaults are what most programs share.
struct ExitStatusHelp {
  std::string success = "on success, including termination by SIGINT or SIGTERM";
  std::string failure = "on a runtime error";
  std::string usage_error = "on invalid arguments, scene or mesh";
};

// Returns "Exit status: 0 on success, ...; 1 ...; 2 ....", the end of every program's description.
std::string exit_status_help(const ExitStatusHelp& help = {});

// Opens the standard descriptors that are closed (standard_descriptors.h); call it before opening any file.
// Returns nullopt if the program should continue, else its exit code: kSuccess after --help or --version,
// kUsageError after one line on standard error.
std::optional<ExitCode> parse_command_line(CLI::App& app, int argc, const char* const* argv);

// Errors: output, or the temporary name under which it is written, exists and is one of the input files.
// Empty paths are ignored.
Expected<void> check_output_not_input(const std::filesystem::path& output,
                                      std::initializer_list<std::filesystem::path> inputs);

// Prints "<program>: <message>" on standard error, after the log level if that is the journal (logging.h).
void print_error(const CLI::App& app, const std::string& message);
void print_error(const CLI::App& app, const Error& error);
// Prints "<program>: warning: <message>" likewise.
void print_warning(const CLI::App& app, const Warning& warning);

// Writes text to standard output. Returns false, after one line on standard error, if that fails, for
// instance because the disk is full.
bool print_output(const CLI::App& app, const std::string& text);

}  // namespace buoyancy
