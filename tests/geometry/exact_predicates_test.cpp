#include "geometry/exact_predicates.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "tests/truth/rational.h"

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

// Returns a number in [-1, 1] with up to 53 significant bits.
double random_coordinate() {
  return static_cast<double>(*rc::gen::inRange<std::int64_t>(-(1LL << 53), 1LL << 53)) * 0x1p-53;
}

Vec3 random_point() {
  return {random_coordinate(), random_coordinate(), random_coordinate()};
}

// Moves a value by up to two units in the last place.
double nudged(double value) {
  const int steps = *rc::gen::inRange(-2, 3);
  const double towards = steps < 0 ? -10.0 : 10.0;
  for (int i = 0; i < std::abs(steps); ++i) value = std::nextafter(value, towards);
  return value;
}

RC_GTEST_PROP(ExactPredicates, Orient3dMatchesRationalArithmetic, ()) {
  const Vec3 a = random_point();
  const Vec3 b = random_point();
  const Vec3 c = random_point();
  const double s = random_coordinate();
  const double t = random_coordinate();
  const Vec3 on_plane = a + s * (b - a) + t * (c - a);  // up to rounding
  const Vec3 d{nudged(on_plane.x()), nudged(on_plane.y()), nudged(on_plane.z())};
  const int expected = rational_orient_3d(a, b, c, d);
  RC_ASSERT(orient_3d(a, b, c, d) == expected);
  RC_ASSERT(orient_3d(b, a, c, d) == -expected);
  const int filtered = orient_3d_filtered(a, b, c, d);
  RC_ASSERT(filtered == 0 || filtered == expected);
}

RC_GTEST_PROP(ExactPredicates, Orient2dMatchesRationalArithmetic, ()) {
  const Eigen::Vector2d a{random_coordinate(), random_coordinate()};
  const Eigen::Vector2d b{random_coordinate(), random_coordinate()};
  const Eigen::Vector2d on_line = a + random_coordinate() * (b - a);
  const Eigen::Vector2d c{nudged(on_line.x()), nudged(on_line.y())};
  const int expected = rational_orient_2d(a, b, c);
  RC_ASSERT(orient_2d(a, b, c) == expected);
  RC_ASSERT(orient_2d(c, b, a) == -expected);
}

TEST(ExactPredicates, ReturnDocumentedSigns) {
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)), 1);
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)), -1);
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(7, 9, 0)), 0);
  EXPECT_EQ(orient_2d({0, 0}, {1, 0}, {0, 1}), 1);
}

TEST(ExactPredicates, DetectOffsetsBelowRoundingError) {
  // d lies one part in 2^1000 off the plane through far points.
  const Vec3 a(1, 1, 1);
  const Vec3 b(2, 1, 1);
  const Vec3 c(1, 3, 1 + 0x1p-52);
  EXPECT_EQ(orient_3d(a, b, c, Vec3(1.5, 2, 1 + 0x1p-52)), 1);
  EXPECT_EQ(orient_3d(a, b, c, Vec3(1.5, 2, 1)), -1);
  EXPECT_EQ(orient_3d(Vec3(0, 0, 0), Vec3(1e8, 1, 0), Vec3(0, 1e8, 1), Vec3(1e-30, 0, 0)), 1);
}

TEST(ExactPredicates, DetectCollinearPointsInSpace) {
  EXPECT_TRUE(collinear(Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(3, 6, 9)));
  EXPECT_FALSE(collinear(Vec3(0, 0, 0), Vec3(1, 2, 3), Vec3(3, 6, std::nextafter(9.0, 10.0))));
  EXPECT_TRUE(collinear(Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(5, 2, 3)));
}

}  // namespace
}  // namespace buoyancy
