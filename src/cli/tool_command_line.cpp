#include "cli/tool_command_line.h"

#include <filesystem>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

namespace buoyancy {

ToolCommandLine::ToolCommandLine(const std::string& description, const std::string& name)
    : app_(std::make_unique<CLI::App>(description, name)) {}

ToolCommandLine::~ToolCommandLine() = default;

void ToolCommandLine::add_flag(const std::string& name, bool& value, const std::string& description,
                               const std::string& excluded) {
  CLI::Option* flag = app_->add_flag(name, value, description);
  if (!excluded.empty()) flag->excludes(app_->get_option(excluded));
}

template <typename Value>
void ToolCommandLine::add_option(const std::string& name, Value& value, const std::string& description) {
  app_->add_option(name, value, description);
}

template <typename Number>
void ToolCommandLine::add_number(const std::string& name, Number& value, Number min, Number max,
                                 const std::string& description, bool show_default) {
  CLI::Option* number = app_->add_option(name, value, description)->check(CLI::Range(min, max));
  if (show_default) number->capture_default_str();
}

void ToolCommandLine::add_positive(const std::string& name, std::int64_t& value,
                                   const std::string& description) {
  app_->add_option(name, value, description)->check(CLI::PositiveNumber);
}

std::optional<int> ToolCommandLine::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? 0 : 2;
  }
  return std::nullopt;
}

template void ToolCommandLine::add_option(const std::string&, std::string&, const std::string&);
template void ToolCommandLine::add_option(const std::string&, std::filesystem::path&, const std::string&);
template void ToolCommandLine::add_option(const std::string&, std::uint64_t&, const std::string&);
template void ToolCommandLine::add_number(const std::string&, int&, int, int, const std::string&, bool);
template void ToolCommandLine::add_number(const std::string&, unsigned&, unsigned, unsigned,
                                          const std::string&, bool);
template void ToolCommandLine::add_number(const std::string&, std::int64_t&, std::int64_t, std::int64_t,
                                          const std::string&, bool);

}  // namespace buoyancy
