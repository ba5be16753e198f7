#include "engine/water_points.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "messages/conversions.h"

namespace buoyancy {
namespace {

// [kg/m^3], of the layer at a height: up . x_W [m].
double density_at(const Water& water, double height) {
  double density = water.density;
  for (const WaterLayer& layer : water.layers) {
    if (!(height < layer.below)) break;
    density = layer.density;
  }
  return density;
}

// Adds what the layers contribute to the pressure of the water above them.
void add_pressure_of_layers(const Water& water, const Vec3& p_W, WaterAtPoint& point) {
  if (!(point.height < 0.0)) return;
  for (std::size_t i = 0; i < water.layers.size(); ++i) {
    const Water step = water_of_step(water, i);
    const double depth = step.level - water.up_W.dot(p_W);
    if (!(depth > 0.0)) return;
    point.pressure += step.density * water.gravity * depth;
  }
}

bool is_finite(const WaterSample& sample) {
  return all_finite(sample.velocity) &&
         all_finite(std::array{sample.elevation, sample.pressure, sample.density});
}

}  // namespace

WaterAtPoint water_at(const WaterState& water, const Vec3& p_W) {
  const Water& at_rest = *water.at_rest;
  WaterAtPoint point;
  if (water.waves != nullptr) {
    point = water.waves->at(p_W);
  } else {
    point.height = at_rest.up_W.dot(p_W) - at_rest.level;
    if (point.height < 0.0) point.pressure = -point.height * at_rest.density * at_rest.gravity;
  }
  if (!at_rest.layers.empty()) add_pressure_of_layers(at_rest, p_W, point);
  return point;
}

WaterSample sample_at(const WaterState& water, const Current& current, const WaterPoint& point) {
  const Water& at_rest = *water.at_rest;
  const Vec3 p_W = to_vec3(point.position);
  const WaterAtPoint at = water_at(water, p_W);
  WaterSample sample{.elevation = at.elevation, .pressure = at.pressure};
  if (!(at.height > 0.0)) sample.velocity = to_array(current.at(at_rest, p_W) + at.velocity_W);
  sample.density = density_at(at_rest, std::min(at_rest.up_W.dot(p_W), at_rest.level + at.elevation));
  return sample;
}

BodyStatus check_points(const WaterPointsView& points, const WaterState& water) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!all_finite(points.point(i).position)) return BodyStatus::kNonFinitePose;
  }
  return water.at_rest == nullptr ? BodyStatus::kNoSea : BodyStatus::kOk;
}

double estimated_time_per_point(const WaterState& water) {
  constexpr double kTimePerPoint = 50.0;
  constexpr double kTimePerComponent = 80.0;
  if (water.waves == nullptr) return kTimePerPoint;
  return kTimePerPoint + kTimePerComponent * static_cast<double>(water.waves->phases().size());
}

bool sample_points(const WaterPointsView& points, std::size_t begin, std::size_t end, const WaterState& water,
                   const Current& current, ThreadPool& threads, WaterSamplesWriter& samples) {
  std::atomic<bool> all_finite{true};
  const auto sample_chunk = [&](std::size_t first, std::size_t last) {
    for (std::size_t i = begin + first; i < begin + last; ++i) {
      const WaterSample sample = sample_at(water, current, points.point(i));
      if (!is_finite(sample)) all_finite = false;
      samples.set(i, sample);
    }
  };
  run_chunks(threads, end - begin, estimated_time_per_point(water), std::cref(sample_chunk));
  return all_finite;
}

}  // namespace buoyancy
