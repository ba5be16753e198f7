#include "geometry/self_intersection.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "geometry/shapes.h"
#include "geometry/welding.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

// The oracle, exact on small integers: two convex polygons or segments share no point if and only if they are
// separated along one of their normals, a cross product of their edges, or a cross product of a normal and an
// edge.
using Point = Eigen::Matrix<std::int64_t, 3, 1>;
using Polygon = std::vector<Point>;

bool separates(const Point& axis, const Polygon& s, const Polygon& t) {
  const auto along = [&axis](const Point& a, const Point& b) { return axis.dot(a) < axis.dot(b); };
  const auto [s_min, s_max] = std::minmax_element(s.begin(), s.end(), along);
  const auto [t_min, t_max] = std::minmax_element(t.begin(), t.end(), along);
  return axis.dot(*s_max) < axis.dot(*t_min) || axis.dot(*t_max) < axis.dot(*s_min);
}

std::vector<Point> edges_of(const Polygon& polygon) {
  std::vector<Point> edges;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    edges.push_back(polygon[(i + 1) % polygon.size()] - polygon[i]);
  return edges;
}

bool have_a_common_point(const Polygon& s, const Polygon& t) {
  const std::vector<Point> s_edges = edges_of(s);
  const std::vector<Point> t_edges = edges_of(t);
  std::vector<Point> edges = s_edges;
  edges.insert(edges.end(), t_edges.begin(), t_edges.end());
  std::vector<Point> axes{s_edges[0].cross(s_edges[1]), t_edges[0].cross(t_edges[1])};
  for (std::size_t normal = 0; normal < 2; ++normal) {
    for (const Point& edge : edges) axes.push_back(axes[normal].cross(edge));
  }
  for (const Point& a : s_edges) {
    for (const Point& b : t_edges) axes.push_back(a.cross(b));
  }
  return std::none_of(axes.begin(), axes.end(), [&](const Point& axis) { return separates(axis, s, t); });
}

Point integer_vertex(const TriangleMesh& mesh, std::int32_t v) {
  return mesh.vertex(v).cast<std::int64_t>();
}

Polygon polygon_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& vertices) {
  Polygon polygon;
  for (const std::int32_t v : vertices) polygon.push_back(integer_vertex(mesh, v));
  return polygon;
}

// Applies the definition in the header to one pair.
bool intersect_by_definition(const TriangleMesh& mesh, const Triangle& s, const Triangle& t) {
  std::vector<std::int32_t> common;
  std::vector<std::int32_t> s_own;
  std::vector<std::int32_t> t_own;
  for (const std::int32_t v : s) {
    (std::find(t.begin(), t.end(), v) != t.end() ? common : s_own).push_back(v);
  }
  for (const std::int32_t v : t) {
    if (std::find(s.begin(), s.end(), v) == s.end()) t_own.push_back(v);
  }
  const Polygon s_polygon = polygon_of(mesh, {s.begin(), s.end()});
  const Polygon t_polygon = polygon_of(mesh, {t.begin(), t.end()});
  if (common.empty()) return have_a_common_point(s_polygon, t_polygon);
  if (common.size() == 1) {
    return have_a_common_point(polygon_of(mesh, s_own), t_polygon) ||
           have_a_common_point(polygon_of(mesh, t_own), s_polygon);
  }
  if (common.size() == 3) return true;
  const Point edge = integer_vertex(mesh, common[1]) - integer_vertex(mesh, common[0]);
  const Point to_s = integer_vertex(mesh, s_own[0]) - integer_vertex(mesh, common[0]);
  const Point to_t = integer_vertex(mesh, t_own[0]) - integer_vertex(mesh, common[0]);
  const Point s_normal = edge.cross(to_s);
  const Point t_normal = edge.cross(to_t);
  return s_normal.dot(to_t) == 0 && s_normal.dot(t_normal) > 0;
}

bool is_degenerate(const TriangleMesh& mesh, const Triangle& face) {
  const Point a = integer_vertex(mesh, face[0]);
  return (integer_vertex(mesh, face[1]) - a).cross(integer_vertex(mesh, face[2]) - a).isZero();
}

std::int64_t count_by_definition(const TriangleMesh& mesh) {
  std::int64_t pairs = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t j = i + 1; j < mesh.triangles.size(); ++j) {
      if (is_degenerate(mesh, mesh.triangles[i]) || is_degenerate(mesh, mesh.triangles[j])) continue;
      if (intersect_by_definition(mesh, mesh.triangles[i], mesh.triangles[j])) ++pairs;
    }
  }
  return pairs;
}

