// The water and the waves of queries in the caller's process, and the motion of the water at many points.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "base/current.h"
#include "base/error.h"
#include "wave_loads/prepared_sea.h"
#include "waves/sea_description.h"

namespace buoyancy {

// Immutable, and cheap to copy: copies share the sea.
class QuerySea {
 public:
  // profile: of the current; description.current_W is its velocity at the level. Empty: it has none. Errors:
  // those of Sea::make().
  static Expected<QuerySea> make(const SeaDescription& description, const Water& water,
                                 CurrentProfile profile = {});
  // text: the sections [world] and [water] of a scene file (docs/scene_file.md); directory: resolves the
  // relative paths of files of wave components. name: identifies the text in errors. Errors: those of
  // parse_water() and Sea::make(), and waves = "received".
  static Expected<QuerySea> parse(std::string_view text, const std::string& name,
                                  const std::filesystem::path& directory);

  // The surface that is the spline through these samples, at all times. Its pressure is hydrostatic. Errors:
  // those of ElevationSpline::set().
  static Expected<QuerySea> from_grid(const ElevationGrid<double>& grid, const Water& water);

  const Water& water() const { return water_; }
  // nullptr: the water is at rest, since no amplitude is above 0.
  const std::shared_ptr<const PreparedSea>& waves() const { return waves_; }
  const Vec3& current_W() const { return current_.velocity_W; }  // [m/s], at the level: it carries the waves
  const Current& current() const { return current_; }
  HorizontalAxes axes() const { return horizontal_axes(water_.up_W); }
  // Returns whether a unit vector is up of this water, to rounding: normalising up again may change its last
  // bits.
  bool has_up(const Vec3& up_W) const { return (up_W - water_.up_W).cwiseAbs().maxCoeff() <= 1e-15; }

 private:
  QuerySea(const Water& water, std::shared_ptr<const PreparedSea> waves, Current current)
      : water_(water), waves_(std::move(waves)), current_(std::move(current)) {}

  Water water_;
  std::shared_ptr<const PreparedSea> waves_;
  Current current_;
};

// Sets out[i] to the elevation of the surface over the level [m] at (x1[i], x2[i]) [m] along the horizontal
// axes (axes()) from the world's origin, at utimes[i] [us]; not a number beyond the edge of a grid. utimes:
// as many, or one for all points, which is quicker by far. All other spans have the same size. threads: see
// evaluate_poses(). Complexity: O(components) per point.
void sea_elevations(const QuerySea& sea, std::span<const double> x1, std::span<const double> x2,
                    std::span<const std::int64_t> utimes, std::span<double> out, unsigned threads = 1);

// The results of water_at_points(): points are in W [m], 3 n; utimes and threads are as above. Pressures are
// gauge pressures, of the waves and of the water at rest together, and 0 above the surface.
struct WaterMotionArrays {
  std::span<double> pressures;      // [Pa]; n, or empty: not wanted
  std::span<double> velocities;     // [m/s], W frame, of current and waves; 3 n, or empty
  std::span<double> accelerations;  // [m/s^2], W frame, as in WaterAtPoint; 3 n, or empty
};
void water_at_points(const QuerySea& sea, std::span<const double> points,
                     std::span<const std::int64_t> utimes, const WaterMotionArrays& out,
                     unsigned threads = 1);

}  // namespace buoyancy
