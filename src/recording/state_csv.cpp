#include "recording/state_csv.h"

#include <algorithm>
#include <string>
#include <type_traits>

#include "base/csv_field.h"
#include "messages/body_csv.h"

namespace buoyancy {
namespace {

constexpr FieldRange kPoseFields{"body_id", "quaternion_wxyz"};
constexpr FieldRange kTwistFields{"linear_velocity", "angular_velocity"};
constexpr std::size_t kPoseColumns = 9;
constexpr std::size_t kTwistColumns = 15;
constexpr std::size_t kMaxLineLength = 4096;

}  // namespace

Expected<StateCsvReader> StateCsvReader::open(const std::filesystem::path& path,
                                              const TableOptions& options) {
  Expected<FileWindow> file = FileWindow::open(path);
  if (!file) return tl::unexpected(file.error());
  StateCsvReader reader(std::move(*file));
  const std::optional<std::string_view> header = reader.read_line();
  if (!header) return reader;
  const Expected<std::size_t> columns = reader.parse_header(*header, path);
  if (columns) reader.columns_ = *columns;
  if (columns && options.format <= TableFormat::kCsv) return reader;
  if (options.format == TableFormat::kCsv) return tl::unexpected(columns.error());
  if (Expected<void> read = reader.read_table(header, options); !read) return tl::unexpected(read.error());
  return reader;
}

Expected<void> StateCsvReader::read_table(std::optional<std::string_view> text, const TableOptions& options) {
  std::string header;
  std::int64_t header_number = 0;
  const auto where = [&] {
    return file_.path().string() + ":" + std::to_string(header.empty() ? line_number_ : header_number);
  };
  const auto keep = [&](std::string_view line) {
    header = line;
    header_number = line_number_;
  };
  for (; text; text = read_line()) {
    if (line_too_long_) {
      return make_error({file_.path().string() + ":" + std::to_string(line_number_),
                         "more than " + std::to_string(kMaxLineLength) + " characters",
                         "poses or their header", "the file has many topics, or is no text",
                         "Export the poses of one topic alone"});
    }
    std::string_view line = *text;
    if (line_start_ == 0 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    line = trim(line);
    if (line.empty()) continue;
    if (line.starts_with('#')) {
      line = trim(line.substr(1));
      if (PoseTable::names_columns(line)) keep(line);
      continue;
    }
    double number = 0.0;
    const std::size_t end = line.find_first_of(",; \t");
    if (header.empty() && !parse_number(line.substr(0, end), number)) {
      keep(line);
      continue;
    }
    Expected<PoseTable> table = PoseTable::from_lines(where(), header, line, options);
    if (!table) return tl::unexpected(table.error());
    table_ = *std::move(table);
    offset_ = line_start_;
    --line_number_;
    return {};
  }
  if (header.empty() || PoseTable::names_columns(header)) return {};
  const Expected<PoseTable> refused = PoseTable::from_lines(where(), header, header, options);
  return refused ? Expected<void>() : tl::unexpected(refused.error());
}

bool StateCsvReader::is_passed_over(std::string_view text) const {
  text = trim(text);
  return !line_too_long_ && (text.empty() || (table_ && text.starts_with('#')));
}

Expected<std::size_t> StateCsvReader::parse_header(std::string_view text, const std::filesystem::path& path) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::string names;  // without spaces
  for (const char c : text) {
    if (c != ' ' && c != '\t' && c != '\r') names += c;
  }
  const std::string pose = csv_header<BodyState>(kPoseFields);
  const std::string twist = csv_columns<BodyState>(kTwistFields);
  if (names == pose) return kPoseColumns;
  if (names == pose + ',' + twist) return kTwistColumns;
  std::string expected = "'";
  expected.append(pose).append("', optionally followed by ',").append(twist).append("'");
  return make_error({path.string() + ":1", "header " + quote(text), expected,
                     "the file has no header, or its columns are in another order", ""});
}

bool StateCsvReader::states_velocities() const {
  return table_ ? table_->states_velocities() : columns_ != kPoseColumns;
}

bool StateCsvReader::reached(std::int64_t limit) const {
  if (corrupt_line_) return corrupt_line_->start >= limit;
  return pending_ && last_row_start_ >= limit;
}

std::int64_t StateCsvReader::position() const {
  if (corrupt_line_) return corrupt_line_->start;
  return pending_ ? pending_->start : offset_;
}

LogItem StateCsvReader::next(std::int64_t limit) {
  if (file_.broken_off()) return EndOfLog{};
  if (reached(limit)) return LimitReached{};
  if (corrupt_line_) {
    CorruptSection corrupt = std::move(corrupt_line_->section);
    corrupt_line_.reset();
    return corrupt;
  }
  request_.bodies.clear();
  const auto append = [this](const Row& row) {
    request_.id.utime = row.utime;
    request_.bodies.push_back(row.state);
    run_utime_ = row.utime;
    last_row_start_ = row.start;
  };
  if (pending_) append(*pending_);
  pending_.reset();
  while (request_.bodies.size() < kMaxRowsPerRequest) {
    const std::optional<std::string_view> text = read_line();
    if (!text) break;
    if (is_passed_over(*text)) continue;
    const tl::expected<Row, std::string> row = parse_row(*text);
    if (!row) {
      corrupt_line_ = {{describe_line() + ": " + row.error() + "; skipped"}, line_start_};
      run_utime_.reset();
      break;
    }
    if (run_utime_ && (table_ || row->utime != *run_utime_)) {
      pending_ = *row;
      break;
    }
    append(*row);
  }
  if (file_.broken_off()) return EndOfLog{};  // the line or the run of rows may be incomplete
  if (!request_.bodies.empty()) {
    encode(request_, bytes_);
    ++request_.id.seq;
    return RecordedEvent{request_.id.utime, {}, bytes_};
  }
  if (corrupt_line_ || pending_) return next(limit);
  return EndOfLog{};
}

void StateCsvReader::seek(std::int64_t offset) {
  if (offset > offset_) {
    offset_ = offset - 1;  // a line starts at `offset` if the byte before is a newline
    skip_to_newline();
  }
  counted_from_ = offset_;
  line_number_ = 0;
  while (true) {
    const LogItem item = next(offset);
    if (std::holds_alternative<LimitReached>(item) || std::holds_alternative<EndOfLog>(item)) break;
  }
  request_.id.seq = 0;
}

std::string StateCsvReader::describe_line() const {
  const std::string number = "line " + std::to_string(line_number_);
  return counted_from_ == 0 ? number : number + " after byte " + std::to_string(counted_from_);
}

std::optional<std::string_view> StateCsvReader::read_line() {
  const Bytes window = file_.read_at(offset_, kMaxLineLength + 1);
  if (window.empty()) return std::nullopt;
  ++line_number_;
  line_start_ = offset_;
  const auto longest = window.subspan(0, std::min(window.size(), kMaxLineLength + 1));
  const auto newline = std::find(longest.begin(), longest.end(), '\n');
  const std::string_view text(reinterpret_cast<const char*>(window.data()),
                              static_cast<std::size_t>(newline - longest.begin()));
  line_too_long_ = text.size() > kMaxLineLength;
  offset_ += static_cast<std::int64_t>(text.size());
  if (line_too_long_) {
    skip_to_newline();
    return std::string_view();
  }
  if (newline != longest.end()) ++offset_;
  return text;
}

void StateCsvReader::skip_to_newline() {
  while (true) {
    const Bytes window = file_.read_at(offset_, 1);
    if (window.empty()) return;
    const auto newline = std::find(window.begin(), window.end(), '\n');
    offset_ += newline - window.begin();
    if (newline != window.end()) {
      ++offset_;
      return;
    }
  }
}

tl::expected<StateCsvReader::Row, std::string> StateCsvReader::parse_row(std::string_view text) const {
  if (line_too_long_) return tl::unexpected("more than " + std::to_string(kMaxLineLength) + " characters");
  Row row;
  row.start = line_start_;
  if (table_) {
    row.state.body_id = body_id_;
    if (const auto read = table_->read_row(text, row.utime, row.state); !read)
      return tl::unexpected(read.error());
    return row;
  }
  CsvFields fields(text);
  std::size_t column = 0;
  std::string error;
  const auto read = [&]<typename Number>(Number& number) {
    if (column == columns_ || !error.empty()) return;
    const std::optional<std::string_view> field = fields.next();
    if (!field) return;
    ++column;
    if (parse_number(*field, number)) return;
    error = quote(*field) + " in column " + std::to_string(column) + " is not " +
            (std::is_integral_v<Number> ? "a whole number" : "a number") + " in range";
  };
  read(row.utime);
  visit_numbers(row.state, kAllFields, read);
  if (!error.empty()) return tl::unexpected(error);
  while (fields.next()) ++column;
  if (column != columns_) {
    return tl::unexpected(std::to_string(column) + " columns where the header has " +
                          std::to_string(columns_));
  }
  return row;
}

}  // namespace buoyancy
