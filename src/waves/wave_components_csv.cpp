#include "waves/wave_components_csv.h"

#include <array>
#include <cstdint>

#include "base/csv_field.h"
#include "base/text_file.h"
#include "waves/sea_ranges.h"

namespace buoyancy {
namespace {

constexpr std::string_view kHeader = "amplitude,angular_frequency,direction,phase";
constexpr std::uintmax_t kMaxFileBytes = 4'000'000;  // a thousand characters per component

struct Column {
  std::string_view name;
  double WaveComponent::*value;
  NumberRange range;
};
constexpr std::array<Column, 4> kColumns{
    {{"amplitude", &WaveComponent::amplitude, sea_ranges::kHeight},
     {"angular_frequency", &WaveComponent::angular_frequency, sea_ranges::kAngularFrequency},
     {"direction", &WaveComponent::direction, sea_ranges::kAngle},
     {"phase", &WaveComponent::phase, sea_ranges::kAngle}}};

std::string without_spaces(std::string_view text) {
  std::string kept;
  for (const char c : text) {
    if (c != ' ' && c != '\t' && c != '\r') kept += c;
  }
  return kept;
}

// line: "sea.csv:3", for errors.
Expected<WaveComponent> parse_component(std::string_view text, const std::string& line) {
  WaveComponent component;
  std::size_t fields = 0;
  for (std::string_view rest = text;; ++fields) {
    const std::size_t comma = rest.find(',');
    if (fields < kColumns.size()) {
      const Column& column = kColumns[fields];
      const std::string_view field = trim(rest.substr(0, comma));
      double& value = component.*column.value;
      if (!parse_number(field, value) || !column.range.contains(value)) {
        return make_error({line + ", column " + std::to_string(fields + 1),
                           std::string(column.name) + " = " + quote(field),
                           column.range.describe(),
                           {},
                           {}});
      }
    }
    if (comma == rest.npos) break;
    rest.remove_prefix(comma + 1);
  }
  ++fields;
  if (fields != kColumns.size()) {
    return make_error({line,
                       std::to_string(fields) + (fields == 1 ? " field" : " fields"),
                       std::to_string(kColumns.size()) + " numbers: " + std::string(kHeader),
                       "decimal commas, or columns of another program",
                       {}});
  }
  return component;
}

}  // namespace

Expected<WaveComponents> parse_wave_components(std::string_view text, const std::string& name) {
  WaveComponents components;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  for (std::size_t number = 1; number == 1 || !text.empty(); ++number) {
    const std::size_t newline = text.find('\n');
    const std::string_view line = text.substr(0, newline);
    text.remove_prefix(newline == text.npos ? text.size() : newline + 1);
    const std::string where = name + ":" + std::to_string(number);
    if (number == 1) {
      if (without_spaces(line) == kHeader) continue;
      return make_error({where,
                         "header " + quote(trim(line)),
                         "'" + std::string(kHeader) + "'",
                         "the file has no header, or its columns are in another order",
                         {}});
    }
    if (trim(line).empty()) continue;
    if (components.size() == kMaxWaveComponents) {
      return make_error({where,
                         "more than " + std::to_string(kMaxWaveComponents) + " components",
                         "at most " + std::to_string(kMaxWaveComponents),
                         {},
                         "Leave out those of the lowest amplitudes: 200 are usual"});
    }
    const Expected<WaveComponent> component = parse_component(line, where);
    if (!component) return make_error(component.error());
    components.push_back(*component);
  }
  return components;
}

Expected<WaveComponents> read_wave_components(const std::filesystem::path& path) {
  const Expected<std::string> text = read_text_file(path, "a CSV file of wave components", kMaxFileBytes);
  if (!text) return make_error(text.error());
  return parse_wave_components(*text, path.string());
}

}  // namespace buoyancy
