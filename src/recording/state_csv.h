// Reads recorded poses from CSV as requests. The first line is the header, exactly
//   utime,body_id,px,py,pz,qw,qx,qy,qz     optionally followed by     ,vx,vy,vz,wx,wy,wz
// Each further line is the state of one body: utime [us] and body_id are integers, the other fields numbers
// (including nan and inf, for which the service has a status). Blank lines are ignored; malformed lines are
// reported with their number and skipped.
//
// Consecutive rows with equal utime, up to kMaxRowsPerRequest, form one request with session kCsvSession,
// lead_time 0 and seq counted from 0.
//
// A run is a sequence of rows with equal utime, with nothing but blank lines between them. The cut
// (log_item.h) for an offset is the first line at or after it that is malformed, or that starts a run and
// follows a row at or after the offset. A request never extends over a cut, whatever kMaxRowsPerRequest is,
// and a cut depends only on the header and on what follows the offset. The rows of a run that spans the
// offset belong to the piece before the cut. Each piece numbers its requests from 0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/request.h"
#include "recording/file_window.h"
#include "recording/log_item.h"
#include "recording/pose_table.h"

namespace buoyancy {

inline constexpr std::size_t kMaxRowsPerRequest = 65'536;
inline constexpr std::int64_t kCsvSession = 0;

class StateCsvReader {
 public:
  // Errors: not readable, an invalid header, those of PoseTable::from_lines(). An empty file has no rows and
  // is valid.
  static Expected<StateCsvReader> open(const std::filesystem::path& path, const TableOptions& options = {});

  // Returns whether the header names velocities; also true for an empty file, which has no rows without them.
  bool states_velocities() const;

  // The layout of another program's poses; nullptr: the file has the columns above, or no rows.
  const PoseTable* table() const { return table_ ? &*table_ : nullptr; }
  // The body of such poses, 0 at first.
  std::int32_t body() const { return body_id_; }
  void set_body(std::int32_t id) { body_id_ = id; }

  // Once file().broken_off(), returns EndOfLog.
  LogItem next(std::int64_t limit = kNoLimit);
  bool reached(std::int64_t limit) const;
  std::int64_t position() const;
  std::int64_t offset() const { return offset_; }  // read so far [bytes]
  std::int64_t size() const { return file_.size(); }
  const FileWindow& file() const { return file_; }
  FileWindow& file() { return file_; }

  // Malformed lines are then numbered from the first line at or after `offset`. O(rows of the run there).
  void seek(std::int64_t offset);

 private:
  struct Row {
    std::int64_t utime = 0;
    BodyState state;
    std::int64_t start = 0;  // [bytes]
  };
  struct CorruptLine {
    CorruptSection section;
    std::int64_t start = 0;  // [bytes]
  };

  explicit StateCsvReader(FileWindow file) : file_(std::move(file)) {}
  std::optional<std::string_view> read_line();  // without its newline; nullopt: end of the file
  void skip_to_newline();
  Expected<void> read_table(std::optional<std::string_view> text, const TableOptions& options);
  bool is_passed_over(std::string_view text) const;  // a blank line or a comment
  Expected<std::size_t> parse_header(std::string_view text, const std::filesystem::path& path);
  tl::expected<Row, std::string> parse_row(std::string_view text) const;  // or the reason why it is invalid
  std::string describe_line() const;                                      // the line read last, for a report

  FileWindow file_;
  std::int64_t offset_ = 0;
  std::int64_t line_start_ = 0;    // of the line read last [bytes]
  std::int64_t line_number_ = 0;   // of the line read last, counted from counted_from_; the header is line 1
  std::int64_t counted_from_ = 0;  // [bytes]
  bool line_too_long_ = false;
  std::size_t columns_ = 0;
  std::optional<PoseTable> table_;
  std::int32_t body_id_ = 0;                 // of the table's poses
  std::optional<std::int64_t> run_utime_;    // nullopt: the next row starts a run
  std::int64_t last_row_start_ = 0;          // of the run [bytes]
  std::optional<Row> pending_;               // read ahead: the first row of the next run
  std::optional<CorruptLine> corrupt_line_;  // read ahead
  WrenchRequest request_;                    // reused
  std::vector<std::uint8_t> bytes_;          // reused
};

}  // namespace buoyancy
