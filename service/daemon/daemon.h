// The live service: waits for questions on LCM, answers them through an Exchange, and says once a second how
// it fares. One thread; SIGINT and SIGTERM end it between two messages.
//
// Poses of single bodies, on channels of their own, are questions too: each channel is a session.
//
// SIGHUP: the scene file is read again, by a SceneLoader, while the scene at hand goes on answering. Between
// two messages the new one takes its place; sessions, repeats and counters do not notice. A scene that cannot
// be used is said in the log and changes nothing.
//
// Mode lockstep: every question is answered, in order of arrival. Mode latest: all that has arrived is looked
// at, then the newest question of the session that has waited longest is answered (see LatestQuestions), and
// so on: what arrives meanwhile still overtakes what waits.
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

std::string_view name(Mode mode);  // "lockstep"

struct ChannelNames {
  std::string states{kStatesChannel};
  std::string wrenches{kWrenchesChannel};
  std::string hydrostatics{kHydrostaticsChannel};
  std::string status{kStatusChannel};
};

class Daemon {
 public:
  // scene: as loaded from the file that it is named after, which a reload reads again. Not nullptr. threads:
  // as ExchangeOptions has it. Starts a thread (SceneLoader): block signals before.
  Daemon(std::unique_ptr<const Scene> scene, LcmConnection connection, Mode mode, ChannelNames channels,
         PoseChannels poses, unsigned threads);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Answers until a signal of termination comes; once. reload: SIGHUP. Errors: the connection ended.
  Expected<void> run(TerminationSignals& termination, BlockedSignals& reload);

  // Is a scene being loaded? The destructor waits for it then, as long as that takes.
  bool loading() const { return loader_.busy(); }

 private:
  Expected<void> subscribe();
  void receive();
  void note_queue_wait();
  void hear_question(Bytes question);
  void hear_pose(std::size_t channel, Bytes pose);  // channel: of poses_
  void take_in(Bytes question, double arrival);
  void answer_next_waiting();
  void answer(Bytes question, double arrival);
  bool publish_answer(Bytes answer);                      // that exchange_ gave last
  bool publish(const std::string& channel, Bytes bytes);  // false: troubles_ says why
  void begin_reload();
  void end_reload();
  void report();

  std::unique_ptr<const Scene> scene_;  // that exchange_ answers from
  SceneLoader loader_;
  Mode mode_;
  ChannelNames channels_;
  LcmConnection connection_;
  Exchange exchange_;
  PoseQuestions poses_;
  LatestQuestions latest_;
  LatencyHistogram latency_;
  double start_;  // s, as all times here of the steady clock
  std::int64_t instance_id_;
  std::int64_t reloads_ = 0;
  std::int64_t reloads_failed_ = 0;
  bool last_reload_failed_ = false;
  std::int64_t not_sent_ = 0;
  double queue_wait_ = 0.0;  // s, the longest since the last report
  OtherInstances other_instances_;
  TroubleLog troubles_;
  ServiceManager manager_;
  Counters reported_;
  ReceiveLosses reported_losses_;
  std::vector<std::uint8_t> status_bytes_;        // reused
  Answer answer_;                                 // reused, of poses
  std::vector<std::uint8_t> force_torque_bytes_;  // reused
};

}  // namespace buoyancy
