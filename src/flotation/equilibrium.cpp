#include "flotation/equilibrium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "flotation/attitude_descent.h"
#include "flotation/attitude_family.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kNeutral = 1e-9;  // relative difference of mass and displaced mass

struct Found {
  Minimum minimum;
  AttitudeFamily family = AttitudeFamily::kNone;
  std::vector<Vec3> curve;  // of a family
};

// Low-discrepancy directions: the first n cover the sphere evenly for every n, and lie on no plane of
// symmetry of the body's axes (M. Roberts' sequence for two dimensions).
Vec3 direction(int n) {
  constexpr double kPlastic = 1.32471795724474602596;
  const double u = std::fmod(0.5 + n / kPlastic, 1.0);
  const double v = std::fmod(0.5 + n / (kPlastic * kPlastic), 1.0);
  const double z = 1.0 - 2.0 * u;
  const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
  return {r * std::cos(2.0 * std::numbers::pi * v), r * std::sin(2.0 * std::numbers::pi * v), z};
}

class EquilibriumSearch {
 public:
  explicit EquilibriumSearch(const Balance& balance)
      : balance_(balance),
        descent_(balance),
        flat_curve_energy_(flat_energy(balance, kFlatCurve)),
        flat_sphere_energy_(flat_energy(balance, kFlatSphere)) {}

