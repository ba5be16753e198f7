#include "waves/elevation_spline.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "base/format.h"
#include "base/number_range.h"

namespace buoyancy {
namespace {

constexpr double kMu = 0.2679491924311227;  // 2 - sqrt 3

// The powers of -mu that matter.
constexpr std::size_t kMemory = 40;

// m_i from a natural edge on.
constexpr std::array<double, 20> kFactorsFromEdge = [] {
  std::array<double, 20> factors{};
  for (std::size_t i = 1; i < factors.size(); ++i) factors[i] = 1.0 / (4.0 - factors[i - 1]);
  return factors;
}();

// Along one axis of a matrix: n elements that are `step` numbers apart, for `width` lines beside each other,
// `apart` numbers from each other. kApart: that distance, or 0 if it is known only at run time.
template <std::ptrdiff_t kApart>
struct Lines {
  double* first;
  std::ptrdiff_t step;
  std::size_t width;
  std::ptrdiff_t apart;

  // element `to` = a * element `to` + b * element `from`
  void combine(std::ptrdiff_t to, double a, std::ptrdiff_t from, double b) const {
    double* const p = first + to * step;
    const double* const q = first + from * step;
    const std::ptrdiff_t between = kApart == 0 ? apart : kApart;
    for (std::size_t line = 0; line < width; ++line) {
      const auto at = static_cast<std::ptrdiff_t>(line) * between;
      p[at] = a * p[at] + b * q[at];
    }
  }
};

// Replaces the samples 0 to n - 1 by the coefficients. Elements -1 and n are overwritten.
template <std::ptrdiff_t kApart>
void filter(const Lines<kApart>& lines, std::size_t n, bool periodic) {
  const auto count = static_cast<std::ptrdiff_t>(n);
  if (!periodic) {
    const auto factor = [](std::ptrdiff_t i) {
      const auto k = static_cast<std::size_t>(i);
      return k < kFactorsFromEdge.size() ? kFactorsFromEdge[k] : kMu;
    };
    for (std::ptrdiff_t i = 1; i < count - 1; ++i) lines.combine(i, 6.0 * factor(i), i - 1, -factor(i));
    for (std::ptrdiff_t i = count - 2; i > 0; --i) lines.combine(i, 1.0, i + 1, -factor(i));
    return;
  }
  const auto terms = static_cast<std::ptrdiff_t>(std::min(n, kMemory));
  const double whole = 1.0 / (1.0 - std::pow(-kMu, static_cast<double>(n)));
  double weight = 6.0 * kMu * whole;
  for (std::ptrdiff_t k = 0; k < terms; ++k, weight *= -kMu) {
    lines.combine(-1, k == 0 ? 0.0 : 1.0, count - 1 - k, weight);
  }
  for (std::ptrdiff_t i = 0; i < count; ++i) lines.combine(i, 6.0 * kMu, i - 1, -kMu);
  weight = whole;
  for (std::ptrdiff_t k = 0; k < terms; ++k, weight *= -kMu) {
    lines.combine(count, k == 0 ? 0.0 : 1.0, k, weight);
  }
  for (std::ptrdiff_t i = count - 1; i >= 0; --i) lines.combine(i, 1.0, i + 1, -kMu);
}

// The weights of four coefficients for the value and the derivatives at `t` from 0 to 1 in a cell.
struct Weights {
  explicit Weights(double t) {
    const double u = 1.0 - t;
    value = {u * u * u / 6.0, (4.0 + t * t * (3.0 * t - 6.0)) / 6.0, (4.0 + u * u * (3.0 * u - 6.0)) / 6.0,
             t * t * t / 6.0};
    first = {-0.5 * u * u, t * (1.5 * t - 2.0), u * (2.0 - 1.5 * u), 0.5 * t * t};
    second = {u, 3.0 * t - 2.0, 3.0 * u - 2.0, t};
  }
  std::array<double, 4> value, first, second;
};

double sum_of(const std::array<double, 4>& weights, const std::array<double, 4>& numbers) {
  return (weights[0] * numbers[0] + weights[1] * numbers[1]) +
         (weights[2] * numbers[2] + weights[3] * numbers[3]);
}

ElevationBounds both(const ElevationBounds& a, const ElevationBounds& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high), std::max(a.third, b.third)};
}

