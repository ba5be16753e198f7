// The sea about a body, written from the formulas of docs/wave_mathematics.md and nothing of src/waves but
// the list of components: axes, wave numbers and the phases at the body's centre are computed here, in
// extended precision. The oracle of waves: many points at a time, with SIMD.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "hydrostatics/water_plane.h"
#include "waves/sea.h"

namespace buoyancy {

// Points, and what the sea is there.
struct SeaPoints {
  std::vector<double> x, y, z;  // [m], B axes, from the mesh's centre c
  std::vector<double> height;   // [m], s: over the instantaneous surface
  // [m], over rho g, wet or not. set_heights() leaves it alone.
  std::vector<double> pressure;

  std::size_t size() const { return x.size(); }
  void clear();
  void add(const Vec3& p);
};

// What reference_load() asks of a sea about a body.
class ReferenceWaters {
 public:
  virtual ~ReferenceWaters() = default;

  virtual void set_heights(SeaPoints& points) const = 0;
  virtual void set_pressures(SeaPoints& points) const = 0;
  virtual std::size_t components() const = 0;
  virtual const Vec3& up_B() const = 0;
  virtual double error() const = 0;             // [m], on heights and pressures
  virtual double curvature() const = 0;         // [1/m], how strongly the surface bends
  virtual double third_derivative() const = 0;  // [1/m^2]
  // [rad/m], the largest wave number of which something is left at a depth below the surface: that of which
  // the components above add up to at most `negligible` [m]. 0: none matters.
  virtual double resolved_wave_number(double depth, double negligible) const = 0;
};

class ReferenceSea final : public ReferenceWaters {
 public:
  ReferenceSea(const Sea& sea, std::int64_t utime, double lead_time, const Pose& pose, const Vec3& center_B);

  void set_heights(SeaPoints& points) const override;
  void set_pressures(SeaPoints& points) const override;

  std::size_t components() const override { return amplitude_.size(); }
  const Vec3& up_B() const override { return up_B_; }
  // The rounding of phases, and of wave numbers, which the sea has in double.
  double error() const override { return error_; }
  // [m], the sum of the amplitudes now: no crest is higher.
  double max_elevation() const { return max_elevation_; }
  double max_slope() const { return max_slope_; }  // sum of a k
  // 4 standard deviations or the sum over the components, whichever is less.
  double curvature() const override { return curvature_; }
  double third_derivative() const override { return third_derivative_; }
  double resolved_wave_number(double depth, double negligible) const override;

  // The components about c, in the order of falling wave number; internal to the SIMD code.
  struct View {
    std::size_t components;
    const double *amplitude, *theta, *k, *k1, *k2, *finite_scale, *twice_depth;
    std::array<double, 3> e1_B, e2_B, up_B;
    double zeta, depth;
    bool hydrostatic;
  };

 private:
  View view() const;

  std::vector<double> amplitude_, theta_, k_, k1_, k2_, finite_scale_, twice_depth_;
  Vec3 e1_B_ = Vec3::UnitX(), e2_B_ = Vec3::UnitY(), up_B_ = Vec3::UnitZ();
  double zeta_ = 0.0, depth_ = 0.0;
  bool hydrostatic_ = false;
  double error_ = 0.0, max_elevation_ = 0.0, max_slope_ = 0.0, curvature_ = 0.0, third_derivative_ = 0.0;
};

}  // namespace buoyancy
