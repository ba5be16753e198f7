#include "engine/request_handler.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <new>
#include <numeric>
#include <span>
#include <utility>

#include "engine/body_evaluation.h"
#include "engine/water_points.h"
#include "messages/wire_views.h"

namespace buoyancy {
namespace {

bool same_bytes(Bytes a, Bytes b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0;
}

constexpr std::size_t kMaxFindings = 16;

std::int64_t failed_bodies(const ServiceCounters& counters) {
  return std::accumulate(counters.bodies.begin(), counters.bodies.end(), std::int64_t{0}) -
         counters.bodies[static_cast<std::size_t>(BodyStatus::kOk)];
}

// The cache has one entry per body if any body has the hydrostatics output.
std::size_t hydrostatics_cache_size(const Scene& scene) {
  return scene.bodies_with_hydrostatics() > 0 ? scene.bodies().size() : 0;
}

}  // namespace

RequestHandler::RequestHandler(const Scene& scene, const RequestHandlerOptions& options)
    : scene_(&scene),
      max_sessions_(options.max_sessions),
      budgets_(options.budgets),
      checks_motion_(options.checks_motion),
      evaluator_(scene, options.threads),
      water_(scene),
      conditions_(scene),
      cached_hydrostatics_(hydrostatics_cache_size(scene)) {
  assert(max_sessions_ >= 1);
  sessions_.reserve(max_sessions_);
  in_progress_.reserve(kMaxInProgress);
  findings_.reserve(kMaxFindings);
}

void RequestHandler::set_scene(const Scene& scene) {
  // What allocates memory comes first: if it fails, nothing has changed.
  ConditionTimeline conditions = conditions_.for_scene(*scene_, scene);
  SeaTimeline seas(scene);
  std::vector<CachedHydrostatics> cached_hydrostatics(hydrostatics_cache_size(scene));
  evaluator_.set_scene(scene);
  water_.set_scene(scene, std::move(seas));
  conditions_ = std::move(conditions);
  applied_conditions_.reset();
  scene_ = &scene;
  cached_hydrostatics_ = std::move(cached_hydrostatics);
  ++changes_;
}

RequestHandler::Step RequestHandler::begin(Bytes bytes, Deadline deadline) {
  ++counters_.requests;
  last_session_.reset();
  const auto header = peek_request(bytes);
  if (!header) {
    count_decode_error(header.error());
    return Step::kRejected;
  }
  const bool has_bodies = header->kind == RequestKind::kBodies;
  const std::size_t scene_bodies = scene_->bodies().size();
  if (has_bodies && header->size > scene_bodies && header->size - scene_bodies > budgets_.extra_bodies) {
    ++counters_.rejected_bodies;
    return Step::kRejected;
  }
  if (!has_bodies && water_samples_size(header->size) > budgets_.message_bytes) {
    ++counters_.rejected_points;
    return Step::kRejected;
  }

  const RequestId& id = header->id;
  const auto known = std::ranges::find(sessions_, header->session(), &Session::key);
  const bool is_new = known == sessions_.end();
  if (!is_new && is_retry(*known, *header, bytes)) {
    ++counters_.retries;
    known->last_use = ++use_;
    if (known->work.in_progress) return Step::kStarted;
    last_session_ = static_cast<std::size_t>(known - sessions_.begin());
    return Step::kAnswered;
  }
  Session* const found = is_new ? start_session(*header) : &*known;
  if (found == nullptr || found->work.in_progress) {
    --counters_.requests;
    return Step::kBusy;
  }
  Session& session = *found;
  session.last_use = ++use_;
  const auto index = static_cast<std::size_t>(&session - sessions_.data());
  const bool conflicts =
      !session.last_request.empty() && id.seq == session.last_seq && !same_bytes(session.last_request, bytes);
  if (checks_motion_ && has_bodies) check_motion(session, RequestView::of(bytes).value());
  return finish(index, [&] {
    bool has_room = begin_work(*header, bytes, session);
    const WaterAtTime::Change now = water_.move_to(id.utime, header->lead_time);
    const bool complete = has_room && advance(bytes, session, now, deadline);
    session.lacks_sea = now.water.at_rest == nullptr;
    if (!complete && in_progress_.size() == kMaxInProgress) has_room = false;
    if (!has_room) {
      session.pace = Pace::kSeveralSlices;
      discard_reply(session);
      --counters_.requests;
      return Step::kBusy;
    }
    // The request is stored only when its response is complete or in progress. Otherwise, if memory ran out
    // in between, a retry of the previous request would get parts of the new response.
    session.last_request.assign(bytes.begin(), bytes.end());
    if (conflicts) ++counters_.conflicting_retries;
    if (!is_new && id.seq < session.newest_seq) ++counters_.stale;
    session.last_seq = id.seq;
    session.newest_seq = std::max(session.newest_seq, id.seq);
    update_retained(session);
    session.pace = complete ? Pace::kOneSlice : Pace::kSeveralSlices;
    if (!complete) {
      ++counters_.requests_sliced;
      session.work.in_progress = true;
      session.work.sea = water_.sea_at(id.utime, header->lead_time);
      in_progress_.push_back(index);
      return Step::kStarted;
    }
    return Step::kAnswered;
  });
}

template <typename Task>
RequestHandler::Step RequestHandler::finish(std::size_t index, const Task& task) {
  Step step = Step::kRejected;
  try {
    step = task();
  } catch (const std::bad_alloc&) {
    discard_reply(sessions_[index]);
    ++counters_.rejected_memory;
  }
  if (step == Step::kAnswered) {
    ++counters_.computed;
    last_session_ = index;
  }
  return step;
}

RequestHandler::Step RequestHandler::resume(Deadline deadline) {
  assert(!in_progress_.empty());
  last_session_.reset();
  const std::size_t index = in_progress_.front();
  in_progress_.erase(in_progress_.begin());
  Session& session = sessions_[index];
  Work& work = session.work;
  const RequestHeader header = peek_request(session.last_request).value();
  const RequestId& id = header.id;
  const auto start = std::chrono::steady_clock::now();
  return finish(index, [&] {
    bool has_room = true;
    WaterAtTime::Change now;
    if (work.changes != changes_) {
      has_room = begin_work(header, session.last_request, session);
      now = water_.move_to(id.utime, header.lead_time);
      work.sea = water_.sea_at(id.utime, header.lead_time);
      session.lacks_sea = now.water.at_rest == nullptr;
    } else if (work.sea != nullptr) {
      now = water_.move_to(work.sea, id.utime, header.lead_time);
    }
    const bool complete = has_room && advance(session.last_request, session, now, deadline);
    update_retained(session);
    work.spent += std::chrono::steady_clock::now() - start;
    if (!complete && has_room && work.spent <= budgets_.computing) {
      in_progress_.push_back(index);
      return Step::kStarted;
    }
    work.in_progress = false;
    work.sea = nullptr;
    if (!complete) {
      discard_reply(session);
      ++(has_room ? counters_.rejected_work : counters_.rejected_busy);
      return Step::kRejected;
    }
    return Step::kAnswered;
  });
}

RequestHandler::Pace RequestHandler::pace_of(const SessionKey& session) const {
  const auto known = std::ranges::find(sessions_, session, &Session::key);
  return known == sessions_.end() ? Pace::kUnknown : known->pace;
}

bool RequestHandler::is_retry(const SessionKey& session, Bytes request) const {
  const auto known = std::ranges::find(sessions_, session, &Session::key);
  const auto header = peek_request(request);
  return known != sessions_.end() && header && is_retry(*known, *header, request);
}

bool RequestHandler::is_retry(const Session& session, const RequestHeader& header, Bytes bytes) const {
  if (!same_bytes(session.last_request, bytes)) return false;
  return session.work.in_progress || !session.lacks_sea ||
         water_.sea_at(header.id.utime, header.lead_time) == nullptr;
}

bool RequestHandler::has_room_for(const SessionKey& session) const {
  if (in_progress_.size() == kMaxInProgress) return false;
  const auto known = std::ranges::find(sessions_, session, &Session::key);
  return known == sessions_.end() || !known->work.in_progress;
}

Expected<void> RequestHandler::receive_sea(Bytes message) {
  Expected<void> received = water_.receive_sea(message);
  ++(received ? counters_.seas_received : counters_.seas_rejected);
  return received;
}

Expected<void> RequestHandler::receive_condition(Bytes message) {
  Expected<void> received = conditions_.receive(message, *scene_);
  applied_conditions_.reset();
  ++changes_;
  ++(received ? counters_.conditions_received : counters_.conditions_rejected);
  return received;
}

void RequestHandler::set_conditions(ConditionTimeline conditions) {
  conditions_ = std::move(conditions);
  applied_conditions_.reset();
  ++changes_;
}

void RequestHandler::reset() {
  sessions_.clear();
  in_progress_.clear();
  counters_.retained_bytes = 0;
  retained_ = 0;
  last_session_.reset();
  evaluator_.clear_cache();
  for (CachedHydrostatics& cached : cached_hydrostatics_) cached.valid = false;
}

std::optional<std::int64_t> RequestHandler::newest_seq(const SessionKey& session) const {
  const auto known = std::ranges::find(sessions_, session, &Session::key);
  if (known == sessions_.end()) return std::nullopt;
  return known->newest_seq;
}

void RequestHandler::check_motion(Session& session, const RequestView& request) {
  const auto before = RequestView::of(session.last_request);
  const auto finding = session.motion.check(before ? &*before : nullptr, request, *scene_);
  if (!finding) return;
  ++(finding->contradictions == 0 ? counters_.quaternions_xyzw : counters_.motions_contradicting);
  if (findings_.size() < kMaxFindings) findings_.push_back(*finding);
}

std::vector<MotionFinding> RequestHandler::take_findings() {
  std::vector<MotionFinding> findings = findings_;
  findings_.clear();  // and keeps its memory
  return findings;
}

void RequestHandler::count_decode_error(DecodeError error) {
  switch (error) {
    case DecodeError::kTruncated:
      ++counters_.rejected_truncated;
      break;
    case DecodeError::kFingerprint:
      ++counters_.rejected_fingerprint;
      break;
    case DecodeError::kCount:
      ++counters_.rejected_count;
      break;
    case DecodeError::kLength:
      ++counters_.rejected_length;
      break;
  }
}

RequestHandler::Session* RequestHandler::start_session(const RequestHeader& first) {
  Session* session = nullptr;
  if (sessions_.size() < max_sessions_) {
    session = &sessions_.emplace_back();
    counters_.sessions = static_cast<std::int64_t>(sessions_.size());
  } else {
    const auto rank = [](const Session& each) { return std::pair(each.work.in_progress, each.last_use); };
    session = &*std::ranges::min_element(sessions_, {}, rank);
    if (session->work.in_progress) return nullptr;
    session->last_request.clear();
    ++counters_.sessions_evicted;
  }
  session->key = first.session();
  session->newest_seq = first.id.seq;
  session->pace = Pace::kUnknown;
  session->motion = {};
  return session;
}

std::size_t RequestHandler::count_states_with(bool Body::*output, const RequestView& request) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < request.size(); ++i) {
    const std::optional<std::size_t> index = scene_->index_of(request.body_id(i), i);
    if (index && scene_->bodies()[*index].*output) ++count;
  }
  return count;
}

