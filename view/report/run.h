// A run as a page shows it: a summary of every body, the rows over time of the bodies that are shown, and the
// warnings of the reader.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/json.h"
#include "engine/sea_timeline.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "messages/status.h"
#include "scene/scene.h"

namespace buoyancy::view {

// The columns of a row, all doubles; NaN: unknown. Vectors are in W, same as in body_state_t and
// body_wrench_t:
//   kTime            time since the run's first row [s]
//   kPx .. kQz       B's origin [m]; q_WB
//   kStatus          a BodyStatus
//   kFx .. kTz       force [N]; torque about the reference point [N m]
//   kVolume          submerged volume [m^3]
//   kBx .. kBz       from B's origin to the centre of buoyancy [m]
//   kEnergy          mechanical energy [J] (simulation/rigid_body.h), with that of added mass
//   kRoundTrip       time from request to response [s], by the recorder's clock
//   kHeave           height of B's origin above the level [m]
//   kRoll, kPitch    angles from upright [degrees] (attitude.h)
//   kForce, kTorque  norms [N], [N m]
//   kSeaTime         time t of the sea at which the row is evaluated [s]
//   kSea             that sea's place in RecordedRun::seas; kUnknown if it is not known
// The last two exist in waves only.
enum RunColumn : std::size_t {
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
  kSeaTime,
  kSea,
  kColumnCount,
};
inline constexpr std::array<std::string_view, kColumnCount> kColumnNames{
    "time",       "px",    "py",   "pz",    "qw",    "qx",     "qy",       "qz", "status", "fx",
    "fy",         "fz",    "tx",   "ty",    "tz",    "volume", "bx",       "by", "bz",     "energy",
    "round_trip", "heave", "roll", "pitch", "force", "torque", "sea_time", "sea"};

using RunRow = std::array<double, kColumnCount>;
// Does a scene have waves, or receive them?
inline bool has_waves(const Scene& scene) {
  return scene.sea() != nullptr || scene.receives_sea();
}

// The columns of a row's loads, all doubles; NaN: unknown. See body_loads_t.lcm; a wrench is a force [N] and
// a torque [N m] about the reference point, both in W:
//   kImmersion      0 to 1
//   kBuoyancyLoad   six columns, a wrench: the buoyancy, or in waves the load of the waves
//   kDragLoad       six columns, the wrench of drag
//   kAddedMassLoad  six columns, the wrench of added mass
//   kWaterVelocity  three columns [m/s], W
enum LoadColumn : std::size_t {
  kImmersion,
  kBuoyancyLoad,
  kDragLoad = kBuoyancyLoad + 6,
  kAddedMassLoad = kDragLoad + 6,
  kWaterVelocity = kAddedMassLoad + 6,
  kLoadColumnCount = kWaterVelocity + 3,
};
using LoadRow = std::array<double, kLoadColumnCount>;

// Where the loads of a row come from: the state that they are computed for, or a message of the file.
struct RowLoads {
  std::int64_t utime = 0;  // [us], of the request
  double lead_time = 0.0;  // [s]
  BodyState state;
  std::shared_ptr<const SeaPeriod> sea;  // nullptr: unknown, or the scene has no waves
  std::optional<BodyLoads> recorded;
};

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Rows of a body by how the service evaluates their poses.
struct EvaluationCounts {
  std::int64_t unchanged = 0;  // pose bitwise equal to that of the previous row: cached result
  std::int64_t dry = 0;        // above the water: from the bounds
  std::int64_t wet = 0;        // fully submerged: from the bounds and constants
  std::int64_t crossing = 0;   // computed
  std::int64_t rejected = 0;   // invalid pose
};

struct BodyRun {
  std::int64_t recorded = 0;  // rows of the file
  // Number of these rows by BodyStatus; the last element counts statuses of later versions. The sum is less
  // than `recorded` if the file does not contain the status and nothing was computed.
  std::array<std::int64_t, kBodyStatusCount + 1> statuses{};
  double max_force = kUnknown;  // [N], of the rows with status OK
  bool shown = false;
  // Only of bodies that are shown:
  std::vector<RunRow> rows;      // in order of time, after decimation
  EvaluationCounts evaluations;  // in water at rest
  // Only of bodies that are shown and have loads (view/common/scene_model.h):
  std::vector<LoadRow> loads;             // one for each of `rows`; unknown where the status is not OK
  std::int64_t loads_recorded = 0;        // of these, those that a message of the file holds
  std::int64_t loads_computed = 0;        // of these, those that were computed from the scene
  bool loads_without_velocities = false;  // were some computed as if the body were at rest?
  // Only of bodies that are shown and have compartments or tanks, and only if a row has another condition
  // than that of the scene file:
  std::vector<std::optional<BodyCondition>> conditions;  // different ones; nullopt: unknown
  std::vector<std::uint32_t> condition_of_row;           // index into `conditions` for each of `rows`
};

// The surface that is drawn from a time of the run until the next one.
struct DrawnSurface {
  double time = 0.0;  // [s]
  Json sea;           // see surface_json()
};

struct RecordedRun {
  std::vector<BodyRun> bodies;      // in the order of Scene::bodies()
  std::int64_t unknown_bodies = 0;  // rows about bodies that the scene does not have
  std::int64_t sessions = 0;        // of requests
  std::int64_t computed = 0;  // rows of shown bodies without a recorded response, computed from the scene
  std::vector<std::string> notices;   // about what the run lacks or contradicts
  std::vector<std::string> warnings;  // the first ones about input that could not be read
  std::int64_t suppressed_warnings = 0;
  std::vector<std::shared_ptr<const SeaPeriod>> seas;  // of the shown rows: the scene's, or those received
  // In a sea on grids, which is another one at every time: in ascending order of time, after decimation.
  std::vector<DrawnSurface> surfaces;
  std::optional<ServiceStatus> status;  // the last one recorded
};

}  // namespace buoyancy::view
