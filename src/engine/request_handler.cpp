#include "engine/request_handler.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

#include "engine/body_evaluation.h"
#include "messages/wire_views.h"

namespace buoyancy {
namespace {

bool same_bytes(Bytes a, Bytes b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0;
}

// One entry per body, if any body has the hydrostatics output.
std::size_t hydrostatics_cache_size(const Scene& scene) {
  return scene.bodies_with_hydrostatics() > 0 ? scene.bodies().size() : 0;
}

}  // namespace

RequestHandler::RequestHandler(const Scene& scene, const RequestHandlerOptions& options)
    : scene_(&scene),
      max_sessions_(options.max_sessions),
      evaluator_(scene, options.threads),
      water_(scene),
      conditions_(scene),
      cached_hydrostatics_(hydrostatics_cache_size(scene)) {
  assert(max_sessions_ >= 1);
}

void RequestHandler::set_scene(const Scene& scene) {
  conditions_.set_scene(*scene_, scene);
  applied_conditions_.reset();
  scene_ = &scene;
  evaluator_.set_scene(scene);
  water_.set_scene(scene);
  cached_hydrostatics_.assign(hydrostatics_cache_size(scene), {});
}

Bytes RequestHandler::handle(Bytes bytes) {
  ++counters_.requests;
  last_session_.reset();
  const auto request = RequestView::of(bytes);
  if (!request) {
    count_decode_error(request.error());
    return {};
  }

  const RequestId& id = request->id();
  const auto known = std::ranges::find(sessions_, id.session_id, &Session::id);
  const bool is_new = known == sessions_.end();
  Session& session = is_new ? start_session(id) : *known;
  session.last_use = ++use_;
  const auto index = static_cast<std::size_t>(&session - sessions_.data());
  if (!is_new) {
    if (same_bytes(session.last_request, bytes)) {
      ++counters_.retries;
      last_session_ = index;
      return session.last_response;
    }
    if (id.seq == session.last_seq) ++counters_.conflicting_retries;
    if (id.seq < session.newest_seq) ++counters_.stale;
  }
  session.last_seq = id.seq;
  session.newest_seq = std::max(session.newest_seq, id.seq);
  compute(bytes, *request, session);
  ++counters_.computed;
  last_session_ = index;
  return session.last_response;
}

Expected<void> RequestHandler::receive_sea(Bytes message) {
  Expected<void> received = water_.receive_sea(message);
  ++(received ? counters_.seas_received : counters_.seas_rejected);
  return received;
}

Expected<void> RequestHandler::receive_condition(Bytes message) {
  Expected<void> received = conditions_.receive(message, *scene_);
  applied_conditions_.reset();
  ++(received ? counters_.conditions_received : counters_.conditions_rejected);
  return received;
}

void RequestHandler::set_conditions(ConditionTimeline conditions) {
  conditions_ = std::move(conditions);
  applied_conditions_.reset();
}

void RequestHandler::reset() {
  sessions_.clear();
  last_session_.reset();
  evaluator_.clear_cache();
  for (CachedHydrostatics& cached : cached_hydrostatics_) cached.valid = false;
}

std::optional<std::int64_t> RequestHandler::newest_seq(std::int64_t session_id) const {
  const auto known = std::ranges::find(sessions_, session_id, &Session::id);
  if (known == sessions_.end()) return std::nullopt;
  return known->newest_seq;
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

RequestHandler::Session& RequestHandler::start_session(const RequestId& first) {
  Session* session = nullptr;
  if (sessions_.size() < max_sessions_) {
    session = &sessions_.emplace_back();
    counters_.sessions = static_cast<std::int64_t>(sessions_.size());
  } else {
    session = &*std::ranges::min_element(sessions_, {}, &Session::last_use);
    ++counters_.sessions_evicted;
  }
  session->id = first.session_id;
  session->newest_seq = first.seq;
  return *session;
}

void RequestHandler::compute(Bytes bytes, const RequestView& request, Session& session) {
  // The request is stored only when its response is complete. Otherwise, if memory ran out in between, a
  // retry of the previous request would get parts of the new response.
  session.last_request.clear();
  ResponseWriter response(request.id(), request.size(), session.last_response);
  const WaterAtTime::Change now = water_.move_to(request.id().utime, request.lead_time());
  if (now.changed) evaluator_.clear_cache();
  apply_conditions(request.id().utime);
  evaluator_.evaluate_all(request, now.water, response, counters_);
  compute_hydrostatics(request, response);
  session.last_hydrostatics.clear();
  if (!hydrostatics_.bodies.empty()) encode(hydrostatics_, session.last_hydrostatics);
  collect_loads(request, response);
  session.last_loads.clear();
  if (!loads_.bodies.empty()) encode(loads_, session.last_loads);
  session.last_request.assign(bytes.begin(), bytes.end());
}

void RequestHandler::apply_conditions(std::int64_t utime) {
  if (applied_conditions_ && applied_conditions_->contains(utime)) return;
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

void RequestHandler::compute_hydrostatics(const RequestView& request, const ResponseWriter& response) {
  hydrostatics_.id = request.id();
  hydrostatics_.bodies.clear();
  for (std::size_t i = 0; scene_->bodies_with_hydrostatics() > 0 && i < request.size(); ++i) {
    const BodyState state = request.body(i);
    const std::optional<std::size_t> index = scene_->index_of(state.body_id, i);
    if (!index || !scene_->bodies()[*index].hydrostatics) continue;
    const BodyStatus status = response.wrench(i).status;
    CachedHydrostatics& cached = cached_hydrostatics_[*index];
    const Pose pose = validate_pose(state, request.lead_time()).pose;
    const PoseBits bits = pose_bits(pose);
    if (status != BodyStatus::kOk || !cached.valid || !equal_branch_free(cached.pose, bits)) {
      cached.hydrostatics = evaluate_hydrostatics(scene_->bodies()[*index], scene_->water(), pose, status,
                                                  counters_, evaluator_.condition(*index));
      cached.pose = bits;
      cached.valid = cached.hydrostatics.status == BodyStatus::kOk;
    }
    hydrostatics_.bodies.push_back(cached.hydrostatics);
  }
}

void RequestHandler::collect_loads(const RequestView& request, const ResponseWriter& response) {
  loads_.id = request.id();
  loads_.bodies.clear();
  for (std::size_t i = 0; scene_->bodies_with_loads() > 0 && i < request.size(); ++i) {
    const std::int32_t id = request.body_id(i);
    const std::optional<std::size_t> index = scene_->index_of(id, i);
    if (!index || !scene_->bodies()[*index].loads) continue;
    const BodyStatus status = response.wrench(i).status;
    BodyLoads& loads = loads_.bodies.emplace_back();
    if (status == BodyStatus::kOk) {
      loads = evaluator_.loads(i);
    } else {
      loads.body_id = id;
      loads.status = status;
    }
  }
}

}  // namespace buoyancy