bool RequestHandler::begin_work(const RequestHeader& header, Bytes request, Session& session) {
  const bool has_bodies = header.kind == RequestKind::kBodies;
  const auto wanted = [&](std::size_t bodies_with_output, bool Body::*output,
                          std::size_t (*size)(std::size_t)) {
    if (!has_bodies || bodies_with_output == 0) return std::size_t{0};
    std::size_t count = count_states_with(output, RequestView::of(request).value());
    if (count > 0 && size(count) > budgets_.message_bytes) {
      ++counters_.outputs_too_large;
      count = 0;
    }
    return count;
  };
  const std::size_t hydrostatics =
      wanted(scene_->bodies_with_hydrostatics(), &Body::hydrostatics, hydrostatics_size);
  const std::size_t loads = wanted(scene_->bodies_with_loads(), &Body::loads, loads_size);
  const std::size_t bytes =
      request.size() + (has_bodies ? response_size(header.size) : water_samples_size(header.size)) +
      (hydrostatics > 0 ? hydrostatics_size(hydrostatics) : 0) + (loads > 0 ? loads_size(loads) : 0);
  Work& work = session.work;
  work.next = 0;
  work.unfinished.clear();
  work.loads = 0;
  work.hydrostatics_next = 0;
  work.hydrostatics = 0;
  work.changes = changes_;
  if (!work.in_progress) {
    work.spent = {};
    session.last_request.clear();
  }
  if (!make_room(session, bytes)) return false;
  if (has_bodies) {
    ResponseWriter(header.id, header.size, session.last_response);
  } else {
    WaterSamplesWriter(header.id, header.size, session.last_response);
  }
  session.last_hydrostatics.clear();
  if (hydrostatics > 0) {
    BodiesWriter<BodiesHydrostatics>(header.id, hydrostatics, session.last_hydrostatics);
  }
  session.last_loads.clear();
  if (loads > 0) BodiesWriter<BodiesLoads>(header.id, loads, session.last_loads);
  return true;
}

