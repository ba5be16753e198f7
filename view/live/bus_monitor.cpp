#include "view/live/bus_monitor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "messages/conversions.h"

namespace buoyancy {
namespace {

std::optional<BodyMonitor::Pose> pose_of(const BodyState& state) {
  constexpr double kMaxNormError = 1e-3;  // as the service has it
  if (!all_finite(state.position)) return std::nullopt;
  double norm = 0.0;
  for (const double part : state.quaternion_wxyz) norm = std::hypot(norm, part);
  if (!(std::abs(norm - 1.0) <= kMaxNormError)) return std::nullopt;
  return BodyMonitor::Pose{state.position, state.quaternion_wxyz};
}

}  // namespace

std::string_view to_string(ServiceState state) {
  switch (state) {
    case ServiceState::kAnswering:
      return "answering";
    case ServiceState::kWaiting:
      return "waiting";
    case ServiceState::kNotAnswering:
      return "not answering";
    case ServiceState::kOffline:
      return "silent";
  }
  return "unknown";
}

BusMonitor::BusMonitor(const Scene& scene, double now, PoseChannels poses)
    : scene_(&scene), poses_(std::move(poses)), second_begun_(now) {
  for (const Body& body : scene.bodies()) {
    BodyMonitor& watched = bodies_.emplace_back();
    watched.id = body.id;
  }
}

template <typename Message>
bool BusMonitor::decode_or_count(Bytes bytes, Message& message) {
  const std::optional<DecodeError> rejection = decode(bytes, message);
  if (rejection) count_malformed(*rejection);
  return !rejection;
}

void BusMonitor::count_malformed(DecodeError cause) {
  ++counts_.malformed[static_cast<std::size_t>(cause)];
}

BodyMonitor* BusMonitor::find(std::int32_t id) {
  const std::optional<std::size_t> index = scene_->index_of(id);
  return index ? &bodies_[*index] : nullptr;
}

void BusMonitor::on_request(Bytes bytes, ArrivalTime arrival) {
  if (decode_or_count(bytes, request_)) note_request(request_, arrival, RequestTracker::Seq::kConsecutive);
}

void BusMonitor::on_pose(std::size_t index, Bytes bytes, ArrivalTime arrival) {
  if (const auto request = poses_.request(index, bytes)) {
    note_request(*request, arrival, RequestTracker::Seq::kArbitrary);
  } else {
    count_malformed(request.error());
  }
}

void BusMonitor::note_request(const WrenchRequest& request, ArrivalTime arrival, RequestTracker::Seq seq) {
  tracker_.on_request(request.key, arrival.utime, arrival.now, seq);
  const bool asked_lately = request_received_ && *request_received_ + kStatusTimeout >= arrival.now;
  if (!waiting_since_ || !asked_lately) waiting_since_ = arrival.now;
  request_received_ = arrival.now;
  for (const BodyState& state : request.bodies) {
    BodyMonitor* const body = find(state.body_id);
    if (body == nullptr) {
      ++counts_.bodies_not_in_scene;
      continue;
    }
    body->asked = arrival.now;
    if (const auto pose = pose_of(state)) body->pose = pose;
  }
}

void BusMonitor::on_response(Bytes bytes, ArrivalTime arrival) {
  if (!decode_or_count(bytes, response_)) return;
  RequestId key = response_.key;
  if (response_.bodies.size() == 1 && !tracker_.remembers(key)) {
    key = poses_.request_id_for_pose(response_.bodies.front().body_id, key.utime).value_or(key);
  }
  note_response(key, arrival);
  for (const BodyWrench& wrench : response_.bodies) {
    BodyMonitor* const body = find(wrench.body_id);
    if (body == nullptr) continue;
    body->wrench = wrench;
    body->answered = arrival.now;
    body->force_torque_only = false;
  }
}

void BusMonitor::on_force_torque(std::size_t index, Bytes bytes, ArrivalTime arrival) {
  const auto heard = decode_six_axis_force_torque(bytes);
  if (!heard) return count_malformed(heard.error());
  const std::int32_t body_id = poses_.channels().channels[index].body_id;
  note_response(poses_.request_id_for_pose(body_id, heard->utime).value(), arrival);
  BodyMonitor* const body = find(body_id);
  if (body == nullptr) return;
  body->wrench = BodyWrench{.body_id = body_id, .force = heard->force, .torque = heard->torque};
  body->answered = arrival.now;
  body->force_torque_only = true;
}

void BusMonitor::note_response(const RequestId& key, ArrivalTime arrival) {
  response_received_ = arrival.now;
  waiting_since_.reset();
  if (const auto latency = tracker_.on_response(key, arrival.utime)) {
    latency_.add(*latency);
    latency_of_second_.add(*latency);
  }
}

void BusMonitor::on_hydrostatics(Bytes bytes) {
  if (!decode_or_count(bytes, hydrostatics_)) return;
  for (const BodyHydrostatics& heard : hydrostatics_.bodies) {
    BodyMonitor* const body = find(heard.body_id);
    if (body == nullptr) continue;
    body->metacenters.reset();
    if (heard.status != BodyStatus::kOk || !std::ranges::all_of(heard.metacenters, all_finite<3>)) continue;
    body->metacenters = BodyMonitor::Metacenters{heard.metacenters, heard.metacentric_heights};
  }
}

void BusMonitor::on_status(Bytes bytes, double now) {
  if (!decode_or_count(bytes, incoming_status_)) return;
  ++counts_.statuses;
  status_received_ = now;
  const std::int64_t id = incoming_status_.instance_id;
  if (status_) {
    std::swap(*status_, incoming_status_);
  } else {
    status_ = incoming_status_;
  }
  const auto known = std::ranges::find(services_, id, &Service::instance_id);
  if (known != services_.end()) {
    known->heard = now;
    return;
  }
  ++counts_.services_started;
  if (services_.size() == kMaxServices)
    services_.erase(std::ranges::min_element(services_, {}, &Service::heard));
  services_.push_back({id, now});
}

void BusMonitor::record_drops(const DropCounts& losses) {
  counts_.losses = losses;
}

void BusMonitor::tick(double now) {
  tracker_.expire(now);
  if (now < second_begun_ + 1.0) return;
  const RequestTracker::Counts& counted = tracker_.counts();
  seconds_.push_back({.number = second_number_++,
                      .requests = counted.requests - at_second_.requests,
                      .responses = counted.responses - at_second_.responses,
                      .unanswered = counted.unanswered - at_second_.unanswered,
                      .latency = latency_of_second_.percentiles()});
  if (seconds_.size() > kSecondsKept) seconds_.pop_front();
  latency_of_second_ = LatencyHistogram();
  at_second_ = counted;
  second_begun_ =
      now < second_begun_ + 2.0 ? second_begun_ + 1.0 : now;  // after a stop: not one per second missed
}

std::vector<std::int64_t> BusMonitor::services(double now) const {
  std::vector<std::int64_t> heard;
  for (const Service& service : services_) {
    if (service.heard + kStatusTimeout >= now) heard.push_back(service.instance_id);
  }
  return heard;
}

ServiceState BusMonitor::service_state(double now) const {
  const auto within = [now](std::optional<double> heard, double patience) {
    return heard && *heard + patience >= now;
  };
  if (within(response_received_, kResponseTimeout)) return ServiceState::kAnswering;
  if (!within(status_received_, kStatusTimeout)) return ServiceState::kOffline;
  const bool waits_too_long = waiting_since_ && *waiting_since_ + kResponseTimeout < now;
  return waits_too_long && within(request_received_, kStatusTimeout) ? ServiceState::kNotAnswering
                                                                     : ServiceState::kWaiting;
}

}  // namespace buoyancy
