// The command line of a benchmark that has --quick and nothing else.
#pragma once

#include <string>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace buoyancy {

// For main() to return: 0, or 2 where the arguments are wrong. quick_help: what --quick changes.
inline int run_with_quick_option(int argc, char** argv, const std::string& description,
                                 const std::string& quick_help, void (*run)(bool quick)) {
  CLI::App app(description);
  bool quick = false;
  app.add_flag("--quick", quick, quick_help);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  run(quick);
  return 0;
}

}  // namespace buoyancy
