#include "query/query_sea.h"

#include <optional>
#include <utility>

#include "engine/water_points.h"
#include "query/pose_loop.h"
#include "scene/scene_file.h"

namespace buoyancy {
namespace {

constexpr double kTimePerComponent = 10.0;  // [ns], rough

double time_per_point(const QuerySea& sea) {
  if (sea.waves() == nullptr) return 1.0;
  return kTimePerComponent * static_cast<double>(sea.waves()->prepared().size());
}

}  // namespace

Expected<QuerySea> QuerySea::make(const SeaDescription& description, const Water& water,
                                  CurrentProfile profile) {
  Current current{description.current_W, std::move(profile)};
  if (description.systems.empty()) return QuerySea(water, nullptr, std::move(current));
  Expected<Sea> sea = Sea::make(description, water);
  if (!sea) return make_error(std::move(sea.error()));
  if (sea->is_still()) return QuerySea(water, nullptr, std::move(current));
  return QuerySea(water, std::make_shared<const PreparedSea>(*std::move(sea)), std::move(current));
}

Expected<QuerySea> QuerySea::parse(std::string_view text, const std::string& name,
                                   const std::filesystem::path& directory) {
  const Expected<SceneDescription> description = parse_water(text, name, directory);
  if (!description) return make_error(description.error());
  if (description->sea_messages != SeaMessages::kNone) {
    return make_error({name, to_string(description->sea_messages), "the wave systems themselves",
                       "no messages are received in a query", "List the systems, or leave waves out"});
  }
  Expected<QuerySea> sea = make(description->sea, description->water, description->current_profile);
  if (!sea) {
    Error error = std::move(sea.error());
    error.subject = name + ": [water], " + error.subject;
    return make_error(std::move(error));
  }
  return sea;
}

Expected<QuerySea> QuerySea::from_grid(const ElevationGrid<double>& grid, const Water& water) {
  auto spline = std::make_shared<ElevationSpline>();
  if (Expected<void> set = spline->set(grid); !set) return make_error(std::move(set.error()));
  Sea sea = Sea::of_surfaces({{0, std::move(spline)}}, water);
  return QuerySea(water, std::make_shared<const PreparedSea>(std::move(sea)), Current{});
}

void sea_elevations(const QuerySea& sea, std::span<const double> x1, std::span<const double> x2,
                    std::span<const std::int64_t> utimes, std::span<double> out, unsigned threads) {
  run_chunks(out.size(), time_per_point(sea), threads, [&](std::size_t begin, std::size_t end) {
    MovingSea moving(sea.waves().get());
    for (std::size_t i = begin; i < end; ++i) {
      const SeaAtTime* const now = moving.at(utimes[utimes.size() == 1 ? 0 : i]);
      out[i] = now == nullptr ? 0.0 : now->elevation(x1[i], x2[i]);
    }
  });
}

void water_at_points(const QuerySea& sea, std::span<const double> points,
                     std::span<const std::int64_t> utimes, const WaterMotionArrays& out, unsigned threads) {
  run_chunks(points.size() / 3, time_per_point(sea), threads, [&](std::size_t begin, std::size_t end) {
    MovingSea moving(sea.waves().get());
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 p_W{points[3 * i], points[3 * i + 1], points[3 * i + 2]};
      const SeaAtTime* const now = moving.at(utimes[utimes.size() == 1 ? 0 : i]);
      const WaterAtPoint point = water_at({&sea.water(), now}, p_W);
      const Vec3 current_W = sea.current().at(sea.water(), p_W);
      if (!out.pressures.empty()) out.pressures[i] = point.pressure;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto n = static_cast<Eigen::Index>(axis);
        if (!out.velocities.empty()) out.velocities[3 * i + axis] = current_W[n] + point.velocity_W[n];
        if (!out.accelerations.empty()) out.accelerations[3 * i + axis] = point.acceleration_W[n];
      }
    }
  });
}

}  // namespace buoyancy
