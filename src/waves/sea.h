// A sea: wave components over water at rest, prepared once per scene, immutable and shared by all threads.
//
// The waves are linear (Airy). With the horizontal position X = (e1 . x, e2 . x) of a point x and its height
// zeta = up . x - level over the water at rest, component i has the phase theta_i = k_i d_i . (X - U t) -
// w_i t + phase_i, where U is the horizontal part of the current that carries the waves, and
//   eta = sum a_i cos(theta_i)                           elevation of the surface
//   s = zeta - eta                                       height over the surface; wet where s < 0
//   p/(rho g) = -zeta + sum a_i E_i(z') cos(theta_i)     E(z') = cosh k(z' + h) / cosh kh, with Wheeler's
//                                                        stretching z' = h s / (h + eta), h the depth
//   p/(rho g) = -s                                       where the pressure is `hydrostatic`
// In deep water z' = s and E = exp(k z'). Below the bed, and where a trough uncovers it, z' = -h, so that the
// waves are those at the bed. See docs/waves.md. A sea that is known on a grid has no components; its
// elevation is a spline.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <vector>

#include "base/error.h"
#include "base/vec3.h"
#include "base/water.h"
#include "waves/elevation_spline.h"
#include "waves/sea_description.h"

namespace buoyancy {

// Horizontal axes: e1 is the world's x axis, or its y axis where |up . x| > 0.9, projected on the horizontal
// plane and normalised; e2 = up x e1.
struct HorizontalAxes {
  Vec3 e1_W = Vec3::UnitX();
  Vec3 e2_W = Vec3::UnitY();
};
HorizontalAxes horizontal_axes(const Vec3& up_W);

// Wave components ready for evaluation, one entry of each array per component of an amplitude above 0.
struct PreparedComponents {
  std::vector<double> amplitude;          // [m]
  std::vector<double> angular_frequency;  // [rad/s]
  // [rad/s], w + k . U, with which the phase falls at a fixed point: a number and its rounding error, since
  // its product with t has to be accurate to a fraction of a turn for every utime.
  std::vector<double> apparent_frequency, apparent_frequency_rest;
  std::vector<double> wave_number;  // [rad/m], k
  // [rad/m], k times the direction's unit vector: the sum of a number and its rounding error, since k . X has
  // to be accurate to a fraction of a turn far from the origin.
  std::vector<double> k1, k1_rest, k2, k2_rest;
  std::vector<double> direction;  // [deg], as described
  std::vector<double> phase;      // [rad]

  std::size_t size() const { return amplitude.size(); }
};

// A surface on a grid, and when the water has it.
struct TimedElevation {
  std::int64_t utime = 0;  // [us]
  std::shared_ptr<const ElevationSpline> spline;
  double rise = 0.0;  // [m], added to its elevations, which are then over the level of the water
};

class Sea {
 public:
  // Errors name the number at fault: not finite, out of its range, too many components, waves without
  // gravity, waves higher than the water is deep.
  static Expected<Sea> make(const SeaDescription& description, const Water& water);
  // A sea of deep water whose surface is known on grids instead of by components, without a current: one
  // surface at all times, or the second one at a later utime, with elevations linear in time from one to the
  // other and at rest before and after. Its pressure is hydrostatic. The water moves upwards as its surface
  // does between the two, and up to the time of the second one.
  static Sea of_surfaces(std::span<const TimedElevation> surfaces, const Water& water);
  static Sea of_surfaces(std::initializer_list<TimedElevation> surfaces, const Water& water) {
    return of_surfaces(std::span(surfaces.begin(), surfaces.size()), water);
  }

  const Water& water() const { return water_; }
  const HorizontalAxes& axes() const { return axes_; }
  double depth() const { return depth_; }  // [m], may be infinite
  WavePressure pressure() const { return pressure_; }
  std::int64_t time_origin() const { return time_origin_; }  // [us]
  double ramp() const { return ramp_; }                      // [s]
  const Vec3& current_W() const { return current_W_; }       // [m/s], carries the waves

  // The described components, system after system. As one system of components they describe the same sea.
  const WaveComponents& components() const { return components_; }
  const PreparedComponents& prepared() const { return prepared_; }
  // None, or one or two: see of_surfaces().
  const std::vector<TimedElevation>& surfaces() const { return surfaces_; }
  bool is_still() const { return prepared_.size() == 0 && surfaces_.empty(); }  // no amplitude is above 0

  double significant_wave_height() const;  // [m], 4 sqrt(sum a^2 / 2); of the components alone
  double max_elevation() const;    // [m], sum a, or that of the grids: no crest is higher, no trough deeper
  double max_wave_number() const;  // [rad/m]; 0 in still water

  // How steep the sea gets: 4 standard deviations of the vertical derivative of its wave pressure at the
  // surface, over rho g, which are 4 sqrt(sum (a k)^2 / 2), or its limit sum a k where that is less. From 1
  // on, the modelled pressure falls downwards under some crests, so that the sea is too steep for linear
  // theory. In finite depth this is an upper bound, since the derivative has a factor tanh(kh).
  double extreme_steepness() const;
  bool is_too_steep() const { return extreme_steepness() >= 1.0; }

  // Amplitudes grow from 0 at t = 0 to their value at t = ramp, as (1 - cos(pi t / ramp)) / 2.
  double amplitude_factor(double t) const;

 protected:
  // Replaces the surfaces and the level [m] of a sea that of_surfaces() made. No heap allocation.
  void set_surfaces(std::span<const TimedElevation> surfaces, double level);
  void release_surfaces() { surfaces_.clear(); }

 private:
  Sea() = default;

  Water water_;
  HorizontalAxes axes_;
  double depth_ = 0.0;
  WavePressure pressure_ = WavePressure::kWheeler;
  std::int64_t time_origin_ = 0;
  double ramp_ = 0.0;
  Vec3 current_W_ = Vec3::Zero();
  WaveComponents components_;
  PreparedComponents prepared_;
  std::vector<TimedElevation> surfaces_;
};

}  // namespace buoyancy
