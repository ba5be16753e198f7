#include "geometry/exact_predicates.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/hydrostatics/rational.h"

namespace buoyancy {
namespace {

int sign(const Rational& value) {
  return value.sign();
}

int rational_orient_2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Rational ux = Rational(b.x()) - Rational(a.x());
  const Rational uy = Rational(b.y()) - Rational(a.y());
  const Rational vx = Rational(c.x()) - Rational(a.x());
  const Rational vy = Rational(c.y()) - Rational(a.y());
  return sign(ux * vy - uy * vx);
}

int rational_orient_3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3T<Rational> u = b.cast<Rational>() - a.cast<Rational>();
  const Vec3T<Rational> v = c.cast<Rational>() - a.cast<Rational>();
  const Vec3T<Rational> w = d.cast<Rational>() - a.cast<Rational>();
  return sign(w(0) * (u(1) * v(2) - u(2) * v(1)) + w(1) * (u(2) * v(0) - u(0) * v(2)) +
              w(2) * (u(0) * v(1) - u(1) * v(0)));
}

// In [-1, 1], with all 53 bits in use.
double full_mantissa() {
  return static_cast<double>(*rc::gen::inRange<std::int64_t>(-(1LL << 53), 1LL << 53)) * 0x1p-53;
}

Vec3 full_point() {
  return {full_mantissa(), full_mantissa(), full_mantissa()};
}

// Up to two steps to a neighbouring double.
double nudged(double value) {
  const int steps = *rc::gen::inRange(-2, 3);
  const double towards = steps < 0 ? -10.0 : 10.0;
  for (int i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, towards);
  return value;
}

RC_GTEST_PROP(ExactPredicates, DecideThePlaneAsRationalArithmeticDoes, ()) {
  const Vec3 a = full_point();
  const Vec3 b = full_point();
  const Vec3 c = full_point();
  const double s = full_mantissa();
  const double t = full_mantissa();
  const Vec3 on_plane = a + s * (b - a) + t * (c - a);  // but for rounding
  const Vec3 d(nudged(on_plane.x()), nudged(on_plane.y()), nudged(on_plane.z()));
  const int expected = rational_orient_3d(a, b, c, d);
  RC_ASSERT(orient_3d(a, b, c, d) == expected);
  RC_ASSERT(orient_3d(b, a, c, d) == -expected);
  const int clear = orient_3d_filtered(a, b, c, d);
  RC_ASSERT(clear == 0 || clear == expected);
}

RC_GTEST_PROP(ExactPredicates, DecideTheLineAsRationalArithmeticDoes, ()) {
  const Eigen::Vector2d a(full_mantissa(), full_mantissa());
  const Eigen::Vector2d b(full_mantissa(), full_mantissa());
  const Eigen::Vector2d on_line = a + full_mantissa() * (b - a);
  const Eigen::Vector2d c(nudged(on_line.x()), nudged(on_line.y()));
  const int expected = rational_orient_2d(a, b, c);
  RC_ASSERT(orient_2d(a, b, c) == expected);
  RC_ASSERT(orient_2d(c, b, a) == -expected);
}

TEST(ExactPredicates, KnowWhichSideIsWhich) {
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)), 1);
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)), -1);
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(7, 9, 0)), 0);
  EXPECT_EQ(orient_2d({0, 0}, {1, 0}, {0, 1}), 1);
}

TEST(ExactPredicates, SeeADifferenceThatRoundingLoses) {
  // d lies one part in 2^1000 off the plane through far points.
  const Vec3 a(1, 1, 1);
  const Vec3 b(2, 1, 1);
  const Vec3 c(1, 3, 1 + 0x1p-52);
  EXPECT_EQ(orient_3d(a, b, c, Vec3(1.5, 2, 1 + 0x1p-52)), 1);
  EXPECT_EQ(orient_3d(a, b, c, Vec3(1.5, 2, 1)), -1);
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1e8, 1, 0), Vec3(0, 1e8, 1), Vec3(1e-30, 0, 0)), 1);
}

TEST(ExactPredicates, FindThreePointsOnOneLineInSpace) {
  EXPECT_TRUE(collinear(Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(3, 6, 9)));
  EXPECT_FALSE(collinear(Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(3, 6, std::nextafter(9.0, 10.0))));
  EXPECT_TRUE(collinear(Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(5, 2, 3)));
}

}  // namespace
}  // namespace buoyancy