// Returns random faces on integer coordinates below `size`, which often share vertices and edges, are
// coplanar, touch or cross.
TriangleMesh random_faces(int size, bool flat) {
  TriangleMesh mesh;
  const int vertices = *rc::gen::inRange(3, 12);
  for (int i = 0; i < vertices; ++i) {
    const auto coordinate = [size] { return static_cast<double>(*rc::gen::inRange(0, size)); };
    mesh.add_vertex({coordinate(), coordinate(), flat ? 1.0 : coordinate()});
  }
  const int faces = *rc::gen::inRange(2, 16);
  for (int i = 0; i < faces; ++i) {
    mesh.triangles.push_back(
        {*rc::gen::inRange(0, vertices), *rc::gen::inRange(0, vertices), *rc::gen::inRange(0, vertices)});
  }
  return weld(mesh).mesh;
}

RC_GTEST_PROP(SelfIntersection, MatchesDefinitionInSpace, ()) {
  const TriangleMesh mesh = random_faces(*rc::gen::element(3, 5, 50), false);
  RC_ASSERT(count_intersecting_pairs(mesh) == count_by_definition(mesh));
}

RC_GTEST_PROP(SelfIntersection, MatchesDefinitionInPlane, ()) {
  const TriangleMesh mesh = random_faces(*rc::gen::element(3, 5, 50), true);
  RC_ASSERT(count_intersecting_pairs(mesh) == count_by_definition(mesh));
}

TEST(SelfIntersection, FindsNoneInGeneratedShapes) {
  EXPECT_EQ(count_intersecting_pairs(make_shape(BoxShape{{1, 2, 3}, {6, 7, 8}})), 0);
  EXPECT_EQ(count_intersecting_pairs(sphere_mesh(24)), 0);
  EXPECT_EQ(count_intersecting_pairs(rock_mesh(12)), 0);
  EXPECT_EQ(count_intersecting_pairs(make_shape(TorusKnotShape{})), 0);
  EXPECT_EQ(count_intersecting_pairs(make_shape(WigleyShape{})), 0);
}

TEST(SelfIntersection, FindsNoneInRotatedCoplanarFaces) {
  // Neighbouring faces are coplanar up to rounding.
  const Mat3 rotation = Eigen::AngleAxisd(0.7, Vec3(1, 2, -3).normalized()).toRotationMatrix();
  const TriangleMesh box = make_shape(BoxShape{{1, 2, 3}, {10, 10, 10}});
  EXPECT_EQ(count_intersecting_pairs(moved_mesh(box, rotation, Vec3(0.1, 0.2, 0.3))), 0);
}

TEST(SelfIntersection, FindsIntersectingBoxes) {
  EXPECT_GT(count_intersecting_pairs(joined(cube_mesh(1), cube_mesh(1, Vec3(0.3, 0.4, 0.5)))), 0);
  EXPECT_EQ(count_intersecting_pairs(joined(cube_mesh(1), cube_mesh(1, Vec3(1.5, 0, 0)))), 0);
  EXPECT_EQ(count_intersecting_pairs(joined(cube_mesh(2), cube_mesh(1))), 0);
}

TEST(SelfIntersection, CountsTouchingFaces) {
  // A corner of the tetrahedron lies on a face of the cube, which it shares no vertex with.
  TriangleMesh tip = tetrahedron_mesh();
  EXPECT_GT(
      count_intersecting_pairs(joined(cube_mesh(1), moved_mesh(tip, Mat3::Identity(), {0.5, 0.1, 0.2}))), 0);
}

TEST(SelfIntersection, CountsFacesFoldedOntoNeighbours) {
  TriangleMesh folded;
  for (const Vec3& v : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)}) folded.add_vertex(v);
  folded.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(count_intersecting_pairs(folded), 1);
  folded.y[3] = -1.0;
  EXPECT_EQ(count_intersecting_pairs(folded), 0);
}

TEST(SelfIntersection, IgnoresFacesOfZeroArea) {
  TriangleMesh cube = cube_mesh();
  const std::int32_t middle = cube.add_vertex({0, -0.5, -0.5});
  cube.triangles.push_back({0, 1, middle});
  EXPECT_EQ(count_intersecting_pairs(cube), 0);
}

}  // namespace
}  // namespace buoyancy
