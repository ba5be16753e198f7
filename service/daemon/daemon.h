// The live service: receives requests over LCM, has a RequestHandler compute the responses, and publishes its
// status once a second. It runs on one thread; SIGINT and SIGTERM stop it between two messages.
//
// A request that takes longer than kSlice is computed in slices (budgets.h). In between, in turn, messages
// are handled for a slice; signals, reloads, the watchdog and the status have their turn after each. A
// request whose session has another one in progress, or may need several slices, waits for its turn. When
// memory runs out, the message that needs it is lost.
//
// Requests for the water at points, on a channel of their own, are handled like those for wrenches.
//
// Poses of single bodies on channels of their own are requests too: each channel is a session. Those without
// velocities, of bodies with drag or added mass, are logged as a warning that says why they get no load.
//
// In waves, the sea of the scene is published when the scene is loaded and once a second. Where the scene
// says that waves are received, its sea is that of the messages on the same channel (SeaTimeline). Grids come
// on a channel of their own. Large ones are prepared by a GridPreparer; in mode lockstep, requests that
// arrive after a grid wait for it, so that they find the sea that was sent before them.
//
// In a scene with compartments or tanks, messages change their condition (ConditionTimeline).
//
// SIGHUP makes a SceneLoader read the scene file again while requests are handled with the current scene. The
// new scene replaces it between two messages; sessions, stored responses and counters are kept. A scene that
// cannot be used is logged as an error and changes nothing.
//
// Mode lockstep: every request is handled, in order of arrival. Mode latest: all messages that have arrived
// are read, then the newest request of the session that has waited longest is handled (LatestRequestQueue),
// and so on: a request that arrives meanwhile still supersedes a pending one of its session.
//
// With inject_faults(), a FaultySender sends the responses. While it is stalled, messages wait to be read;
// signals, reloads, the watchdog and the status go on.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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
#include "service/daemon/fault_injection.h"
#include "service/daemon/faulty_sender.h"
#include "service/daemon/grid_preparer.h"
#include "service/daemon/instance_monitor.h"
#include "service/daemon/latest_request_queue.h"
#include "service/daemon/rate_limited_log.h"
#include "service/daemon/scene_loader.h"
#include "service/daemon/systemd_notifier.h"
#include "service/daemon/waiting_requests.h"
#include "transport/lcm_connection.h"

namespace buoyancy::service {

std::string_view to_string(ServiceMode mode);  // "lockstep"

struct ChannelNames {
  std::string states{kStatesChannel};
  std::string wrenches{kWrenchesChannel};
  std::string hydrostatics{kHydrostaticsChannel};
  std::string loads{kLoadsChannel};
  std::string sea{kSeaChannel};
  std::string sea_grid{kSeaGridChannel};
  std::string condition{kConditionChannel};
  std::string water_points{kWaterPointsChannel};
  std::string water_samples{kWaterSamplesChannel};
  std::string status{kStatusChannel};
};

class Daemon {
 public:
  // scene must not be nullptr; a reload reads the file scene->name(). threads: see RequestHandlerOptions.
  // Starts a thread (SceneLoader): block signals before the construction.
  Daemon(std::unique_ptr<const Scene> scene, LcmConnection connection, ServiceMode mode,
         ChannelNames channels, PoseChannels poses, unsigned threads);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Makes the service misbehave on purpose, and logs a warning that says so. Call it before run().
  void inject_faults(const FaultOptions& options);

  // Handles requests until a termination signal arrives; call it once. reload: SIGHUP.
  // Errors: too few file descriptors for timers and signals, a failed subscription, or a failed poll(). A
  // message that cannot be sent is no error: it is counted and logged.
  Expected<void> run(TerminationSignals& termination, SignalFd& reload);

  // Is a scene being loaded? Then the destructor waits until the load has finished.
  bool is_loading() const { return loader_.is_loading(); }