  void find_minima(const EquilibriumOptions& options) {
    constexpr int kMinStarts = 24;
    constexpr int kMaxStarts = 600;
    for (const Vec3& axis : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitX())}) {
      descend(axis);
      descend(-axis);
    }
    // The more attitudes are known, the fewer starts lead to one that is not, and the more are needed.
    const auto enough = [&] { return 16 + static_cast<int>(4 * found_.size()); };
    int last_news = 0;
    for (int n = 0; n < kMaxStarts && (n < kMinStarts || n - last_news < enough()); ++n) {
      if (descend(direction(n))) last_news = n;
      if (options.progress) {
        options.progress(n + 1, std::min(std::max(last_news + enough(), kMinStarts), kMaxStarts));
      }
      if (!found_.empty() && found_.front().family == AttitudeFamily::kSphere) return;
    }
  }

  // Finds saddle points and maxima, after find_minima(). On a sphere, minima - saddle points + maxima = 2 if
  // none is missing.
  void find_unstable() {
    constexpr int kMinStarts = 24;
    constexpr int kMaxStarts = 400;
    for (const Vec3& axis : {Vec3(Vec3::UnitZ()), Vec3(Vec3::UnitY()), Vec3(Vec3::UnitX())}) {
      add_stationary(axis);
      add_stationary(-axis);
    }
    for (std::size_t i = 0; i < found_.size(); ++i) {
      for (std::size_t j = 0; j < i && i < kMinStarts; ++j) {
        const Vec3 middle = found_[i].minimum.attitude.up_B + found_[j].minimum.attitude.up_B;
        if (middle.norm() > 0.2) add_stationary(middle.normalized());
      }
    }
    for (int n = 0; n < kMaxStarts && (n < kMinStarts || characteristic() != 2); ++n) {
      add_stationary(direction(n));
    }
  }

  // Descends from a start. Returns true if that led to a minimum that was not known.
  bool descend(const Vec3& start_B) {
    constexpr int kMaxFurther = 4;
    bool is_new = descend_once(start_B);
    std::vector<Vec3> further = descent_.take_further_starts();
    for (int i = 0; i < kMaxFurther && !further.empty(); ++i) {
      const Vec3 next = further.back();
      further.pop_back();
      is_new = descend_once(next) || is_new;
      for (const Vec3& start : descent_.take_further_starts()) further.push_back(start);
    }
    return is_new;
  }

  const std::vector<Found>& found() const { return found_; }
  const std::vector<Minimum>& unstable() const { return unstable_; }

 private:
  bool descend_once(const Vec3& start_B) {
    constexpr int kMaxRestarts = 4;
    std::optional<BalancedAttitude> at = balance_.at(start_B, nullptr, balance_.start_slack());
    for (int restart = 0; at && restart < kMaxRestarts; ++restart) {
      std::optional<Minimum> minimum =
          descent_.minimum_from(*at, [this](const BalancedAttitude& current, const Vec3& target,
                                            double step) { return approaches_known(current, target, step); });
      if (!minimum) return false;
      at = lower_nearby(*minimum);
      if (!at) return add(std::move(*minimum));
    }
    return false;
  }

  // Adds the unstable attitude that a start leads to, if that is new.
  void add_stationary(const Vec3& start_B) {
    constexpr double kApart = 1e-3;  // [rad]
    const std::optional<BalancedAttitude> at = balance_.at(start_B);
    if (!at) return;
    const std::optional<Minimum> point = descent_.stationary_from(*at);
    if (!point || belongs_to_family(point->attitude)) return;
    const Vec3& up = point->attitude.up_B;
    if (!(point->curvature.values[0] < -balance_.curvature_rounding())) {
      descend(up);
      return;
    }
    const auto is_same = [&](const Minimum& other) { return (other.attitude.up_B - up).norm() < kApart; };
    if (std::none_of(unstable_.begin(), unstable_.end(), is_same)) unstable_.push_back(*point);
  }

  int characteristic() const {
    int sum = static_cast<int>(found_.size());
    for (const Minimum& point : unstable_) sum += point.curvature.values[1] < 0.0 ? 1 : -1;
    return sum;
  }

  // True if the descent will end at a known minimum. step: [rad], to the minimum of the model; negative:
  // there is none.
  bool approaches_known(const BalancedAttitude& at, const Vec3& target, double step) const {
    for (const Found& found : found_) {
      const double distance = (found.minimum.attitude.up_B - target).norm();
      if (step >= 0.0 && step <= 0.4 && distance <= 0.02 + 0.15 * step) return true;
      if (is_in_bowl_of(found.minimum, at)) return true;
    }
    return belongs_to_family(at);
  }

  // True if energy and gradient agree with the quadratic model at a minimum, as between two they do not.
  static bool is_in_bowl_of(const Minimum& minimum, const BalancedAttitude& at) {
    constexpr double kMaxDistance = 0.5;  // [rad]
    constexpr double kAgreement = 0.2;
    const Vec3 offset = at.up_B - minimum.attitude.up_B;
    if (offset.squaredNorm() > kMaxDistance * kMaxDistance) return false;
    double energy = 0.0;
    double gradient_squared = 0.0;
    double difference_squared = 0.0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3& direction = minimum.curvature.directions_B[i];
      const double along = offset.dot(direction);
      const double gradient = minimum.curvature.values[i] * along;
      const double difference = at.gradient.dot(direction) - gradient;
      energy += 0.5 * gradient * along;
      gradient_squared += gradient * gradient;
      difference_squared += difference * difference;
    }
    const double rise = at.energy - minimum.attitude.energy;
    return std::abs(rise - energy) <= kAgreement * energy &&
           difference_squared <= kAgreement * kAgreement * gradient_squared;
  }

  bool belongs_to_family(const BalancedAttitude& at) const {
    constexpr double kNear = 0.75 * kFamilyStep;
    return std::any_of(found_.begin(), found_.end(), [&](const Found& found) {
      const double difference = std::abs(at.energy - found.minimum.attitude.energy);
      if (found.family == AttitudeFamily::kSphere) return difference <= 2.0 * flat_sphere_energy_;
      if (difference > 2.0 * flat_curve_energy_) return false;
      return std::any_of(found.curve.begin(), found.curve.end(),
                         [&](const Vec3& up) { return (up - at.up_B).norm() <= kNear; });
    });
  }

  // Returns the lowest attitude on a small circle around a stationary one, if its energy is lower.
  std::optional<BalancedAttitude> lower_nearby(const Minimum& minimum) const {
    constexpr int kDirections = 8;
    constexpr double kRadius = 1e-3;  // [rad]
    const BalancedAttitude& center = minimum.attitude;
    const double slack = balance_.slack(0.1 * balance_.energy_rounding(), center.area);
    std::optional<BalancedAttitude> lowest;
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2.0 * std::numbers::pi * (i + 0.25) / kDirections;
      const Vec3 step = std::cos(angle) * minimum.curvature.directions_B[0] +
                        std::sin(angle) * minimum.curvature.directions_B[1];
      const auto at = balance_.at(turned(center.up_B, kRadius * step), &center, slack);
      if (!at || at->energy >= center.energy - balance_.energy_rounding()) continue;
      if (!lowest || at->energy < lowest->energy) lowest = at;
    }
    return lowest;
  }

  // True if two attitudes are the same minimum: they are near, and the energy does not rise between them.
  bool is_same(const Minimum& a, const Minimum& b) const {
    constexpr double kNear = 0.03;  // [rad]
    if ((a.attitude.up_B - b.attitude.up_B).norm() > kNear) return false;
    const auto middle = balance_.at((a.attitude.up_B + b.attitude.up_B).normalized(), &a.attitude);
    return middle && middle->energy <=
                         std::max(a.attitude.energy, b.attitude.energy) + 2.0 * balance_.energy_rounding();
  }

  bool add(Minimum minimum) {
    if (belongs_to_family(minimum.attitude)) return false;
    for (Found& known : found_) {
      if (!is_same(known.minimum, minimum)) continue;
      if (minimum.attitude.gradient.norm() < known.minimum.attitude.gradient.norm()) {
        known.minimum = std::move(minimum);
      }
      return false;
    }
    constexpr double kWeak = 0.05;
    Found found;
    found.minimum = std::move(minimum);
    if (found.minimum.curvature.values[0] <= kWeak * found.minimum.curvature.largest_moment) {
      if (is_flat_everywhere(balance_, found.minimum, flat_sphere_energy_)) {
        found.family = AttitudeFamily::kSphere;
      } else {
        found.curve = flat_curve(balance_, found.minimum, flat_curve_energy_);
        if (!found.curve.empty()) found.family = AttitudeFamily::kCurve;
      }
    }
    if (found.family != AttitudeFamily::kNone) {
      const std::vector<Found> others = std::exchange(found_, {});
      found_.push_back(std::move(found));
      for (const Found& other : others) {
        if (!belongs_to_family(other.minimum.attitude)) found_.push_back(other);
      }
      return true;
    }
    found_.push_back(std::move(found));
    return true;
  }

  const Balance& balance_;
  AttitudeDescent descent_;
  double flat_curve_energy_;   // [kg m]
  double flat_sphere_energy_;  // [kg m]
  std::vector<Found> found_;
  std::vector<Minimum> unstable_;
};

