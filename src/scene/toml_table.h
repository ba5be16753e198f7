// Internal to scene_file.cpp, sea_toml.cpp and shape_toml.cpp: reads a table of a scene file key by key. An
// Error names file, line, key, value and range.
//
// Contract: reading a key makes it known; finish() reports unknown keys. The first error is kept and reading
// continues with defaults, so that callers check for an error once, at the end.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "base/error.h"
#include "base/number_range.h"
#include "base/vec3.h"

namespace buoyancy {

// Replaces every control character by '?', so that file contents are safe to print on one line.
std::string printable(std::string text);

// Returns SceneDescription::text_fingerprint.
std::uint64_t fingerprint_of(const toml::table& scene_file);

// The file being parsed and the first error in it.
struct SceneParseContext {
  std::string file;
  std::optional<Error> error;

  std::string location(const toml::source_region& region) const;  // "scene.toml:12"
};

class TomlTable {
 public:
  // name: identifies the table in errors: "body 3", "[water]". table and context must outlive this object.
  TomlTable(const toml::table& table, std::string name, SceneParseContext& context)
      : table_(&table), name_(std::move(name)), context_(&context) {}

  void rename(std::string name) { name_ = std::move(name); }
  bool has(std::string_view key);

  // Each leaves the value unchanged if the key is absent. Reading a double also accepts an integer.
  void read(std::string_view key, double& value, const NumberRange& range);
  void read(std::string_view key, std::optional<double>& value, const NumberRange& range);
  void read(std::string_view key, Vec3& value, std::string_view unit);
  void read(std::string_view key, std::span<double> values, std::string_view unit);
  void read(std::string_view key, std::span<std::int32_t> values);
  void read(std::string_view key, std::int32_t& value);
  void read(std::string_view key, std::int32_t& value, const NumberRange& range);  // finite limits
  void read(std::string_view key, std::int64_t& value, std::string_view unit);
  void read(std::string_view key, std::uint64_t& value, std::uint64_t min);
  void read(std::string_view key, std::string& value);

  // Returns finite numbers, as many as one of `counts`; empty if the key is absent or wrong.
  std::vector<double> numbers(std::string_view key, std::span<const std::size_t> counts,
                              std::string_view unit);
  // Returns the index of the value among the words; nullopt if the key is absent or wrong.
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> words);
  const toml::table* table(std::string_view key);  // nullptr if absent or wrong
  const toml::node* node(std::string_view key);    // nullptr if absent

  // Reports the first unknown key.
  void finish();

  bool failed() const { return context_->error.has_value(); }  // in this table or before it

  // These set an error: about the table as a whole, about a key's value, in the file that a key names, and
  // about a missing key.
  void fail(std::string actual, std::string expected, std::string cause = {}, std::string hint = {});
  void fail_at(std::string_view key, std::string expected, std::string cause = {}, std::string hint = {});
  void fail_in(std::string_view key, Error error);
  void fail_missing(std::string_view key, std::string expected);

 private:
  void set_error(const toml::source_region& source, std::string actual, std::string expected,
                 std::string cause, std::string hint);

  const toml::table* table_;
  std::string name_;
  SceneParseContext* context_;
  std::vector<std::string_view> known_;  // each key once, in the order of reading
};

}  // namespace buoyancy