// Of differences, over the coefficients: more than their rounding errors add up to.
constexpr double kRoundingOfDifferences = 0x1p-44;
constexpr double kMargin = 2.5e-7;  // more than the relative rounding error of float

constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr ElevationBounds kEmpty{kNone, -kNone, 0.0F};

template <typename Number>
std::optional<Error> error_in(const ElevationGrid<Number>& grid) {
  const auto error = [](std::string actual, std::string expected, std::string cause, std::string hint) {
    return Error{"the grid of elevations", std::move(actual), std::move(expected), std::move(cause),
                 std::move(hint)};
  };
  const auto is_side = [](std::size_t n) { return n >= kMinGridSide && n <= kMaxGridSide; };
  if (!is_side(grid.rows) || !is_side(grid.columns)) {
    return error(std::to_string(grid.rows) + " rows and " + std::to_string(grid.columns) + " columns",
                 std::to_string(kMinGridSide) + " to " + std::to_string(kMaxGridSide) + " of both", "",
                 "Take a part of a larger grid, around the bodies");
  }
  if (grid.elevations.size() != grid.rows * grid.columns) {
    return error(std::to_string(grid.elevations.size()) + " elevations",
                 std::to_string(grid.rows) + " rows of " + std::to_string(grid.columns), "", "");
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const NumberRange range = NumberRange::from_to(kMinGridSpacing, kMaxGridSpacing, "m");
    if (!range.contains(grid.spacing[axis])) {
      return error("spacing[" + std::to_string(axis) + "] = " + format_shortest(grid.spacing[axis]),
                   range.describe(), "", "");
    }
    if (!std::isfinite(grid.origin[axis])) {
      return error("origin[" + std::to_string(axis) + "] = " + format_shortest(grid.origin[axis]),
                   NumberRange::any("m").describe(), "", "");
    }
  }
  const auto is_good = [](Number elevation) {
    return std::abs(static_cast<double>(elevation)) <= kMaxGridElevation;
  };
  std::size_t good = 0;  // counted without a branch, which is quicker
  for (const Number elevation : grid.elevations) good += static_cast<std::size_t>(is_good(elevation));
  if (good == grid.elevations.size()) return std::nullopt;
  const auto bad = std::find_if_not(grid.elevations.begin(), grid.elevations.end(), is_good);
  const auto place = static_cast<std::size_t>(bad - grid.elevations.begin());
  return error("elevation[" + std::to_string(place / grid.columns) + "][" +
                   std::to_string(place % grid.columns) + "] = " + format_shortest(static_cast<double>(*bad)),
               NumberRange::from_to(-kMaxGridElevation, kMaxGridElevation, "m").describe(),
               "the samples are heights over another level, or not in metres",
               "Give elevations over the level of the water");
}

// The largest differences of coefficients [m], of order 1 and 2 along both axes.
struct LargestDifferences {
  double d1 = 0.0, d2 = 0.0, d11 = 0.0, d12 = 0.0, d22 = 0.0;
};

// The bounds of a strip of cells, row after row: few enough beside each other for the nearest cache.
class StripBounds {
 public:
  static constexpr std::size_t kMaxCells = 120;

  StripBounds(std::size_t cells, double per_spacing_1, double per_spacing_2)
      : cells_(cells), g1_(per_spacing_1), g2_(per_spacing_2) {}

