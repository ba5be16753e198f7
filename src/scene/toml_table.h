// One table of a scene file, read key by key; what is wrong with it becomes an Error that names file, line,
// key, value and range. For scene_file.cpp and shape_toml.cpp only.
//
// A key that is read is a known key; finish() reports the ones nobody asked for. The first error stands, and
// reading goes on with defaults: callers look at the error once, at the end.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "base/error.h"
#include "base/vec3.h"

namespace buoyancy {

// On one line: every control character, whatever a file's text may have smuggled in, as '?'.
std::string printable(std::string text);

// The file being read, and the first thing found wrong with it.
struct SceneParseContext {
  std::string file;
  std::optional<Error> error;

  std::string at(const toml::source_region& place) const;  // "scene.toml:12"
};

struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_inclusive = true;
  std::string_view unit;  // "kg"; empty for pure numbers

  static NumberRange any(std::string_view unit) {
    NumberRange range;
    range.unit = unit;
    return range;
  }
  static NumberRange from_zero(std::string_view unit) {
    NumberRange range = any(unit);
    range.min = 0.0;
    return range;
  }
  static NumberRange above_zero(std::string_view unit) {
    NumberRange range = from_zero(unit);
    range.min_inclusive = false;
    return range;
  }
  static NumberRange from_zero_to(double max) {
    NumberRange range = from_zero("");
    range.max = max;
    return range;
  }

  bool contains(double value) const;
  std::string describe() const;  // "a number above 0 (kg)"
};

class TomlTable {
 public:
  // what: as errors call the table, "body 3", "[water]". table and reading must outlive this.
  TomlTable(const toml::table& table, std::string what, SceneParseContext& reading)
      : table_(&table), what_(std::move(what)), reading_(&reading) {}

  void rename(std::string what) { what_ = std::move(what); }
  bool has(std::string_view key);

  // Each leaves the value as it is where the key is absent. Whole numbers are welcome where numbers are.
  void read(std::string_view key, double& value, const NumberRange& range);
  void read(std::string_view key, std::optional<double>& value, const NumberRange& range);
  void read(std::string_view key, Vec3& value, std::string_view unit);
  void read(std::string_view key, std::span<double> values, std::string_view unit);
  void read(std::string_view key, std::span<std::int32_t> values);
  void read(std::string_view key, std::int32_t& value);
  void read(std::string_view key, std::uint64_t& value, std::uint64_t min);
  void read(std::string_view key, std::string& value);

  // As many finite numbers as one of `counts` says; empty: absent or wrong.
  std::vector<double> numbers(std::string_view key, std::span<const std::size_t> counts,
                              std::string_view unit);
  // One of the words: its place among them; nullopt: absent or wrong.
  std::optional<std::size_t> choice(std::string_view key, std::span<const std::string_view> words);
  const toml::table* table(std::string_view key);  // nullptr: absent or wrong
  const toml::node* node(std::string_view key);    // nullptr: absent

  // Reports the first key that was not asked for.
  void finish();

  bool failed() const { return reading_->error.has_value(); }  // here or before

  // Error about the table as a whole, about a key's value, about a key that is missing.
  void fail(std::string found, std::string expectation, std::string cause = {}, std::string remedy = {});
  void fail_at(std::string_view key, std::string expectation, std::string cause = {},
               std::string remedy = {});
  void fail_missing(std::string_view key, std::string expectation);

 private:
  void set_error(const toml::source_region& source, std::string found, std::string expectation,
                 std::string cause, std::string remedy);

  const toml::table* table_;
  std::string what_;
  SceneParseContext* reading_;
  std::vector<std::string_view> known_;  // each once, in the order asked
};

}  // namespace buoyancy
