// The live service: waits for requests on LCM, answers them through an RequestHandler, and says once a second
// how it fares. One thread; SIGINT and SIGTERM end it between two messages.
//
// Poses of single bodies, on channels of their own, are requests too: each channel is a session.
//
// SIGHUP: the scene file is read again, by a SceneLoader, while the scene at hand goes on answering. Between
// two messages the new one takes its place; sessions, repeats and counters do not notice. A scene that cannot
// be used is said in the log and changes nothing.
//
// Mode lockstep: every request is answered, in order of arrival. Mode latest: all that has arrived is looked
// at, then the newest request of the session that has waited longest is answered (see LatestRequestQueue),
// and so on: what arrives meanwhile still overtakes what waits.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/signal_fd.h"
#include "cli/termination_signals.h"
#include "engine/pose_request_adapter.h"
#include "engine/request_handler.h"
#include "messages/latency_histogram.h"
#include "scene/scene.h"
#include "service/daemon/instance_monitor.h"
#include "service/daemon/latest_request_queue.h"
#include "service/daemon/rate_limited_log.h"
#include "service/daemon/scene_loader.h"
#include "service/daemon/systemd_notifier.h"
#include "transport/lcm_connection.h"

namespace buoyancy {

std::string_view to_string(ServiceMode mode);  // "lockstep"

struct ChannelNames {
  std::string states{kStatesChannel};
  std::string wrenches{kWrenchesChannel};
  std::string hydrostatics{kHydrostaticsChannel};
  std::string status{kStatusChannel};
};

class Daemon {
 public:
  // scene: as loaded from the file that it is named after, which a reload reads again. Not nullptr. threads:
  // as RequestHandlerOptions has it. Starts a thread (SceneLoader): block signals before.
  Daemon(std::unique_ptr<const Scene> scene, LcmConnection connection, ServiceMode mode,
         ChannelNames channels, PoseChannels poses, unsigned threads);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Answers until a signal of termination comes; once. reload: SIGHUP. Errors: the connection ended.
  Expected<void> run(TerminationSignals& termination, SignalFd& reload);

  // Is a scene being loaded? The destructor waits for it then, as long as that takes.
  bool is_loading() const { return loader_.is_loading(); }

 private:
  Expected<void> subscribe();
  void receive();
  void record_queue_delay();
  void on_request(Bytes request);
  void on_pose(std::size_t channel, Bytes pose);  // channel: of poses_
  void take_in(Bytes request, double arrival);
  void response_next_waiting();
  void response(Bytes request, double arrival);
  bool publish_response(Bytes response);                  // that handler_ gave last
  bool publish(const std::string& channel, Bytes bytes);  // false: troubles_ says why
  void begin_reload();
  void end_reload();
  void report();

  std::unique_ptr<const Scene> scene_;  // that handler_ answers from
  SceneLoader loader_;
  ServiceMode mode_;
  ChannelNames channels_;
  LcmConnection connection_;
  RequestHandler handler_;
  PoseRequestAdapter poses_;
  LatestRequestQueue latest_;
  LatencyHistogram latency_;
  double start_;  // s, as all times here of the steady clock
  std::int64_t instance_id_;
  std::int64_t reloads_ = 0;
  std::int64_t reloads_failed_ = 0;
  bool last_reload_failed_ = false;
  std::int64_t send_failures_ = 0;
  double queue_delay_ = 0.0;  // s, the longest since the last report
  InstanceMonitor instances_;
  RateLimitedLog warnings_;
  SystemdNotifier systemd_;
  ServiceCounters reported_;
  DropCounts reported_losses_;
  std::vector<std::uint8_t> status_bytes_;        // reused
  WrenchResponse response_;                       // reused, of poses
  std::vector<std::uint8_t> force_torque_bytes_;  // reused
};

}  // namespace buoyancy