  // Takes the next row of coefficients, of which those before it are `stride` apart. out: the cells whose
  // last row it is; not used for the first three.
  void take(const double* c, std::size_t stride, ElevationBounds* out) {
    const std::size_t r = taken_++;
    const std::size_t width = cells_ + 3;
    Row& low = low_[r % 4];
    Row& high = high_[r % 4];
    Row& t30 = t30_[r % 4];
    for (std::size_t i = 0; i < cells_; ++i) {
      low[i] = std::min(std::min(c[i], c[i + 1]), std::min(c[i + 2], c[i + 3]));
      high[i] = std::max(std::max(c[i], c[i + 1]), std::max(c[i + 2], c[i + 3]));
      t30[i] = std::abs((c[i + 3] - c[i]) - 3.0 * (c[i + 2] - c[i + 1]));
    }
    for (std::size_t i = 0; i < cells_ + 1; ++i) {
      d11_[i] = std::max(d11_[i], std::abs((c[i + 2] - c[i + 1]) - (c[i + 1] - c[i])));
    }
    for (std::size_t i = 0; i < cells_ + 2; ++i) d1_[i] = std::max(d1_[i], std::abs(c[i + 1] - c[i]));
    if (r < 1) return;
    const double* const b = c - stride;
    Row& t21 = t21_[r % 3];
    for (std::size_t i = 0; i < width; ++i) {
      d_[i] = c[i] - b[i];
      d2_[i] = std::max(d2_[i], std::abs(d_[i]));
    }
    for (std::size_t i = 0; i < cells_ + 2; ++i) d12_[i] = std::max(d12_[i], std::abs(d_[i + 1] - d_[i]));
    for (std::size_t i = 0; i < cells_; ++i) {
      const double left = (d_[i + 2] - d_[i + 1]) - (d_[i + 1] - d_[i]);
      const double right = (d_[i + 3] - d_[i + 2]) - (d_[i + 2] - d_[i + 1]);
      t21[i] = std::max(std::abs(left), std::abs(right));
    }
    if (r < 2) return;
    const double* const a = b - stride;
    Row& t12 = t12_[r % 2];
    for (std::size_t i = 0; i < width; ++i) {
      d_[i] = (c[i] - b[i]) - (b[i] - a[i]);
      d22_[i] = std::max(d22_[i], std::abs(d_[i]));
    }
    for (std::size_t i = 0; i < cells_; ++i) {
      t12[i] = std::max(std::abs(d_[i + 1] - d_[i]),
                        std::max(std::abs(d_[i + 2] - d_[i + 1]), std::abs(d_[i + 3] - d_[i + 2])));
    }
    if (r < 3) return;
    const double* const z = a - stride;
    for (std::size_t i = 0; i < width; ++i) d_[i] = std::abs((c[i] - z[i]) - 3.0 * (b[i] - a[i]));
    set_bounds(out);
  }

  LargestDifferences largest() const {
    const auto of = [this](const Row& row, std::size_t fewer) {
      return *std::max_element(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(cells_ + 3 - fewer));
    };
    return {of(d1_, 1), of(d2_, 0), of(d11_, 2), of(d12_, 1), of(d22_, 0)};
  }

 private:
  using Row = std::array<double, kMaxCells + 3>;

  void set_bounds(ElevationBounds* out) const {
    const auto largest_of = [](const auto& rows, std::size_t i) {
      return std::max(std::max(rows[0][i], rows[1][i]), std::max(rows[2][i], rows.back()[i]));
    };
    const double g = std::max(g1_, g2_);
    const double per_volume = g * g * g;
    for (std::size_t i = 0; i < cells_; ++i) {
      const double least = std::min(std::min(low_[0][i], low_[1][i]), std::min(low_[2][i], low_[3][i]));
      const double most = largest_of(high_, i);
      const double rounding = kRoundingOfDifferences * std::max(std::abs(least), std::abs(most));
      const double t30 = g1_ * g1_ * g1_ * largest_of(t30_, i);
      const double t21 = g1_ * g1_ * g2_ * largest_of(t21_, i);
      const double t12 = g1_ * g2_ * g2_ * std::max(t12_[0][i], t12_[1][i]);
      const double t03 =
          g2_ * g2_ * g2_ * std::max(std::max(d_[i], d_[i + 1]), std::max(d_[i + 2], d_[i + 3]));
      const double v1 = t30 + t12;
      const double v2 = t21 + t03;
      const double w1 = t30 - 3.0 * t12;
      const double w2 = 3.0 * t21 - t03;
      const double third = 0.25 * (3.0 * std::sqrt(v1 * v1 + v2 * v2) + std::sqrt(w1 * w1 + w2 * w2));
      out[i].low = static_cast<float>(least - kMargin * std::abs(least));
      out[i].high = static_cast<float>(most + kMargin * std::abs(most));
      out[i].third = static_cast<float>((1.0 + kMargin) * (third + rounding * per_volume));
    }
  }

