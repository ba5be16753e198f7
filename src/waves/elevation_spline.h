// The surface of a sea that is known at the points of a grid: the bicubic spline through these samples, with
// bounds on its values and derivatives over rectangles (docs/wave_mathematics.md, "Surfaces on a grid").
//
//   eta(X) = sum c_ij beta((X_1 - origin_1) / spacing_1 - i) beta((X_2 - origin_2) / spacing_2 - j)
//
// with the cubic B-spline beta and X the horizontal position along e1 and e2 (HorizontalAxes in sea.h).
// Value, gradient and Hessian are continuous, third derivatives are bounded. The surface is periodic, or ends
// at the outermost samples, where it is natural: its second derivative across the edge is 0.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/error.h"

namespace buoyancy {

// A float as it is in messages.
struct BigEndianFloat {
  std::array<std::uint8_t, 4> bytes{};

  explicit operator double() const {
    const std::uint32_t bits = (std::uint32_t{bytes[0]} << 24U) | (std::uint32_t{bytes[1]} << 16U) |
                               (std::uint32_t{bytes[2]} << 8U) | std::uint32_t{bytes[3]};
    return static_cast<double>(std::bit_cast<float>(bits));
  }
};

// Samples of an elevation: number 0 is at `origin`, the next one is beside it along e1.
// Number: float, double or BigEndianFloat.
template <typename Number>
struct ElevationGrid {
  std::span<const Number> elevations;  // [m], over the level, row after row; within kMaxGridElevation of 0
  std::size_t rows = 0;                // along e2, kMinGridSide to kMaxGridSide
  std::size_t columns = 0;             // along e1, as many
  std::array<double, 2> origin{};      // [m], from the world's origin along e1 and e2
  std::array<double, 2> spacing{1.0, 1.0};  // [m], kMinGridSpacing to kMaxGridSpacing
  bool periodic = false;  // repeats after columns * spacing[0] along e1 and rows * spacing[1] along e2
};

inline constexpr std::size_t kMinGridSide = 4;
inline constexpr std::size_t kMaxGridSide = 4096;
inline constexpr double kMinGridSpacing = 1e-3;   // [m]
inline constexpr double kMaxGridSpacing = 1e4;    // [m]
inline constexpr double kMaxGridElevation = 1e3;  // [m]

struct ElevationDerivatives {
  double eta = 0.0;                                 // [m]
  double eta_1 = 0.0, eta_2 = 0.0;                  // [-]
  double eta_11 = 0.0, eta_12 = 0.0, eta_22 = 0.0;  // [1/m]
};

// Over a part of the surface, rounded outwards.
struct ElevationBounds {
  float low = 0.0F, high = 0.0F;  // [m], eta is between them
  float third = 0.0F;             // [1/m^2], on the norm of the third derivative
};

// A rectangle of the horizontal plane.
struct HorizontalBox {
  std::array<double, 2> low{}, high{};  // [m], along e1 and e2 from the world's origin
};

// Several threads may read at once.
class ElevationSpline {
 public:
  // Takes the place of what was set before, which remains where the result is an error. Errors: counts out of
  // range or unequal to the number of samples; numbers that are not finite or out of range.
  // No heap allocation unless the grid is larger than those before it. Complexity: O(samples), 20 ns each.
  template <typename Number>
  Expected<void> set(const ElevationGrid<Number>& grid);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  // The distance of the grid's farthest sample from the world's origin along an axis, at most [m].
  double farthest() const { return farthest_; }
  double min_spacing() const;  // [m], of both axes

  // Returns whether the surface is defined on the box: always if it is periodic.
  bool holds(const HorizontalBox& box) const;
  // Beyond the edge of a surface that is not periodic, the outermost polynomials are continued.
  ElevationDerivatives at(double x1, double x2) const;
  // Of the part of the box that has a surface. Complexity: O(1).
  ElevationBounds bounds_over(const HorizontalBox& box) const;

  ElevationBounds bounds() const { return bounds_.back(); }  // of all
  double max_slope() const { return max_slope_; }            // bound on |grad eta|
  double max_curvature() const { return max_curvature_; }    // [1/m], bound on the norm of the Hessian
  // [m], bound on the rounding errors of at(), and those of a gradient times r and of a Hessian times r^2 / 2
  // for r = reach [m]. largest: bound on |eta| in the cells that are asked for.
  double rounding(double largest, double reach) const {
    const double growth = 1.0 + kGrowth * reach / min_spacing();
    return (kRoundingOfSum * largest + kRoundingOfCoefficients * largest_) * growth * growth;
  }
  static constexpr double kGrowth = 3.0;

