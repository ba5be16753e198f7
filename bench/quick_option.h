// Command line of a benchmark whose only option is --quick.
#pragma once

#include <string>

#include "cli/tool_command_line.h"

namespace buoyancy::bench {

// Parses the arguments and calls run(). Returns the exit code for main(): 0, or 2 for invalid arguments.
// quick_help: the effect of --quick.
inline int run_with_quick_option(int argc, char** argv, const std::string& description,
                                 const std::string& quick_help, void (*run)(bool quick)) {
  ToolCommandLine command_line(description);
  bool quick = false;
  command_line.add_flag("--quick", quick, quick_help);
  if (const auto exit_code = command_line.parse(argc, argv)) return *exit_code;
  run(quick);
  return 0;
}

}  // namespace buoyancy::bench