  std::size_t cells_;
  double g1_, g2_;
  std::size_t taken_ = 0;
  // By the number of the row. The differences t of Lemma 6 are not divided by the spacing yet.
  std::array<Row, 4> low_{}, high_{}, t30_{};
  std::array<Row, 3> t21_{};
  std::array<Row, 2> t12_{};
  Row d_{};
  Row d1_{}, d2_{}, d11_{}, d12_{}, d22_{};  // the largest so far, by column
};

}  // namespace

template <typename Number>
Expected<void> ElevationSpline::set(const ElevationGrid<Number>& grid) {
  if (std::optional<Error> error = error_in(grid)) return make_error(*std::move(error));
  rows_ = grid.rows;
  columns_ = grid.columns;
  farthest_ = 0.0;
  for (std::size_t n = 0; n < 2; ++n) {
    const std::size_t samples = n == 0 ? columns_ : rows_;
    const std::size_t cells = grid.periodic ? samples : samples - 1;
    axes_[n] = {grid.origin[n], grid.spacing[n], 1.0 / grid.spacing[n], static_cast<std::int32_t>(cells),
                grid.periodic};
    farthest_ = std::max({farthest_, std::abs(grid.origin[n]),
                          std::abs(grid.origin[n] + static_cast<double>(cells) * grid.spacing[n])});
  }
  coefficients_.resize(stride() * (static_cast<std::size_t>(axes_[1].cells) + 3));
  for (std::size_t j = 0; j < rows_; ++j) {
    double* const row = &coefficients_[(j + 1) * stride() + 1];
    const auto samples = grid.elevations.subspan(j * columns_, columns_);
    std::transform(samples.begin(), samples.end(), row,
                   [](Number elevation) { return static_cast<double>(elevation); });
  }
  filter_rows();
  filter_columns();
  continue_beyond_edges();
  set_cell_bounds();
  build_pyramid();
  largest_ = std::max(-static_cast<double>(bounds().low), static_cast<double>(bounds().high));
  const double rounding = kRoundingOfDifferences * largest_;
  const double g = std::max(axes_[0].per_spacing, axes_[1].per_spacing);
  max_slope_ += 2.0 * g * rounding;
  max_curvature_ += 2.0 * g * g * rounding;
  return {};
}

template Expected<void> ElevationSpline::set(const ElevationGrid<float>& grid);
template Expected<void> ElevationSpline::set(const ElevationGrid<double>& grid);
template Expected<void> ElevationSpline::set(const ElevationGrid<BigEndianFloat>& grid);

void ElevationSpline::filter_rows() {
  constexpr std::size_t kTogether = 8;  // so that their chains of operations overlap
  const auto apart = static_cast<std::ptrdiff_t>(stride());
  for (std::size_t j = 0; j < rows_; j += kTogether) {
    const Lines<0> lines{&coefficients_[(j + 1) * stride() + 1], 1, std::min(kTogether, rows_ - j), apart};
    filter(lines, columns_, axes_[0].periodic);
  }
}

void ElevationSpline::filter_columns() {
  const Lines<1> lines{&coefficients_[stride() + 1], static_cast<std::ptrdiff_t>(stride()), columns_, 1};
  filter(lines, rows_, axes_[1].periodic);
}

void ElevationSpline::continue_beyond_edges() {
  const auto continue_lines = [](const auto& lines, std::size_t samples, bool periodic) {
    const auto n = static_cast<std::ptrdiff_t>(samples);
    if (periodic) {
      lines.combine(-1, 0.0, n - 1, 1.0);
      lines.combine(n, 0.0, 0, 1.0);
      lines.combine(n + 1, 0.0, 1, 1.0);
      return;
    }
    // The second derivative is 0 at the outermost samples.
    lines.combine(-1, 0.0, 0, 2.0);
    lines.combine(-1, 1.0, 1, -1.0);
    lines.combine(n, 0.0, n - 1, 2.0);
    lines.combine(n, 1.0, n - 2, -1.0);
  };
  const auto step = static_cast<std::ptrdiff_t>(stride());
  continue_lines(Lines<0>{&coefficients_[stride() + 1], 1, rows_, step}, columns_, axes_[0].periodic);
  continue_lines(Lines<1>{&coefficients_[stride()], step, stride(), 1}, rows_, axes_[1].periodic);
}

