#include "recording/pose_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "base/csv_field.h"
#include "messages/conversions.h"

namespace buoyancy {
namespace {

// What a column holds: first the numbers of a state in the order of its fields.
enum Slot : std::int8_t {
  kPosition,
  kQuaternion = 3,
  kLinear = 7,
  kAngular = 10,
  kTime = 13,
  kNanoseconds,
  kIgnored
};

// The names of columns, each followed by the letter of an axis. The names of nav messages follow a prefix.
struct ColumnNames {
  TableFormat format;
  const char* title;
  std::string_view position, orientation, linear, angular;  // empty: the format has none
  bool linear_in_body;
};
constexpr std::array<ColumnNames, 3> kNames{{
    {TableFormat::kTum, "TUM", "t", "q", "", "", false},
    {TableFormat::kEuroc, "EuRoC", "p_RS_R_", "q_RS_", "v_RS_R_", "w_RS_S_", false},
    {TableFormat::kNav, "nav_msgs", "position.", "orientation.", "twist.twist.linear.",
     "twist.twist.angular.", true},
}};
constexpr std::string_view kTumHeader = "timestamp tx ty tz qx qy qz qw";
constexpr std::string_view kEurocHeader =
    "timestamp,p_RS_R_x,p_RS_R_y,p_RS_R_z,q_RS_w,q_RS_x,q_RS_y,q_RS_z,v_RS_R_x,v_RS_R_y,v_RS_R_z,b_w_x,b_w_y,"
    "b_w_z,b_a_x,"
    "b_a_y,b_a_z";
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kEurocColumns = 17;
constexpr const char* kFormats =
    "a TUM trajectory (t tx ty tz qx qy qz qw), or a header: "
    "utime,body_id,px,py,pz,qw,qx,qy,qz[,vx,vy,vz,wx,wy,wz] in "
    "this order, or one with p_RS_R_x ... (EuRoC) or pose.position.x ... (nav_msgs)";

struct Unit {
  TimeUnit unit;
  const char* name;
  std::string_view in_header;
  double from;  // a time of this size is guessed to have the unit
  std::int64_t per_second;
};
constexpr std::array<Unit, 4> kUnits{{
    {TimeUnit::kSeconds, "seconds", "[s]", 0.0, 1},
    {TimeUnit::kMilliseconds, "milliseconds", "[ms]", 1e11, 1'000},
    {TimeUnit::kMicroseconds, "microseconds", "[us]", 1e14, 1'000'000},
    {TimeUnit::kNanoseconds, "nanoseconds", "[ns]", 1e17, 1'000'000'000},
}};
constexpr std::int64_t kMicrosecondsPerSecond = 1'000'000;
constexpr double kMaxTime = 4e18;  // [us], so that nanoseconds can be added

const Unit& facts_of(TimeUnit unit) {
  return kUnits[static_cast<std::size_t>(unit)];
}

const ColumnNames& names_of(TableFormat format) {
  return *std::ranges::find(kNames, format, &ColumnNames::format);
}

char separator_of(std::string_view line) {
  if (line.find(',') != line.npos) return ',';
  return line.find(';') != line.npos ? ';' : ' ';
}

// The names of a header, without units in brackets and with dots as separators.
std::vector<std::string> column_names(std::string_view header, char separator) {
  std::string text;
  bool in_brackets = false;
  for (const char c : header) {
    if (c == '[') in_brackets = true;
    if (!in_brackets) text += c == '/' ? '.' : c;
    if (c == ']') in_brackets = false;
  }
  std::vector<std::string> names;
  CsvFields fields(text, separator);
  while (std::optional<std::string_view> name = fields.next()) {
    name->remove_prefix(std::min(name->find_first_not_of(".%#\""), name->size()));
    if (name->ends_with('"')) name->remove_suffix(1);
    names.emplace_back(*name);
  }
  return names;
}

bool is_name_of(std::string_view column, std::string_view name) {
  return column == name || (column.ends_with(name) && column[column.size() - name.size() - 1] == '.');
}

// Reads a time as microseconds: whole numbers exactly, others as the nearest double.
bool read_time(std::string_view text, TimeUnit unit, std::int64_t& utime) {
  const std::int64_t per_second = facts_of(unit).per_second;
  std::int64_t whole = 0;
  if (per_second >= kMicrosecondsPerSecond && parse_number(text, whole)) {
    const std::int64_t divisor = per_second / kMicrosecondsPerSecond;
    const std::int64_t rest = ((whole % divisor) + divisor) % divisor;
    const std::int64_t floor = whole / divisor - (whole % divisor < 0 ? 1 : 0);
    utime = floor + (divisor > 1 && 2 * rest >= divisor ? 1 : 0);
    return std::abs(static_cast<double>(whole)) / static_cast<double>(divisor) < kMaxTime;
  }
  double value = 0.0;
  if (!parse_finite(text, value)) return false;
  value *= static_cast<double>(kMicrosecondsPerSecond) / static_cast<double>(per_second);
  if (std::abs(value) >= kMaxTime) return false;
  utime = std::llround(value);
  return true;
}

TimeUnit guessed_unit(std::string_view first_time, TableFormat format) {
  double time = 0.0;
  parse_number(first_time, time);
  TimeUnit unit = format == TableFormat::kEuroc ? TimeUnit::kNanoseconds : TimeUnit::kSeconds;
  for (const Unit& candidate : kUnits) {
    if (candidate.from > 0.0 && std::abs(time) >= candidate.from) unit = candidate.unit;
  }
  return unit;
}

// Assigns slots to columns by their names.
class ColumnSearch {
 public:
  explicit ColumnSearch(std::vector<std::string> names)
      : names_(std::move(names)), slots_(names_.size(), kIgnored) {}

  // The prefixes below which there are a position and an orientation.
  std::vector<std::string> pose_prefixes(const ColumnNames& format) const {
    std::vector<std::string> found;
    const std::string position = std::string(format.position) + 'x';
    for (const std::string& name : names_) {
      if (!is_name_of(name, position)) continue;
      std::string prefix = name.substr(0, name.size() - position.size());
      const std::string orientation = prefix + std::string(format.orientation) + 'x';
      if (std::ranges::find(names_, orientation) != names_.end()) found.push_back(std::move(prefix));
    }
    return found;
  }

  // Returns whether the one column of this name exists and was assigned.
  bool assign(const std::string& name, std::int8_t slot) {
    const auto found = std::ranges::find(names_, name);
    if (found == names_.end()) return false;
    slots_[static_cast<std::size_t>(found - names_.begin())] = slot;
    return true;
  }
  // Assigns prefix + each letter; returns the first name that is missing, or nothing.
  std::string assign_axes(const std::string& prefix, std::string_view letters, std::int8_t first_slot) {
    for (std::size_t i = 0; i < letters.size(); ++i) {
      std::string name = prefix + letters[i];
      if (!assign(name, static_cast<std::int8_t>(first_slot + static_cast<std::int8_t>(i)))) return name;
    }
    return "";
  }
  // Assigns the columns of time below the message's prefix, else the first general one. Returns whether any
  // exists.
  bool assign_time(const std::string& root) {
    const std::string stamp = root + "header.stamp";
    for (const char* seconds : {".sec", ".secs"}) {
      for (const char* nanoseconds : {".nanosec", ".nsec", ".nsecs", ".nanosecs"}) {
        if (std::ranges::find(names_, stamp + nanoseconds) != names_.end() &&
            assign(stamp + seconds, kTime)) {
          return assign(stamp + nanoseconds, kNanoseconds);
        }
      }
    }
    if (assign(stamp, kTime)) return true;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      std::string name = names_[i];
      for (char& c : name) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
      }
      for (const char* known : {"time", "__time", "timestamp", "t", "rosbagtimestamp"}) {
        if (name != known) continue;
        slots_[i] = kTime;
        return true;
      }
    }
    return false;
  }
  void unassign(std::int8_t first_slot, std::int8_t count) {
    for (std::int8_t& slot : slots_) {
      if (slot >= first_slot && slot < first_slot + count) slot = kIgnored;
    }
  }
  std::vector<std::int8_t>& slots() { return slots_; }

 private:
  std::vector<std::string> names_;
  std::vector<std::int8_t> slots_;
};

// The message's prefix of a nav export: what precedes "pose.pose." or "pose.".
std::string root_of(std::string_view prefix) {
  constexpr std::string_view kPose = "pose.";
  for (int i = 0; i < 2 && (prefix == kPose || prefix.ends_with(".pose.")); ++i)
    prefix.remove_suffix(kPose.size());
  return std::string(prefix);
}

std::size_t count_fields(std::string_view line, char separator) {
  CsvFields fields(line, separator);
  std::size_t count = 0;
  while (fields.next()) ++count;
  return count;
}

// The header that a file without one stands for; empty if it cannot be told.
std::string_view implied_header(std::string_view first_row, TableFormat format) {
  const char separator = separator_of(first_row);
  const std::size_t columns = count_fields(first_row, separator);
  if (format == TableFormat::kTum) return kTumHeader;
  if (format == TableFormat::kEuroc) return kEurocHeader;
  if (format != TableFormat::kGuess) return {};
  if (columns == kEurocColumns) return kEurocHeader;
  // EuRoC's order of the quaternion is another one: such a file is not taken for TUM.
  double time = 0.0;
  parse_number(*CsvFields(first_row, separator).next(), time);
  const bool may_be_euroc = separator == ',' && std::abs(time) >= facts_of(TimeUnit::kMicroseconds).from;
  return columns == kTumColumns && !may_be_euroc ? kTumHeader : std::string_view();
}

}  // namespace

bool PoseTable::names_columns(std::string_view line) {
  const ColumnSearch search(column_names(line, separator_of(line)));
  return std::ranges::any_of(
      kNames, [&search](const ColumnNames& names) { return !search.pose_prefixes(names).empty(); });
}

Expected<PoseTable> PoseTable::from_lines(const std::string& subject, std::string_view header,
                                          std::string_view first_row, const TableOptions& options) {
  const std::string_view implied = header.empty() ? implied_header(first_row, options.format) : header;
  const auto fail = [&](const std::string& actual, const std::string& expected, const std::string& hint) {
    return make_error({subject, actual, expected, "", hint});
  };
  if (implied.empty()) {
    return fail("poses " + quote(first_row) + " without a header", kFormats,
                "State --format tum or --format euroc");
  }
  PoseTable table;
  table.separator_ = separator_of(first_row);
  ColumnSearch search(column_names(implied, separator_of(implied)));
  std::vector<std::string> found;
  for (const ColumnNames& names : kNames) {
    if (options.format != TableFormat::kGuess && options.format != names.format) continue;
    found = search.pose_prefixes(names);
    table.format_ = names.format;
    if (!found.empty()) break;
  }
  if (found.empty()) {
    const bool guessed = options.format == TableFormat::kGuess;
    const std::string stated = guessed ? "" : std::string(names_of(options.format).position);
    return fail("header " + quote(header),
                guessed ? kFormats : "columns " + stated + "x ..., as --format states", "");
  }
  const ColumnNames& names = names_of(table.format_);
  const std::string& prefix = found.front();
  if (found.size() > 1) {
    return fail("the poses '" + prefix + "' and '" + found[1] + "'", "one pose", "Export one topic alone");
  }
  const std::string root = table.format_ == TableFormat::kNav ? root_of(prefix) : prefix;
  std::string missing = search.assign_axes(prefix + std::string(names.position), "xyz", kPosition);
  if (missing.empty())
    missing = search.assign_axes(prefix + std::string(names.orientation), "wxyz", kQuaternion);
  if (missing.empty() && !search.assign_time(root)) missing = "header.stamp, time or timestamp";
  if (!missing.empty()) return fail("header " + quote(implied), "a column " + missing, "");
  const auto velocity = [&](std::string_view name, std::int8_t slot) {
    if (name.empty()) return false;
    const bool complete = search.assign_axes(root + std::string(name), "xyz", slot).empty();
    if (!complete) search.unassign(slot, 3);
    return complete;
  };
  table.has_linear_ = velocity(names.linear, kLinear);
  table.has_angular_ = velocity(names.angular, kAngular);
  table.slots_ = std::move(search.slots());

  if (std::ranges::find(table.slots_, kNanoseconds) != table.slots_.end()) {
    if (options.time_unit)
      return fail("--time-unit", "no unit, since sec and nanosec are columns of their own", "");
    return table;
  }
  const auto time_column =
      static_cast<std::size_t>(std::ranges::find(table.slots_, kTime) - table.slots_.begin());
  CsvFields fields(first_row, table.separator_);
  std::optional<std::string_view> first_time = fields.next();
  for (std::size_t i = 0; i < time_column && first_time; ++i) first_time = fields.next();
  table.unit_ = guessed_unit(first_time.value_or(""), table.format_);
  if (header.starts_with('%')) table.unit_ = TimeUnit::kNanoseconds;
  for (const Unit& unit : kUnits) {
    if (header.find(unit.in_header) != header.npos) table.unit_ = unit.unit;
  }
  table.unit_ = options.time_unit.value_or(table.unit_);
  return table;
}

std::string PoseTable::description() const {
  std::string text = names_of(format_).title;
  const bool in_two = std::ranges::find(slots_, kNanoseconds) != slots_.end();
  text += std::string(", time in ") + (in_two ? "seconds and nanoseconds" : facts_of(unit_).name);
  if (states_velocities()) return text + ", with velocities";
  return text + (has_linear_ ? ", without angular velocities" : ", without velocities");
}

tl::expected<void, std::string> PoseTable::read_row(std::string_view line, std::int64_t& utime,
                                                    BodyState& state) const {
  std::array<double, kTime> numbers{};
  numbers.fill(std::numeric_limits<double>::quiet_NaN());
  std::int64_t seconds = 0;
  std::int64_t nanoseconds = 0;
  std::size_t column = 0;
  CsvFields fields(line, separator_);
  while (const std::optional<std::string_view> field = fields.next()) {
    const std::int8_t slot = column < slots_.size() ? slots_[column] : std::int8_t{kIgnored};
    ++column;
    const auto invalid = [&](const std::string& expected) {
      return tl::unexpected(quote(*field) + " in column " + std::to_string(column) + " is not " + expected +
                            " in range");
    };
    if (slot == kTime) {
      if (!read_time(*field, unit_, seconds))
        return invalid(std::string("a time in ") + facts_of(unit_).name);
    } else if (slot == kNanoseconds) {
      if (!read_time(*field, TimeUnit::kNanoseconds, nanoseconds)) return invalid("a time in nanoseconds");
    } else if (slot != kIgnored && !parse_number(*field, numbers[static_cast<std::uint8_t>(slot)])) {
      return invalid("a number");
    }
  }
  if (column != slots_.size()) {
    return tl::unexpected(std::to_string(column) + " columns where " + std::to_string(slots_.size()) +
                          " are expected");
  }
  utime = seconds + nanoseconds;
  const auto copy = [&numbers](std::size_t first, std::span<double> to) {
    std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(first), to.size(), to.begin());
  };
  copy(kPosition, state.position);
  copy(kQuaternion, state.quaternion_wxyz);
  copy(kLinear, state.linear_velocity);
  copy(kAngular, state.angular_velocity);
  if (has_linear_ && names_of(format_).linear_in_body) {
    state.linear_velocity = to_world(state.quaternion_wxyz, state.linear_velocity);
  }
  if (has_angular_) state.angular_velocity = to_world(state.quaternion_wxyz, state.angular_velocity);
  return {};
}

}  // namespace buoyancy
