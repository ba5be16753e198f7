#include "view/live/bus_monitor.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "messages/conversions.h"

namespace buoyancy {
namespace {

std::optional<WatchedBody::Pose> pose_of(const BodyState& state) {
  constexpr double kMostNormError = 1e-3;  // as the service has it
  if (!all_finite(state.position)) return std::nullopt;
  double norm = 0.0;
  for (const double part : state.quaternion_wxyz) norm = std::hypot(norm, part);
  if (!(std::abs(norm - 1.0) <= kMostNormError)) return std::nullopt;
  return WatchedBody::Pose{state.position, state.quaternion_wxyz};
}

}  // namespace

std::string_view name(ServiceState state) {
  switch (state) {
    case ServiceState::kAnswering:
      return "answering";
    case ServiceState::kWaiting:
      return "waiting";
    case ServiceState::kNotAnswering:
      return "not answering";
    case ServiceState::kSilent:
      return "silent";
  }
  return "unknown";
}

BusWatch::BusWatch(const Scene& scene, double now, PoseChannels poses)
    : scene_(&scene), poses_(std::move(poses)), second_begun_(now) {
  for (const Body& body : scene.bodies()) {
    WatchedBody& watched = bodies_.emplace_back();
    watched.id = body.id;
  }
}

template <typename Message>
bool BusWatch::take(Bytes bytes, Message& message) {
  const std::optional<Rejection> rejection = decode(bytes, message);
  if (rejection) count_malformed(*rejection);
  return !rejection;
}

void BusWatch::count_malformed(Rejection cause) {
  ++counts_.malformed[static_cast<std::size_t>(cause)];
}

WatchedBody* BusWatch::find(std::int32_t id) {
  const std::optional<std::size_t> index = scene_->index_of(id);
  return index ? &bodies_[*index] : nullptr;
}

void BusWatch::hear_question(Bytes bytes, HeardAt arrival) {
  if (take(bytes, question_)) note_question(question_, arrival, QuestionLedger::Seq::kCounted);
}

void BusWatch::hear_pose(std::size_t index, Bytes bytes, HeardAt arrival) {
  if (const auto question = poses_.question(index, bytes)) {
    note_question(*question, arrival, QuestionLedger::Seq::kAnyNumber);
  } else {
    count_malformed(question.error());
  }
}

void BusWatch::note_question(const Question& question, HeardAt arrival, QuestionLedger::Seq seq) {
  ledger_.hear_question(question.key, arrival.utime, arrival.now, seq);
  const bool asked_lately = question_heard_ && *question_heard_ + kStatusPatience >= arrival.now;
  if (!waiting_since_ || !asked_lately) waiting_since_ = arrival.now;
  question_heard_ = arrival.now;
  for (const BodyState& state : question.bodies) {
    WatchedBody* const body = find(state.body_id);
    if (body == nullptr) {
      ++counts_.bodies_not_in_scene;
      continue;
    }
    body->asked = arrival.now;
    if (const auto pose = pose_of(state)) body->pose = pose;
  }
}

void BusWatch::hear_answer(Bytes bytes, HeardAt arrival) {
  if (!take(bytes, answer_)) return;
  QuestionKey key = answer_.key;
  if (answer_.bodies.size() == 1 && !ledger_.remembers(key)) {
    key = poses_.asked_by_pose(answer_.bodies.front().body_id, key.utime).value_or(key);
  }
  note_answer(key, arrival);
  for (const BodyWrench& wrench : answer_.bodies) {
    WatchedBody* const body = find(wrench.body_id);
    if (body == nullptr) continue;
    body->wrench = wrench;
    body->answered = arrival.now;
    body->says_force_and_torque_alone = false;
  }
}

void BusWatch::hear_force_torque(std::size_t index, Bytes bytes, HeardAt arrival) {
  const auto heard = decode_six_axis_force_torque(bytes);
  if (!heard) return count_malformed(heard.error());
  const std::int32_t body_id = poses_.asked_on().channels[index].body_id;
  note_answer(poses_.asked_by_pose(body_id, heard->utime).value(), arrival);
  WatchedBody* const body = find(body_id);
  if (body == nullptr) return;
  body->wrench = BodyWrench{.body_id = body_id, .force = heard->force, .torque = heard->torque};
  body->answered = arrival.now;
  body->says_force_and_torque_alone = true;
}

void BusWatch::note_answer(const QuestionKey& key, HeardAt arrival) {
  answer_heard_ = arrival.now;
  waiting_since_.reset();
  if (const auto latency = ledger_.hear_answer(key, arrival.utime)) {
    latency_.add(*latency);
    latency_of_second_.add(*latency);
  }
}

void BusWatch::hear_hydrostatics(Bytes bytes) {
  if (!take(bytes, hydrostatics_)) return;
  for (const BodyHydrostatics& heard : hydrostatics_.bodies) {
    WatchedBody* const body = find(heard.body_id);
    if (body == nullptr) continue;
    body->metacenters.reset();
    if (heard.status != BodyStatus::kOk || !std::ranges::all_of(heard.metacenters, all_finite<3>)) continue;
    body->metacenters = WatchedBody::Metacenters{heard.metacenters, heard.metacentric_heights};
  }
}

void BusWatch::hear_status(Bytes bytes, double now) {
  if (!take(bytes, incoming_status_)) return;
  ++counts_.statuses;
  status_heard_ = now;
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
  if (services_.size() == kMostServices)
    services_.erase(std::ranges::min_element(services_, {}, &Service::heard));
  services_.push_back({id, now});
}

void BusWatch::note_losses(const ReceiveLosses& losses) {
  counts_.losses = losses;
}

void BusWatch::pass_time(double now) {
  ledger_.give_up_old(now);
  if (now < second_begun_ + 1.0) return;
  const QuestionLedger::Counts& counted = ledger_.counts();
  seconds_.push_back({.number = second_number_++,
                      .questions = counted.questions - at_second_.questions,
                      .answers = counted.answers - at_second_.answers,
                      .unanswered = counted.unanswered - at_second_.unanswered,
                      .latency = latency_of_second_.percentiles()});
  if (seconds_.size() > kSecondsKept) seconds_.pop_front();
  latency_of_second_ = LatencyHistogram();
  at_second_ = counted;
  second_begun_ =
      now < second_begun_ + 2.0 ? second_begun_ + 1.0 : now;  // after a stop: not one per second missed
}

std::vector<std::int64_t> BusWatch::services(double now) const {
  std::vector<std::int64_t> heard;
  for (const Service& service : services_) {
    if (service.heard + kStatusPatience >= now) heard.push_back(service.instance_id);
  }
  return heard;
}

ServiceState BusWatch::service_state(double now) const {
  const auto within = [now](std::optional<double> heard, double patience) {
    return heard && *heard + patience >= now;
  };
  if (within(answer_heard_, kAnswerPatience)) return ServiceState::kAnswering;
  if (!within(status_heard_, kStatusPatience)) return ServiceState::kSilent;
  const bool waits_too_long = waiting_since_ && *waiting_since_ + kAnswerPatience < now;
  return waits_too_long && within(question_heard_, kStatusPatience) ? ServiceState::kNotAnswering
                                                                    : ServiceState::kWaiting;
}

}  // namespace buoyancy