void ElevationSpline::set_cell_bounds() {
  const std::size_t width = stride();
  const auto columns = static_cast<std::size_t>(axes_[0].cells);
  const auto rows = static_cast<std::size_t>(axes_[1].cells);
  std::size_t blocks = 0;
  level_count_ = 0;
  for (std::int32_t l = 0; level_count_ == 0 || levels_[level_count_ - 1].blocks != std::array{1, 1}; ++l) {
    const auto blocks_of = [l](std::int32_t cells) { return ((cells - 1) >> l) + 1; };
    levels_[level_count_] = {blocks, {blocks_of(axes_[0].cells), blocks_of(axes_[1].cells)}};
    blocks += static_cast<std::size_t>(levels_[level_count_].blocks[0]) *
              static_cast<std::size_t>(levels_[level_count_].blocks[1]);
    ++level_count_;
  }
  bounds_.resize(blocks);

  const double g1 = axes_[0].per_spacing;
  const double g2 = axes_[1].per_spacing;
  LargestDifferences most;
  for (std::size_t first = 0; first < columns; first += StripBounds::kMaxCells) {
    StripBounds strip(std::min(StripBounds::kMaxCells, columns - first), g1, g2);
    for (std::size_t r = 0; r < rows + 3; ++r) {
      ElevationBounds* const out = r < 3 ? nullptr : &bounds_[(r - 3) * columns + first];
      strip.take(&coefficients_[r * width + first], width, out);
    }
    const LargestDifferences of_strip = strip.largest();
    most = {std::max(most.d1, of_strip.d1), std::max(most.d2, of_strip.d2), std::max(most.d11, of_strip.d11),
            std::max(most.d12, of_strip.d12), std::max(most.d22, of_strip.d22)};
  }
  max_slope_ = (1.0 + kMargin) * std::hypot(g1 * most.d1, g2 * most.d2);
  const double bend_1 = g1 * g1 * most.d11;
  const double bend_2 = g2 * g2 * most.d22;
  max_curvature_ =
      (1.0 + kMargin) * (0.5 * (bend_1 + bend_2) + std::hypot(0.5 * (bend_1 - bend_2), g1 * g2 * most.d12));
}

void ElevationSpline::build_pyramid() {
  for (std::size_t l = 1; l < level_count_; ++l) {
    const Level& finer = levels_[l - 1];
    const Level& level = levels_[l];
    ElevationBounds* block = &bounds_[level.begin];
    for (std::int32_t j = 0; j < level.blocks[1]; ++j) {
      const auto row = [&](std::int32_t at) {
        return &bounds_[finer.begin + static_cast<std::size_t>(std::min(at, finer.blocks[1] - 1)) *
                                          static_cast<std::size_t>(finer.blocks[0])];
      };
      const ElevationBounds* const one = row(2 * j);
      const ElevationBounds* const other = row(2 * j + 1);
      for (std::int32_t i = 0; i < level.blocks[0]; ++i) {
        const std::int32_t left = 2 * i;
        const std::int32_t right = std::min(left + 1, finer.blocks[0] - 1);
        *block++ = both(both(one[left], one[right]), both(other[left], other[right]));
      }
    }
  }
}

std::size_t ElevationSpline::level_of(const CellRange& range, std::size_t finer) const {
  std::array<std::int32_t, 2> spans{};
  for (std::size_t n = 0; n < 2; ++n) {
    spans[n] = range.last[n] - range.first[n];
    if (spans[n] < 0) spans[n] += axes_[n].cells;
  }
  const auto span = static_cast<std::uint32_t>(std::max(spans[0], spans[1]));
  const auto l = static_cast<std::size_t>(span < 2 ? 0 : std::bit_width(span - 1));
  return l > finer ? l - finer : 0;
}

std::int32_t ElevationSpline::Axis::cell_of(double whole) const {
  if (periodic) whole -= cells * std::floor(whole / cells);
  return static_cast<std::int32_t>(std::min(std::max(0.0, whole), cells - 1.0));  // 0 if it is not a number
}

void ElevationSpline::set_range(std::size_t n, double low, double high, CellRange& range) const {
  const Axis& axis = axes_[n];
  const double first = std::floor(low);
  const double last = std::floor(high);
  const bool all = axis.periodic && !(last - first < axis.cells - 1.0);
  range.first[n] = all ? 0 : axis.cell_of(first);
  range.last[n] = all ? axis.cells - 1 : axis.cell_of(last);
}

