#include "scene/floating_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "hydrostatics/buoyancy.h"

namespace buoyancy {
namespace {

// Heights of B's origin over the water between which the body floats: fully submerged or, for an open mesh,
// with its boundary at the surface, and dry.
struct Bracket {
  double low = 0.0;   // [m]
  double high = 0.0;  // [m]
};

Bracket bracket_of(const HydrostaticMesh& mesh, const Vec3& up_B) {
  const double center = up_B.dot(mesh.center_B + 0.5 * (mesh.box_min + mesh.box_max));
  const double half = 0.5 * up_B.cwiseAbs().dot(mesh.box_max - mesh.box_min);
  const double margin = 1e-9 * mesh.diagonal;
  Bracket bracket{-(center + half) - margin, -(center - half) + margin};
  for (const std::int32_t i : mesh.boundary_vertices) {
    bracket.low = std::max(bracket.low, -up_B.dot(mesh.center_B + mesh.vertex(i)) + margin);
  }
  return bracket;
}

// [m], depth of the lowest vertex under B's origin.
double depth_under_origin(const HydrostaticMesh& mesh, const Vec3& up_B) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : mesh.surface.triangles) {
    for (const std::int32_t i : triangle) lowest = std::min(lowest, up_B.dot(mesh.vertex(i)));
  }
  return -(lowest + up_B.dot(mesh.center_B));
}

// The root of a function of the height that decreases from the low to the high end of a bracket.
class RootSearch {
 public:
  RootSearch(const Bracket& bracket, double low_value, double high_value)
      : bracket_(bracket), low_value_(low_value), high_value_(high_value) {}

  // The next height at which the value is needed: by the false position of Anderson and Bjorck, or by
  // bisection where this has not halved the bracket in three rounds.
  double next() const {
    const double middle = 0.5 * (bracket_.low + bracket_.high);
    if (width() > 0.5 * older_width_) return middle;
    const double secant =
        bracket_.low + (bracket_.high - bracket_.low) * (low_value_ / (low_value_ - high_value_));
    return secant > bracket_.low && secant < bracket_.high ? secant : middle;
  }

  void narrow(double height, double value) {
    older_width_ = previous_widths_[rounds_ % previous_widths_.size()];
    previous_widths_[rounds_++ % previous_widths_.size()] = width();
    const bool is_low = value > 0.0;
    double& replaced = is_low ? low_value_ : high_value_;
    double& kept = is_low ? high_value_ : low_value_;
    if (is_low == last_was_low_) {
      const double shrink = 1.0 - value / replaced;
      kept *= shrink > 0.0 ? shrink : 0.5;
    }
    replaced = value;
    last_was_low_ = is_low;
    (is_low ? bracket_.low : bracket_.high) = height;
  }

  // Are the ends neighbours, but for rounding?
  bool is_narrow() const {
    return width() <= 2.0 * std::numeric_limits<double>::epsilon() *
                          std::max(std::abs(bracket_.low), std::abs(bracket_.high));
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  double width() const { return bracket_.high - bracket_.low; }

  Bracket bracket_;
  double low_value_, high_value_;
  std::optional<bool> last_was_low_;
  std::array<double, 3> previous_widths_{kNone, kNone, kNone};
  double older_width_ = kNone;
  std::size_t rounds_ = 0;
};

// Returns the height at which `excess_at` vanishes within the tolerance; nullopt: the bracket holds none.
template <typename Excess>
std::optional<double> find_height(const Bracket& bracket, double volume, double tolerance,
                                  const Excess& excess_at) {
  const double largest_excess = excess_at(bracket.low);
  if (!(volume > 0.0) || !(largest_excess >= 0.0)) return std::nullopt;

  constexpr int kMaxRounds = 200;
  RootSearch search(bracket, largest_excess, -volume);
  double height = bracket.low;
  double excess = largest_excess;
  for (int round = 0; round < kMaxRounds; ++round) {
    if (std::abs(excess) <= tolerance || search.is_narrow()) break;
    height = search.next();
    excess = excess_at(height);
    search.narrow(height, excess);
  }
  return height;
}

}  // namespace

std::optional<FloatingPose> find_floating_pose(const HydrostaticMesh& mesh, const Eigen::Quaterniond& q_WB,
                                               double volume, const Water& water,
                                               const Vec3& center_of_mass_B) {
  const Vec3 up_B = q_WB.conjugate() * water.up_W;
  const Solver solver(mesh, Method::kHierarchical);
  const auto pose_at = [&](double height) { return Pose{water.up_W * (water.level + height), q_WB}; };
  const auto excess_at = [&](double height) {
    const BuoyancyResult result = buoyancy(solver, pose_at(height), water, center_of_mass_B);
    return result.status == BuoyancyStatus::kOk ? result.volume - volume : -volume;
  };
  const std::optional<double> height =
      find_height(bracket_of(mesh, up_B), volume, mesh.volume_tolerance(), excess_at);
  if (!height) return std::nullopt;
  std::optional<Hydrostatics> found =
      hydrostatics(mesh, pose_at(*height), water, center_of_mass_B, center_of_mass_B);
  if (!found) return std::nullopt;
  return FloatingPose{pose_at(*height), depth_under_origin(mesh, up_B) - *height, *found};
}

std::optional<FloatingPose> find_floating_pose(const FloatingBody& body, const Eigen::Quaterniond& q_WB,
                                               const Water& water) {
  const Vec3 up_B = q_WB.conjugate() * water.up_W;
  const double center = up_B.dot(body.center_B());
  const double lowest = center + lowest_along(body, up_B);
  const double margin = 1e-9 * body.reach();
  const Bracket bracket{-(center - lowest_along(body, -up_B)) - margin, -lowest + margin};
  const double volume = body.total_mass() / water.density;
  const auto pose_at = [&](double height) { return Pose{water.up_W * (water.level + height), q_WB}; };
  const auto excess_at = [&](double height) {
    const std::optional<FloatingState> state = floating_state(body, pose_at(height), water);
    return state ? state->hydrostatics.volume - volume : -volume;
  };
  const std::optional<double> height = find_height(bracket, volume, body.volume_tolerance(), excess_at);
  if (!height) return std::nullopt;
  const std::optional<FloatingState> found = floating_state(body, pose_at(*height), water);
  if (!found) return std::nullopt;
  return FloatingPose{pose_at(*height), -lowest - *height, found->hydrostatics};
}

}  // namespace buoyancy
