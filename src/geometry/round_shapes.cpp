// Sphere, cylinder and cone: stacks of vertex rings about the z axis, from bottom to top, closed at both ends
// by a single vertex on the axis.
#include <cmath>
#include <numbers>

#include "geometry/shape_generators.h"

namespace buoyancy {
namespace {

class RingStack {
 public:
  RingStack(std::int32_t segments, double min_z) : segments_(segments) {
    previous_ = mesh_.add_vertex({0.0, 0.0, min_z});
  }

  void add_ring(double radius, double z) {
    const auto ring = static_cast<std::int32_t>(mesh_.vertex_count());
    for (std::int32_t j = 0; j < segments_; ++j) {
      const double angle = 2.0 * std::numbers::pi * j / segments_;
      mesh_.add_vertex({radius * std::cos(angle), radius * std::sin(angle), z});
    }
    for (std::int32_t j = 0; j < segments_; ++j) {
      const std::int32_t next = (j + 1) % segments_;
      if (on_axis_) {
        mesh_.triangles.push_back({previous_, ring + next, ring + j});
      } else {
        mesh_.triangles.push_back({previous_ + j, previous_ + next, ring + next});
        mesh_.triangles.push_back({previous_ + j, ring + next, ring + j});
      }
    }
    previous_ = ring;
    on_axis_ = false;
  }

  // Closes the stack with a vertex on the axis above the last ring.
  TriangleMesh finish(double max_z) && {
    const std::int32_t pole = mesh_.add_vertex({0.0, 0.0, max_z});
    for (std::int32_t j = 0; j < segments_; ++j) {
      mesh_.triangles.push_back({previous_ + j, previous_ + (j + 1) % segments_, pole});
    }
    return std::move(mesh_);
  }

 private:
  TriangleMesh mesh_;
  std::int32_t segments_;
  std::int32_t previous_;  // first vertex of the last ring, or the vertex on the axis
  bool on_axis_ = true;    // previous_ is the lowest vertex, on the axis
};

}  // namespace

TriangleMesh generate(const SphereShape& sphere) {
  const std::int32_t n = sphere.segments;
  RingStack stack(n, -sphere.radius);
  for (std::int32_t i = 1; i <= n; ++i) {
    const double latitude = std::numbers::pi * (2 * i - n - 1) / (2.0 * (n + 1));
    stack.add_ring(sphere.radius * std::cos(latitude), sphere.radius * std::sin(latitude));
  }
  return std::move(stack).finish(sphere.radius);
}

TriangleMesh generate(const CylinderShape& cylinder) {
  const double half = 0.5 * cylinder.height;
  RingStack stack(cylinder.segments, -half);
  for (std::int32_t i = 0; i <= cylinder.stacks; ++i) {
    stack.add_ring(cylinder.radius, half * (2 * i - cylinder.stacks) / cylinder.stacks);
  }
  return std::move(stack).finish(half);
}

TriangleMesh generate(const ConeShape& cone) {
  RingStack stack(cone.segments, 0.0);
  for (std::int32_t i = 0; i < cone.stacks; ++i) {
    stack.add_ring(cone.radius * (cone.stacks - i) / cone.stacks, cone.height * i / cone.stacks);
  }
  return std::move(stack).finish(cone.height);
}

}  // namespace buoyancy
