// Recorded poses as CSV, turned into requests. The first line is the header, exactly
//   utime,body_id,px,py,pz,qw,qx,qy,qz     or the same with     ,vx,vy,vz,wx,wy,wz     after it,
// each further line one body's state: utime (us) and body_id whole numbers, the rest numbers (nan and inf
// are numbers: the service has a status for them). Blank lines are passed over, a malformed one is reported
// with its number and left out.
//
// Rows that follow each other with equal utime, up to kMaxRowsPerRequest, are one request; its session is
// 0, its seq counts from 0, its lead_time is 0.
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
  // Errors: not readable, a first line that is no such header. An empty file is one without rows.
  static Expected<StateCsvReader> open(const std::filesystem::path& path);

  LogItem next();
  std::int64_t offset() const { return offset_; }  // bytes read
  std::int64_t size() const { return file_.size(); }

 private:
  struct Row {
    std::int64_t utime = 0;
    BodyState state;
  };

  explicit StateCsvReader(FileWindow file) : file_(std::move(file)) {}
  std::optional<std::string_view> line();  // without its newline; nullopt: end of the file
  void skip_to_newline();
  Expected<std::size_t> parse_header(std::string_view text, const std::filesystem::path& path);
  tl::expected<Row, std::string> parse_row(std::string_view text) const;  // or what is wrong with it

  FileWindow file_;
  std::int64_t offset_ = 0;
  std::int64_t line_number_ = 0;  // of the line last read; the header's is 1
  bool line_too_long_ = false;
  std::size_t columns_ = 0;
  std::optional<Row> pending_;            // read ahead: the next request's first
  std::optional<CorruptSection> damage_;  // found behind the request that was returned
  WrenchRequest request_;                 // reused
  std::vector<std::uint8_t> bytes_;       // reused
};

}  // namespace buoyancy