 private:
  Expected<void> subscribe();
  Expected<void> subscribe_to_conditions();  // once, and if the scene has compartments or tanks
  Expected<void> subscribe_to_grids();       // once, and if the scene receives them
  void prepare_for_messages();  // of the scene: enlarges the receive buffer, and logs what cannot arrive
  void prepare_for_scene();     // that has been loaded again: its messages, its conditions, its sea
  // Handles messages: one, or as many as fit a slice of time in mode latest or if requests are in progress.
  void handle_messages(bool have_arrived);
  // Is there a request that takes several slices and can go on?
  bool has_work() const;
  // May the session's next request take a slice of time, for which quick requests would have to wait? That is
  // assumed of a session whose requests have not been timed yet, if there is room for it.
  bool may_take_long(const SessionKey& session) const;
  void work();  // for a slice. Precondition: has_work()
  void record_queue_delay();
  void on_request(RequestKind kind, Bytes request);  // kind: that of the channel
  void on_sea(Bytes message);
  void on_grid(Bytes message);
  void take_grids();  // that grids_ has prepared
  void warn_of_rejected_sea(const Error& error);
  void on_condition(Bytes message);
  void on_pose(std::size_t channel, Bytes pose);  // channel: an index into poses_.channels()
  void enqueue(Bytes request, double arrival);
  bool handle_next();  // the first request of latest_ that can be handled; false: there is none
  // may_wait: else a request that cannot be handled now is rejected.
  void handle(Bytes request, double arrival, bool may_wait);
  void wait(Bytes request, double arrival);
  void send_reply(double arrival);  // of the last request of handler_
  // Calls task(). If memory runs out, counts a message that was rejected for lack of memory.
  template <typename Task>
  void guard(const Task& task);
  // The channel of the last response from handler_, and its bytes in the message type of that channel.
  struct AddressedResponse {
    const std::string& channel;
    Bytes bytes;
  };
  AddressedResponse address(Bytes response);
  Reply copy_reply(Bytes response, double arrival);
  void publish_reply(const Reply& reply);
  bool publish(const std::string& channel, Bytes bytes);  // false: not sent, and added to warnings_
  void begin_reload();
  void end_reload();
  void publish_status_to_new_sessions();
  void publish_status();  // and the sea, and logs the warnings that are due
  void publish_sea();
  void warn_of_missing_velocities(double now);
  bool is_stalled() const;

  std::unique_ptr<const Scene> scene_;  // used by handler_
  SceneLoader loader_;
  ServiceMode mode_;
  ChannelNames channels_;
  LcmConnection connection_;
  bool receives_conditions_ = false;   // subscribed to
  std::optional<GridPreparer> grids_;  // nullopt: not subscribed to
  RequestHandler handler_;
  PoseRequestAdapter poses_;
  LatestRequestQueue latest_;
  WaitingRequests waiting_;  // mode lockstep
  struct Arrival {
    SessionKey session;
    double time = 0.0;
  };
  std::vector<Arrival> arrivals_;  // of the requests in progress
  LatencyHistogram latency_;
  double start_;  // [s], steady clock, like all times here
  std::int64_t instance_id_;
  std::int64_t scene_fingerprint_;
  std::int64_t reloads_ = 0;
  std::int64_t reloads_failed_ = 0;
  bool last_reload_failed_ = false;
  std::int64_t send_failures_ = 0;
  double last_status_ = 0.0;      // [s]
  bool has_new_session_ = false;  // since the last status
  double queue_delay_ = 0.0;      // [s], longest since the last status
  InstanceMonitor instances_;
  RateLimitedLog warnings_;
  RateLimitedLog details_;                       // for --log-level debug
  std::shared_ptr<const SeaPeriod> newest_sea_;  // the last received one that warnings_ has been told about
  SystemdNotifier systemd_;
  std::optional<FaultySender> faults_;  // nullopt: the service behaves
  ServiceCounters reported_;
  DropCounts reported_drops_;
  std::vector<std::int64_t> reported_without_velocities_;  // by pose channel
  BufferLimit receive_buffer_limit_;                       // for the largest request about the scene
  std::vector<std::uint8_t> status_bytes_;                 // reused
  std::vector<std::uint8_t> sea_bytes_;                    // of the scene's sea; empty: it has none
  WrenchResponse response_;                                // reused, for poses
  std::vector<std::uint8_t> force_torque_bytes_;           // reused
};

}  // namespace buoyancy::service