// Returns nullopt where a number is out of range, and where the residuals are not within their bounds.
std::optional<Equilibrium> equilibrium_at(const Balance& balance, const Minimum& minimum,
                                          const ShipAxes& axes) {
  const FloatingBody& body = balance.body();
  const Water& water = balance.water();
  const BalancedAttitude& at = minimum.attitude;
  Equilibrium result;
  result.angles = heel_trim_of(axes, at.up_B);
  const double height = at.height - at.up_B.dot(body.center_B());  // [m], of B's origin over the water
  result.pose = {water.up_W * (water.level + height), attitude_at(axes, result.angles, water.up_W)};
  std::optional<FloatingState> state = floating_state(body, result.pose, water);
  if (!state) return std::nullopt;
  result.state = *state;
  result.draft = -at.height - lowest_along(body, at.up_B);
  result.residual_force = state->force_W.norm();
  result.residual_torque = state->torque_W.norm();

  // [m] and [rad], by which rounding of the position and the quaternion may move the body.
  const double angle_rounding = 4.0 * kEpsilon;
  const double height_rounding = kEpsilon * (std::abs(water.level) + std::abs(height)) +
                                 angle_rounding * (body.center_of_mass_B().norm() + body.reach());
  const Eigen::Matrix<double, 6, 6>& stiffness = state->hydrostatics.stiffness;
  const double heave = stiffness.topLeftCorner<3, 3>().norm();
  const double coupling = stiffness.topRightCorner<3, 3>().norm();
  const double rotation = stiffness.bottomRightCorner<3, 3>().norm();
  result.force_bound = state->force_error_bound + heave * height_rounding + coupling * angle_rounding;
  result.torque_bound = state->torque_error_bound + coupling * height_rounding + rotation * angle_rounding;
  const bool balances = result.residual_force <= result.force_bound && std::isfinite(result.force_bound) &&
                        result.residual_torque <= result.torque_bound && std::isfinite(result.torque_bound);
  if (!balances) return std::nullopt;
  for (std::size_t i = 0; i < 2; ++i) {
    result.stiffness[i] = water.gravity * minimum.curvature.values[i];
    if (minimum.curvature.values[i] < -balance.curvature_rounding()) ++result.unstable_directions;
  }
  return result;
}

}  // namespace

