// A triangle mesh as plain arrays (SoA): vertices in the body frame B [m], one array per coordinate;
// triangles as three vertex indices, counter-clockwise seen from outside, so that (b - a) x (c - a) points
// outward.
//
// A TriangleMesh has no invariants: it may be open, inside out or contain NaN. A mesh that validation accepts
// is a ValidatedMesh (mesh_validation.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec3.h"

namespace buoyancy {

using Triangle = std::array<std::int32_t, 3>;

struct TriangleMesh {
  std::vector<double> x, y, z;      // [m], B; all of the same length
  std::vector<Triangle> triangles;  // indices into x, y, z

  std::size_t vertex_count() const { return x.size(); }
  Vec3 vertex(std::int32_t i) const {
    const auto n = static_cast<std::size_t>(i);
    return {x[n], y[n], z[n]};
  }
  std::int32_t add_vertex(const Vec3& vertex_B) {
    x.push_back(vertex_B.x());
    y.push_back(vertex_B.y());
    z.push_back(vertex_B.z());
    return static_cast<std::int32_t>(x.size() - 1);
  }
};

// Axis-aligned bounding box; empty if min > max.
struct BoundingBox {
  Vec3 min_B, max_B;  // [m]

  double diagonal() const { return (max_B - min_B).norm(); }
  Vec3 center() const { return 0.5 * (min_B + max_B); }
};

// Returns the bounding box of the vertices that triangles use; an empty box if there are no triangles.
BoundingBox bounding_box(const TriangleMesh& mesh);

}  // namespace buoyancy