  // For code that evaluates many points at once.
  struct Axis {
    double origin = 0.0;       // [m]
    double spacing = 1.0;      // [m]
    double per_spacing = 1.0;  // [1/m]
    std::int32_t cells = 1;    // between samples
    bool periodic = false;

    // The position over the spacing, from the first sample.
    double position(double x) const { return (x - origin) * per_spacing; }
    // The cell of a position that has this whole part, from 0 to cells - 1.
    std::int32_t cell_of(double whole) const;
  };
  // Cells from `first` to `last` along each axis. Those of a periodic axis go on at 0 where last < first.
  struct CellRange {
    std::array<std::int32_t, 2> first, last;
  };
  const Axis& axis(std::size_t n) const { return axes_[n]; }
  // The 16 coefficients of cell (i, j) are c[(j + n) * stride() + i + m], m and n from 0 to 3.
  const double* coefficients() const { return coefficients_.data(); }
  std::size_t stride() const { return static_cast<std::size_t>(axes_[0].cells) + 3; }
  // Calls take(bounds) for blocks of cells that cover the range: at most 2^(finer + 1) + 1 along each axis.
  template <typename Take>
  void for_each_block(const CellRange& range, std::size_t finer, const Take& take) const {
    const std::size_t l = level_of(range, finer);
    const Level& level = levels_[l];
    const auto along = [&](std::size_t axis, const auto& take_block) {
      const std::int32_t first = range.first[axis] >> l;
      const std::int32_t last = range.last[axis] >> l;
      if (range.first[axis] <= range.last[axis]) {
        for (std::int32_t b = first; b <= last; ++b) take_block(b);
        return;
      }
      for (std::int32_t b = first; b < level.blocks[axis]; ++b) take_block(b);
      for (std::int32_t b = 0; b <= last; ++b) take_block(b);
    };
    along(1, [&](std::int32_t row) {
      const ElevationBounds* const of_row =
          &bounds_[level.begin + static_cast<std::size_t>(row) * static_cast<std::size_t>(level.blocks[0])];
      along(0, [&](std::int32_t column) { take(of_row[column]); });
    });
  }
  // The cells between two positions along an axis; low <= high.
  void set_range(std::size_t axis, double low, double high, CellRange& range) const;

 private:
  // Of the pyramid: blocks of 2^l by 2^l cells.
  struct Level {
    std::size_t begin = 0;  // of its blocks
    std::array<std::int32_t, 2> blocks{};
  };
  static constexpr std::size_t kMaxLevels = 14;
  static constexpr double kRoundingOfSum = 0x1p-47;  // 40 unit roundoffs and more
  static constexpr double kRoundingOfCoefficients = 0x1p-42;

  std::size_t level_of(const CellRange& range, std::size_t finer) const;
  void filter_rows();
  void filter_columns();
  void continue_beyond_edges();
  void set_cell_bounds();
  void build_pyramid();

  std::size_t rows_ = 0, columns_ = 0;
  std::array<Axis, 2> axes_;
  double farthest_ = 0.0;
  double largest_ = 0.0;  // [m], absolute value of a coefficient
  double max_slope_ = 0.0, max_curvature_ = 0.0;
  std::vector<double> coefficients_;
  std::array<Level, kMaxLevels> levels_{};
  std::size_t level_count_ = 0;
  std::vector<ElevationBounds> bounds_;  // level after level
};

// The elevation at one time: that of a spline, or of two, with shares that add up to 1, over another level.
struct ElevationBlend {
  struct Part {
    const ElevationSpline* spline = nullptr;
    double share = 0.0;
  };
  std::array<Part, 2> parts;
  std::size_t count = 0;  // of the parts; 0: none
  double rise = 0.0;      // [m], added to their sum

  bool holds(const HorizontalBox& box) const;
  ElevationDerivatives at(double x1, double x2) const;
  ElevationBounds bounds_over(const HorizontalBox& box) const;
};

}  // namespace buoyancy
