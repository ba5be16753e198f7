// The command line of a tool of ours for developers, such as a benchmark: few options, and CLI11's own
// messages. CLI11 is compiled in the .cpp alone, since it takes seconds in every source that declares options
// with it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): the name is the library's
class App;
}

namespace buoyancy {

class ToolCommandLine {
 public:
  explicit ToolCommandLine(const std::string& description, const std::string& name = "");
  ~ToolCommandLine();
  ToolCommandLine(const ToolCommandLine&) = delete;
  ToolCommandLine& operator=(const ToolCommandLine&) = delete;

  // Each declares an option whose value must live until parse(). excluded: the name of a flag before it that
  // may not be given with it.
  void add_flag(const std::string& name, bool& value, const std::string& description,
                const std::string& excluded = "");
  // For std::string, std::filesystem::path and std::uint64_t.
  template <typename Value>
  void add_option(const std::string& name, Value& value, const std::string& description);
  // For int, unsigned and std::int64_t.
  template <typename Number>
  void add_number(const std::string& name, Number& value, Number least, Number most,
                  const std::string& description, bool show_default = false);
  void add_positive(const std::string& name, std::int64_t& value, const std::string& description);

  // nullopt: parsed, go on. Else the exit code: 0 after --help, 2 after a message.
  std::optional<int> parse(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace buoyancy
