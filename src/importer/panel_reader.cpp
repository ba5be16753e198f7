#include "importer/panel_reader.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <unistd.h>

#include "base/format.h"
#include "importer/reader_errors.h"

namespace buoyancy {
namespace {

std::string read_all(const UniqueFd& file) {
  std::string text;
  std::array<char, 65'536> part{};
  while (file.valid()) {
    const ssize_t got = ::pread(file.value(), part.data(), part.size(), static_cast<off_t>(text.size()));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  return text;
}

// Reads numbers as Fortran's list-directed READ does: separated by blanks, commas or line ends, with
// exponents in E or D.
class Numbers {
 public:
  explicit Numbers(std::string text) : text_(std::move(text)) {}

  void skip_line() {
    const std::size_t end = text_.find('\n', at_);
    at_ = end == std::string::npos ? text_.size() : end + 1;
  }

  // Returns whether the rest of this line begins with a number, and not with a note such as "(bow)".
  bool has_number_on_line() {
    const std::size_t start = at_;
    const std::size_t line_end = std::min(text_.find('\n', at_), text_.size());
    const bool has = text_.find_first_not_of(kSeparators, at_) < line_end && next().has_value();
    at_ = start;
    return has;
  }

  std::optional<double> next() {
    at_ = std::min(text_.find_first_not_of(kSeparators, at_), text_.size());
    const std::size_t end = std::min(text_.find_first_of(kSeparators, at_), text_.size());
    std::string word = text_.substr(at_, end - at_);
    for (char& c : word) {
      if (c == 'D' || c == 'd') c = 'E';
    }
    if (word.starts_with('+')) word.erase(0, 1);
    double value = 0.0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || rest != word.data() + word.size()) return std::nullopt;
    at_ = end;
    return value;
  }

  // Returns the next number if it is a whole one from 0 to `max`.
  std::optional<std::int64_t> next_count(std::int64_t max) {
    const std::optional<double> value = next();
    if (!value || !(*value >= 0.0 && *value <= static_cast<double>(max)) || *value != std::floor(*value)) {
      return std::nullopt;
    }
    return static_cast<std::int64_t>(*value);
  }

  std::optional<Vec3> next_place() {
    Vec3 place;
    for (double& coordinate : place) {
      const std::optional<double> value = next();
      if (!value) return std::nullopt;
      coordinate = *value;
    }
    return place;
  }

  std::string line() const {
    return "line " + std::to_string(1 + std::count(text_.begin(), text_.begin() + offset(at_), '\n'));
  }

 private:
  static constexpr std::string_view kSeparators = " \t\r\n,";

  static std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  std::string text_;
  std::size_t at_ = 0;
};

constexpr std::int64_t kMaxCount = 2'147'483'647;  // vertex indices have 32 bits

// Adds the mirror image of all panels so far. axis: normal to the plane of symmetry.
void mirror(int axis, StoredMesh& stored) {
  const auto count = static_cast<std::int32_t>(stored.mesh.vertex_count());
  for (std::int32_t v = 0; v < count; ++v) {
    Vec3 place = stored.mesh.vertex(v);
    place[axis] = -place[axis];
    stored.mesh.add_vertex(place);
  }
  const std::size_t panels = stored.polygons.size();
  for (std::size_t p = 0; p < panels; ++p) {
    std::array<std::int32_t, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[3 - i] = count + stored.polygons[p][i];
    stored.polygons.add(corners);
  }
}

Error fault(MeshFormat format, const Numbers& numbers, const std::string& expected) {
  return unreadable(format, numbers.line() + ": no " + expected);
}

Expected<StoredMesh> read_gdf(Numbers numbers, const ImportLimits& limits) {
  constexpr MeshFormat kFormat = MeshFormat::kWamit;
  numbers.skip_line();  // the title
  const std::optional<double> length = numbers.next();
  const std::optional<double> gravity = numbers.next();
  if (!length || !gravity) return make_error(fault(kFormat, numbers, "ULEN and GRAV"));
  numbers.skip_line();
  std::array<std::int64_t, 2> symmetries{};
  for (std::int64_t& symmetry : symmetries) {
    const std::optional<std::int64_t> flag = numbers.next_count(1);
    if (!flag) return make_error(fault(kFormat, numbers, "ISX and ISY, each 0 or 1"));
    symmetry = *flag;
  }
  numbers.skip_line();
  const std::optional<std::int64_t> panels = numbers.next_count(kMaxCount);
  if (!panels) return make_error(fault(kFormat, numbers, "number of panels"));
  if (numbers.has_number_on_line()) {
    const std::optional<std::int64_t> kind = numbers.next_count(kMaxCount);  // IGDEF of high-order files
    if (kind != 0)
      return make_error(fault(kFormat, numbers, "flat panels: IGDEF is not 0, as for B-splines"));
  }
  numbers.skip_line();
  if (*panels == 0) return make_error(no_triangles(0));
  const auto copies = static_cast<std::uint64_t>((1 + symmetries[0]) * (1 + symmetries[1]));
  const std::uint64_t total = static_cast<std::uint64_t>(*panels) * copies;
  if (std::optional<Error> error = check_limits(4 * total, 2 * total, limits))
    return make_error(*std::move(error));

  constexpr double kFoot = 0.3048;
  const bool is_in_feet = std::abs(*gravity - 32.17) < 0.1;
  StoredMesh stored;
  for (std::int64_t panel = 0; panel < *panels; ++panel) {
    std::array<std::int32_t, 4> corners{};
    for (std::int32_t& corner : corners) {
      const std::optional<Vec3> place = numbers.next_place();
      if (!place) {
        return make_error(
            fault(kFormat, numbers,
                  "corner of panel " + std::to_string(panel + 1) + " of " + std::to_string(*panels)));
      }
      corner = stored.mesh.add_vertex(is_in_feet ? Vec3(kFoot * *place) : *place);
    }
    stored.polygons.add(corners);
    if (!numbers.has_number_on_line()) numbers.skip_line();
  }
  // Some writers end with zeros or a note; other numbers mean that the panels were miscounted.
  while (const std::optional<double> rest = numbers.next()) {
    if (*rest != 0.0) return make_error(fault(kFormat, numbers, "end after the last panel"));
  }
  std::string& note = stored.source.note;
  if (*length != 1.0)
    note = "not scaled by ULEN, " + format_shortest(*length) + ", which is a reference length";
  if (is_in_feet && !note.empty()) note += "; ";
  if (is_in_feet) note += "scaled by 0.3048 from feet to metres, since GRAV is " + format_shortest(*gravity);
  for (int axis = 0; axis < 2; ++axis) {
    if (symmetries[static_cast<std::size_t>(axis)] == 0) continue;
    mirror(axis, stored);
    if (!note.empty()) note += "; ";
    note += axis == 0 ? "mirrored in x = 0 (ISX)" : "mirrored in y = 0 (ISY)";
  }
  return stored;
}

Expected<StoredMesh> read_nemoh(Numbers numbers, const ImportLimits& limits) {
  constexpr MeshFormat kFormat = MeshFormat::kNemoh;
  const std::optional<std::int64_t> two = numbers.next_count(2);
  const std::optional<std::int64_t> symmetry = numbers.next_count(1);
  if (two != 2 || !symmetry) {
    return make_error(fault(kFormat, numbers, "first line of 2 and the flag of symmetry, 0 or 1"));
  }
  numbers.skip_line();
  StoredMesh stored;
  std::unordered_map<std::int64_t, std::int32_t> vertices;  // by their numbers in the file
  while (true) {
    const std::optional<std::int64_t> number = numbers.next_count(kMaxCount);
    const std::optional<Vec3> place = number ? numbers.next_place() : std::nullopt;
    if (!place)
      return make_error(fault(kFormat, numbers, "node: its number, x, y and z, or 0 after the last"));
    if (*number == 0) break;
    if (std::optional<Error> error = check_limits(stored.mesh.vertex_count() + 1, 0, limits)) {
      return make_error(*std::move(error));
    }
    if (!vertices.try_emplace(*number, stored.mesh.add_vertex(*place)).second) {
      return make_error(unreadable(kFormat, "node " + std::to_string(*number) + " appears twice"));
    }
  }
  while (true) {
    std::array<std::int32_t, 4> corners{};
    bool is_end = false;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::optional<std::int64_t> number = numbers.next_count(kMaxCount);
      if (!number)
        return make_error(fault(kFormat, numbers, "panel of four nodes, or 0 0 0 0 after the last"));
      is_end = is_end || *number == 0;
      const auto found = vertices.find(*number);
      if (found != vertices.end()) {
        corners[i] = found->second;
      } else if (!is_end) {
        return make_error(unreadable(kFormat, numbers.line() + ": no node " + std::to_string(*number)));
      }
    }
    if (is_end) break;
    stored.polygons.add(corners);
  }
  const auto copies = static_cast<std::uint64_t>(1 + *symmetry);
  if (std::optional<Error> error =
          check_limits(copies * stored.mesh.vertex_count(), 2 * copies * stored.polygons.size(), limits)) {
    return make_error(*std::move(error));
  }
  if (stored.polygons.size() == 0) return make_error(no_triangles(0));
  if (*symmetry == 1) {
    mirror(1, stored);
    stored.source.note = "mirrored in y = 0, as its first line says";
  }
  return stored;
}

}  // namespace

bool is_panel_format(MeshFormat format) {
  return format == MeshFormat::kWamit || format == MeshFormat::kNemoh;
}

Expected<StoredMesh> read_panels(const ImportRequest& request, const OpenFile& open) {
  Numbers numbers(read_all(open(request.name)));
  Expected<StoredMesh> stored = request.format == MeshFormat::kWamit
                                    ? read_gdf(std::move(numbers), request.limits)
                                    : read_nemoh(std::move(numbers), request.limits);
  if (!stored) return stored;
  stored->source.format = to_string(request.format);
  stored->source.up_axis = std::string(1, 'z');  // by the formats' definitions
  stored->source.nodes = 1;
  return stored;
}

}  // namespace buoyancy
