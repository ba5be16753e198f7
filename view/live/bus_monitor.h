// The state of the bus as an observer derives it from the messages: the latest pose and wrench of each body
// of the scene, response times, lost and malformed messages, and which services are present and responding.
//
// Input is bytes and times: the class uses neither LCM nor a clock. Memory is bounded whatever arrives, by
// the scene, by RequestTracker, by kMaxServices, by SeaTimeline, and by the largest message received.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/sea_timeline.h"
#include "messages/hydrostatics.h"
#include "messages/latency_histogram.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "messages/status.h"
#include "messages/wire.h"
#include "scene/scene.h"
#include "transport/udpm_receiver.h"
#include "view/common/condition_tracker.h"
#include "view/common/pose_tracker.h"
#include "view/live/request_tracker.h"

namespace buoyancy::view {

// The arrival time of a message on two clocks.
struct ArrivalTime {
  std::int64_t utime = 0;  // [us since 1970], as the kernel stamped it
  double now = 0.0;        // [s], monotonic
};

// The time for which a request was evaluated.
struct RequestTime {
  std::int64_t utime = 0;  // [us]
  double lead_time = 0.0;  // [s], finite

  bool operator==(const RequestTime&) const = default;
};

// The latest observations of one body.
struct BodyMonitor {
  struct Pose {
    std::array<double, 3> position;         // [m], W; finite
    std::array<double, 4> quaternion_wxyz;  // abs(norm - 1) <= 1e-3
  };
  struct Metacenters {
    std::array<std::array<double, 3>, 2> points;  // [m], W axes, relative to position; finite
    std::array<double, 2> heights;                // [m], GM; NaN: unknown
  };
  std::int32_t id = 0;
  std::optional<Pose> pose;             // the latest valid one; an invalid pose is ignored
  std::optional<double> last_request;   // [s], arrival of the latest request for it
  std::optional<double> last_response;  // [s], arrival of the latest wrench
  std::optional<BodyWrench> wrench;     // the latest, whatever its status
  bool force_torque_only = false;  // wrench came as six_axis_force_torque_t, its other fields are unknown
  std::optional<Metacenters> metacenters;
  std::optional<BodyLoads> loads;  // the latest, with status kOk; all its numbers but the matrices are finite

  // True if the wrench is too old to belong to the displayed pose.
  bool response_overdue(double timeout) const {
    return last_request && last_response && *last_response + timeout < *last_request;
  }
};

struct SecondStats {
  std::int64_t number = 0;  // counted from the start
  std::int64_t requests = 0, responses = 0, unanswered = 0;
  LatencyPercentiles latency;  // [s]; zeros if responses is 0
};

enum class ServiceState {
  kAnswering,     // responses arrive
  kIdle,          // status messages arrive, no request is pending for long
  kNotAnswering,  // status messages arrive, but requests get no response
  kOffline,       // neither responses nor status messages arrive
};
std::string_view to_string(ServiceState state);  // "not answering"

class BusMonitor {
 public:
  static constexpr std::size_t kMaxServices = 16;
  static constexpr std::size_t kSecondsKept = 60;
  static constexpr double kStatusTimeout = 3.0;    // [s]; a status is due every second
  static constexpr double kResponseTimeout = 1.0;  // [s]; an older request is overdue

  struct Counts {
    std::array<std::int64_t, 4> malformed{};  // by DecodeError
    DropCounts drops;
    std::int64_t bodies_not_in_scene = 0;  // bodies of requests
    std::int64_t statuses = 0;
    std::int64_t seas_rejected = 0;
    std::int64_t conditions_rejected = 0;
    std::int64_t services_started = 0;  // instance_ids that were not known yet, including the first
  };

  // scene must outlive the monitor.
  BusMonitor(const Scene& scene, double now, PoseChannels poses = {});

  void on_request(Bytes bytes, ArrivalTime arrival);
  void on_response(Bytes bytes, ArrivalTime arrival);
  // index: of the pose channel on which the pose arrived, or to whose force-torque channel the response
  // belongs.
  void on_pose(std::size_t index, Bytes bytes, ArrivalTime arrival);
  void on_force_torque(std::size_t index, Bytes bytes, ArrivalTime arrival);
  void on_hydrostatics(Bytes bytes);
  void on_loads(Bytes bytes);
  void on_status(Bytes bytes, double now);
  void on_sea(Bytes bytes);                    // of a scene that receives its sea
  void on_condition(Bytes bytes);              // of a scene with compartments or tanks
  void record_drops(const DropCounts& drops);  // totals since the start

  // Drops expired requests and closes a second that is over; to be called many times per second.
  void tick(double now);

  const std::vector<BodyMonitor>& bodies() const { return bodies_; }  // in the scene's order
  const Scene& scene() const { return *scene_; }
  const Counts& counts() const { return counts_; }
  const RequestTracker::Counts& tracker() const { return tracker_.counts(); }
  LatencyPercentiles latency() const { return latency_.percentiles(); }             // [s], since the start
  const std::deque<SecondStats>& seconds() const { return seconds_; }               // the latest last
  const std::optional<ServiceStatus>& status() const { return status_; }            // the latest
  std::optional<double> status_received() const { return status_received_; }        // [s]
  std::optional<double> response_received() const { return response_received_; }    // [s], of the latest
  std::optional<double> request_received() const { return request_received_; }      // [s], of the latest
  const std::optional<RequestTime>& request_time() const { return request_time_; }  // of the latest
  bool in_waves() const { return scene_->sea() != nullptr || scene_->receives_sea(); }
  // The sea of the latest request; nullptr: no request yet, or no sea has been received that holds at its
  // time.
  std::shared_ptr<const SeaPeriod> sea_period() const;
  // Was a condition of compartments or tanks received?
  bool has_conditions() const { return conditions_.has_received(); }
  // The condition of a body, by its index, at the time of the latest request. nullptr: it is unknown, or the
  // body has neither compartments nor tanks.
  std::shared_ptr<const BodyCondition> condition(std::size_t body) const;
  std::vector<std::int64_t> services(double now) const;  // instance_ids seen within kStatusTimeout
  ServiceState service_state(double now) const;

 private:
  struct Service {
    std::int64_t instance_id;
    double last_seen;
  };

  template <typename Message>
  bool decode_or_count(Bytes bytes, Message& message);
  void count_malformed(DecodeError error);
  BodyMonitor* find(std::int32_t id);
  void record_request(const WrenchRequest& request, ArrivalTime arrival, SeqPolicy policy);
  void record_response(const RequestId& id, ArrivalTime arrival);

  const Scene* scene_;
  SeaTimeline seas_;
  mutable ConditionTracker conditions_;  // caches the conditions that are requested
  PoseTracker poses_;
  std::vector<BodyMonitor> bodies_;
  RequestTracker tracker_;
  Counts counts_;
  LatencyHistogram latency_;
  LatencyHistogram latency_of_second_;
  RequestTracker::Counts counts_at_second_start_;
  double second_start_;
  std::int64_t second_number_ = 0;
  std::deque<SecondStats> seconds_;
  std::optional<ServiceStatus> status_;
  std::optional<double> status_received_, response_received_, request_received_;
  std::optional<RequestTime> request_time_;
  std::optional<double> waiting_since_;  // [s], arrival of the oldest request after the latest response
  std::vector<Service> services_;
  WrenchRequest request_;  // decode buffers, reused
  WrenchResponse response_;
  BodiesHydrostatics hydrostatics_;
  BodiesLoads loads_;
  ServiceStatus incoming_status_;
};

}  // namespace buoyancy::view