std::string_view to_string(FlotationOutcome outcome) {
  switch (outcome) {
    case FlotationOutcome::kFloats:
      return "floats";
    case FlotationOutcome::kSinks:
      return "sinks";
    case FlotationOutcome::kNeutral:
      return "neutrally_buoyant";
    case FlotationOutcome::kTakesInWater:
      return "takes_in_water";
    case FlotationOutcome::kOutOfRange:
      break;
  }
  return "out_of_range";
}

std::string_view to_string(AttitudeFamily family) {
  switch (family) {
    case AttitudeFamily::kCurve:
      return "curve";
    case AttitudeFamily::kSphere:
      return "sphere";
    case AttitudeFamily::kNone:
      break;
  }
  return "none";
}

FlotationOutcome outcome_by_mass(const FloatingBody& body, const Water& water) {
  if (body.is_open()) return FlotationOutcome::kFloats;
  return outcome_by_mass(body.total_mass(), deepest_density(water) * body.volume());
}

FlotationOutcome outcome_by_mass(double mass, double displaced) {
  if (std::abs(mass - displaced) <= kNeutral * displaced) return FlotationOutcome::kNeutral;
  return mass < displaced ? FlotationOutcome::kFloats : FlotationOutcome::kSinks;
}

Equilibria find_equilibria(const FloatingBody& body, const Water& water, const EquilibriumOptions& options) {
  Equilibria result;
  result.outcome = outcome_by_mass(body, water);
  if (result.outcome != FlotationOutcome::kFloats) return result;
  const Balance balance(body, water);
  EquilibriumSearch search(balance);
  search.find_minima(options);
  if (options.unstable) search.find_unstable();

  for (const Found& found : search.found()) {
    std::optional<Equilibrium> equilibrium = equilibrium_at(balance, found.minimum, options.axes);
    if (!equilibrium) continue;
    equilibrium->family = found.family;
    equilibrium->unstable_directions = 0;
    result.attitudes.push_back(*equilibrium);
  }
  if (result.attitudes.empty()) {
    result.outcome = body.is_open() ? FlotationOutcome::kTakesInWater : FlotationOutcome::kOutOfRange;
  }
  for (const Minimum& point : search.unstable()) {
    const std::optional<Equilibrium> equilibrium = equilibrium_at(balance, point, options.axes);
    if (equilibrium && !equilibrium->is_stable()) result.attitudes.push_back(*equilibrium);
  }
  std::stable_sort(
      result.attitudes.begin(), result.attitudes.end(),
      [](const Equilibrium& a, const Equilibrium& b) { return a.state.energy < b.state.energy; });
  result.is_truncated = result.attitudes.size() > options.max_attitudes;
  if (result.is_truncated) result.attitudes.resize(options.max_attitudes);
  return result;
}

std::optional<Equilibrium> find_equilibrium_from(const FloatingBody& body, const Water& water,
                                                 const Eigen::Quaterniond& q_WB, const ShipAxes& axes) {
  if (outcome_by_mass(body, water) != FlotationOutcome::kFloats) return std::nullopt;
  const Balance balance(body, water);
  EquilibriumSearch search(balance);
  search.descend(q_WB.normalized().conjugate() * water.up_W);
  if (search.found().empty()) return std::nullopt;
  const Found& found = search.found().front();
  std::optional<Equilibrium> equilibrium = equilibrium_at(balance, found.minimum, axes);
  if (equilibrium) {
    equilibrium->family = found.family;
    equilibrium->unstable_directions = 0;
  }
  return equilibrium;
}

}  // namespace buoyancy