bool RequestHandler::make_room(Session& session, std::size_t bytes) {
  if (retained_ - session.counted + std::max(session.counted, bytes) <= budgets_.retained_bytes) return true;
  if (!session.work.in_progress) discard_reply(session);
  const std::size_t own = session.counted;
  while (retained_ - own + std::max(own, bytes) > budgets_.retained_bytes) {
    Session* victim = nullptr;
    for (Session& each : sessions_) {
      if (&each == &session || each.work.in_progress || each.counted == 0) continue;
      if (victim == nullptr || each.last_use < victim->last_use) victim = &each;
    }
    if (victim == nullptr) return false;
    if (!victim->last_request.empty()) ++counters_.replies_evicted;
    discard_reply(*victim);
  }
  return true;
}

void RequestHandler::update_retained(Session& session) {
  const std::size_t retained = session.retained();
  retained_ = retained_ - session.counted + retained;
  session.counted = retained;
  counters_.retained_bytes = static_cast<std::int64_t>(retained_);
}

void RequestHandler::discard_reply(Session& session) {
  using Memory = std::vector<std::uint8_t>;
  session.last_request = Memory();  // {} would keep the memory
  session.last_response = Memory();
  session.last_hydrostatics = Memory();
  session.last_loads = Memory();
  session.work = {};
  update_retained(session);
}

