#include "engine/condition_timeline.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>

#include "base/format.h"
#include "engine/condition_range.h"

namespace buoyancy {
namespace {

constexpr const char* kUntilThen =
    "Correct the sender; until it sends one that can be used, the body has the status BAD_CONDITION";

Error not_a_condition(DecodeError error) {
  return {"a message of the conditions", to_string(error), "the bytes of a body_condition_t of this version",
          "the sender has another version of the message, or sends another type on this channel", ""};
}

Error without_body(std::int32_t id) {
  return {"a received condition", "body_id = " + std::to_string(id), "the id of a body of the scene",
          "the sender has another scene file", ""};
}

std::string subject(const Body& body) {
  return "a condition received for body " + std::to_string(body.id) + " (" + body.name + ")";
}

Error without_subdivision(const Body& body) {
  return {subject(body), "the body has neither compartments nor tanks", "a body that has some",
          "the sender has another scene file",
          "Add [[body.compartment]] or [[body.tank]] to the scene that the service reads"};
}

Error unknown_kind(const Body& body, ConditionKind kind) {
  return {subject(body), "kind = " + std::to_string(static_cast<std::int32_t>(kind)),
          "COMPARTMENT (0) or TANK (1)", "the sender has not set it, or is of another version", kUntilThen};
}

Error unknown_index(const Body& body, const ConditionChange& change, std::size_t count) {
  const bool is_tank = change.kind == ConditionKind::kTank;
  std::string actual = format_text(is_tank ? "tank {}" : "compartment {}", change.index);
  std::string expected =
      is_tank ? "a compartment: the body has no tanks" : "a tank: the body has no compartments";
  if (count > 0) {
    expected = "an index from 0 to " + std::to_string(count - 1) + ", in the order of the scene file";
  }
  return {subject(body), std::move(actual), std::move(expected),
          "the sender has another scene file, or counts from 1", kUntilThen};
}

// Returns the value of a change, or an error if it cannot be used.
Expected<double> value_of(const Body& body, const ConditionChange& change) {
  const auto index = static_cast<std::size_t>(change.index);
  if (change.kind == ConditionKind::kCompartment) {
    if (kFloodedRange.contains(change.flooded)) return change.flooded;
    return make_error({subject(body) + ", " + body.subdivision->compartments[index].name,
                       "flooded = " + format_shortest(change.flooded), kFloodedRange.describe(),
                       "the sender means a percentage or a volume: it is the share that is open to the sea",
                       kUntilThen});
  }
  const BodyTank& tank = body.subdivision->tanks[index];
  if (const auto volume = usable_liquid_volume(tank, change.liquid_volume)) return *volume;
  return make_error({subject(body) + ", " + tank.name,
                     "liquid_volume = " + format_shortest(change.liquid_volume),
                     "from 0 to the tank's volume, " + format_number(tank.capacity()) + " m^3",
                     "the sender means litres, a mass or a fraction", kUntilThen});
}

bool has_same_subdivision(const Body& a, const Body& b) {
  return std::ranges::equal(
             a.subdivision->compartments, b.subdivision->compartments,
             [](const BodyCompartment& x, const BodyCompartment& y) { return x.name == y.name; }) &&
         std::ranges::equal(a.subdivision->tanks, b.subdivision->tanks,
                            [](const BodyTank& x, const BodyTank& y) {
                              return x.name == y.name && x.capacity() == y.capacity();
                            });
}

}  // namespace

void ConditionHistory::add(const Change& change) {
  const auto replaced = std::ranges::lower_bound(changes_, change.from_utime, {}, &Change::from_utime);
  changes_.erase(replaced, changes_.end());
  if (dropped_ && dropped_->from_utime >= change.from_utime) dropped_.reset();
  if (!changes_.empty() && changes_.back().usable == change.usable && changes_.back().value == change.value) {
    return;
  }
  if (changes_.size() == kMaxChanges) {
    dropped_ = changes_.front();
    changes_.erase(changes_.begin());
  }
  changes_.push_back(change);
}

const ConditionHistory::Change* ConditionHistory::at(std::int64_t utime, UtimeRange& range) const {
  const auto after = std::ranges::upper_bound(changes_, utime, {}, &Change::from_utime);
  if (after != changes_.end()) range.last = std::min(range.last, after->from_utime - 1);
  if (after == changes_.begin()) return dropped_ ? &*dropped_ : nullptr;
  range.first = std::max(range.first, (after - 1)->from_utime);
  return &*(after - 1);
}

ConditionTimeline::ConditionTimeline(const Scene& scene) {
  if (scene.bodies_with_subdivision() == 0) return;
  std::size_t histories = 0;
  for (std::size_t i = 0; i < scene.bodies().size(); ++i) {
    const Subdivision* const subdivision = scene.bodies()[i].subdivision;
    if (subdivision == nullptr) continue;
    bodies_.push_back({i, histories, subdivision->compartments.size(), subdivision->tanks.size()});
    histories = bodies_.back().unnamed() + 1;
  }
  histories_.resize(histories);
}

const ConditionTimeline::BodyHistories* ConditionTimeline::find(std::size_t body) const {
  const auto found = std::ranges::lower_bound(bodies_, body, {}, &BodyHistories::body);
  return found == bodies_.end() || found->body != body ? nullptr : &*found;
}

Expected<void> ConditionTimeline::receive(Bytes message, const Scene& scene) {
  ConditionChange change;
  if (const std::optional<DecodeError> error = decode(message, change)) {
    return make_error(not_a_condition(*error));
  }
  const std::optional<std::size_t> index = scene.index_of(change.body_id);
  if (!index) return make_error(without_body(change.body_id));
  const Body& body = scene.bodies()[*index];
  const BodyHistories* const of_body = find(*index);
  if (of_body == nullptr) return make_error(without_subdivision(body));

  const ConditionHistory::Change unusable{.from_utime = change.utime, .value = 0.0, .usable = false};
  ConditionHistory& unnamed = histories_[of_body->unnamed()];
  if (change.kind != ConditionKind::kCompartment && change.kind != ConditionKind::kTank) {
    unnamed.add(unusable);
    return make_error(unknown_kind(body, change.kind));
  }
  const bool is_tank = change.kind == ConditionKind::kTank;
  const std::size_t count = is_tank ? of_body->tanks : of_body->compartments;
  if (change.index < 0 || static_cast<std::size_t>(change.index) >= count) {
    unnamed.add(unusable);
    return make_error(unknown_index(body, change, count));
  }
  ConditionHistory& history = histories_[of_body->first + (is_tank ? of_body->compartments : 0) +
                                         static_cast<std::size_t>(change.index)];
  const Expected<double> value = value_of(body, change);
  if (!value) {
    history.add(unusable);
    return make_error(value.error());
  }
  history.add({.from_utime = change.utime, .value = *value, .usable = true});
  if (!unnamed.empty()) unnamed.add({.from_utime = change.utime, .value = 0.0, .usable = true});
  return {};
}

ConditionTimeline ConditionTimeline::for_scene(const Scene& before, const Scene& scene) const {
  ConditionTimeline next(scene);
  for (const BodyHistories& to : next.bodies_) {
    const Body& body = scene.bodies()[to.body];
    const std::optional<std::size_t> index = before.index_of(body.id, to.body);
    const BodyHistories* const from = index ? find(*index) : nullptr;
    if (from == nullptr || !has_same_subdivision(before.bodies()[*index], body)) continue;
    for (std::size_t i = 0; from->first + i <= from->unnamed(); ++i) {
      next.histories_[to.first + i] = histories_[from->first + i];
    }
  }
  return next;
}

bool ConditionTimeline::condition_at(std::int64_t utime, std::size_t i, const Scene& scene,
                                     BodyCondition& condition, UtimeRange& range) const {
  const BodyHistories& of_body = bodies_[i];
  const Subdivision& subdivision = *scene.bodies()[of_body.body].subdivision;
  bool usable = true;
  const auto value_at = [&](std::size_t history, double initial) {
    const ConditionHistory::Change* const change = histories_[history].at(utime, range);
    if (change == nullptr) return initial;
    usable = usable && change->usable;
    return change->value;
  };
  condition.flooded.resize(of_body.compartments);
  condition.liquid_volumes.resize(of_body.tanks);
  for (std::size_t c = 0; c < of_body.compartments; ++c) {
    condition.flooded[c] = value_at(of_body.first + c, subdivision.compartments[c].flooded);
  }
  for (std::size_t t = 0; t < of_body.tanks; ++t) {
    condition.liquid_volumes[t] =
        value_at(of_body.first + of_body.compartments + t, subdivision.tanks[t].liquid_volume);
  }
  value_at(of_body.unnamed(), 0.0);
  return usable;
}

}  // namespace buoyancy
