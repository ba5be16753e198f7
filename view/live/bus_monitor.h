// What an onlooker makes of the messages on the bus: the newest pose and wrench of each body of the scene,
// how long answers take, what was lost or malformed, which services there are and whether they still answer.
//
// Hears bytes and times and knows neither LCM nor a clock. Memory is bounded whatever arrives: by the scene,
// by RequestTracker, by kMaxServices, and by the largest message that is heard.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string_view>
#include <vector>

#include "messages/hydrostatics.h"
#include "messages/latency_histogram.h"
#include "messages/request.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "transport/udpm_receiver.h"
#include "view/common/pose_tracker.h"
#include "view/live/request_tracker.h"

namespace buoyancy {

// When a message arrived, by two clocks: us since 1970 as the kernel stamped it, and s of a clock that never
// jumps.
struct ArrivalTime {
  std::int64_t utime = 0;
  double now = 0.0;
};

// The newest that was heard of one body.
struct BodyMonitor {
  struct Pose {
    std::array<double, 3> position;         // m, W; finite
    std::array<double, 4> quaternion_wxyz;  // its norm is within 1e-3 of 1
  };
  struct Metacenters {
    std::array<std::array<double, 3>, 2> points;  // m, W axes, relative to position; finite
    std::array<double, 2> heights;                // m, GM; NaN: not known
  };
  std::int32_t id = 0;
  std::optional<Pose> pose;          // the newest that could be one: a NaN moves nothing
  std::optional<double> asked;       // s, when the newest request about it came
  std::optional<double> answered;    // s, when the newest wrench came
  std::optional<BodyWrench> wrench;  // as answered, also where it is not OK
  bool force_torque_only = false;    // wrench: it came as six_axis_force_torque_t, the rest is unknown
  std::optional<Metacenters> metacenters;

  // Is the wrench too old to belong to the pose that is shown?
  bool response_overdue(double patience) const { return asked && answered && *answered + patience < *asked; }
};

struct SecondStats {
  std::int64_t number = 0;  // counted from the start
  std::int64_t requests = 0, responses = 0, unanswered = 0;
  LatencyPercentiles latency;  // s; zeros where no request was answered
};

enum class ServiceState {
  kAnswering,     // requests and answers
  kWaiting,       // there is a service, and nobody asks
  kNotAnswering,  // there is a service, and requests stay without a response
  kOffline,       // nothing is heard of a service
};
std::string_view to_string(ServiceState state);  // "not answering"

class BusMonitor {
 public:
  static constexpr std::size_t kMaxServices = 16;
  static constexpr std::size_t kSecondsKept = 60;
  static constexpr double kStatusTimeout = 3.0;  // s; a status is due every second
  static constexpr double kResponseTimeout =
      1.0;  // s; without a response for so long, a request waits too long

  struct Counts {
    std::array<std::int64_t, 4> malformed{};  // by DecodeError
    DropCounts losses;
    std::int64_t bodies_not_in_scene = 0;  // asked about
    std::int64_t statuses = 0;
    std::int64_t services_started = 0;  // another instance_id than those known; the first one too
  };

  // scene must live as long.
  BusMonitor(const Scene& scene, double now, PoseChannels poses = {});

  void on_request(Bytes bytes, ArrivalTime arrival);
  void on_response(Bytes bytes, ArrivalTime arrival);
  // On the pose channel of this index; on its channel for force and torque.
  void on_pose(std::size_t index, Bytes bytes, ArrivalTime arrival);
  void on_force_torque(std::size_t index, Bytes bytes, ArrivalTime arrival);
  void on_hydrostatics(Bytes bytes);
  void on_status(Bytes bytes, double now);
  void record_drops(const DropCounts& losses);  // so far

  // To be called many times a second: gives up what waited too long, closes a second that is over.
  void tick(double now);

  const std::vector<BodyMonitor>& bodies() const { return bodies_; }  // in the scene's order
  const Counts& counts() const { return counts_; }
  const RequestTracker::Counts& tracker() const { return tracker_.counts(); }
  LatencyPercentiles latency() const { return latency_.percentiles(); }           // s, since the start
  const std::deque<SecondStats>& seconds() const { return seconds_; }             // the newest last
  const std::optional<ServiceStatus>& status() const { return status_; }          // the newest
  std::optional<double> status_received() const { return status_received_; }      // s
  std::optional<double> response_received() const { return response_received_; }  // s, of the newest
  std::optional<double> request_received() const { return request_received_; }    // s, of the newest
  std::vector<std::int64_t> services(double now) const;  // instance_ids heard within kStatusTimeout
  ServiceState service_state(double now) const;

 private:
  struct Service {
    std::int64_t instance_id;
    double heard;
  };

  template <typename Message>
  bool decode_or_count(Bytes bytes, Message& message);
  void count_malformed(DecodeError cause);
  BodyMonitor* find(std::int32_t id);
  void note_request(const WrenchRequest& request, ArrivalTime arrival, RequestTracker::Seq seq);
  void note_response(const RequestId& key, ArrivalTime arrival);

  const Scene* scene_;
  PoseTracker poses_;
  std::vector<BodyMonitor> bodies_;
  RequestTracker tracker_;
  Counts counts_;
  LatencyHistogram latency_;
  LatencyHistogram latency_of_second_;
  RequestTracker::Counts at_second_;  // as counted when the second began
  double second_begun_;
  std::int64_t second_number_ = 0;
  std::deque<SecondStats> seconds_;
  std::optional<ServiceStatus> status_;
  std::optional<double> status_received_, response_received_, request_received_;
  std::optional<double> waiting_since_;  // s, of the oldest request after the newest response
  std::vector<Service> services_;
  WrenchRequest request_;  // reused, as the next three
  WrenchResponse response_;
  BodiesHydrostatics hydrostatics_;
  ServiceStatus incoming_status_;
};

}  // namespace buoyancy
