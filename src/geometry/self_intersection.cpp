#include "geometry/self_intersection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "geometry/aabb_tree.h"
#include "geometry/exact_predicates.h"

namespace buoyancy {
namespace {

using Corners = std::array<Vec3, 3>;
using Point2 = Eigen::Vector2d;
using Corners2 = std::array<Point2, 3>;

int orientation(const Corners2& t) {
  return orient_2d(t[0], t[1], t[2]);
}

Corners2 project_corners(int axis, const Corners& t) {
  return {project_along_axis(axis, t[0]), project_along_axis(axis, t[1]), project_along_axis(axis, t[2])};
}

// Returns an axis whose projection of the triangle is not degenerate, if possible the one with the largest
// area. Requires non-zero area.
int projection_axis(const Corners& t) {
  const Vec3 u = t[1] - t[0];
  const Vec3 v = t[2] - t[0];
  const Vec3 normal(u.y() * v.z() - u.z() * v.y(), u.z() * v.x() - u.x() * v.z(),
                    u.x() * v.y() - u.y() * v.x());
  Eigen::Index largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  const int axis = static_cast<int>(largest);
  for (int turn = 0; turn < 2; ++turn) {
    const int candidate = (axis + turn) % 3;
    if (orientation(project_corners(candidate, t)) != 0) return candidate;
  }
  return (axis + 2) % 3;
}

// Returns whether a and b lie on the same side of `from`. Requires that all three are collinear.
bool same_direction(const Point2& from, const Point2& a, const Point2& b) {
  const int axis = a.x() != from.x() ? 0 : 1;
  return (a(axis) > from(axis)) == (b(axis) > from(axis)) && b(axis) != from(axis);
}

bool in_box(const Point2& point, const Point2& a, const Point2& b) {
  return std::min(a.x(), b.x()) <= point.x() && point.x() <= std::max(a.x(), b.x()) &&
         std::min(a.y(), b.y()) <= point.y() && point.y() <= std::max(a.y(), b.y());
}

// Requires that neither p nor q lies on the segment ab.
bool segments_meet(const Point2& p, const Point2& q, const Point2& a, const Point2& b) {
  const int side_p = orient_2d(a, b, p);
  const int side_q = orient_2d(a, b, q);
  if (side_p * side_q > 0) return false;
  const int side_a = orient_2d(p, q, a);
  const int side_b = orient_2d(p, q, b);
  if (side_a == 0 && in_box(a, p, q)) return true;
  if (side_b == 0 && in_box(b, p, q)) return true;
  return side_p * side_q < 0 && side_a * side_b < 0;
}

// Requires a triangle of non-zero area.
bool point_in_triangle(const Point2& point, const Corners2& t) {
  const int turn = orientation(t);
  for (std::size_t i = 0; i < 3; ++i) {
    if (orient_2d(t[i], t[(i + 1) % 3], point) * turn < 0) return false;
  }
  return true;
}

bool segment_meets_triangle_in_plane(const Point2& p, const Point2& q, const Corners2& t) {
  if (point_in_triangle(p, t) || point_in_triangle(q, t)) return true;
  return segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) ||
         segments_meet(p, q, t[2], t[0]);
}

// The segment and the triangle are closed sets; the triangle has non-zero area.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Corners& t) {
  const int side_p = orient_3d(t[0], t[1], t[2], p);
  const int side_q = orient_3d(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return false;
  if (side_p == 0 || side_q == 0) {
    const int axis = projection_axis(t);
    const Corners2 flat = project_corners(axis, t);
    if (side_q != 0) return point_in_triangle(project_along_axis(axis, p), flat);
    if (side_p != 0) return point_in_triangle(project_along_axis(axis, q), flat);
    return segment_meets_triangle_in_plane(project_along_axis(axis, p), project_along_axis(axis, q), flat);
  }
  const int first = orient_3d(p, q, t[0], t[1]);
  const int second = orient_3d(p, q, t[1], t[2]);
  const int third = orient_3d(p, q, t[2], t[0]);
  return (first >= 0 && second >= 0 && third >= 0) || (first <= 0 && second <= 0 && third <= 0);
}

bool filtered_on_one_side(const Corners& plane, const Vec3& p, const Vec3& q) {
  const int side = orient_3d_filtered(plane[0], plane[1], plane[2], p);
  return side != 0 && orient_3d_filtered(plane[0], plane[1], plane[2], q) == side;
}

// Returns whether, in a projection of s, an edge of one triangle separates it strictly from the other.
bool separated_in_projection(const Corners& s, const Corners& t) {
  const int axis = projection_axis(s);
  const std::array<Corners2, 2> flat{project_corners(axis, s), project_corners(axis, t)};
  for (std::size_t which = 0; which < 2; ++which) {
    const Corners2& one = flat[which];
    const Corners2& other = flat[1 - which];
    const int turn = orientation(one);
    for (std::size_t i = 0; turn != 0 && i < 3; ++i) {
      const auto beyond = [&](const Point2& point) {
        return orient_2d(one[i], one[(i + 1) % 3], point) * turn < 0;
      };
      if (beyond(other[0]) && beyond(other[1]) && beyond(other[2])) return true;
    }
  }
  return false;
}

bool meet_without_common_vertex(const Corners& s, const Corners& t) {
  const auto clear_of = [](const Corners& plane, const Corners& triangle) {
    return filtered_on_one_side(plane, triangle[0], triangle[1]) &&
           filtered_on_one_side(plane, triangle[1], triangle[2]);
  };
  if (clear_of(s, t) || clear_of(t, s) || separated_in_projection(s, t)) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    if (segment_meets_triangle(s[i], s[(i + 1) % 3], t)) return true;
    if (segment_meets_triangle(t[i], t[(i + 1) % 3], s)) return true;
  }
  return false;
}

