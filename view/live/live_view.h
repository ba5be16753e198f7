// Listens on the bus and lays down snapshots for the page, kSnapshotsPerSecond times a second, as long as
// somebody looks: one thread.
//
// It must not slow down what it looks at: messages do not wake it (UdpmReceiver), and it runs where a
// processor has nothing better to do (use_idle_scheduling()). A machine that never has, shows fewer
// snapshots, and packets that the kernel had to drop.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cli/termination_signals.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "transport/udpm_receiver.h"
#include "view/live/bus_monitor.h"
#include "view/live/snapshot_broadcaster.h"

namespace buoyancy {

struct WatchedChannels {
  std::string states{kStatesChannel};
  std::string wrenches{kWrenchesChannel};
  std::string hydrostatics{kHydrostaticsChannel};
  std::string status{kStatusChannel};
  PoseChannels poses;
};

// This thread, and those that it starts from here on, run only while a processor would otherwise be idle.
void use_idle_scheduling();

class LiveView {
 public:
  static constexpr double kSnapshotsPerSecond = 30.0;

  // scene and hub must live as long. Listens from here on. Errors: as UdpmReceiver::open, and two channels of
  // one name.
  static Expected<LiveView> open(const Scene& scene, const std::string& lcm_url,
                                 const WatchedChannels& channels, SnapshotBroadcaster& hub);

  // Until a signal of termination comes or keep_running says no; once.
  void run(const TerminationSignals& termination, const std::function<bool()>& keep_running);

 private:
  // What a channel of the receiver carries.
  enum class MessageKind { kRequests, kResponses, kHydrostatics, kStatus, kPoses, kForceTorques };
  struct Route {
    MessageKind carries;
    std::size_t index = 0;  // of the pose channel
  };

  LiveView(const Scene& scene, UdpmReceiver receiver, std::vector<Route> routes, PoseChannels poses,
           SnapshotBroadcaster& hub);
  void take_in();
  void hear(const Route& route, Bytes bytes, ArrivalTime arrival);
  void publish();

  UdpmReceiver receiver_;
  std::vector<Route> routes_;  // by the receiver's number of the channel
  SnapshotBroadcaster* hub_;
  double start_;  // s, of the steady clock
  double now_;
  BusMonitor watch_;
  std::int64_t snapshots_ = 0;
};

}  // namespace buoyancy
