#include "view/report/run_csv_reader.h"

#include <array>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "base/csv_field.h"
#include "messages/body_csv.h"

namespace buoyancy::view {
namespace {

constexpr std::int64_t kRowsBetweenProgress = 4'096;
constexpr std::size_t kMaxLine = 65'536;  // [bytes]

constexpr FieldRange kPoseFields{"position", "quaternion_wxyz"};
constexpr FieldRange kTwistFields{"linear_velocity", "angular_velocity"};
constexpr FieldRange kWrenchFields{"status", "center_of_buoyancy"};

enum class LineEnd { kNewline, kTooLong, kNone };

// Reads a line, or the first kMaxLine bytes of one that is too long. kNone: there are no more lines.
LineEnd read_line(std::istream& file, std::vector<char>& buffer, std::string_view& line) {
  buffer.resize(kMaxLine + 1);
  file.getline(buffer.data(), static_cast<std::streamsize>(buffer.size()));
  const auto bytes = static_cast<std::size_t>(file.gcount());
  line = {buffer.data(), bytes};
  if (file.good()) {
    line.remove_suffix(1);  // the newline
    return LineEnd::kNewline;
  }
  if (file.eof()) return bytes > 0 ? LineEnd::kNewline : LineEnd::kNone;
  if (bytes < kMaxLine) return LineEnd::kNone;  // not readable
  file.clear();
  file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  return LineEnd::kTooLong;
}

template <typename Number>
bool is_int32(Number number) {
  return number >= static_cast<Number>(std::numeric_limits<std::int32_t>::min()) &&
         number <= static_cast<Number>(std::numeric_limits<std::int32_t>::max());
}

std::vector<std::string_view> split_fields(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = line.find(',');
    fields.push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

class Header {
 public:
  explicit Header(std::string_view line) : names_(split_fields(line)) {}

  // The positions of a group of columns such as "utime,body_id"; empty if the group is incomplete.
  std::vector<std::size_t> positions(std::string_view group) const {
    const std::vector<std::string_view> wanted = split_fields(group);
    std::vector<std::size_t> found;
    for (const std::string_view name : wanted) {
      for (std::size_t i = 0; i < names_.size(); ++i) {
        if (names_[i] == name) found.push_back(i);
      }
    }
    if (found.size() != wanted.size()) found.clear();
    return found;
  }
  std::size_t size() const { return names_.size(); }

 private:
  std::vector<std::string_view> names_;
};

struct ColumnPositions {
  std::vector<std::size_t> key, pose, velocities, wrench, energy;
};

// Reads the numbers of a group in its order; false if one of them is invalid.
template <typename T>
bool read(const std::vector<std::string_view>& fields, const std::vector<std::size_t>& positions,
          T* numbers) {
  for (const std::size_t position : positions) {
    if (!parse_number(fields[position], *numbers++)) return false;
  }
  return true;
}

// Reads the fields of a range, which stay as they are if the file has no columns for them.
template <typename Body>
bool read(const std::vector<std::string_view>& fields, const std::vector<std::size_t>& positions,
          const FieldRange& range, Body& body) {
  if (positions.empty()) return true;
  auto position = positions.begin();
  bool good = true;
  visit_numbers(body, range, [&]<typename Number>(Number& number) {
    double value = 0.0;
    good = good && parse_number(fields[*position++], value);
    if constexpr (!std::is_same_v<Number, double>) good = good && is_int32(value);
    if (good) number = static_cast<Number>(value);
  });
  return good;
}

bool read_row(const std::vector<std::string_view>& fields, const ColumnPositions& positions,
              RecordedState& row) {
  std::array<std::int64_t, 2> key{};
  double energy = 0.0;
  BodyWrench wrench;
  if (!read(fields, positions.key, key.data()) || !read(fields, positions.pose, kPoseFields, row.state) ||
      !read(fields, positions.velocities, kTwistFields, row.state) ||
      !read(fields, positions.wrench, kWrenchFields, wrench) || !read(fields, positions.energy, &energy) ||
      !is_int32(key[1])) {
    return false;
  }
  row.utime = key[0];
  row.state.body_id = static_cast<std::int32_t>(key[1]);
  wrench.body_id = row.state.body_id;
  row.velocities = !positions.velocities.empty();
  if (!positions.wrench.empty()) row.wrench = wrench;
  if (!positions.energy.empty()) row.energy = energy;
  return true;
}

}  // namespace

Expected<void> read_run_csv(const std::filesystem::path& path, const RunFileOptions& options,
                            RunBuilder& builder) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> buffer;
  std::string_view line;
  if (!file.is_open() || (read_line(file, buffer, line) == LineEnd::kNone && !file.eof())) {
    return make_error(
        {path.string(), "cannot be read", "a CSV file", "the file does not exist or is not readable", ""});
  }
  if (line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
  const std::string header_line(line);
  const Header header(header_line);
  const ColumnPositions positions{
      header.positions("utime,body_id"), header.positions(csv_columns<BodyState>(kPoseFields)),
      header.positions(csv_columns<BodyState>(kTwistFields)),
      header.positions(csv_columns<BodyWrench>(kWrenchFields)), header.positions("energy")};
  if (positions.key.empty() || positions.pose.empty()) {
    return make_error(
        {path.string(), "first line '" + header_line.substr(0, 120) + "'",
         "columns utime, body_id, px, py, pz, qw, qx, qy, qz; optionally the others of buoyancy-client --csv",
         "the output of buoyancy-replay contains no poses", "Use the file that was replayed"});
  }
  std::error_code unknown_size;  // a pipe has none
  const std::uintmax_t size = std::filesystem::file_size(path, unknown_size);
  const std::int64_t bytes = unknown_size ? 0 : static_cast<std::int64_t>(size);
  for (std::int64_t number = 2;; ++number) {
    const LineEnd end = read_line(file, buffer, line);
    if (end == LineEnd::kNone) break;
    if (line.empty() || line == "\r") continue;
    const std::vector<std::string_view> fields = split_fields(line);
    RecordedState row;
    if (end == LineEnd::kTooLong || fields.size() != header.size() || !read_row(fields, positions, row)) {
      builder.add_warning("line " + std::to_string(number) + " skipped: expected " +
                          std::to_string(header.size()) + " numbers");
      continue;
    }
    row.time = builder.time_of(row.state.body_id, 0, row.utime);
    builder.add(row);
    if (number % kRowsBetweenProgress == 0 && options.progress &&
        !options.progress(file.tellg(), bytes, number))
      break;
  }
  return {};
}

}  // namespace buoyancy::view
