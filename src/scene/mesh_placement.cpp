#include "scene/mesh_placement.h"

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/double_double.h"

namespace buoyancy {
namespace {

using RotationMatrix = std::array<std::array<DoubleDouble, 3>, 3>;

// R of q/|q|.
RotationMatrix rotation_of(const Eigen::Quaterniond& q) {
  const std::array<double, 3> u{q.x(), q.y(), q.z()};
  DoubleDouble u_squared;
  for (const double component : u) u_squared = u_squared + two_product(component, component);
  const DoubleDouble w_squared = two_product(q.w(), q.w());
  const DoubleDouble per_norm_squared = reciprocal(w_squared + u_squared);
  RotationMatrix R;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      DoubleDouble entry = two_product(2.0 * u[i], u[j]);
      if (i == j) {
        entry = entry + (w_squared - u_squared);
      } else {
        const double sign = (j + 3 - i) % 3 == 1 ? -2.0 : 2.0;
        entry = entry + two_product(sign * q.w(), u[3 - i - j]);
      }
      R[i][j] = entry * per_norm_squared;
    }
  }
  return R;
}

}  // namespace

MeshPlacement compose(const MeshPlacement& outer, const MeshPlacement& inner) {
  MeshPlacement both = outer;
  both.scale = inner.scale;
  if (inner.position_B != Vec3::Zero()) {
    both.position_B += outer.orientation_B.normalized() * inner.position_B;
  }
  if (inner.orientation_B.vec() != Vec3::Zero()) {
    both.orientation_B = outer.orientation_B.normalized() * inner.orientation_B.normalized();
  }
  return both;
}

void place(TriangleMesh& mesh, const MeshPlacement& placement) {
  const std::array<std::vector<double>*, 3> coordinates{&mesh.x, &mesh.y, &mesh.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double factor = placement.scale[static_cast<Eigen::Index>(axis)];
    if (factor == 1.0) continue;
    for (double& coordinate : *coordinates[axis]) coordinate *= factor;
  }
  if (placement.mirrors()) {
    for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  }
  const bool is_turned = placement.orientation_B.vec() != Vec3::Zero();
  if (!is_turned && placement.position_B == Vec3::Zero()) return;
  const RotationMatrix R = rotation_of(placement.orientation_B);
  for (std::size_t vertex = 0; vertex < mesh.x.size(); ++vertex) {
    const std::array<double, 3> from{mesh.x[vertex], mesh.y[vertex], mesh.z[vertex]};
    Vec3 moved;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      DoubleDouble sum{placement.position_B[row], 0.0};
      if (is_turned) {
        for (std::size_t j = 0; j < 3; ++j) sum = sum + R[i][j] * from[j];
      } else {
        sum = sum + DoubleDouble{from[i], 0.0};
      }
      moved[row] = sum.hi;
    }
    mesh.x[vertex] = moved.x();
    mesh.y[vertex] = moved.y();
    mesh.z[vertex] = moved.z();
  }
}

}  // namespace buoyancy
