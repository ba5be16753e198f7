// Builds a recorded run from states and wrenches as a file contains them: computes missing values from the
// scene, maps the clients' clocks to one time axis, and decimates each body's rows. This is done for the
// bodies that are shown; of the others only the rows are counted and the recorded forces compared, at
// negligible cost.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "engine/body_evaluation.h"
#include "engine/water_at_time.h"
#include "messages/bot_core.h"
#include "scene/scene.h"
#include "simulation/hydrodynamic_motion.h"
#include "simulation/rigid_body.h"
#include "view/common/condition_tracker.h"
#include "view/report/attitude.h"
#include "view/report/decimated_rows.h"
#include "view/report/run.h"

namespace buoyancy::view {

inline constexpr std::size_t kMaxBodies = 1'000;   // shown in one page
inline constexpr std::size_t kMaxSeasShown = 100;  // about 20 kB each, of 200 components
// Of all surfaces on grids in a page: more of them are drawn less often.
inline constexpr std::size_t kMaxSurfaceBytes = 25'000'000;

// The contents of a file about one body at one instant.
struct RecordedState {
  std::int64_t time = 0;   // [us], on the run's time axis; from RunBuilder::time_of()
  std::int64_t utime = 0;  // [us], of the request: the time of the sea
  BodyState state;
  double lead_time = 0.0;            // [s]
  std::optional<BodyWrench> wrench;  // nullopt: to be computed
  std::optional<BotForceTorque>
      force_torque;              // if the file holds no more of the wrench; the rest is computed
  std::optional<double> energy;  // [J]; nullopt: computed if velocities and [body.client] are known
  bool velocities = false;       // true if state's velocities are known
  double round_trip = kUnknown;  // [s]
};

class RunBuilder {
 public:
  // scene must outlive the builder. max_rows: approximate limit for all bodies together. selected: the bodies
  // to show, as indices into scene.bodies(), at most kMaxBodies; empty: the first kMaxBodies in the run.
  RunBuilder(const Scene& scene, std::size_t max_rows, const std::vector<std::size_t>& selected = {});

  // Maps a state's utime to the run's time axis [us]; 0 for a body that is not shown. To be called once for
  // each state, in order of arrival. The axis starts at the run's first state. If a clock restarts, in a new
  // session or within one, its times continue after the body's previous ones; so do those of a clock that
  // differs by more than a day.
  std::int64_t time_of(std::int32_t body_id, std::int64_t session_id, std::int64_t utime);
  // Adds a row, in any order. Returns nullptr for a body that is not shown or has no loads; otherwise the
  // row's loads: set `recorded` in them, before finish(), to what the file holds; others are computed.
  std::shared_ptr<RowLoads> add(const RecordedState& recorded);
  // Receives a sea_state_t or sea_grid_t, for a scene that receives it: wrenches of rows added later are
  // those in it.
  void receive_sea(std::int64_t timestamp, Bytes message);
  // Receives a body_condition_t, for a scene with compartments or tanks. It holds from its utime on.
  void receive_condition(std::int64_t timestamp, Bytes message);
  void add_warning(std::string warning);
  void add_notice(std::string notice) { run_.notices.push_back(std::move(notice)); }
  const Scene& scene() const { return scene_; }
  void set_status(ServiceStatus status) { run_.status = std::move(status); }

  // Returns the run; the builder must not be used afterwards.
  RecordedRun finish();

 private:
  // The clock of a session, for one body.
  struct SessionClock {
    std::int64_t session_id = 0;
    std::int64_t offset = 0;  // [us]: time on the axis - utime, modulo 2^64
    std::int64_t latest = 0;  // [us], on the axis
  };
  struct ShownBody {
    explicit ShownBody(std::size_t max_rows) : rows(max_rows) {}

    DecimatedRows rows;
    std::optional<RigidBody> rigid;
    std::optional<HydrodynamicMotion> motion;        // of a rigid body with drag or added mass
    std::shared_ptr<const BodyCondition> condition;  // of `rigid`; nullptr: that of the scene file
    MeshUp mesh_up = MeshUp::kZ;
    EvaluationCounts evaluations;
    std::optional<PoseBits> last_pose;
    std::deque<SessionClock> clocks;  // of its last sessions, the latest first
    std::int64_t last_time = 0;       // the maximum so far
    std::int64_t last_step = 0;
  };

  // Returns nullptr if the body is not shown.
  ShownBody* show(std::size_t index);
  // Sets the rigid body, with the liquids of this condition; nullptr: those of the scene file.
  void make_rigid(const Body& body, const std::shared_ptr<const BodyCondition>& condition, ShownBody& shown);
  std::shared_ptr<const SeaPeriod> sea_of(const RecordedState& recorded) const;
  void keep_surface(const RecordedState& recorded);
  double place_of(const std::shared_ptr<const SeaPeriod>& sea);  // in run_.seas, see kSea
  void count_evaluation(ShownBody& shown, const Body& body, const ValidatedPose& pose) const;
  std::shared_ptr<RowLoads> make_loads(BodyRun& run, const Body& body, const RecordedState& recorded) const;

  const Scene& scene_;
  WaterAtTime water_;
  ConditionTracker conditions_;
  std::size_t max_rows_of_body_;
  std::size_t free_places_ = 0;  // number of bodies that can still be shown
  std::vector<std::unique_ptr<ShownBody>>
      bodies_;                                 // in the order of Scene::bodies(); nullptr: not shown (yet)
  std::unordered_set<std::int64_t> sessions_;  // at most kMaxSessionsCounted
  std::optional<std::int64_t> first_utime_;
  std::int64_t latest_ = 0;  // [us], on the axis, of all bodies
  std::int64_t rows_added_ = 0;
  bool warned_of_seas_ = false;
  std::size_t surface_bytes_ = 0;  // of run_.surfaces
  double surface_interval_ = 0.0;  // [s], at least between two of them
  RecordedRun run_;
};

}  // namespace buoyancy::view
