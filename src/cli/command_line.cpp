#include "cli/command_line.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <string>
#include <system_error>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "base/standard_descriptors.h"
#include "cli/logging.h"
#include "recording/staged_file.h"

namespace buoyancy {
namespace {

// level: the prefix that names the line's level in the journal.
void print_line(const char* level, const CLI::App& app, const std::string& text) {
  std::fprintf(stderr, "%s%s: %s\n", stderr_is_journal() ? level : "", app.get_name().c_str(), text.c_str());
}

}  // namespace

std::string exit_status_help(const ExitStatusHelp& help) {
  return "Exit status: 0 " + help.success + ";\n1 " + help.failure + ";\n2 " + help.usage_error + ".";
}

std::optional<ExitCode> parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  // Every program comes here before it opens a file.
  open_standard_descriptors();
  std::signal(SIGXFSZ,
              SIG_IGN);  // a file as large as `ulimit -f` allows becomes a write error with a message
  try {
    app.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& parse_error) {
    if (parse_error.get_exit_code() == 0) {  // --help, --version
      app.exit(parse_error, std::cout, std::cerr);
      return kSuccess;
    }
    print_error(app, std::string(parse_error.what()) + "; see " + app.get_name() + " --help");
    return kUsageError;
  }
}

Expected<void> check_output_not_input(const std::filesystem::path& output,
                                      std::initializer_list<std::filesystem::path> inputs) {
  for (const std::filesystem::path& file : inputs) {
    std::error_code no_such_file;
    if (std::filesystem::equivalent(file, output, no_such_file) ||
        std::filesystem::equivalent(file, StagedFile::temporary_name(output), no_such_file)) {
      return make_error({output.string(), "the same file as " + file.string(), "a separate output file",
                         "writing it would overwrite the input", ""});
    }
  }
  return {};
}

void print_error(const CLI::App& app, const std::string& message) {
  print_line("<3>", app, message);
}

void print_error(const CLI::App& app, const Error& error) {
  print_error(app, error.message());
}

void print_warning(const CLI::App& app, const Warning& warning) {
  print_line("<4>", app, "warning: " + warning.message());
}

bool print_output(const CLI::App& app, const std::string& text) {
  errno = 0;
  if (std::fputs(text.c_str(), stdout) >= 0 && std::fflush(stdout) == 0) return true;
  print_error(app, "standard output: " + std::generic_category().message(errno));
  return false;
}

}  // namespace buoyancy
