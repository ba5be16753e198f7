// Ball arithmetic: intervals as a midpoint and a radius, in extended precision. Every operation's radius
// covers the radii of its operands and its own rounding, so that the true value of whatever a templated
// kernel computes certainly lies within the ball. It is thousands of times faster than rational arithmetic,
// and its 64 bits of mantissa keep balls narrow enough to check doubles.
//
// Boost.Interval is not an alternative: it changes the processor's rounding mode, and GCC moves operations
// across such a change unless the whole program is compiled for it.
#pragma once

#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {

struct Ball {
  long double mid = 0.0L;
  long double rad = 0.0L;

  Ball() = default;
  explicit Ball(double number) : mid(number) {}
  explicit Ball(int number) : mid(number) {}

  static Ball around(const Rational& number);
  bool contains(const Rational& number) const;

  friend Ball operator-(Ball a) {
    a.mid = -a.mid;
    return a;
  }
  friend Ball operator+(const Ball& a, const Ball& b) { return rounded(a.mid + b.mid, a.rad + b.rad); }
  friend Ball operator-(const Ball& a, const Ball& b) { return rounded(a.mid - b.mid, a.rad + b.rad); }
  friend Ball operator*(const Ball& a, const Ball& b) {
    return rounded(a.mid * b.mid, std::abs(a.mid) * b.rad + std::abs(b.mid) * a.rad + a.rad * b.rad);
  }
  // Returns the whole line if b contains 0.
  friend Ball operator/(const Ball& a, const Ball& b) {
    const long double min_divisor = std::abs(b.mid) - b.rad;
    const long double quotient = a.mid / b.mid;
    if (!(min_divisor > 0.0L)) return rounded(0.0L, std::numeric_limits<long double>::infinity());
    return rounded(quotient, (a.rad + std::abs(quotient) * (b.rad + std::abs(b.mid) * kUnit)) / min_divisor);
  }
  Ball& operator+=(const Ball& b) { return *this = *this + b; }
  Ball& operator-=(const Ball& b) { return *this = *this - b; }
  Ball& operator*=(const Ball& b) { return *this = *this * b; }
  Ball& operator/=(const Ball& b) { return *this = *this / b; }

  // Compares midpoints: heights are settled (SettledHeights<Ball>) before they are compared.
  friend bool operator<(const Ball& a, const Ball& b) { return a.mid < b.mid; }
  friend bool operator==(const Ball& a, const Ball& b) { return a.mid == b.mid && a.rad == b.rad; }

  // Upper bound on the distance of any point of the ball from `number`.
  long double distance(double number) const { return std::abs(mid - number) + rad; }

 private:
  static constexpr long double kUnit = 0x1p-63L;  // twice the rounding error of one operation, relative

  static Ball rounded(long double mid, long double rad) {
    Ball ball;
    ball.mid = mid;
    ball.rad = (rad + std::abs(mid) * kUnit) * (1.0L + 0x1p-58L) + 0x1p-16300L;
    return ball;
  }
};

}  // namespace buoyancy

// The names are Eigen's.
// NOLINTBEGIN(readability-identifier-naming)
template <>
struct Eigen::NumTraits<buoyancy::Ball> : Eigen::GenericNumTraits<long double> {
  using Real = buoyancy::Ball;
  using NonInteger = buoyancy::Ball;
  using Nested = buoyancy::Ball;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 2,
    AddCost = 4,
    MulCost = 8
  };
};
template <>
struct Eigen::internal::cast_impl<double, buoyancy::Ball> {
  static buoyancy::Ball run(const double& number) { return buoyancy::Ball(number); }
};
// NOLINTEND(readability-identifier-naming)

namespace buoyancy {

// Computed in rational arithmetic: level, position and the mesh's offset in B may cancel almost completely.
template <>
ExactPlane<Ball> exact_plane<Ball>(const Pose& pose, const Water& water, const Vec3& o_B);

}  // namespace buoyancy
