// Receives from the bus and publishes snapshots to the page, kSnapshotsPerSecond times a second while a
// listener is connected; single-threaded.
//
// It must not slow down the programs that it observes: messages do not wake it (UdpmReceiver polls), and it
// can run while a processor would otherwise be idle (use_idle_scheduling()). On a machine that is never idle
// it publishes fewer snapshots and reports packets that the kernel had to drop.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/termination_signals.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "transport/udpm_receiver.h"
#include "view/live/bus_monitor.h"
#include "view/live/metrics.h"
#include "view/live/snapshot_broadcaster.h"

namespace buoyancy::view {

struct ObservedChannels {
  std::string states{kStatesChannel};
  std::string wrenches{kWrenchesChannel};
  std::string hydrostatics{kHydrostaticsChannel};
  std::string loads{kLoadsChannel};
  std::string status{kStatusChannel};
  std::string sea{kSeaChannel};
  std::string sea_grid{kSeaGridChannel};
  std::string condition{kConditionChannel};
  PoseChannels poses;
};

// Applies SCHED_IDLE to this thread and to those that it starts afterwards.
void use_idle_scheduling();

class LiveView {
 public:
  static constexpr double kSnapshotsPerSecond = 30.0;
  // To a page in a sea on grids: more would fall behind. 256 by 256 samples fit into every snapshot.
  static constexpr double kSurfaceBytesPerSecond = 2e7;

  // Receives from here on. scene and broadcaster must outlive the view. Errors: see UdpmReceiver::open; two
  // channels have the same name.
  static Expected<LiveView> open(const Scene& scene, const std::string& lcm_url,
                                 const ObservedChannels& channels, SnapshotBroadcaster& broadcaster);

  // Warns that this view may lose messages about all bodies of the scene, since the kernel grants it too
  // small a receive buffer; nullopt: they fit.
  const std::optional<Warning>& buffer_warning() const { return buffer_warning_; }

  // Has run() update the metrics with every status, and when no more arrive. They must outlive the view.
  void keep_metrics(Metrics& metrics) { metrics_ = &metrics; }

  // Runs until a termination signal arrives or keep_running returns false; to be called once.
  void run(const TerminationSignals& termination, const std::function<bool()>& keep_running);

 private:
  enum class MessageKind {
    kRequest,
    kResponse,
    kHydrostatics,
    kLoads,
    kStatus,
    kSea,
    kCondition,
    kPose,
    kForceTorque
  };
  struct Route {
    MessageKind kind;
    std::size_t index = 0;  // of the pose channel
  };

  LiveView(const Scene& scene, UdpmReceiver receiver, std::vector<Route> routes, PoseChannels poses,
           SnapshotBroadcaster& broadcaster);
  void drain();
  void dispatch(const Route& route, Bytes bytes, ArrivalTime arrival);
  void publish();
  // Publishes the surface of a sea on grids, unless the page has it.
  void publish_surface(const SeaPeriod& sea, const RequestTime& time);
  void update_metrics();

  UdpmReceiver receiver_;
  std::vector<Route> routes_;  // by the receiver's channel number
  std::optional<Warning> buffer_warning_;
  SnapshotBroadcaster* broadcaster_;
  double start_;  // [s], steady clock
  double now_;
  BusMonitor monitor_;
  Metrics* metrics_ = nullptr;
  double next_metrics_ = 0.0;  // [s]
  std::int64_t snapshots_ = 0;
  bool receives_sea_;
  std::shared_ptr<const SeaPeriod> sea_;  // the received one that sea_text_ describes
  SnapshotBroadcaster::Text sea_text_;
  std::optional<RequestTime> surface_time_;  // of sea_text_, in a sea on grids
  double next_surface_ = 0.0;                // [s], when the page may get another one
};

}  // namespace buoyancy::view
