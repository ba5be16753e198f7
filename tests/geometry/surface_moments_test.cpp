#include "geometry/surface_moments.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "geometry/pairwise_sum.h"
#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

template <typename T>
Vec3T<T> vertex_of(const TriangleMesh& mesh, std::int32_t i) {
  return mesh.vertex(i).cast<T>();
}

template <typename T>
SurfaceMoments<T> moments_of_mesh(const TriangleMesh& mesh, const Vec3T<T>& center_B) {
  PairwiseSum<SurfaceMoments<T>> sum;
  for (const Triangle& face : mesh.triangles) {
    sum.add(moments_of_triangle<T>(vertex_of<T>(mesh, face[0]) - center_B,
                                   vertex_of<T>(mesh, face[1]) - center_B,
                                   vertex_of<T>(mesh, face[2]) - center_B));
  }
  return sum.total();
}

template <typename T>
void expect_equal(const SurfaceMoments<T>& a, const SurfaceMoments<T>& b) {
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(a.S(k), b.S(k));
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(a.N(i, k), b.N(i, k));
      for (int j = 0; j < 3; ++j) EXPECT_EQ(a.second(i, j, k), b.second(i, j, k));
    }
  }
}

double max_difference(const SurfaceMoments<double>& a, const SurfaceMoments<double>& b) {
  return std::max({(a.S - b.S).cwiseAbs().maxCoeff(), (a.N - b.N).cwiseAbs().maxCoeff(),
                   (a.P - b.P).cwiseAbs().maxCoeff()});
}

Vec3T<Rational> rational_point() {
  const auto coordinate = [] {
    const int numerator = *rc::gen::inRange(-50, 51);
    return Rational(numerator, *rc::gen::inRange(1, 8));
  };
  return {coordinate(), coordinate(), coordinate()};
}

TEST(SurfaceMoments, MatchIntegralsOverTriangle) {
  // The triangle x, y >= 0, x + y <= 1 at z = 2: n = e_z; integrals of x^p y^q are p! q! / (p + q + 2)!.
  const SurfaceMoments<double> moments =
      moments_of_triangle<double>(Vec3(0, 0, 2), Vec3(1, 0, 2), Vec3(0, 1, 2));
  EXPECT_EQ(moments.S, Vec3(0, 0, 0.5));
  EXPECT_DOUBLE_EQ(moments.N(0, 2), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(moments.N(1, 2), 1.0 / 6.0);
  EXPECT_DOUBLE_EQ(moments.N(2, 2), 1.0);
  EXPECT_EQ(moments.N(2, 0), 0.0);
  EXPECT_DOUBLE_EQ(moments.second(0, 0, 2), 1.0 / 12.0);
  EXPECT_DOUBLE_EQ(moments.second(0, 1, 2), 1.0 / 24.0);
  EXPECT_DOUBLE_EQ(moments.second(1, 2, 2), 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(moments.second(2, 2, 2), 2.0);
  EXPECT_EQ(moments.second(2, 2, 0), 0.0);
}

RC_GTEST_PROP(SurfaceMoments, AreExactlyAdditiveOverPartsOfATriangle, ()) {
  const Vec3T<Rational> a = rational_point();
  const Vec3T<Rational> b = rational_point();
  const Vec3T<Rational> c = rational_point();
  const Rational s(*rc::gen::inRange(0, 11), 10);
  const Vec3T<Rational> cut = a + s * (b - a);
  SurfaceMoments<Rational> parts = moments_of_triangle<Rational>(a, cut, c);
  parts += moments_of_triangle<Rational>(cut, b, c);
  expect_equal(parts, moments_of_triangle<Rational>(a, b, c));
}

RC_GTEST_PROP(SurfaceMoments, ChangeCentreExactly, ()) {
  const Vec3T<Rational> a = rational_point();
  const Vec3T<Rational> b = rational_point();
  const Vec3T<Rational> c = rational_point();
  const Vec3T<Rational> t = rational_point();
  const Vec3T<Rational> u = rational_point();
  const SurfaceMoments<Rational> about_origin = moments_of_triangle<Rational>(a, b, c);
  expect_equal(about_origin.moved(t), moments_of_triangle<Rational>(a - t, b - t, c - t));
  expect_equal(about_origin.moved(t).moved(u), about_origin.moved(t + u));
}

RC_GTEST_PROP(SurfaceMoments, ChangeSignWithWinding, ()) {
  const Vec3T<Rational> a = rational_point();
  const Vec3T<Rational> b = rational_point();
  const Vec3T<Rational> c = rational_point();
  SurfaceMoments<Rational> both = moments_of_triangle<Rational>(a, b, c);
  both += moments_of_triangle<Rational>(a, c, b);
  expect_equal(both, SurfaceMoments<Rational>{});
}

// Invariant of a closed surface: S = 0, N = V I, P_ijk = V (m_i d_jk + m_j d_ik).
template <typename T>
SurfaceMoments<T> closed_moments(const T& volume, const Vec3T<T>& centroid) {
  SurfaceMoments<T> moments;
  for (int k = 0; k < 3; ++k) {
    moments.N(k, k) = volume;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        if (j == k) moments.second(i, j, k) += volume * centroid(i);
        if (i == k) moments.second(i, j, k) += volume * centroid(j);
      }
    }
  }
  return moments;
}

TEST(SurfaceMoments, MatchVolumeOfBoxExactly) {
  const TriangleMesh box = box_mesh(Vec3(1, 2, 3), Vec3(2, 4, 7));
  const Vec3T<Rational> center_B(Rational(1, 3), Rational(-1, 7), Rational(5));
  const Vec3T<Rational> centroid(Rational(3, 2) - center_B(0), Rational(3) - center_B(1), Rational(0));
  expect_equal(moments_of_mesh<Rational>(box, center_B), closed_moments<Rational>(Rational(8), centroid));
}

TEST(SurfaceMoments, ConvergeQuadraticallyForSphere) {
  const double volume = 4.0 / 3.0 * 3.14159265358979323846;
  const Vec3 center_B(0.3, -0.2, 0.1);
  const double coarse = max_difference(moments_of_mesh<double>(sphere_mesh(20), center_B),
                                       closed_moments<double>(volume, -center_B));
  const double fine = max_difference(moments_of_mesh<double>(sphere_mesh(40), center_B),
                                     closed_moments<double>(volume, -center_B));
  EXPECT_LT(coarse, 0.03 * volume);
  EXPECT_NEAR(coarse / fine, 4.0, 0.3);
}

TEST(SurfaceMoments, MatchExactArithmeticInDouble) {
  const TriangleMesh rock = rock_mesh();
  const SurfaceMoments<double> rounded = moments_of_mesh<double>(rock, Vec3(0.1, 0.2, 0.3));
  const SurfaceMoments<Rational> exact =
      moments_of_mesh<Rational>(rock, Vec3(0.1, 0.2, 0.3).cast<Rational>());
  SurfaceMoments<double> expected;
  for (int k = 0; k < 3; ++k) {
    expected.S(k) = exact.S(k).convert_to<double>();
    for (int i = 0; i < 3; ++i) {
      expected.N(i, k) = exact.N(i, k).convert_to<double>();
      for (int j = i; j < 3; ++j) expected.second(i, j, k) = exact.second(i, j, k).convert_to<double>();
    }
  }
  EXPECT_LT(max_difference(rounded, expected), 1e-14);
}

}  // namespace
}  // namespace buoyancy