// Requires s[0] = t[0]. Returns whether, in a projection of s, a line through the common vertex and another
// vertex has the triangles on different sides, without a common direction along it.
bool separated_at_vertex_in_projection(const Corners& s, const Corners& t) {
  const int axis = projection_axis(s);
  const std::array<Corners2, 2> flat{project_corners(axis, s), project_corners(axis, t)};
  const Point2& apex = flat[0][0];
  for (std::size_t which = 0; which < 2; ++which) {
    const Corners2& one = flat[which];
    const Corners2& other = flat[1 - which];
    for (std::size_t i = 1; i < 3; ++i) {
      const int turn = orient_2d(apex, one[i], one[3 - i]);
      if (turn == 0) continue;
      const auto beyond = [&](const Point2& point) {
        const int side = orient_2d(apex, one[i], point) * turn;
        return side < 0 || (side == 0 && point != apex && !same_direction(apex, one[i], point));
      };
      if (beyond(other[1]) && beyond(other[2])) return true;
    }
  }
  return false;
}

// Requires s[0] = t[0]. If the triangles share other points, one lies on an edge opposite the common vertex.
bool meet_beyond_common_vertex(const Corners& s, const Corners& t) {
  if (filtered_on_one_side(s, t[1], t[2]) || filtered_on_one_side(t, s[1], s[2])) return false;
  if (separated_at_vertex_in_projection(s, t)) return false;
  return segment_meets_triangle(s[1], s[2], t) || segment_meets_triangle(t[1], t[2], s);
}

// Requires s[0] = t[0], s[1] = t[1]. The triangles share other points only if folded flat onto each other.
bool meet_beyond_common_edge(const Corners& s, const Corners& t) {
  if (orient_3d_filtered(s[0], s[1], s[2], t[2]) != 0) return false;
  const int axis = projection_axis(s);
  const Corners2 flat = project_corners(axis, s);
  if (orient_2d(flat[0], flat[1], project_along_axis(axis, t[2])) != orientation(flat)) return false;
  return orient_3d(s[0], s[1], s[2], t[2]) == 0;
}

// Moves the common vertices of two faces to the front, in the same order, and returns their number.
std::size_t move_common_vertices_to_front(Triangle& s, Triangle& t) {
  std::size_t common = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    auto* const found = std::find(t.begin() + common, t.end(), s[i]);
    if (found == t.end()) continue;
    std::swap(s[common], s[i]);
    std::swap(t[common], *found);
    ++common;
  }
  return common;
}

Corners corners_of(const TriangleMesh& mesh, const Triangle& face) {
  return {mesh.vertex(face[0]), mesh.vertex(face[1]), mesh.vertex(face[2])};
}

bool intersect(const TriangleMesh& mesh, Triangle s, Triangle t) {
  const std::size_t common = move_common_vertices_to_front(s, t);
  const Corners s_corners = corners_of(mesh, s);
  const Corners t_corners = corners_of(mesh, t);
  switch (common) {
    case 0:
      return meet_without_common_vertex(s_corners, t_corners);
    case 1:
      return meet_beyond_common_vertex(s_corners, t_corners);
    case 2:
      return meet_beyond_common_edge(s_corners, t_corners);
    default:
      return true;
  }
}

}  // namespace

std::int64_t count_intersecting_pairs(const TriangleMesh& mesh, bool* cut_off) {
  std::vector<Triangle> faces;
  std::vector<BoundingBox> boxes;
  for (const Triangle& face : mesh.triangles) {
    if (collinear(mesh.vertex(face[0]), mesh.vertex(face[1]), mesh.vertex(face[2]))) continue;
    faces.push_back(face);
    boxes.push_back(box_of_face(mesh, face));
  }
  std::int64_t pairs = 0;
  std::int64_t tests_left = 5'000'000 + 64 * static_cast<std::int64_t>(faces.size());
  const auto test = [&](std::int32_t i, std::int32_t j) {
    if (intersect(mesh, faces[static_cast<std::size_t>(i)], faces[static_cast<std::size_t>(j)])) ++pairs;
    return --tests_left > 0;
  };
  const bool complete = AabbTree(std::move(boxes)).for_each_overlapping_pair(test);
  if (cut_off != nullptr) *cut_off = !complete;
  return pairs;
}

}  // namespace buoyancy