bool RequestHandler::advance(Bytes bytes, Session& session, const WaterAtTime::Change& now,
                             Deadline deadline) {
  if (now.changed) evaluator_.clear_cache();
  if (session.key.kind == RequestKind::kWaterPoints) {
    return sample_water(bytes, session, now.water, deadline);
  }
  const RequestView request = RequestView::of(bytes).value();
  apply_conditions(request.id().utime);
  while (session.work.next < request.size()) {
    if (!evaluate_part(request, session, now.water, deadline)) return false;
    if (session.work.next < request.size() && has_passed(deadline)) return false;
  }
  return session.last_hydrostatics.empty() || compute_hydrostatics(request, session, deadline);
}

bool RequestHandler::sample_water(Bytes request, Session& session, const WaterState& water,
                                  Deadline deadline) {
  constexpr double kPartTime = 1e6;  // [ns], of a thread
  const WaterPointsView points = WaterPointsView::of(request).value();
  WaterSamplesWriter samples(session.last_response);
  std::size_t& next = session.work.next;
  BodyStatus status = next == 0 ? check_points(points, water) : BodyStatus::kOk;
  while (status == BodyStatus::kOk && next < points.size()) {
    const double part = kPartTime * thread_count() / estimated_time_per_point(water);
    const std::size_t end =
        std::min(points.size(), next + std::max(static_cast<std::size_t>(part), std::size_t{1}));
    if (!sample_points(points, next, end, water, scene_->current(), evaluator_.threads(), samples)) {
      status = BodyStatus::kOutOfRange;
    }
    next = end;
    if (status == BodyStatus::kOk && next < points.size() && has_passed(deadline)) return false;
  }
  if (status != BodyStatus::kOk) samples.fail(status);
  (status == BodyStatus::kOk ? counters_.water_points : counters_.water_points_failed) +=
      static_cast<std::int64_t>(points.size());
  return true;
}

