#include "engine/request_handler.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "engine/body_evaluation.h"

namespace buoyancy {
namespace {

bool same_bytes(Bytes a, Bytes b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0;
}

// One per body, where any asks.
std::size_t places_for_hydrostatics(const Scene& scene) {
  return scene.any_hydrostatics() ? scene.bodies().size() : 0;
}

}  // namespace

Exchange::Exchange(const Scene& scene, const ExchangeOptions& options)
    : scene_(&scene),
      max_sessions_(options.max_sessions),
      body_answers_(scene, options.threads),
      last_hydrostatics_(places_for_hydrostatics(scene)) {
  assert(max_sessions_ >= 1);
}

void Exchange::use(const Scene& scene) {
  scene_ = &scene;
  body_answers_.use(scene);
  last_hydrostatics_.assign(places_for_hydrostatics(scene), {});
}

Bytes Exchange::answer(Bytes question) {
  ++counters_.questions;
  answered_.reset();
  const auto key = peek_key(question);
  if (!key) {
    count_rejection(key.error());
    return {};
  }

  const auto known = std::ranges::find(sessions_, key->session_id, &Session::id);
  const bool is_new = known == sessions_.end();
  Session& session = is_new ? start_session(*key) : *known;
  session.last_use = ++use_;
  const auto place = static_cast<std::size_t>(&session - sessions_.data());
  if (!is_new) {
    if (same_bytes(session.last_question, question)) {
      ++counters_.repeated;
      answered_ = place;
      return session.last_answer;
    }
    if (key->seq == session.last_seq) ++counters_.changed_repeats;
    if (key->seq < session.newest_seq) ++counters_.stale;
  }
  session.last_seq = key->seq;
  session.newest_seq = std::max(session.newest_seq, key->seq);
  compute(question, session);
  ++counters_.answered;
  answered_ = place;
  return session.last_answer;
}

void Exchange::begin_anew() {
  sessions_.clear();
  answered_.reset();
  body_answers_.forget();
  for (LastHydrostatics& last : last_hydrostatics_) last.valid = false;
}

std::optional<std::int64_t> Exchange::newest_seq(std::int64_t session_id) const {
  const auto known = std::ranges::find(sessions_, session_id, &Session::id);
  if (known == sessions_.end()) return std::nullopt;
  return known->newest_seq;
}

void Exchange::count_rejection(Rejection rejection) {
  switch (rejection) {
    case Rejection::kTruncated:
      ++counters_.rejected_truncated;
      break;
    case Rejection::kFingerprint:
      ++counters_.rejected_fingerprint;
      break;
    case Rejection::kCount:
      ++counters_.rejected_count;
      break;
    case Rejection::kLength:
      ++counters_.rejected_length;
      break;
  }
}

Exchange::Session& Exchange::start_session(const QuestionKey& first) {
  Session* session = nullptr;
  if (sessions_.size() < max_sessions_) {
    session = &sessions_.emplace_back();
    counters_.sessions = static_cast<std::int64_t>(sessions_.size());
  } else {
    session = &*std::ranges::min_element(sessions_, {}, &Session::last_use);
    ++counters_.sessions_forgotten;
  }
  session->id = first.session_id;
  session->newest_seq = first.seq;
  return *session;
}

void Exchange::compute(Bytes question, Session& session) {
  // No question is kept until its answer stands: should memory run out in between, a repeat of the old one
  // would else be answered with what is left of the new answer.
  session.last_question.clear();
  [[maybe_unused]] const auto rejection = decode(question, question_);
  assert(!rejection);  // peek_key() made the same checks
  answer_.key = question_.key;
  body_answers_.answer(question_, answer_.bodies, counters_);
  compute_hydrostatics();
  encode(answer_, session.last_answer);
  session.last_hydrostatics.clear();
  if (!hydrostatics_.bodies.empty()) encode(hydrostatics_, session.last_hydrostatics);
  session.last_question.assign(question.begin(), question.end());
}

void Exchange::compute_hydrostatics() {
  hydrostatics_.key = question_.key;
  hydrostatics_.bodies.clear();
  for (std::size_t i = 0; scene_->any_hydrostatics() && i < question_.bodies.size(); ++i) {
    const BodyState& state = question_.bodies[i];
    const std::optional<std::size_t> index = scene_->index_of(state.body_id);
    if (!index || !scene_->bodies()[*index].hydrostatics) continue;
    const BodyStatus status = answer_.bodies[i].status;
    LastHydrostatics& last = last_hydrostatics_[*index];
    const Pose pose = asked_pose(state, question_.lead_time).pose;
    const PoseBits bits = pose_bits(pose);
    if (status != BodyStatus::kOk || !last.valid || !same(last.pose, bits)) {
      last.hydrostatics =
          hydrostatics_of_body(scene_->bodies()[*index], scene_->water(), pose, status, counters_);
      last.pose = bits;
      last.valid = last.hydrostatics.status == BodyStatus::kOk;
    }
    hydrostatics_.bodies.push_back(last.hydrostatics);
  }
}

}  // namespace buoyancy
