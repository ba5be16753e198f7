#include "engine/body_evaluator.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

namespace buoyancy {
namespace {

// [ns]. Dispatching work to other threads costs about 10 us: parallel execution has to save several times
// that, and each dispatched task should take about as long.
constexpr double kMinParallelWork = 5e4;
constexpr double kMinTaskWork = 1e4;

// A chunk takes about kMinTaskWork.
constexpr std::size_t kChunkStates = 256;
constexpr double kBoundsTime = 40.0;  // [ns], rough cost of a state that needs no more than its bounds

std::size_t chunks_of(std::size_t states) {
  return (states + kChunkStates - 1) / kChunkStates;
}

// Is the calling thread the first that marks this body in this request? The mark orders no other memory.
bool mark_first(std::uint32_t& last_request, std::uint32_t request) {
  return std::atomic_ref(last_request).exchange(request, std::memory_order_relaxed) != request;
}

}  // namespace

void BodyEvaluator::set_scene(const Scene& scene) {
  using Key = std::tuple<const PreparedMesh*, const Subdivision*, Method, double, double, double, double>;
  const std::size_t bodies = scene.bodies().size();
  std::vector<BodyKind> kinds;
  std::vector<std::uint32_t> kind_of;
  kind_of.reserve(bodies);
  std::map<Key, std::uint32_t> known;
  for (const Body& body : scene.bodies()) {
    const Vec3& reference = body.reference_B;
    const Key key{body.prepared_mesh, body.subdivision, body.solver.method(), body.solver.tolerance(),
                  reference.x(),      reference.y(),    reference.z()};
    const auto [kind, is_new] = known.emplace(key, static_cast<std::uint32_t>(kinds.size()));
    if (is_new) {
      kinds.push_back(
          {.representative = &body,
           .submerged = submerged_constants(body.solver.mesh(), scene.water(), reference),
           .estimated_time = estimated_time(body.solver, scene.sea() != nullptr || scene.receives_sea())});
    }
    kind_of.push_back(kind->second);
  }
  std::vector<LastPose> last(bodies);
  std::vector<BodyOutcome> results(bodies);
  std::vector<BodyTwist> last_twists(scene.bodies_with_hydrodynamics() > 0 ? bodies : 0);
  std::vector<BodyCondition> conditions(scene.bodies_with_subdivision() > 0 ? bodies : 0);
  std::vector<bool> unknown_conditions(conditions.size(), false);
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const Subdivision* subdivision = scene.bodies()[i].subdivision;
    if (subdivision != nullptr) conditions[i] = initial_condition(*subdivision);
  }

  scene_ = &scene;
  kinds_ = std::move(kinds);
  kind_of_ = std::move(kind_of);
  last_ = std::move(last);
  results_ = std::move(results);
  has_loads_ = scene.bodies_with_hydrodynamics() > 0 || scene.bodies_with_loads() > 0;
  needs_twists_ = scene.bodies_with_hydrodynamics() > 0;
  last_twists_ = std::move(last_twists);
  conditions_ = std::move(conditions);
  unknown_conditions_ = std::move(unknown_conditions);
}

void BodyEvaluator::set_condition(std::size_t body, const BodyCondition& condition) {
  conditions_[body] = condition;
  unknown_conditions_[body] = false;
  last_[body].cached = Cached::kNothing;
}

void BodyEvaluator::clear_cache() {
  for (LastPose& last : last_) last.cached = Cached::kNothing;
}

void BodyEvaluator::prepare_buffers(std::size_t states) {
  // A number that was used 2^32 requests ago must not be taken for this request's.
  if (++request_number_ == 0) {
    for (LastPose& last : last_) last.request = 0;
    request_number_ = 1;
  }
  // Buffers only grow: shrinking and growing again would initialise them again.
  if (states <= pending_.size()) return;
  repeated_.resize(states);
  pending_order_.reserve(states);
  unfinished_.reserve(states);
  task_results_.resize(std::max(chunks_of(states), max_pending_tasks()));
  pending_.resize(states);  // resized last: its size shows that all buffers are large enough
}

std::size_t BodyEvaluator::max_pending_tasks() const {
  constexpr std::size_t kTasksPerThread = 64;  // more would not balance the threads' work noticeably better
  return kTasksPerThread * thread_count();
}

template <typename Task>
void BodyEvaluator::run(std::size_t tasks, double time, const Task& task) {
  if (tasks > 1 && time > kMinParallelWork && thread_pool_.thread_count() > 1) {
    thread_pool_.run(tasks, 1, std::cref(task));  // a copy of the task would need the heap
  } else {
    for (std::size_t i = 0; i < tasks; ++i) task(i);
  }
}