double ElevationSpline::min_spacing() const {
  return std::min(axes_[0].spacing, axes_[1].spacing);
}

bool ElevationSpline::holds(const HorizontalBox& box) const {
  for (std::size_t n = 0; n < 2; ++n) {
    const Axis& axis = axes_[n];
    if (axis.periodic) continue;
    // So that the outermost samples are within.
    const double rounding = 1e-9 + 1e-15 * farthest_ * axis.per_spacing;
    const bool is_within =
        axis.position(box.low[n]) >= -rounding && axis.position(box.high[n]) <= axis.cells + rounding;
    if (!is_within) return false;
  }
  return true;
}

ElevationDerivatives ElevationSpline::at(double x1, double x2) const {
  std::array<double, 2> position{axes_[0].position(x1), axes_[1].position(x2)};
  std::array<std::size_t, 2> cell{};
  for (std::size_t n = 0; n < 2; ++n) {
    const double whole = std::floor(position[n]);
    const std::int32_t inside = axes_[n].cell_of(whole);
    cell[n] = static_cast<std::size_t>(inside);
    position[n] -= axes_[n].periodic ? whole : inside;
  }
  const Weights along_1(position[0]);
  const Weights along_2(position[1]);
  std::array<double, 4> values{}, firsts{}, seconds{};
  for (std::size_t n = 0; n < 4; ++n) {
    const double* const c = &coefficients_[(cell[1] + n) * stride() + cell[0]];
    const std::array<double, 4> row{c[0], c[1], c[2], c[3]};
    values[n] = sum_of(along_1.value, row);
    firsts[n] = sum_of(along_1.first, row);
    seconds[n] = sum_of(along_1.second, row);
  }
  const double g1 = axes_[0].per_spacing;
  const double g2 = axes_[1].per_spacing;
  return {sum_of(along_2.value, values),           g1 * sum_of(along_2.value, firsts),
          g2 * sum_of(along_2.first, values),      g1 * g1 * sum_of(along_2.value, seconds),
          g1 * g2 * sum_of(along_2.first, firsts), g2 * g2 * sum_of(along_2.second, values)};
}

ElevationBounds ElevationSpline::bounds_over(const HorizontalBox& box) const {
  CellRange range{};
  for (std::size_t n = 0; n < 2; ++n) {
    set_range(n, axes_[n].position(box.low[n]), axes_[n].position(box.high[n]), range);
  }
  ElevationBounds bounds = kEmpty;
  constexpr std::size_t kFiner = 3;
  for_each_block(range, kFiner, [&](const ElevationBounds& block) { bounds = both(bounds, block); });
  return bounds;
}

bool ElevationBlend::holds(const HorizontalBox& box) const {
  return std::all_of(parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const Part& part) { return part.spline->holds(box); });
}

ElevationDerivatives ElevationBlend::at(double x1, double x2) const {
  ElevationDerivatives sum{.eta = rise};
  for (std::size_t n = 0; n < count; ++n) {
    const double share = parts[n].share;
    const ElevationDerivatives of_part = parts[n].spline->at(x1, x2);
    sum.eta += share * of_part.eta;
    sum.eta_1 += share * of_part.eta_1;
    sum.eta_2 += share * of_part.eta_2;
    sum.eta_11 += share * of_part.eta_11;
    sum.eta_12 += share * of_part.eta_12;
    sum.eta_22 += share * of_part.eta_22;
  }
  return sum;
}

ElevationBounds ElevationBlend::bounds_over(const HorizontalBox& box) const {
  if (count == 1 && rise == 0.0) return parts[0].spline->bounds_over(box);
  double low = rise;
  double high = rise;
  double third = 0.0;
  for (std::size_t n = 0; n < count; ++n) {
    const ElevationBounds of_part = parts[n].spline->bounds_over(box);
    low += parts[n].share * static_cast<double>(of_part.low);
    high += parts[n].share * static_cast<double>(of_part.high);
    third += parts[n].share * static_cast<double>(of_part.third);
  }
  return {static_cast<float>(low - kMargin * std::abs(low)),
          static_cast<float>(high + kMargin * std::abs(high)), static_cast<float>(third + kMargin * third)};
}

}  // namespace buoyancy
