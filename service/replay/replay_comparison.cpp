#include "service/replay/replay_comparison.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace buoyancy::service {
namespace {

bool same_id(const RequestId& a, const RequestId& b) {
  return a.utime == b.utime && a.session_id == b.session_id && a.seq == b.seq;
}

void compare(const BodyWrench& now, const BodyWrench& baseline, std::int64_t utime,
             BodyDifferences& differences) {
  ++differences.responses;
  if (now.status != baseline.status) ++differences.status_changes;
  const WrenchDifferences of_these = compare_wrenches(now, baseline);
  if (of_these.in_bounds() > differences.largest.in_bounds()) differences.worst_utime = utime;
  differences.largest.update(of_these);
}

bool has_loads(const Scene& scene, std::int32_t id) {
  const Body* const body = scene.find(id);
  return body != nullptr && body->loads;
}

}  // namespace

Expected<ReplayComparison> ReplayComparison::open(const std::filesystem::path& baseline,
                                                  const OutputLayout& layout, const Scene& scene) {
  Expected<EventLogReader> responses = EventLogReader::open(baseline, only_channel(layout.wrenches_channel));
  if (!responses) return tl::unexpected(responses.error());
  Expected<EventLogReader> hydrostatics =
      EventLogReader::open(baseline, only_channel(layout.hydrostatics_channel));
  if (!hydrostatics) return tl::unexpected(hydrostatics.error());
  Expected<EventLogReader> loads = EventLogReader::open(baseline, only_channel(layout.loads_channel));
  if (!loads) return tl::unexpected(loads.error());
  return ReplayComparison(std::move(*responses), std::move(*hydrostatics), std::move(*loads), scene);
}

void ReplayComparison::stop_when(const std::function<bool()>& stop) {
  responses_.baseline.file().stop_when(stop);
  hydrostatics_.baseline.file().stop_when(stop);
  loads_.baseline.file().stop_when(stop);
}

bool ReplayComparison::stopped() const {
  return std::ranges::any_of(files(), [](const FileWindow* file) { return file->stopped(); });
}

std::optional<Error> ReplayComparison::read_error() const {
  for (const FileWindow* file : files()) {
    if (file->read_error()) return file->read_error();
  }
  return std::nullopt;
}

template <typename Message>
bool ReplayComparison::Channel<Message>::read_one() {
  while (true) {
    const LogItem item = baseline.next();
    if (std::holds_alternative<EndOfLog>(item)) return false;
    const auto* event = std::get_if<RecordedEvent>(&item);
    if (event == nullptr) {
      ++corrupt_sections;
      continue;
    }
    if (!decode(event->bytes, ahead.emplace_back())) {
      baseline_gaps.add(ahead.back().id.session_id, ahead.back().id.seq);
      return true;
    }
    ahead.pop_back();
    ++invalid_messages;
  }
}

template <typename Message>
void ReplayComparison::Channel<Message>::count_skipped(std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const RequestId& id = ahead[i].id;
    ++(new_gaps.is_missing(id.session_id, id.seq) ? not_recorded : unmatched_baseline);
  }
}

template <typename Message>
std::optional<Message> ReplayComparison::Channel<Message>::pop_counterpart() {
  new_gaps.add(now.id.session_id, now.id.seq);
  for (std::size_t i = 0; i < kMatchWindow; ++i) {
    if (i == ahead.size() && !read_one()) break;
    if (!same_id(ahead[i].id, now.id)) continue;
    std::optional<Message> found = std::move(ahead[i]);
    count_skipped(i);
    ahead.erase(ahead.begin(), ahead.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return found;
  }
  ++(baseline_gaps.is_missing(now.id.session_id, now.id.seq) ? not_recorded : unmatched_new);
  return std::nullopt;
}

template <typename Message>
void ReplayComparison::Channel<Message>::finish() {
  do {
    count_skipped(ahead.size());
    ahead.clear();
  } while (read_one());
}

// Calls compare_body for each body at the same index in both messages.
template <typename Message, typename CompareBody>
void ReplayComparison::add(Channel<Message>& channel, Bytes bytes, const CompareBody& compare_body) {
  [[maybe_unused]] const auto rejected = decode(bytes, channel.now);
  assert(!rejected);  // the handler encoded it
  const std::optional<Message> baseline = channel.pop_counterpart();
  if (!baseline) return;
  const auto& now = channel.now.bodies;
  const std::size_t both = std::min(now.size(), baseline->bodies.size());
  bool same_bodies = now.size() == baseline->bodies.size();
  for (std::size_t i = 0; i < both; ++i) {
    if (now[i].body_id == baseline->bodies[i].body_id) {
      compare_body(now[i], baseline->bodies[i], bodies_[now[i].body_id]);
    } else {
      same_bodies = false;
    }
  }
  if (same_bodies) return;
  ++channel.unmatched_new;
  ++channel.unmatched_baseline;
}

void ReplayComparison::add(Bytes response) {
  std::vector<BodyLimits> limits;
  add(responses_, response,
      [this, &limits](const BodyWrench& now, const BodyWrench& baseline, BodyDifferences& differences) {
        compare(now, baseline, responses_.now.id.utime, differences);
        if (has_loads(*scene_, now.body_id)) limits.push_back({now.body_id, limits_of(now, baseline)});
      });
  const auto& bodies = responses_.now.bodies;
  if (std::ranges::any_of(bodies, [this](const auto& body) { return has_loads(*scene_, body.body_id); })) {
    limits_.push_back(std::move(limits));
  }
}

void ReplayComparison::add_hydrostatics(Bytes hydrostatics) {
  add(hydrostatics_, hydrostatics,
      [this](const BodyHydrostatics& now, const BodyHydrostatics& baseline, BodyDifferences& differences) {
        const Body* const body = scene_->find(now.body_id);
        if (now.status != baseline.status) {
          ++differences.status_changes;
        } else if (now.status == BodyStatus::kOk && body != nullptr) {
          compare_hydrostatics(now, baseline, *body, scene_->water(), differences.hydrostatics);
        }
      });
}

void ReplayComparison::add_loads(Bytes loads) {
  assert(!limits_.empty());  // the message's response was added before
  const std::vector<BodyLimits> limits = std::move(limits_.front());
  limits_.pop_front();
  auto next = limits.begin();
  add(loads_, loads,
      [this, &limits, &next](const BodyLoads& now, const BodyLoads& baseline, BodyDifferences& differences) {
        const Body* const body = scene_->find(now.body_id);
        next = std::find_if(next, limits.end(),
                            [&now](const BodyLimits& one) { return one.body_id == now.body_id; });
        if (next == limits.end()) return;  // the response has no counterpart, which counts already
        const WrenchLimits of_both = (next++)->limits;
        if (now.status != baseline.status) {
          ++differences.status_changes;
        } else if (now.status == BodyStatus::kOk && body != nullptr) {
          compare_loads(now, baseline, of_both, *body, *scene_, differences.loads);
        }
      });
}

void ReplayComparison::finish() {
  responses_.finish();
  hydrostatics_.finish();
  loads_.finish();
}

bool ReplayComparison::agrees() const {
  return unmatched_new() == 0 && unmatched_baseline() == 0 && decode_errors() == 0 &&
         std::ranges::all_of(bodies_, [](const auto& body) { return body.second.within_bounds(); });
}

}  // namespace buoyancy::service
