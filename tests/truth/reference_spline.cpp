#include "tests/truth/reference_spline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace buoyancy {
namespace {

using Matrix = std::vector<std::vector<long double>>;

// The B-spline of a degree on the knots 0, 1, ... degree + 1, or its derivative.
long double b_spline(int degree, int order, long double u) {
  if (order > 0) return b_spline(degree - 1, order - 1, u) - b_spline(degree - 1, order - 1, u - 1);
  if (degree == 0) return u >= 0 && u < 1 ? 1 : 0;
  return (u * b_spline(degree - 1, 0, u) + (degree + 1 - u) * b_spline(degree - 1, 0, u - 1)) / degree;
}

// Solves A X = B by elimination with pivots; B holds X afterwards.
void solve(Matrix A, Matrix& B) {
  const std::size_t n = A.size();
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t pivot = i;
    for (std::size_t row = i + 1; row < n; ++row) {
      if (std::abs(A[row][i]) > std::abs(A[pivot][i])) pivot = row;
    }
    std::swap(A[i], A[pivot]);
    std::swap(B[i], B[pivot]);
    for (std::size_t row = 0; row < n; ++row) {
      if (row == i || A[row][i] == 0) continue;
      const long double factor = A[row][i] / A[i][i];
      for (std::size_t column = i; column < n; ++column) A[row][column] -= factor * A[i][column];
      for (std::size_t column = 0; column < B[row].size(); ++column) B[row][column] -= factor * B[i][column];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (long double& number : B[i]) number /= A[i][i];
  }
}

// The coefficients along the columns of `samples`, which has a row for each sample along the axis.
Matrix interpolated(const Matrix& samples, bool periodic) {
  const std::size_t n = samples.size();
  const std::size_t unknowns = n + (periodic ? 0 : 2);
  Matrix A(unknowns, std::vector<long double>(unknowns));
  Matrix X(unknowns, std::vector<long double>(samples[0].size()));
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t m = 0; m < 3; ++m) {
      const std::size_t place = periodic ? (i + n + m - 1) % n : i + m;
      A[i][place] += b_spline(3, 0, 3.0L - static_cast<long double>(m));
    }
    X[i] = samples[i];
  }
  if (!periodic) {
    for (std::size_t m = 0; m < 3; ++m) {
      const long double second = b_spline(3, 2, 3.0L - static_cast<long double>(m));
      A[n][m] = second;
      A[n + 1][n - 1 + m] = second;
    }
  }
  solve(std::move(A), X);
  return X;
}

Matrix transposed(const Matrix& matrix) {
  Matrix result(matrix[0].size(), std::vector<long double>(matrix.size()));
  for (std::size_t i = 0; i < matrix.size(); ++i) {
    for (std::size_t j = 0; j < matrix[0].size(); ++j) result[j][i] = matrix[i][j];
  }
  return result;
}

}  // namespace

ReferenceSpline::ReferenceSpline(const ElevationGrid<double>& grid)
    : axes_{{{grid.origin[0], grid.spacing[0], grid.columns}, {grid.origin[1], grid.spacing[1], grid.rows}}},
      periodic_(grid.periodic) {
  Matrix samples(grid.rows, std::vector<long double>(grid.columns));
  for (std::size_t j = 0; j < grid.rows; ++j) {
    for (std::size_t i = 0; i < grid.columns; ++i) samples[j][i] = grid.elevations[j * grid.columns + i];
  }
  const Matrix coefficients =
      transposed(interpolated(transposed(interpolated(samples, periodic_)), periodic_));
  for (const auto& row : coefficients) coefficients_.insert(coefficients_.end(), row.begin(), row.end());
}

ReferenceSpline::Basis ReferenceSpline::basis_at(std::size_t n, double x, int order) const {
  const Axis& axis = axes_[n];
  const long double position =
      (static_cast<long double>(x) - axis.origin) / static_cast<long double>(axis.spacing);
  long double cell = std::floor(position);
  if (!periodic_) cell = std::clamp(cell, 0.0L, static_cast<long double>(axis.samples - 2));
  const long double t = position - cell;
  // The B-splines of rising degree that are not 0 in the cell, from their recursion, then as many differences
  // as derivatives.
  Basis basis{};
  basis.values[0] = std::pow(static_cast<long double>(axis.spacing), -order);
  for (int degree = 1; degree <= 3 - order; ++degree) {
    long double saved = 0;
    for (int m = 0; m < degree; ++m) {
      long double& value = basis.values[static_cast<std::size_t>(m)];
      const long double share = value / degree;
      value = saved + (m + 1 - t) * share;
      saved = (t + (degree - 1 - m)) * share;
    }
    basis.values[static_cast<std::size_t>(degree)] = saved;
  }
  for (std::size_t top = 4 - static_cast<std::size_t>(order); top < 4; ++top) {
    for (std::size_t m = top; m > 0; --m) basis.values[m] = basis.values[m - 1] - basis.values[m];
    basis.values[0] = -basis.values[0];
  }
  for (std::size_t m = 0; m < 4; ++m) {
    const long double number = cell - 1 + static_cast<long double>(m);
    const auto count = static_cast<long double>(axis.samples);
    basis.places[m] =
        static_cast<std::size_t>(periodic_ ? number - count * std::floor(number / count) : number + 1);
  }
  return basis;
}

