// Fuzz target: bytes as a CSV file of recorded poses, and as the poses of other programs. Every line must be
// accounted for exactly once: as the header, as blank, as a body of a request, or as reported; the rows
// written with 17 digits must be read as the same rows; and two pieces of the file must hold the requests of
// the whole.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "recording/state_csv.h"
#include "tests/fuzz/fuzz_check.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxLineLength = 4096;
constexpr std::string_view kTwistHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";

// Writes the text to an in-memory file, one for the whole run, and returns its path.
std::string path_of_file_with(std::string_view text) {
  static const int kFile = ::memfd_create("fuzz.csv", MFD_CLOEXEC);
  const auto size = static_cast<ssize_t>(text.size());
  if (kFile < 0 || ::ftruncate(kFile, 0) != 0 || ::pwrite(kFile, text.data(), text.size(), 0) != size) {
    fail_requirement("the target can write its own file");
  }
  return "/proc/self/fd/" + std::to_string(kFile);
}

// The lines after the header that are not blank; the last one counts even without a newline.
std::vector<std::string_view> data_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  bool is_header = true;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const bool blank = line.find_first_not_of(" \t\r") == line.npos && line.size() <= kMaxLineLength;
    if (!is_header && !blank) lines.push_back(line);
    is_header = false;
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  return lines;
}

// The utime of a line that was read as a row.
std::int64_t utime_of(std::string_view line) {
  return std::strtoll(std::string(line.substr(0, line.find(','))).c_str(), nullptr, 10);
}

WrenchRequest request_of(const RecordedEvent& recorded, std::size_t number) {
  WrenchRequest request;
  require(!decode(recorded.bytes, request), "a request from CSV decodes");
  require(!request.bodies.empty() && request.bodies.size() <= kMaxRowsPerRequest, "a request has bodies");
  require(request.id.utime == recorded.timestamp && request.id.session_id == 0 &&
              request.id.seq == static_cast<std::int64_t>(number) && request.lead_time == 0.0,
          "a request from CSV has its rows' utime, session 0 and seq counted from 0");
  return request;
}

// Reads all items and checks that each line is a row of the next request or the next reported line.
std::vector<WrenchRequest> read_all(StateCsvReader& reader, const std::vector<std::string_view>& lines) {
  std::vector<WrenchRequest> requests;
  std::int64_t offset = 0;
  std::size_t next_line = 0;
  while (true) {
    const LogItem item = reader.next();
    require(reader.offset() >= offset && reader.offset() <= reader.size(),
            "the offset increases up to the file's size");
    offset = reader.offset();
    if (std::holds_alternative<EndOfLog>(item)) break;
    require(next_line < lines.size(), "a file has no more rows and reports than lines");
    if (const auto* recorded = std::get_if<RecordedEvent>(&item)) {
      requests.push_back(request_of(*recorded, requests.size()));
      const WrenchRequest& request = requests.back();
      require(request.bodies.size() <= lines.size() - next_line, "a file has no more rows than lines");
      for (std::size_t row = 0; row < request.bodies.size(); ++row) {
        require(utime_of(lines[next_line++]) == request.id.utime, "the rows of a request have its utime");
      }
    } else {
      require(!std::get<CorruptSection>(item).description.empty(), "a report describes the error");
      ++next_line;
    }
  }
  require(offset == reader.size(), "reading ends at the end of the file");
  require(std::holds_alternative<EndOfLog>(reader.next()), "the end of the log is final");
  require(next_line == lines.size(), "every line is a row or reported");
  return requests;
}

void append(double value, std::string& row) {
  char text[40];
  std::snprintf(text, sizeof(text), ",%.17g", value);
  row += text;
}

std::string rewrite(const std::vector<WrenchRequest>& requests) {
  std::string text(kTwistHeader);
  for (const WrenchRequest& request : requests) {
    for (const BodyState& body : request.bodies) {
      text += std::to_string(request.id.utime) + "," + std::to_string(body.body_id);
      for (const double value : body.position) append(value, text);
      for (const double value : body.quaternion_wxyz) append(value, text);
      for (const double value : body.linear_velocity) append(value, text);
      for (const double value : body.angular_velocity) append(value, text);
      text += '\n';
    }
  }
  return text;
}

