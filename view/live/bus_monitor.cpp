#include "view/live/bus_monitor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/body_evaluation.h"
#include "messages/conversions.h"

namespace buoyancy::view {
namespace {

std::optional<BodyMonitor::Pose> valid_pose(const BodyState& state) {
  if (validate_pose(state, 0.0).status != BodyStatus::kOk) return std::nullopt;
  return BodyMonitor::Pose{state.position, state.quaternion_wxyz};
}

bool has_finite_parts(const BodyLoads& loads) {
  return std::isfinite(loads.immersion) &&
         std::ranges::all_of(
             std::array{loads.buoyancy_force, loads.buoyancy_torque, loads.drag_force, loads.drag_torque,
                        loads.added_mass_force, loads.added_mass_torque, loads.water_velocity},
             all_finite<3>);
}

}  // namespace

std::string_view to_string(ServiceState state) {
  switch (state) {
    case ServiceState::kAnswering:
      return "answering";
    case ServiceState::kIdle:
      return "idle";
    case ServiceState::kNotAnswering:
      return "not answering";
    case ServiceState::kOffline:
      return "offline";
  }
  return "unknown";
}

BusMonitor::BusMonitor(const Scene& scene, double now, PoseChannels poses)
    : scene_(&scene), seas_(scene), conditions_(scene), poses_(std::move(poses)), second_start_(now) {
  for (const Body& body : scene.bodies()) {
    bodies_.emplace_back().id = body.id;
  }
}

template <typename Message>
bool BusMonitor::decode_or_count(Bytes bytes, Message& message) {
  const std::optional<DecodeError> error = decode(bytes, message);
  if (error) count_malformed(*error);
  return !error;
}

void BusMonitor::count_malformed(DecodeError error) {
  ++counts_.malformed[static_cast<std::size_t>(error)];
}

BodyMonitor* BusMonitor::find(std::int32_t id) {
  const std::optional<std::size_t> index = scene_->index_of(id);
  return index ? &bodies_[*index] : nullptr;
}

void BusMonitor::on_request(Bytes bytes, ArrivalTime arrival) {
  if (decode_or_count(bytes, request_)) record_request(request_, arrival, SeqPolicy::kConsecutive);
}

void BusMonitor::on_pose(std::size_t index, Bytes bytes, ArrivalTime arrival) {
  if (const auto request = poses_.request(index, bytes)) {
    record_request(*request, arrival, SeqPolicy::kArbitrary);
  } else {
    count_malformed(request.error());
  }
}

void BusMonitor::record_request(const WrenchRequest& request, ArrivalTime arrival, SeqPolicy policy) {
  tracker_.on_request(request.id, arrival.utime, arrival.now, policy);
  const bool requested_recently = request_received_ && *request_received_ + kStatusTimeout >= arrival.now;
  if (!waiting_since_ || !requested_recently) waiting_since_ = arrival.now;
  request_received_ = arrival.now;
  request_time_ = {request.id.utime, std::isfinite(request.lead_time) ? request.lead_time : 0.0};
  for (const BodyState& state : request.bodies) {
    BodyMonitor* const body = find(state.body_id);
    if (body == nullptr) {
      ++counts_.bodies_not_in_scene;
      continue;
    }
    body->last_request = arrival.now;
    if (const auto pose = valid_pose(state)) body->pose = pose;
  }
}

void BusMonitor::on_response(Bytes bytes, ArrivalTime arrival) {
  if (!decode_or_count(bytes, response_)) return;
  RequestId id = response_.id;
  if (response_.bodies.size() == 1 && !tracker_.contains(id)) {
    id = poses_.request_id_for_pose(response_.bodies.front().body_id, id.utime).value_or(id);
  }
  record_response(id, arrival);
  for (const BodyWrench& wrench : response_.bodies) {
    BodyMonitor* const body = find(wrench.body_id);
    if (body == nullptr) continue;
    body->wrench = wrench;
    body->last_response = arrival.now;
    body->force_torque_only = false;
  }
}

void BusMonitor::on_force_torque(std::size_t index, Bytes bytes, ArrivalTime arrival) {
  const auto message = decode_six_axis_force_torque(bytes);
  if (!message) return count_malformed(message.error());
  const std::int32_t body_id = poses_.channels().channels[index].body_id;
  record_response(poses_.request_id_for_pose(body_id, message->utime).value(), arrival);
  BodyMonitor* const body = find(body_id);
  if (body == nullptr) return;
  body->wrench = BodyWrench{.body_id = body_id, .force = message->force, .torque = message->torque};
  body->last_response = arrival.now;
  body->force_torque_only = true;
}

void BusMonitor::record_response(const RequestId& id, ArrivalTime arrival) {
  response_received_ = arrival.now;
  waiting_since_.reset();
  if (const auto latency = tracker_.on_response(id, arrival.utime)) {
    latency_.add(*latency);
    latency_of_second_.add(*latency);
  }
}

void BusMonitor::on_hydrostatics(Bytes bytes) {
  if (!decode_or_count(bytes, hydrostatics_)) return;
  for (const BodyHydrostatics& observed : hydrostatics_.bodies) {
    BodyMonitor* const body = find(observed.body_id);
    if (body == nullptr) continue;
    body->metacenters.reset();
    if (observed.status != BodyStatus::kOk || !std::ranges::all_of(observed.metacenters, all_finite<3>))
      continue;
    body->metacenters = BodyMonitor::Metacenters{observed.metacenters, observed.metacentric_heights};
  }
}

void BusMonitor::on_loads(Bytes bytes) {
  if (!decode_or_count(bytes, loads_)) return;
  for (const BodyLoads& observed : loads_.bodies) {
    BodyMonitor* const body = find(observed.body_id);
    if (body == nullptr) continue;
    body->loads.reset();
    if (observed.status == BodyStatus::kOk && has_finite_parts(observed)) body->loads = observed;
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
    known->last_seen = now;
    return;
  }
  ++counts_.services_started;
  if (services_.size() == kMaxServices)
    services_.erase(std::ranges::min_element(services_, {}, &Service::last_seen));
  services_.push_back({id, now});
}

void BusMonitor::on_sea(Bytes bytes) {
  if (!seas_.receive(bytes, *scene_)) ++counts_.seas_rejected;
}

void BusMonitor::on_condition(Bytes bytes) {
  if (!conditions_.receive(bytes)) ++counts_.conditions_rejected;
}

std::shared_ptr<const BodyCondition> BusMonitor::condition(std::size_t body) const {
  return request_time_ ? conditions_.at(body, request_time_->utime) : nullptr;
}

std::shared_ptr<const SeaPeriod> BusMonitor::sea_period() const {
  const std::shared_ptr<const SeaPeriod>* period =
      request_time_ ? seas_.at(request_time_->utime, request_time_->lead_time) : nullptr;
  return period == nullptr ? nullptr : *period;
}

void BusMonitor::record_drops(const DropCounts& drops) {
  counts_.drops = drops;
}

void BusMonitor::tick(double now) {
  tracker_.expire(now);
  if (now < second_start_ + 1.0) return;
  const RequestTracker::Counts& counted = tracker_.counts();
  seconds_.push_back({.number = second_number_++,
                      .requests = counted.requests - counts_at_second_start_.requests,
                      .responses = counted.responses - counts_at_second_start_.responses,
                      .unanswered = counted.unanswered - counts_at_second_start_.unanswered,
                      .latency = latency_of_second_.percentiles()});
  if (seconds_.size() > kSecondsKept) seconds_.pop_front();
  latency_of_second_ = LatencyHistogram();
  counts_at_second_start_ = counted;
  // Seconds that were missed while the process was paused are skipped.
  second_start_ = now < second_start_ + 2.0 ? second_start_ + 1.0 : now;
}

std::vector<std::int64_t> BusMonitor::services(double now) const {
  std::vector<std::int64_t> present;
  for (const Service& service : services_) {
    if (service.last_seen + kStatusTimeout >= now) present.push_back(service.instance_id);
  }
  return present;
}

ServiceState BusMonitor::service_state(double now) const {
  const auto within = [now](std::optional<double> received, double timeout) {
    return received && *received + timeout >= now;
  };
  if (within(response_received_, kResponseTimeout)) return ServiceState::kAnswering;
  if (!within(status_received_, kStatusTimeout)) return ServiceState::kOffline;
  const bool is_overdue = waiting_since_ && *waiting_since_ + kResponseTimeout < now;
  return is_overdue && within(request_received_, kStatusTimeout) ? ServiceState::kNotAnswering
                                                                 : ServiceState::kIdle;
}

}  // namespace buoyancy::view