long double ReferenceSpline::derivative(double x1, double x2, int order_1, int order_2) const {
  const Basis along_1 = basis_at(0, x1, order_1);
  const Basis along_2 = basis_at(1, x2, order_2);
  long double sum = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    const long double* const row = &coefficients_[along_2.places[n] * coefficients_along(0)];
    long double of_row = 0;
    for (std::size_t m = 0; m < 4; ++m) of_row += along_1.values[m] * row[along_1.places[m]];
    sum += along_2.values[n] * of_row;
  }
  return sum;
}

double ReferenceSpline::third_derivative(double x1, double x2) const {
  std::array<double, 4> entries{};
  for (int b = 0; b < 4; ++b) {
    entries[static_cast<std::size_t>(b)] = static_cast<double>(derivative(x1, x2, 3 - b, b));
  }
  double most = 0.0;
  constexpr int kDirections = 90;
  for (int n = 0; n < kDirections; ++n) {
    const double c = std::cos(n * std::numbers::pi / kDirections);
    const double s = std::sin(n * std::numbers::pi / kDirections);
    const double along = entries[0] * c * c * c + 3.0 * entries[1] * c * c * s +
                         3.0 * entries[2] * c * s * s + entries[3] * s * s * s;
    most = std::max(most, std::abs(along));
  }
  return most;
}

double ReferenceSpline::largest_difference(std::size_t order) const {
  double differences = 0.0;
  const std::size_t width = coefficients_along(0);
  const std::size_t height = coefficients_along(1);
  const auto at = [&](std::size_t j, std::size_t i) {
    return static_cast<double>(coefficients_[j % height * width + i % width]);
  };
  for (std::size_t j = 0; j < height; ++j) {
    for (std::size_t i = 0; i < width; ++i) {
      for (const bool along_1 : {true, false}) {
        if (!periodic_ && (along_1 ? i + order >= width : j + order >= height)) continue;
        const auto c = [&](std::size_t n) { return along_1 ? at(j, i + n) : at(j + n, i); };
        const double difference =
            order == 2 ? c(0) - 2.0 * c(1) + c(2) : c(0) - 3.0 * c(1) + 3.0 * c(2) - c(3);
        differences = std::max(differences, std::abs(difference));
      }
    }
  }
  // Mixed ones are as large in the worst case.
  return 2.0 * differences / std::pow(min_spacing(), static_cast<double>(order));
}

ReferenceSplineSea::ReferenceSplineSea(std::vector<Part> parts, const Water& water, const Pose& pose,
                                       const Vec3& center_B)
    : parts_(std::move(parts)) {
  const Mat3 R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 c_W = pose.p_WB + R_WB * center_B;
  const Vec3 axis = std::abs(water.up_W.x()) > 0.9 ? Vec3::UnitY() : Vec3::UnitX();
  const Vec3 e1_W = (axis - axis.dot(water.up_W) * water.up_W).normalized();
  const Vec3 e2_W = water.up_W.cross(e1_W);
  e1_B_ = R_WB.transpose() * e1_W;
  e2_B_ = R_WB.transpose() * e2_W;
  up_B_ = R_WB.transpose() * water.up_W;
  x1_ = e1_W.dot(c_W);
  x2_ = e2_W.dot(c_W);
  zeta_ = water.up_W.dot(c_W) - water.level;
  error_ = 1e-14 * (pose.p_WB.norm() + center_B.norm() + std::abs(water.level) + 10.0);
}

void ReferenceSplineSea::set_heights(SeaPoints& points) const {
  points.height.resize(points.size());
  points.pressure.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 y(points.x[i], points.y[i], points.z[i]);
    long double height = zeta_ + up_B_.dot(y);
    for (const Part& part : parts_) {
      height -= part.share * part.spline->elevation(x1_ + e1_B_.dot(y), x2_ + e2_B_.dot(y));
    }
    points.height[i] = static_cast<double>(height);
  }
}

void ReferenceSplineSea::set_pressures(SeaPoints& points) const {
  set_heights(points);
  for (std::size_t i = 0; i < points.size(); ++i) points.pressure[i] = -points.height[i];
}

double ReferenceSplineSea::curvature() const {
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.share * part.spline->curvature();
  return sum;
}

double ReferenceSplineSea::third_derivative() const {
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.share * part.spline->third_derivative();
  return sum;
}

double ReferenceSplineSea::resolved_wave_number(double /*depth*/, double /*negligible*/) const {
  double most = 0.0;
  // Elements of a cell's size resolve the spline.
  for (const Part& part : parts_) most = std::max(most, 1.5 / part.spline->min_spacing());
  return most;
}

}  // namespace buoyancy