template <std::size_t kSize>
bool same(const std::array<double, kSize>& a, const std::array<double, kSize>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
    return std::isnan(x) ? std::isnan(y) : x == y && std::signbit(x) == std::signbit(y);
  });
}

void check_same_rows(const std::vector<WrenchRequest>& first, const std::vector<WrenchRequest>& second) {
  std::vector<BodyState> rows;
  for (const WrenchRequest& request : first) {
    rows.insert(rows.end(), request.bodies.begin(), request.bodies.end());
  }
  std::size_t row = 0;
  for (const WrenchRequest& request : second) {
    require(request.bodies.size() <= rows.size() - row, "a rewritten file has no more rows");
    for (const BodyState& again : request.bodies) {
      const BodyState& body = rows[row++];
      require(body.body_id == again.body_id && same(body.position, again.position) &&
                  same(body.quaternion_wxyz, again.quaternion_wxyz) &&
                  same(body.linear_velocity, again.linear_velocity) &&
                  same(body.angular_velocity, again.angular_velocity),
              "a rewritten row is read as the same row");
    }
  }
  require(row == rows.size(), "a rewritten file is read completely");
}

// Appends the sizes of the requests up to the limit and returns where the next item starts.
std::int64_t read_piece(StateCsvReader reader, std::int64_t limit, std::vector<std::size_t>& sizes) {
  while (true) {
    const LogItem item = reader.next(limit);
    if (std::holds_alternative<LimitReached>(item) || std::holds_alternative<EndOfLog>(item)) break;
    if (const auto* recorded = std::get_if<RecordedEvent>(&item)) sizes.push_back(recorded->bytes.size());
  }
  return reader.position();
}

void check_pieces(const std::string& path, std::int64_t cut, const TableOptions& options = {}) {
  std::vector<std::size_t> whole;
  read_piece(*StateCsvReader::open(path, options), kNoLimit, whole);
  std::vector<std::size_t> pieces;
  const std::int64_t end = read_piece(*StateCsvReader::open(path, options), cut, pieces);
  Expected<StateCsvReader> back = StateCsvReader::open(path, options);
  back->seek(cut);
  require(back->position() == end, "a piece begins where the one before ends");
  read_piece(*std::move(back), kNoLimit, pieces);
  require(pieces == whole, "two pieces hold the requests of the whole");
}

// Poses of other programs: each is a request of one body, and two pieces hold those of the whole.
void check_other_formats(std::string_view text) {
  const std::string path = path_of_file_with(text);
  for (const TableFormat format :
       {TableFormat::kGuess, TableFormat::kTum, TableFormat::kEuroc, TableFormat::kNav}) {
    const TableOptions options{format, {}};
    Expected<StateCsvReader> reader = StateCsvReader::open(path, options);
    if (!reader) {
      require(reader.error().message().find('\n') == std::string::npos, "an error is one line");
      continue;
    }
    if (reader->table() == nullptr) continue;
    std::vector<std::size_t> sizes;
    require(read_piece(*std::move(reader), kNoLimit, sizes) == static_cast<std::int64_t>(text.size()),
            "reading ends at the end of the file");
    require(std::ranges::all_of(sizes, [](std::size_t size) { return size == request_size(1); }),
            "each pose is a request");
    check_pieces(path, static_cast<std::int64_t>(text.size() / 2), options);
  }
}

void check(std::string_view text) {
  check_other_formats(text);
  Expected<StateCsvReader> reader = StateCsvReader::open(path_of_file_with(text));
  if (!reader) {
    require(reader.error().message().find('\n') == std::string::npos, "an error is one line");
    return;
  }
  const std::vector<WrenchRequest> requests = read_all(*reader, data_lines(text));
  for (const std::size_t cut : {text.size() / 3, text.size() / 2, text.size() - text.size() / 5}) {
    check_pieces(path_of_file_with(text), static_cast<std::int64_t>(cut));
  }

  const std::string again = rewrite(requests);
  Expected<StateCsvReader> second = StateCsvReader::open(path_of_file_with(again));
  require(second.has_value(), "a rewritten file opens");
  check_same_rows(requests, read_all(*second, data_lines(again)));
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
