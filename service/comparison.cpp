#include "service/comparison.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace buoyancy {
namespace {

bool same(const QuestionKey& a, const QuestionKey& b) {
  return a.utime == b.utime && a.session_id == b.session_id && a.seq == b.seq;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A number is infinitely far from what is none.
double distance(double a, double b) {
  const double difference = std::abs(a - b);
  return std::isfinite(difference) ? difference : kInfinity;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  const double length = std::hypot(distance(a[0], b[0]), distance(a[1], b[1]), distance(a[2], b[2]));
  // libstdc++'s hypot() of three numbers is NaN where one of them is infinite.
  return std::isnan(length) ? kInfinity : length;
}

// 0 / 0 is 0: both are exact and the same. A bound that is no number bounds nothing.
double in_bounds(double difference, double bounds) {
  if (!std::isfinite(bounds)) return kInfinity;
  if (difference == 0.0) return 0.0;
  return bounds > 0.0 ? difference / bounds : kInfinity;
}

void compare(const BodyWrench& now, const BodyWrench& earlier, std::int64_t utime,
             BodyDifferences& differences) {
  ++differences.answers;
  if (now.status != earlier.status) ++differences.status_changes;
  const double force = distance(now.force, earlier.force);
  const double torque = distance(now.torque, earlier.torque);
  const double force_in_bounds = in_bounds(force, now.force_error_bound + earlier.force_error_bound);
  const double torque_in_bounds = in_bounds(torque, now.torque_error_bound + earlier.torque_error_bound);
  if (std::max(force_in_bounds, torque_in_bounds) >
      std::max(differences.force_in_bounds, differences.torque_in_bounds)) {
    differences.worst_utime = utime;
  }
  differences.force = std::max(differences.force, force);
  differences.torque = std::max(differences.torque, torque);
  differences.volume = std::max(differences.volume, distance(now.submerged_volume, earlier.submerged_volume));
  differences.force_in_bounds = std::max(differences.force_in_bounds, force_in_bounds);
  differences.torque_in_bounds = std::max(differences.torque_in_bounds, torque_in_bounds);
}

}  // namespace

Expected<Comparison> Comparison::open(const std::filesystem::path& earlier,
                                      const std::string& wrenches_channel) {
  Expected<EventLogReader> reader = EventLogReader::open(earlier, only_channel(wrenches_channel));
  if (!reader) return tl::unexpected(reader.error());
  return Comparison(std::move(*reader));
}

bool Comparison::read_one() {
  while (true) {
    const InputItem item = earlier_.next();
    if (std::holds_alternative<EndOfInput>(item)) return false;
    const auto* event = std::get_if<RecordedEvent>(&item);
    if (event != nullptr && !decode(event->bytes, ahead_.emplace_back())) return true;
    if (event != nullptr) ahead_.pop_back();
    ++unreadable_;
  }
}

void Comparison::take(Bytes answer) {
  [[maybe_unused]] const auto rejected = decode(answer, now_);
  assert(!rejected);  // we encoded it
  for (std::size_t i = 0; i < kReach; ++i) {
    if (i == ahead_.size() && !read_one()) break;
    if (!same(ahead_[i].key, now_.key)) continue;
    compare(now_, ahead_[i]);
    only_earlier_ += static_cast<std::int64_t>(i);
    ahead_.erase(ahead_.begin(), ahead_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return;
  }
  ++only_now_;
}

void Comparison::finish() {
  only_earlier_ += static_cast<std::int64_t>(ahead_.size());
  for (ahead_.clear(); read_one(); ahead_.clear()) ++only_earlier_;
}

void Comparison::compare(const Answer& now, const Answer& earlier) {
  const std::size_t both = std::min(now.bodies.size(), earlier.bodies.size());
  bool same_bodies = now.bodies.size() == earlier.bodies.size();
  for (std::size_t i = 0; i < both; ++i) {
    const std::int32_t id = now.bodies[i].body_id;
    if (id == earlier.bodies[i].body_id) {
      buoyancy::compare(now.bodies[i], earlier.bodies[i], now.key.utime, bodies_[id]);
    } else {
      same_bodies = false;
    }
  }
  if (same_bodies) return;
  ++only_now_;
  ++only_earlier_;
}

bool Comparison::agrees() const {
  return only_now_ == 0 && only_earlier_ == 0 && unreadable_ == 0 &&
         std::ranges::all_of(bodies_, [](const auto& body) { return body.second.within_bounds(); });
}

}  // namespace buoyancy
