// Seas of the C interface, and the water without waves.
#include <limits>
#include <memory>
#include <utility>

#include "c/pose_arguments.h"

using buoyancy::ArgumentChecks;
using buoyancy::CallResult;
using buoyancy::run_call;

namespace {

void set(const buoyancy::Vec3& vector, double* out) {
  for (int axis = 0; axis < 3; ++axis) out[axis] = vector[axis];
}

void set_info(const buoyancy::QuerySea& sea, buoyancy_sea_info& info) {
  const buoyancy::Water& water = sea.water();
  info.level = water.level;
  info.density = water.density;
  info.gravity = water.gravity;
  set(water.up_W, info.up);
  set(sea.axes().e1_W, info.axis1);
  set(sea.axes().e2_W, info.axis2);
  const bool waves = sea.waves() != nullptr;
  info.depth = waves ? sea.waves()->depth() : std::numeric_limits<double>::infinity();
  info.max_elevation = waves ? sea.waves()->max_elevation() : 0.0;
  info.wave_components = waves ? static_cast<std::int64_t>(sea.waves()->prepared().size()) : 0;
}

}  // namespace

buoyancy_error buoyancy_default_water(buoyancy_water* water, size_t size) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_default_water");
    checks.not_null("water", water);
    checks.has_size("water", size, sizeof *water);
    if (!checks.failed()) *water = buoyancy::kDefaultWater;
    return checks.failure();
  });
}

buoyancy_error buoyancy_sea_from_toml(const char* toml, const char* directory, buoyancy_sea** sea) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_sea_from_toml");
    checks.out_handle("sea", sea);
    const std::string_view text = checks.text("toml", toml);
    if (checks.failed()) return checks.failure();
    buoyancy::Expected<buoyancy::QuerySea> parsed =
        buoyancy::QuerySea::parse(text, "sea", directory == nullptr ? "" : directory);
    if (!parsed) return buoyancy::failure(BUOYANCY_ERROR_SCENE, std::move(parsed.error()));
    buoyancy::hand_over(std::make_unique<buoyancy_sea>(*std::move(parsed)), sea);
    return {};
  });
}

buoyancy_error buoyancy_sea_from_grid(const buoyancy_grid* grid, const buoyancy_water* water,
                                      buoyancy_sea** sea) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_sea_from_grid");
    checks.out_handle("sea", sea);
    const buoyancy_grid* const given = checks.given("grid", grid);
    const buoyancy::QueryWater under = buoyancy::check_water(checks, water);
    if (checks.failed()) return checks.failure();
    if (under.waves != nullptr) checks.fail("water->sea", "a sea", "NULL");
    const auto max_side = static_cast<std::int64_t>(buoyancy::kMaxGridSide);
    checks.count("grid->rows", given->rows, max_side);
    checks.count("grid->columns", given->columns, max_side);
    if (checks.failed()) return checks.failure();
    const std::span elevations =
        checks.array("grid->elevations", given->elevations, given->rows * given->columns);
    if (checks.failed()) return checks.failure();
    buoyancy::Expected<buoyancy::QuerySea> made =
        buoyancy::QuerySea::from_grid({elevations,
                                       static_cast<std::size_t>(given->rows),
                                       static_cast<std::size_t>(given->columns),
                                       {given->origin[0], given->origin[1]},
                                       {given->spacing[0], given->spacing[1]},
                                       given->periodic != 0},
                                      under.at_rest);
    if (!made) return buoyancy::failure(BUOYANCY_ERROR_SCENE, std::move(made.error()));
    buoyancy::hand_over(std::make_unique<buoyancy_sea>(*std::move(made)), sea);
    return {};
  });
}

buoyancy_error buoyancy_sea_free(buoyancy_sea* sea) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_sea_free");
    checks.free("sea", sea);
    return checks.failure();
  });
}

buoyancy_error buoyancy_sea_get_info(const buoyancy_sea* sea, buoyancy_sea_info* info) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_sea_get_info");
    const buoyancy_sea* const of = checks.handle("sea", sea);
    buoyancy_sea_info* const out = checks.output("info", info);
    if (!checks.failed()) set_info(of->sea, *out);
    return checks.failure();
  });
}

buoyancy_error buoyancy_sea_elevations(const buoyancy_sea* sea, int64_t count, const double* x1,
                                       const double* x2, const int64_t* utimes, int64_t utime_count,
                                       double* elevations, int32_t threads) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_sea_elevations");
    const buoyancy_sea* const of = checks.handle("sea", sea);
    checks.count("count", count, buoyancy::kMaxCount);
    const std::span along1 = checks.array("x1", x1, count);
    const std::span along2 = checks.array("x2", x2, count);
    const std::span times = checks.utimes(utimes, utime_count, count, 1);
    const std::span out = checks.array("elevations", elevations, count);
    const unsigned on = checks.threads(threads);
    if (checks.failed()) return checks.failure();
    sea_elevations(of->sea, along1, along2, times, out, on);
    return {};
  });
}

buoyancy_error buoyancy_sea_water_at(const buoyancy_sea* sea, int64_t count, const double* positions,
                                     const int64_t* utimes, int64_t utime_count, double* pressures,
                                     double* velocities, double* accelerations, int32_t threads) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_sea_water_at");
    const buoyancy_sea* const of = checks.handle("sea", sea);
    checks.count("count", count, buoyancy::kMaxCount);
    if (checks.failed()) return checks.failure();
    const std::span points = checks.array("positions", positions, count, 3);
    const std::span times = checks.utimes(utimes, utime_count, count, 1);
    const buoyancy::WaterMotionArrays out{checks.optional_array("pressures", pressures, count),
                                          checks.optional_array("velocities", velocities, count, 3),
                                          checks.optional_array("accelerations", accelerations, count, 3)};
    const unsigned on = checks.threads(threads);
    if (checks.failed()) return checks.failure();
    water_at_points(of->sea, points, times, out, on);
    return {};
  });
}
