// The bicubic spline through samples by the definition of B-splines, in extended precision, and nothing of
// src/waves: basis functions by de Boor's recursion, coefficients by elimination of the full equations.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "hydrostatics/water_plane.h"
#include "tests/truth/reference_sea.h"
#include "waves/elevation_spline.h"
#include "waves/sea.h"

namespace buoyancy {

class ReferenceSpline {
 public:
  // Complexity: O(n^3) of the samples along an axis.
  explicit ReferenceSpline(const ElevationGrid<double>& grid);

  // The derivative of this order along e1 and e2, up to 3 together.
  long double derivative(double x1, double x2, int order_1, int order_2) const;
  long double elevation(double x1, double x2) const { return derivative(x1, x2, 0, 0); }
  // The norm of the third derivative, by many directions.
  double third_derivative(double x1, double x2) const;
  // Bounds on second and third derivatives along any direction, rough ones.
  double curvature() const { return largest_difference(2); }
  double third_derivative() const { return largest_difference(3); }
  double min_spacing() const { return std::min(axes_[0].spacing, axes_[1].spacing); }

 private:
  struct Axis {
    double origin, spacing;
    std::size_t samples;
  };
  // The first of the four coefficients that count at a position, and what each counts.
  struct Basis {
    std::array<std::size_t, 4> places;
    std::array<long double, 4> values;
  };
  Basis basis_at(std::size_t axis, double x, int order) const;
  // Coefficients along an axis, with those before and after the samples unless it is periodic.
  std::size_t coefficients_along(std::size_t axis) const { return axes_[axis].samples + (periodic_ ? 0 : 2); }

  double largest_difference(std::size_t order) const;  // over the spacing

  std::array<Axis, 2> axes_;
  bool periodic_;
  std::vector<long double> coefficients_;  // row after row
};

// The water under splines about a body: hydrostatic, as in Sea::of_surfaces().
class ReferenceSplineSea final : public ReferenceWaters {
 public:
  struct Part {
    const ReferenceSpline* spline;
    double share;
  };
  ReferenceSplineSea(std::vector<Part> parts, const Water& water, const Pose& pose, const Vec3& center_B);

  void set_heights(SeaPoints& points) const override;
  void set_pressures(SeaPoints& points) const override;
  std::size_t components() const override { return parts_.size(); }
  const Vec3& up_B() const override { return up_B_; }
  double error() const override { return error_; }
  double curvature() const override;
  double third_derivative() const override;
  double resolved_wave_number(double depth, double negligible) const override;

 private:
  std::vector<Part> parts_;
  Vec3 e1_B_, e2_B_, up_B_;
  double x1_, x2_, zeta_;
  double error_;
};

}  // namespace buoyancy
