#include "wave_loads/edge_division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

Vec3 area_vector(const TriangleMesh& mesh, const Triangle& t) {
  return 0.5 * (mesh.vertex(t[1]) - mesh.vertex(t[0])).cross(mesh.vertex(t[2]) - mesh.vertex(t[0]));
}

double area_of(const TriangleMesh& mesh) {
  double area = 0.0;
  for (const Triangle& t : mesh.triangles) area += area_vector(mesh, t).norm();
  return area;
}

// Whether each edge is used once in each direction.
bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::int32_t, std::int32_t>, int> uses;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
  }
  return std::ranges::all_of(uses, [&](const auto& use) {
    const auto opposite = uses.find({use.first.second, use.first.first});
    return use.second == 1 && opposite != uses.end() && opposite->second == 1;
  });
}

const std::array kShapes{Shape(BoxShape{{2.0, 3.0, 0.1}, {1, 1, 1}}), Shape(CylinderShape{0.2, 4.9, 64, 1}),
                         Shape(ConeShape{1.0, 3.0, 40, 1}), Shape(RockShape{1.0, 2, 0.4, 7})};

TEST(EdgeDivision, KeepsTheSurface) {
  for (const Shape& shape : kShapes) {
    const TriangleMesh mesh = make_shape(shape);
    for (const double longest : {1.0, 0.31, 0.07}) {
      const TriangleMesh divided = with_divided_edges(mesh, longest, 1'000'000);
      EXPECT_TRUE(is_closed(divided)) << longest;
      EXPECT_NEAR(area_of(divided), area_of(mesh), 1e-12 * area_of(mesh));
      EXPECT_NEAR(volume_of(divided), volume_of(mesh), 1e-12 * std::abs(volume_of(mesh)));
      for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
        const auto n = static_cast<std::int32_t>(i);
        ASSERT_EQ(divided.vertex(n), mesh.vertex(n));
      }
    }
  }
}

TEST(EdgeDivision, DividesLongEdges) {
  for (const Shape& shape : kShapes) {
    const TriangleMesh mesh = make_shape(shape);
    const TriangleMesh divided = with_divided_edges(mesh, 0.1, 1'000'000);
    double longest = 0.0;
    for (const Triangle& t : divided.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        longest = std::max(longest, (divided.vertex(t[(i + 1) % 3]) - divided.vertex(t[i])).norm());
      }
    }
    EXPECT_LE(longest, 0.2);  // the diagonals between rows are longer than its edges
  }
}

TEST(EdgeDivision, LeavesShortEdgesAlone) {
  const TriangleMesh mesh = make_shape(SphereShape{1.0, 20});
  const TriangleMesh divided = with_divided_edges(mesh, 0.5, 1'000'000);
  EXPECT_EQ(divided.triangles, mesh.triangles);
}

TEST(EdgeDivision, MakesTwoTrianglesPerPartOfANeedle) {
  const TriangleMesh mesh = make_shape(CylinderShape{0.01, 10.0, 50, 1});
  const TriangleMesh divided = with_divided_edges(mesh, 0.1, 1'000'000);
  EXPECT_LE(divided.triangles.size(), 2U * 100U * 101U + 200U);
  EXPECT_GE(divided.triangles.size(), 2U * 100U * 99U);
}

TEST(EdgeDivision, KeepsWithinTheNumberOfTriangles) {
  const TriangleMesh mesh = make_shape(BoxShape{});
  const TriangleMesh divided = with_divided_edges(mesh, 1e-3, 5'000);
  EXPECT_LE(divided.triangles.size(), 5'000U);
  EXPECT_GE(divided.triangles.size(), 2'500U);
  EXPECT_TRUE(is_closed(divided));
}

}  // namespace
}  // namespace buoyancy