bool BodyEvaluator::evaluate(const RequestView& request, const States& states, const WaterState& water,
                             const Outputs& outputs, ServiceCounters& counters, Deadline deadline) {
  assert(request.size() == outputs.response.size() && states.size() <= kMaxStates);
  water_ = water;
  outputs_ = outputs;
  first_state_ = states.first;
  const std::size_t chunks = chunks_of(states.size());
  prepare_buffers(states.size());
  const bool may_be_long = chunks > 1 && deadline != kNoDeadline;
  const Deadline begin_of_bounds = may_be_long ? Deadline::clock::now() : Deadline();
  run(chunks, kBoundsTime * static_cast<double>(states.size()),
      [&](std::size_t chunk) { evaluate_chunk(request, states, chunk); });
  if (may_be_long) {
    // Every slice looks at all states that are left. Where that takes most of it, as on a slow machine, the
    // request would hardly advance: bodies get as much time again.
    const Deadline now = Deadline::clock::now();
    deadline = std::max(deadline, now + (now - begin_of_bounds));
  }
  pending_order_.clear();
  repeated_order_.clear();
  unfinished_.clear();
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    const TaskResult& result = task_results_[chunk];
    counters += result.counters;
    const auto begin = static_cast<std::uint32_t>(chunk * kChunkStates);
    for (std::uint32_t n = 0; n < result.pending; ++n) pending_order_.push_back(begin + n);
    for (std::uint32_t n = 0; n < result.repeated; ++n) repeated_order_.push_back(begin + n);
  }
  compute_pending(request, counters, deadline);
  bool stops = !unfinished_.empty();
  bool is_first = pending_order_.empty();
  for (const std::uint32_t n : repeated_order_) {
    stops = stops || (!std::exchange(is_first, false) && has_passed(deadline));
    if (stops) {
      unfinished_.push_back(repeated_[n]);
    } else {
      evaluate_repeated(request, repeated_[n], counters);
    }
  }
  return unfinished_.empty();
}

void BodyEvaluator::evaluate_chunk(const RequestView& request, const States& states, std::size_t chunk) {
  const std::size_t begin = chunk * kChunkStates;
  const std::size_t end = std::min(begin + kChunkStates, states.size());
  TaskResult& result = task_results_[chunk];
  result = {};
  for (std::size_t n = begin; n < end; ++n) {
    const std::size_t i = states[n];
    const BodyState state = request.body(i);
    BodyOutcome outcome;
    Pending& pending = pending_[begin + result.pending];
    switch (evaluate_from_bounds(state, request.lead_time(), i, pending, outcome)) {
      case EvaluationStep::kDone:
        if (has_loads_ && outcome.status == BodyStatus::kOk) {
          respond(pending, outcome, request, result.counters);
          break;
        }
        outputs_.response.set(i, to_wrench(state.body_id, outcome));
        add_to_counters(outcome, result.counters);
        break;
      case EvaluationStep::kPending:
        ++result.pending;
        break;
      case EvaluationStep::kRepeated:
        repeated_[begin + result.repeated++] = static_cast<std::uint32_t>(i);
        break;
    }
  }
}

BodyEvaluator::EvaluationStep BodyEvaluator::evaluate_from_bounds(const BodyState& state, double lead_time,
                                                                  std::size_t i, Pending& pending,
                                                                  BodyOutcome& outcome) {
  const std::optional<std::size_t> body = scene_->index_of(state.body_id, i);
  if (!body) {
    outcome.status = BodyStatus::kUnknownBody;
    return EvaluationStep::kDone;
  }
  const ValidatedPose validated = validate_pose(state, lead_time);
  if (validated.status != BodyStatus::kOk) {
    outcome.status = validated.status;
    outcome.quaternion_normalised = validated.quaternion_normalised;
    return EvaluationStep::kDone;
  }
  const bool needs_twist = needs_twists_ && scene_->bodies()[*body].hydrodynamics != nullptr;
  const bool is_condition_known = unknown_conditions_.empty() || !unknown_conditions_[*body];
  outcome.status = check_state(state, lead_time, water_, needs_twist, is_condition_known);
  if (outcome.status != BodyStatus::kOk) return EvaluationStep::kDone;
  if (!mark_first(last_[*body].request, request_number_)) return EvaluationStep::kRepeated;
  const bool done = evaluate_from_bounds(validated, *body, outcome);
  if (done && !has_loads_) return EvaluationStep::kDone;
  pending = {.state = static_cast<std::uint32_t>(i),
             .body = static_cast<std::uint32_t>(*body),
             .quaternion_normalised = validated.quaternion_normalised};
  return done ? EvaluationStep::kDone : EvaluationStep::kPending;
}

bool BodyEvaluator::evaluate_from_bounds(const ValidatedPose& validated, std::size_t body,
                                         BodyOutcome& outcome) {
  LastPose& last = last_[body];
  const PoseBits pose = pose_bits(validated.pose);
  const bool unchanged = last.cached != Cached::kNothing && equal_branch_free(last.pose, pose);
  if (unchanged && last.cached == Cached::kResult) {
    outcome = results_[body];
    outcome.quaternion_normalised = validated.quaternion_normalised;
    outcome.unchanged = true;
    return true;
  }
  const BodyKind& kind = kinds_[kind_of_[body]];
  last.pose = pose;
  last.cached = Cached::kNothing;
  if (!try_evaluate_from_bounds(*kind.representative, kind.submerged, water_, validated, outcome)) {
    return false;
  }
  outcome.unchanged = unchanged;
  if (outcome.status == BodyStatus::kOk) last.cached = Cached::kPose;
  return true;
}

