// A sea at one instant: elevation, pressure, and the velocity and acceleration of the water, at any point.
#pragma once

#include <cstdint>
#include <vector>

#include "base/vec3.h"
#include "waves/elevation_spline.h"
#include "waves/sea.h"

namespace buoyancy {

// The water at a point. Above the surface there is none: the pressure is then 0, and velocity and
// acceleration are those of the surface below the point.
struct WaterAtPoint {
  double elevation = 0.0;  // [m], eta: of the surface above or below the point, over the level
  double height = 0.0;     // [m], s: of the point over the surface; wet where below 0
  double pressure = 0.0;   // [Pa], over that of the air
  // By stretched linear theory (docs/waves.md). Beyond first order in the steepness, the acceleration is not
  // the derivative of the velocity. Both are those that an observer sees who drifts with the current.
  Vec3 velocity_W = Vec3::Zero();      // [m/s], of the waves, without the current
  Vec3 acceleration_W = Vec3::Zero();  // [m/s^2]
};

// Nothing allocates but the constructors, and phases_at() if its output has too little capacity. Several
// threads may query at once. Complexity: O(components) each.
class SeaSnapshot {
 public:
  // sea: must outlive this object. The time is t = 0 until set_time() is called.
  explicit SeaSnapshot(const Sea& sea);
  SeaSnapshot(const Sea& sea, std::int64_t utime, double lead_time = 0.0);  // at this time, see set_time()

  // utime: [us]; t = (utime - time_origin) / 1e6 + lead_time. lead_time: [s], finite. Phases are exact to
  // 1e-15 of a turn for every utime.
  void set_time(std::int64_t utime, double lead_time = 0.0);

  const Sea& sea() const { return *sea_; }
  double amplitude_factor() const { return amplitude_factor_; }  // Sea::amplitude_factor() now
  // [rad], one per component of Sea::prepared(), in [-pi, pi]: the phase at X = 0.
  const std::vector<double>& phases() const { return phases_; }
  // Of a sea on grids, otherwise without parts.
  const ElevationBlend& surface() const { return surface_; }
  // [s], of the two surfaces on grids between which this time is, or whose later one has it; 0: there are no
  // two.
  double time_between_surfaces() const { return time_between_; }

  // [m], over the level. x1, x2: [m], along the horizontal axes from the world's origin. Phases are exact to
  // 1e-15 of a turn out to 1e9 wavelengths. Not a number where a sea on grids has no surface.
  double elevation(double x1, double x2) const;
  // Of a sea on grids, the velocity is that of the surface, upwards, where both grids have one, and the
  // acceleration 0.
  WaterAtPoint at(const Vec3& p_W) const;
  // Sets out[i] to the phase of component i at this place [rad], in [-pi, pi].
  void phases_at(double x1, double x2, std::vector<double>& out) const;

 private:
  double phase_at(std::size_t component, double x1, double x2) const;  // [rad]
  void set_surface(double t);
  double surface_velocity(double x1, double x2) const;

  const Sea* sea_;
  double amplitude_factor_ = 1.0;
  std::vector<double> phases_;
  ElevationBlend surface_;
  double time_between_ = 0.0;
};

}  // namespace buoyancy
