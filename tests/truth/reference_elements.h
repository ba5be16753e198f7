// Internal to reference_load.cpp: what it integrates over, and the rules of integration.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/vec3.h"
#include "tests/truth/reference_sea.h"

namespace buoyancy::reference {

enum class State : unsigned char { kUnknown, kCrossing, kWet, kDry };

// A triangle or a part of one, with its integrals.
struct Element {
  std::array<Vec3, 3> corners;
  std::uint32_t triangle = 0;
  State state = State::kUnknown;
  bool done = false;                                         // replaced by its parts
  double highest = std::numeric_limits<double>::infinity();  // [m], over the surface, of a wet element
  std::array<double, 3> heights{};                           // at the corners
  // Integrals of the pressure, of the pressure times y, and of the height.
  double pressure = 0.0, height = 0.0;
  Vec3 moment = Vec3::Zero();
  double force_error = 0.0, torque_error = 0.0, volume_error = 0.0;
  double score = 0.0;  // the largest of the errors over what is requested of the whole
};

// A triangle to integrate over, wet throughout.
struct Part {
  std::array<Vec3, 3> corners;
  double area;
  std::size_t element;
};

// Rules of degree 4 (Dunavant) and 2, one point of each orbit: barycentric coordinates of the two corners
// that have the same one, and weight.
struct Orbit {
  double same, weight;
};
inline constexpr std::array<Orbit, 3> kOrbits{
    {{0.445948490915965, 0.223381589678011}, {0.091576213509771, 0.109951743655322}, {1.0 / 6.0, 1.0 / 3.0}}};
inline constexpr std::size_t kPointsPerPart = 9;

inline double longest_edge(const std::array<Vec3, 3>& c) {
  return std::sqrt(
      std::max({(c[1] - c[0]).squaredNorm(), (c[2] - c[1]).squaredNorm(), (c[0] - c[2]).squaredNorm()}));
}

// The mean of max(u, 0) over a triangle on which u is linear.
inline double mean_positive_part(std::array<double, 3> u) {
  std::sort(u.begin(), u.end());
  if (u[0] >= 0.0) return (u[0] + u[1] + u[2]) / 3.0;
  if (u[2] <= 0.0) return 0.0;
  if (u[1] <= 0.0) return u[2] * (u[2] / (u[2] - u[0])) * (u[2] / (u[2] - u[1])) / 3.0;
  const double below = -u[0] * (u[0] / (u[0] - u[1])) * (u[0] / (u[0] - u[2])) / 3.0;
  return (u[0] + u[1] + u[2]) / 3.0 + below;
}

// The wave numbers up to which waves matter, by depth below the surface: the components above add up to at
// most `negligible` [m] there.
class WaveResolution {
 public:
  WaveResolution(const ReferenceWaters& sea, double negligible) {
    const double first = 0.02 / std::max(sea.resolved_wave_number(0.0, 0.0), 1e-12);
    double depth = 0.0;
    for (int i = 0; i < 60; ++i) {
      levels_.push_back({depth, sea.resolved_wave_number(depth, negligible)});
      depth = i == 0 ? first : 1.25 * depth;
    }
  }

  double wave_number(double depth) const {
    double k = levels_.front().wave_number;
    for (const Level& level : levels_) {
      if (level.depth > depth) break;
      k = level.wave_number;
    }
    return k;
  }

 private:
  struct Level {
    double depth, wave_number;
  };
  std::vector<Level> levels_;
};

}  // namespace buoyancy::reference