void BodyEvaluator::compute_pending(const RequestView& request, ServiceCounters& counters,
                                    Deadline deadline) {
  if (pending_order_.empty()) return;
  double work = 0.0;
  for (const std::uint32_t n : pending_order_) work += kinds_[kind_of_[pending_[n].body]].estimated_time;
  const std::size_t count = pending_order_.size();
  const double each = work / static_cast<double>(count);
  const std::size_t grain = std::max({std::size_t{1}, static_cast<std::size_t>(kMinTaskWork / each),
                                      (count + max_pending_tasks() - 1) / max_pending_tasks()});
  const std::size_t tasks = (count + grain - 1) / grain;
  run(tasks, work, [&](std::size_t t) {
    TaskResult& result = task_results_[t];
    result = {};
    const std::size_t begin = t * grain;
    const std::size_t end = std::min(begin + grain, count);
    std::size_t n = begin;
    while (n < end && (n == 0 || !has_passed(deadline))) {
      const std::size_t size = water_.waves == nullptr ? std::min(kMaxGroup, end - n) : 1;
      std::array<Pending, kMaxGroup> group;
      for (std::size_t i = 0; i < size; ++i) group[i] = pending_[pending_order_[n + i]];
      compute(std::span(group).first(size), request, result.counters);
      n += size;
    }
    result.computed = n - begin;
  });
  for (std::size_t t = 0; t < tasks; ++t) {
    counters += task_results_[t].counters;
    const std::size_t end = std::min((t + 1) * grain, count);
    for (std::size_t n = t * grain + task_results_[t].computed; n < end; ++n) {
      unfinished_.push_back(pending_[pending_order_[n]].state);
    }
  }
}

void BodyEvaluator::compute(std::span<const Pending> group, const RequestView& request,
                            ServiceCounters& counters) {
  std::array<PoseQuery, kMaxGroup> queries;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const std::size_t body = group[i].body;
    queries[i] = {.body = &representative_of(body),
                  .pose = to_pose(last_[body].pose),
                  .quaternion_normalised = group[i].quaternion_normalised,
                  .condition = condition(body),
                  .outcome = &results_[body]};
  }
  buoyancy::evaluate(std::span(queries).first(group.size()), water_);
  for (const Pending& pending : group) {
    const BodyOutcome& outcome = results_[pending.body];
    counters.wave_patches += outcome.in_waves.patches;
    if (outcome.status == BodyStatus::kOk) last_[pending.body].cached = Cached::kResult;
    respond(pending, outcome, request, counters);
  }
}

void BodyEvaluator::respond(const Pending& pending, const BodyOutcome& buoyancy, const RequestView& request,
                            ServiceCounters& counters) {
  BodyWrench wrench = to_wrench(request.body_id(pending.state), buoyancy);
  if (!has_loads_ || buoyancy.status != BodyStatus::kOk) {
    outputs_.response.set(pending.state, wrench);
    add_to_counters(buoyancy, counters);
    return;
  }
  BodyOutcome outcome = buoyancy;
  outcome.unchanged = add_loads_of(pending, buoyancy, request, wrench);
  outcome.status = wrench.status;
  outputs_.response.set(pending.state, wrench);
  add_to_counters(outcome, counters);
}

bool BodyEvaluator::add_loads_of(const Pending& pending, const BodyOutcome& buoyancy,
                                 const RequestView& request, BodyWrench& wrench) {
  const Body& body = scene_->bodies()[pending.body];
  if (body.hydrodynamics == nullptr && !body.loads) return buoyancy.unchanged;
  const BodyTwist twist = twist_of(request.body(pending.state));
  const Pose pose = to_pose(last_[pending.body].pose);
  std::optional<BodyLoads> loads;
  if (body.loads) loads.emplace();
  add_loads(body, water_, scene_->current(), pose, twist, buoyancy, wrench, loads ? &*loads : nullptr);
  if (loads && outputs_.loads.size() > 0) {
    outputs_.loads.set(outputs_.load_places[pending.state - first_state_], *loads);
  }
  if (body.hydrodynamics == nullptr) return buoyancy.unchanged;
  BodyTwist& last = last_twists_[pending.body];
  const bool unchanged = buoyancy.unchanged && last.velocity_W == twist.velocity_W &&
                         last.angular_velocity_W == twist.angular_velocity_W;
  last = twist;
  return unchanged;
}

void BodyEvaluator::evaluate_repeated(const RequestView& request, std::size_t i, ServiceCounters& counters) {
  const BodyState state = request.body(i);
  const std::size_t body = scene_->index_of(state.body_id, i).value();
  const ValidatedPose validated = validate_pose(state, request.lead_time());
  const Pending pending{.state = static_cast<std::uint32_t>(i),
                        .body = static_cast<std::uint32_t>(body),
                        .quaternion_normalised = validated.quaternion_normalised};
  BodyOutcome outcome;
  if (evaluate_from_bounds(validated, body, outcome)) {
    respond(pending, outcome, request, counters);
  } else {
    compute(std::span(&pending, 1), request, counters);
  }
}

}  // namespace buoyancy