bool RequestHandler::evaluate_part(const RequestView& request, Session& session, const WaterState& water,
                                   Deadline deadline) {
  Work& work = session.work;
  const std::size_t count = std::min(request.size() - work.next, BodyEvaluator::kMaxStates);
  const BodyEvaluator::States states{work.next, count, work.unfinished};
  BodyEvaluator::Outputs outputs{
      .response = ResponseWriter(session.last_response), .loads = {}, .load_places = {}};
  std::size_t loads = work.loads;
  if (!session.last_loads.empty()) {
    outputs.loads = BodiesWriter<BodiesLoads>(session.last_loads);
    load_places_.resize(std::max(load_places_.size(), count));
    for (std::size_t i = 0; i < count; ++i) {
      load_places_[i] = static_cast<std::uint32_t>(loads);
      const std::optional<std::size_t> index =
          scene_->index_of(request.body_id(work.next + i), work.next + i);
      if (index && scene_->bodies()[*index].loads) ++loads;
    }
    outputs.load_places = std::span(load_places_).first(count);
  }
  const std::int64_t failures = failed_bodies(counters_);
  const bool complete = evaluator_.evaluate(request, states, water, outputs, counters_, deadline);
  work.has_failures |= failed_bodies(counters_) > failures;
  if (!complete) {
    const auto unfinished = evaluator_.unfinished();
    work.unfinished.assign(unfinished.begin(), unfinished.end());
    return false;
  }
  for (std::size_t i = 0; i < count && outputs.loads.size() > 0; ++i) {
    // Only a state whose body has the loads output has a place of its own.
    const std::size_t end = i + 1 < count ? load_places_[i + 1] : loads;
    const BodyStatus status = outputs.response.body(work.next + i).status;
    if (load_places_[i] == end || status == BodyStatus::kOk) continue;
    outputs.loads.set(load_places_[i], {.body_id = request.body_id(work.next + i), .status = status});
  }
  if (std::exchange(work.has_failures, false)) {
    record_failures(request, work.next, work.next + count, outputs.response);
  }
  work.loads = loads;
  work.next += count;
  work.unfinished.clear();
  return true;
}

void RequestHandler::record_failures(const RequestView& request, std::size_t begin, std::size_t end,
                                     const ResponseWriter& response) {
  for (std::size_t i = begin; i < end; ++i) {
    const BodyStatus status = response.body(i).status;
    if (status == BodyStatus::kOk) continue;
    newest_failures_[static_cast<std::size_t>(status)] = {request.id().session_id, request.body_id(i)};
  }
}

void RequestHandler::apply_conditions(std::int64_t utime) {
  if (applied_conditions_ && applied_conditions_->contains(utime)) return;
  applied_conditions_.reset();  // until all are applied
  UtimeRange range;
  for (std::size_t i = 0; i < conditions_.size(); ++i) {
    const std::size_t body = conditions_.body(i);
    const bool known = conditions_.condition_at(utime, i, *scene_, condition_, range);
    const bool was_known = evaluator_.is_condition_known(body);
    if (known == was_known && (!known || condition_ == *evaluator_.condition(body))) continue;
    if (known) {
      evaluator_.set_condition(body, condition_);
    } else {
      evaluator_.set_condition_unknown(body);
    }
    if (!cached_hydrostatics_.empty()) cached_hydrostatics_[body].valid = false;
  }
  applied_conditions_ = range;
}

bool RequestHandler::compute_hydrostatics(const RequestView& request, Session& session, Deadline deadline) {
  Work& work = session.work;
  const ResponseWriter response(session.last_response);
  BodiesWriter<BodiesHydrostatics> writer(session.last_hydrostatics);
  bool is_first = true;
  for (; work.hydrostatics_next < request.size(); ++work.hydrostatics_next) {
    const std::size_t i = work.hydrostatics_next;
    const std::optional<std::size_t> index = scene_->index_of(request.body_id(i), i);
    if (!index || !scene_->bodies()[*index].hydrostatics) continue;
    if (!std::exchange(is_first, false) && has_passed(deadline)) return false;
    const BodyStatus status = response.body(i).status;
    CachedHydrostatics& cached = cached_hydrostatics_[*index];
    const Pose pose = validate_pose(request.body(i), request.lead_time()).pose;
    const PoseBits bits = pose_bits(pose);
    if (status != BodyStatus::kOk || !cached.valid || !equal_branch_free(cached.pose, bits)) {
      cached.valid = false;
      cached.hydrostatics = evaluate_hydrostatics(scene_->bodies()[*index], scene_->water(), pose, status,
                                                  counters_, evaluator_.condition(*index));
      cached.pose = bits;
      cached.valid = cached.hydrostatics.status == BodyStatus::kOk;
    }
    writer.set(work.hydrostatics++, cached.hydrostatics);
  }
  return true;
}

}  // namespace buoyancy
