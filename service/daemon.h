// The live service: waits for questions on LCM, answers them through an Exchange, and says once a second how
// it fares. One thread; SIGINT and SIGTERM end it between two messages.
//
// Mode lockstep: every question is answered, in order of arrival. Mode latest: all that has arrived is looked
// at, then the newest question of the session that has waited longest is answered (see LatestQuestions), and
// so on: what arrives meanwhile still overtakes what waits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "exchange/exchange.h"
#include "geometry/error.h"
#include "messages/latency_histogram.h"
#include "scene/scene.h"
#include "service/latest_questions.h"
#include "service/other_instances.h"
#include "service/termination_signals.h"
#include "transport/lcm_connection.h"

namespace buoyancy {

enum class Mode { kLockstep, kLatest };
std::string_view name(Mode mode);  // "lockstep"

struct ChannelNames {
  std::string states{kStatesChannel};
  std::string wrenches{kWrenchesChannel};
  std::string hydrostatics{kHydrostaticsChannel};
  std::string status{kStatusChannel};
};

class Daemon {
 public:
  // scene must outlive the daemon. threads: as ExchangeOptions has it.
  Daemon(const Scene& scene, LcmConnection connection, Mode mode, ChannelNames channels, unsigned threads);
  Daemon(const Daemon&) = delete;
  Daemon& operator=(const Daemon&) = delete;

  // Answers until a signal comes; once. Errors: the connection ended.
  Expected<void> run(TerminationSignals& signals);

 private:
  Expected<void> receive();
  void take_in(Bytes question, double arrival);
  void answer_next_waiting();
  void answer(Bytes question, double arrival);
  bool publish(const std::string& channel, Bytes bytes);  // false: publish_error_ says why
  void report();

  Mode mode_;
  ChannelNames channels_;
  LcmConnection connection_;
  Exchange exchange_;
  LatestQuestions latest_;
  LatencyHistogram latency_;
  std::int64_t instance_id_;
  OtherInstances other_instances_;
  std::string publish_error_;  // the newest since the last report; empty: none
  Counters reported_;
  std::vector<std::uint8_t> status_bytes_;  // reused
};

}  // namespace buoyancy
