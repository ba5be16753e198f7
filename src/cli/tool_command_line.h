// The command line of a developer tool, such as a benchmark: few options and CLI11's own messages. CLI11 is
// compiled in the .cpp only, since it adds seconds to every source that includes it.
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

  // Each declares an option whose value must live until parse(). excluded: the name of an earlier flag that
  // cannot be combined with it.
  void add_flag(const std::string& name, bool& value, const std::string& description,
                const std::string& excluded = "");
  // Value is std::string, std::filesystem::path or std::uint64_t.
  template <typename Value>
  void add_option(const std::string& name, Value& value, const std::string& description);
  // Number is int, unsigned or std::int64_t.
  template <typename Number>
  void add_number(const std::string& name, Number& value, Number min, Number max,
                  const std::string& description, bool show_default = false);
  void add_positive(const std::string& name, std::int64_t& value, const std::string& description);

  // Returns nullopt if the program should continue, else its exit code: 0 after --help, 2 after an error.
  std::optional<int> parse(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace buoyancy
