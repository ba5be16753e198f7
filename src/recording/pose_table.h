// The layout of poses that other programs write as text, one pose of one body per line:
//   TUM     t tx ty tz qx qy qz qw, separated by spaces, tabs, commas or semicolons, without a header
//   EuRoC   the ground truth of the EuRoC MAV data set: p_RS_R_x, q_RS_w, v_RS_R_x ...; w_RS_S_x if it is
//   there nav     exports of ROS's PoseStamped, PoseWithCovarianceStamped and Odometry by rostopic, bagpy,
//   PlotJuggler
//           and others: pose.position.x or pose.pose.position.x and so on, after any prefix, with . or /
// Columns are found by their names, in any order; a comment that names them is a header too. Others are
// ignored.
//
// R and S of EuRoC, and the frames of header.frame_id and child_frame_id, are taken as W and B. p and v are
// in W, w_RS_S and both parts of an Odometry's twist in B. Velocities that the file does not have are NaN in
// the states.
//
// Times become microseconds, rounded to nearest. The unit is, in this order: the given one; that of the
// header ([ns]); ns below a header that begins with %; and a guess by the first time: from 1e17 on
// nanoseconds, from 1e14 on microseconds, from 1e11 on milliseconds, below it seconds (EuRoC: nanoseconds).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/request.h"

namespace buoyancy {

enum class TableFormat : std::uint8_t { kGuess, kCsv, kTum, kEuroc, kNav };  // kCsv: see state_csv.h
enum class TimeUnit : std::uint8_t { kSeconds, kMilliseconds, kMicroseconds, kNanoseconds };

struct TableOptions {
  TableFormat format = TableFormat::kCsv;
  std::optional<TimeUnit> time_unit;  // nullopt: see above; only of the formats of other programs
};

class PoseTable {
 public:
  // Does the line name the columns of a pose? Then it is a header, even as a comment.
  static bool names_columns(std::string_view line);

  // header: the line of names without '#', or empty. subject: where first_row is, for errors. Errors: a
  // format that cannot be told, or is not the given one; a column that is missing or there twice; a unit of
  // time where the columns have their own.
  static Expected<PoseTable> from_lines(const std::string& subject, std::string_view header,
                                        std::string_view first_row, const TableOptions& options);

  TableFormat format() const { return format_; }
  bool states_velocities() const { return has_linear_ && has_angular_; }
  // "TUM, time in seconds, without velocities"
  std::string description() const;

  // Replaces utime and state, but not its body_id, by those of a line; or returns the reason why it is
  // invalid. No heap allocation unless it is. O(length).
  tl::expected<void, std::string> read_row(std::string_view line, std::int64_t& utime,
                                           BodyState& state) const;

 private:
  TableFormat format_ = TableFormat::kTum;
  TimeUnit unit_ = TimeUnit::kSeconds;
  char separator_ = ' ';
  bool has_linear_ = false;
  bool has_angular_ = false;
  std::vector<std::int8_t> slots_;  // of each column: the number that it holds (pose_table.cpp)
};

}  // namespace buoyancy
