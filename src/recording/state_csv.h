// Reads recorded poses from CSV as requests. The first line is the header, exactly
//   utime,body_id,px,py,pz,qw,qx,qy,qz     optionally followed by     ,vx,vy,vz,wx,wy,wz
// Each further line is the state of one body: utime [us] and body_id are integers, the other fields numbers
// (including nan and inf, for which the service has a status). Blank lines are ignored; malformed lines are
// reported with their number and skipped.
//
// Consecutive rows with equal utime, up to kMaxRowsPerRequest, form one request with session 0, lead_time 0
// and seq counted from 0.
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

namespace buoyancy {

inline constexpr std::size_t kMaxRowsPerRequest = 65'536;

class StateCsvReader {
 public:
  // Errors: not readable, an invalid header. An empty file has no rows and is valid.
  static Expected<StateCsvReader> open(const std::filesystem::path& path);

  LogItem next();
  std::int64_t offset() const { return offset_; }  // read so far [bytes]
  std::int64_t size() const { return file_.size(); }

 private:
  struct Row {
    std::int64_t utime = 0;
    BodyState state;
  };

  explicit StateCsvReader(FileWindow file) : file_(std::move(file)) {}
  std::optional<std::string_view> read_line();  // without its newline; nullopt: end of the file
  void skip_to_newline();
  Expected<std::size_t> parse_header(std::string_view text, const std::filesystem::path& path);
  tl::expected<Row, std::string> parse_row(std::string_view text) const;  // or the reason why it is invalid

  FileWindow file_;
  std::int64_t offset_ = 0;
  std::int64_t line_number_ = 0;  // of the line read last; the header is line 1
  bool line_too_long_ = false;
  std::size_t columns_ = 0;
  std::optional<Row> pending_;                  // read ahead: the first row of the next request
  std::optional<CorruptSection> corrupt_line_;  // found after the request that was returned
  WrenchRequest request_;                       // reused
  std::vector<std::uint8_t> bytes_;             // reused
};

}  // namespace buoyancy
