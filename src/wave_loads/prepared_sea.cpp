#include "wave_loads/prepared_sea.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace buoyancy {
namespace {

// The table's heights are 0 and -(kRatio^i - 1) times the shortest wave's 1 / k.
constexpr double kRatio = 1.1;
constexpr double kDeepest = 60.0;  // over the longest wave's 1 / k: what is left there is below 1e-26

double depth_of(std::size_t row, double k_max) {
  return (std::pow(kRatio, static_cast<double>(row)) - 1.0) / k_max;
}

// cosh k(z + h) / cosh kh, without overflow.
double decay(double k, double z, double h) {
  if (std::isinf(h)) return std::exp(k * z);
  return (std::exp(k * z) + std::exp(-k * (z + 2.0 * h))) / (1.0 + std::exp(-2.0 * k * h));
}

constexpr double kRoundingMargin = 1.0 + 1e-12;

}  // namespace

PreparedSea::PreparedSea(Sea sea) : Sea(std::move(sea)), expansion_(*this) {
  assert(!is_still());
  if (!surfaces().empty()) {
    set_bounds_of_surfaces();
    return;
  }
  const PreparedComponents& components = prepared();
  const std::vector<double>& k = components.wave_number;
  const double k_max = expansion_.k_max;
  const double deepest = std::min(kDeepest / *std::min_element(k.begin(), k.end()), depth());
  for (std::size_t row = 0;; ++row) {
    const double z = -std::min(depth_of(row, k_max), depth());
    double sum = 0.0;
    for (std::size_t i = 0; i < components.size(); ++i) {
      sum += components.amplitude[i] * k[i] * decay(k[i], z, depth());
    }
    max_gradients_.push_back(kRoundingMargin * sum);
    if (-z >= deepest) break;
  }
}

void PreparedSea::set_surfaces(std::span<const TimedElevation> surfaces, double level) {
  Sea::set_surfaces(surfaces, level);
  set_bounds_of_surfaces();
}

void PreparedSea::set_bounds_of_surfaces() {
  auto& [elevation, slope, curvature] = expansion_.amplitude_sums;
  elevation = max_elevation();
  slope = curvature = 0.0;
  for (const TimedElevation& surface : surfaces()) {
    slope = std::max(slope, surface.spline->max_slope());
    curvature = std::max(curvature, surface.spline->max_curvature());
  }
}

double PreparedSea::max_gradient(double z) const {
  const double row = std::floor(std::log(1.0 - z * expansion_.k_max) / std::log(kRatio));
  auto n = static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(max_gradients_.size() - 1)));
  // The row is the last one whose height is not below z, also where the logarithm is rounded up.
  while (n > 0 && depth_of(n, expansion_.k_max) > -z) --n;
  return max_gradients_[n];
}

double SeaAtTime::max_elevation() const {
  return kRoundingMargin * amplitude_factor() * sea_->expansion().amplitude_sums[0];
}

}  // namespace buoyancy
