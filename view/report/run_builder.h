// Rows of a recorded run, put together from states and wrenches as a file has them: what the file lacks is
// computed from the scene, time gets one axis, and each body's rows are thinned. That is done for the bodies
// that are shown; of the others the rows are counted and the recorded forces compared, which costs next to
// nothing.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

#include "engine/body_evaluation.h"
#include "messages/bot_core.h"
#include "scene/scene.h"
#include "simulation/rigid_body.h"
#include "view/report/attitude.h"
#include "view/report/decimated_rows.h"
#include "view/report/run.h"

namespace buoyancy {

inline constexpr std::size_t kMaxBodies = 1'000;  // that one page shows

// What a file says of one body at one instant.
struct RecordedState {
  std::int64_t time = 0;  // us, on the run's axis: as RunBuilder::time_of() said when it came
  BodyState state;
  double lead_time = 0.0;            // s
  std::optional<BodyWrench> wrench;  // nullopt: to be computed
  std::optional<BotForceTorque>
      force_torque;              // where nothing else of the wrench is known: the rest is computed
  std::optional<double> energy;  // J; nullopt: to be computed, where velocities and [body.client] allow it
  bool velocities = false;       // state has them
  double round_trip = kUnknown;  // s
};

class RunBuilder {
 public:
  // scene must outlive this. max_rows: of all bodies together, roughly. selected: the bodies to show, as
  // indices into scene.bodies(), at most kMaxBodies; empty: the first kMaxBodies that the run names.
  RunBuilder(const Scene& scene, std::size_t max_rows, const std::vector<std::size_t>& selected = {});

  // Where on the run's axis a state of this body stands, us. To be asked once about each, in the order in
  // which they came; 0 of a body that is not shown. The axis begins with the run's first state. A clock that
  // began again, in a session of its own or within one, goes on behind what the body had before; so does
  // one that differs by more than a day, which is another clock.
  std::int64_t time_of(std::int32_t body_id, std::int64_t session_id, std::int64_t utime);
  // In any order.
  void add(const RecordedState& recorded);
  void add_warning(std::string warning);
  void set_status(ServiceStatus status) { run_.status = std::move(status); }

  // What it all came to; the builder is done for then.
  RecordedRun finish();

 private:
  // A session's, as a body knows it.
  struct Clock {
    std::int64_t session_id = 0;
    std::int64_t offset = 0;  // us: time on the axis less utime, modulo 2^64
    std::int64_t latest = 0;  // us, on the axis
  };
  struct Collected {
    explicit Collected(std::size_t max_rows) : rows(max_rows) {}

    DecimatedRows rows;
    std::optional<RigidBody> rigid;
    MeshUp mesh_up = MeshUp::kZ;
    EvaluationCounts skipped;
    std::optional<PoseBits> last_pose;
    std::deque<Clock> clocks;    // of its last sessions, the newest in front
    std::int64_t last_time = 0;  // the latest
    std::int64_t last_step = 0;
  };

  Collected* show(std::size_t index);  // nullptr: the body is not shown, there is no room for it
  void classify(Collected& collected, const Body& body, const ValidatedPose& asked) const;

  const Scene& scene_;
  std::size_t max_rows_of_body_;
  std::size_t room_ = 0;                            // for further bodies, where none are selected
  std::vector<std::unique_ptr<Collected>> bodies_;  // as Scene::bodies(); nullptr: not shown (yet)
  std::unordered_set<std::int64_t> sessions_;       // up to a bound
  std::optional<std::int64_t> first_utime_;
  std::int64_t latest_ = 0;  // us, on the axis: of all bodies
  std::int64_t number_ = 0;
  RecordedRun run_;
};

}  // namespace buoyancy
