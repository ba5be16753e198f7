#include "c/pose_arguments.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/format.h"

namespace buoyancy {
namespace {

bool is_default(const Vec3& up_W) {
  return up_W == Vec3::UnitZ();
}

// A sea has water of its own: an argument that contradicts it would have no effect.
void check_contradictions(ArgumentChecks& checks, const Water& given, const QuerySea& of) {
  const Water& sea = of.water();
  const Water defaults;
  const auto contradicts = [&](const char* name, double value, double of_sea, double by_default) {
    if (value == of_sea || value == by_default) return;
    checks.fail(name, format_shortest(value), format_shortest(of_sea) + " as in the sea, or the default",
                "a sea has a level, a density, a gravity and an up direction of its own",
                "Set them in the text of the sea");
  };
  contradicts("water->level", given.level, sea.level, defaults.level);
  contradicts("water->density", given.density, sea.density, defaults.density);
  contradicts("water->gravity", given.gravity, sea.gravity, defaults.gravity);
  if (!of.has_up(given.up_W) && !is_default(given.up_W)) {
    checks.fail("water->up", format_vector(given.up_W),
                format_vector(sea.up_W) + " as in the sea, or the default", "",
                "Set it in the text of the sea");
  }
}

template <std::size_t kSize>
void store(const std::array<double, kSize>& values, double* out, std::size_t i) {
  if (out != nullptr) std::copy(values.begin(), values.end(), out + kSize * i);
}

void store(double value, double* out, std::size_t i) {
  if (out != nullptr) out[i] = value;
}

template <std::size_t kRows, std::size_t kColumns>
void store(const std::array<std::array<double, kColumns>, kRows>& rows, double* out, std::size_t i) {
  for (std::size_t row = 0; row < kRows; ++row) store(rows[row], out, kRows * i + row);
}

template <typename T>
std::span<T> part_of(std::span<T> all, std::size_t per_pose, std::size_t first, std::size_t n) {
  return all.empty() ? all : all.subspan(per_pose * first, per_pose * n);
}

}  // namespace

QueryWater check_water(ArgumentChecks& checks, const buoyancy_water* given) {
  QueryWater result;
  if (given == nullptr || checks.given("water", given) == nullptr) return result;
  Water& water = result.at_rest;
  const Vec3 up_W{given->up[0], given->up[1], given->up[2]};
  const double largest = up_W.cwiseAbs().maxCoeff();
  checks.number("water->level", given->level, std::isfinite(given->level), "a finite number (m)");
  checks.number("water->density", given->density, std::isfinite(given->density) && given->density >= 0.0,
                "a number from 0 (kg/m^3)");
  checks.number("water->gravity", given->gravity, std::isfinite(given->gravity) && given->gravity >= 0.0,
                "a number from 0 (m/s^2)");
  if (!up_W.allFinite() || largest == 0.0) {
    checks.fail("water->up", format_vector(up_W), "a direction: three numbers, not all zero");
  }
  if (checks.failed()) return result;
  water.level = given->level;
  water.density = given->density;
  water.gravity = given->gravity;
  water.up_W = (up_W / largest).normalized();
  if (given->sea == nullptr) return result;
  const buoyancy_sea* const sea = checks.handle("water->sea", given->sea);
  if (sea == nullptr) return result;
  check_contradictions(checks, water, sea->sea);
  return water_of(sea->sea);
}

PoseArrays check_poses(ArgumentChecks& checks, const buoyancy_poses* given) {
  if (checks.given("poses", given) == nullptr) return {};
  const std::int64_t n = given->count;
  checks.count("poses->count", n, kMaxCount);
  if (checks.failed()) return {};
  return {
      .positions = checks.array("poses->positions", given->positions, n, 3),
      .quaternions_wxyz = checks.array("poses->quaternions", given->quaternions, n, 4),
      .linear_velocities = checks.optional_array("poses->linear_velocities", given->linear_velocities, n, 3),
      .angular_velocities =
          checks.optional_array("poses->angular_velocities", given->angular_velocities, n, 3),
      .utimes = checks.utimes(given->utimes, given->utime_count, n, 0)};
}

WrenchOutput::WrenchOutput(ArgumentChecks& checks, const buoyancy_wrenches* given, std::size_t n) {
  if (checks.given("wrenches", given) == nullptr || checks.failed()) return;
  struct Numbers {
    const char* name;
    double* array;
    std::size_t per_pose;
    std::span<double>* span;
  };
  const std::array numbers{
      Numbers{"wrenches->forces", given->forces, 3, &arrays_.forces},
      Numbers{"wrenches->torques", given->torques, 3, &arrays_.torques},
      Numbers{"wrenches->volumes", given->volumes, 1, &arrays_.volumes},
      Numbers{"wrenches->centers_of_buoyancy", given->centers_of_buoyancy, 3, &arrays_.centers_of_buoyancy},
      Numbers{"wrenches->force_error_bounds", given->force_error_bounds, 1, &arrays_.force_error_bounds},
      Numbers{"wrenches->torque_error_bounds", given->torque_error_bounds, 1, &arrays_.torque_error_bounds}};
  std::size_t unwanted = 0;
  for (const Numbers& number : numbers) {
    if (number.array == nullptr) unwanted += number.per_pose * n;
  }
  unwanted_.resize(unwanted);
  std::size_t used = 0;
  for (const Numbers& number : numbers) {
    const std::size_t size = number.per_pose * n;
    if (number.array == nullptr) {
      *number.span = std::span(unwanted_).subspan(used, size);
      used += size;
    } else {
      *number.span = checks.array(number.name, number.array, static_cast<std::int64_t>(size));
    }
  }
  if (given->statuses == nullptr) {
    unwanted_statuses_.resize(n);
    arrays_.statuses = unwanted_statuses_;
  } else {
    arrays_.statuses = checks.array("wrenches->statuses", given->statuses, static_cast<std::int64_t>(n));
  }
}

void check_loads(ArgumentChecks& checks, const buoyancy_loads& given, std::size_t n) {
  const auto poses = static_cast<std::int64_t>(n);
  for (double* const array :
       {given.immersions, given.buoyancy_forces, given.buoyancy_torques, given.drag_forces,
        given.drag_torques, given.added_mass_forces, given.added_mass_torques, given.added_masses,
        given.dampings, given.water_velocities}) {
    checks.optional_array("loads", array, poses);
  }
}

void store_loads(std::span<const BodyLoads> loads, const buoyancy_loads& out, std::size_t first) {
  for (std::size_t n = 0; n < loads.size(); ++n) {
    const BodyLoads& load = loads[n];
    const std::size_t i = first + n;
    store(load.immersion, out.immersions, i);
    store(load.buoyancy_force, out.buoyancy_forces, i);
    store(load.buoyancy_torque, out.buoyancy_torques, i);
    store(load.drag_force, out.drag_forces, i);
    store(load.drag_torque, out.drag_torques, i);
    store(load.added_mass_force, out.added_mass_forces, i);
    store(load.added_mass_torque, out.added_mass_torques, i);
    store(load.added_mass, out.added_masses, i);
    store(load.damping, out.dampings, i);
    store(load.water_velocity, out.water_velocities, i);
  }
}

void check_hydrostatics(ArgumentChecks& checks, const buoyancy_hydrostatics& given, std::size_t n) {
  const auto poses = static_cast<std::int64_t>(n);
  checks.optional_array("hydrostatics->statuses", given.statuses, poses);
  for (double* const array :
       {given.volumes, given.centers_of_buoyancy, given.wetted_areas, given.waterplane_areas,
        given.waterplane_centroids, given.waterplane_second_moments, given.waterplane_axes,
        given.metacentric_radii, given.metacenters, given.metacentric_heights, given.stiffnesses}) {
    checks.optional_array("hydrostatics", array, poses);
  }
}

void store_hydrostatics(std::span<const BodyHydrostatics> hydrostatics, const buoyancy_hydrostatics& out,
                        std::size_t first) {
  for (std::size_t n = 0; n < hydrostatics.size(); ++n) {
    const BodyHydrostatics& of = hydrostatics[n];
    const std::size_t i = first + n;
    if (out.statuses != nullptr) out.statuses[i] = static_cast<std::int32_t>(of.status);
    store(of.submerged_volume, out.volumes, i);
    store(of.center_of_buoyancy, out.centers_of_buoyancy, i);
    store(of.wetted_area, out.wetted_areas, i);
    store(of.waterplane_area, out.waterplane_areas, i);
    store(of.waterplane_centroid, out.waterplane_centroids, i);
    store(of.waterplane_second_moments, out.waterplane_second_moments, i);
    store(of.waterplane_axes, out.waterplane_axes, i);
    store(of.metacentric_radii, out.metacentric_radii, i);
    store(of.metacenters, out.metacenters, i);
    store(of.metacentric_heights, out.metacentric_heights, i);
    store(of.stiffness, out.stiffnesses, i);
  }
}

PoseArrays part_of(const PoseArrays& poses, std::size_t first, std::size_t n) {
  return {part_of(poses.positions, 3, first, n), part_of(poses.quaternions_wxyz, 4, first, n),
          part_of(poses.linear_velocities, 3, first, n), part_of(poses.angular_velocities, 3, first, n),
          poses.utimes.size() == 1 ? poses.utimes : part_of(poses.utimes, 1, first, n)};
}

WrenchArrays part_of(const WrenchArrays& wrenches, std::size_t first, std::size_t n) {
  return {part_of(wrenches.statuses, 1, first, n),
          part_of(wrenches.forces, 3, first, n),
          part_of(wrenches.torques, 3, first, n),
          part_of(wrenches.volumes, 1, first, n),
          part_of(wrenches.centers_of_buoyancy, 3, first, n),
          part_of(wrenches.force_error_bounds, 1, first, n),
          part_of(wrenches.torque_error_bounds, 1, first, n)};
}

void evaluate_hydrostatics(const Body& body, const Water& water, const PoseArrays& poses,
                           const buoyancy_hydrostatics& out, unsigned threads) {
  std::vector<BodyHydrostatics> block(std::min(poses.size(), kBlock));
  for (std::size_t first = 0; first < poses.size(); first += kBlock) {
    const std::span results = std::span(block).first(std::min(kBlock, poses.size() - first));
    buoyancy::evaluate_hydrostatics(body, water, part_of(poses, first, results.size()), results, threads);
    store_hydrostatics(results, out, first);
  }
}

}  // namespace buoyancy
