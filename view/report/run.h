// A run as a page shows it: of every body a summary, of those that are shown the rows in time, and what was
// found on the way.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "messages/request.h"
#include "messages/status.h"

namespace buoyancy {

// The columns of a row, all doubles; NaN: not known. In W, as in body_state_t and body_wrench_t:
//   kTime            s since the run's first row
//   kPx .. kQz       B's origin, m; q_WB
//   kStatus          a BodyStatus
//   kFx .. kTz       N; N m about the reference point
//   kVolume          m^3, submerged
//   kBx .. kBz       m, from B's origin to the centre of buoyancy
//   kEnergy          J, mechanical (simulation/rigid_body.h)
//   kRoundTrip       s, from request to answer, by the clock of whoever recorded them
//   kHeave           m, of B's origin over the water
//   kRoll, kPitch    degrees from upright (attitude.h)
//   kForce, kTorque  N, N m: lengths
enum Column : std::size_t {
  kTime,
  kPx,
  kPy,
  kPz,
  kQw,
  kQx,
  kQy,
  kQz,
  kStatus,
  kFx,
  kFy,
  kFz,
  kTx,
  kTy,
  kTz,
  kVolume,
  kBx,
  kBy,
  kBz,
  kEnergy,
  kRoundTrip,
  kHeave,
  kRoll,
  kPitch,
  kForce,
  kTorque,
  kColumnCount,
};
inline constexpr std::array<std::string_view, kColumnCount> kColumnNames{
    "time", "px",     "py",         "pz",    "qw",   "qx",    "qy",     "qz",    "status",
    "fx",   "fy",     "fz",         "tx",    "ty",   "tz",    "volume", "bx",    "by",
    "bz",   "energy", "round_trip", "heave", "roll", "pitch", "force",  "torque"};

using Row = std::array<double, kColumnCount>;
inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// What a body's pose let the service leave out, by row.
struct EvaluationCounts {
  std::int64_t unchanged = 0;  // the same pose as the row before, bit for bit: answered from it
  std::int64_t dry = 0;        // clear of the water: answered from the bounds
  std::int64_t wet = 0;        // wholly under water: from the bounds and constants
  std::int64_t crossing = 0;   // computed
  std::int64_t refused = 0;    // a pose that has no response
};

struct BodyRun {
  std::int64_t recorded = 0;  // rows of the file
  // Of these, by BodyStatus, the last for statuses of a later version; fewer than `recorded` where neither
  // the file says the status nor anything was computed.
  std::array<std::int64_t, kBodyStatusCount + 1> statuses{};
  double largest_force = kUnknown;  // N, of the rows that are OK
  // Of the bodies that are shown, alone:
  bool shown = false;
  std::vector<Row> rows;  // in order of time; what is left of `recorded`
  EvaluationCounts skipped;
};

struct RecordedRun {
  std::vector<BodyRun> bodies;      // as Scene::bodies()
  std::int64_t unknown_bodies = 0;  // rows about bodies that the scene has not
  std::int64_t sessions = 0;        // of requests; one after the other on the axis of time
  std::int64_t computed =
      0;  // rows of shown bodies whose file has no response, computed from the scene instead
  std::vector<std::string> warnings;  // what could not be read: the first of them
  std::int64_t suppressed_warnings = 0;
  std::optional<ServiceStatus> status;  // the last that was recorded
};

}  // namespace buoyancy
