#include "geometry/winding_number.h"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "geometry/exact_predicates.h"

namespace buoyancy {
namespace {

// Returns the side of the directed line uv on which the point lies in the projection along x. The point is
// perturbed by (e, e^2) for a vanishing e > 0, so that it lies on no line and a ray meets faces, never edges.
// The result is 0 only if the projections of u and v coincide.
int perturbed_side(const Vec3& u, const Vec3& v, const Vec3& point) {
  const int side =
      orient_2d(project_along_axis(0, u), project_along_axis(0, v), project_along_axis(0, point));
  if (side != 0) return side;
  if (u.z() != v.z()) return v.z() < u.z() ? 1 : -1;
  if (u.y() != v.y()) return v.y() > u.y() ? 1 : -1;
  return 0;
}

struct Crossing {
  int direction = 0;     // of the ray from the point along +x: 1 outward, -1 inward, 0 no crossing
  bool touches = false;  // the point lies on the face
};

Crossing cross(const TriangleMesh& mesh, const Triangle& face, const Vec3& point) {
  const Vec3 a = mesh.vertex(face[0]);
  const Vec3 b = mesh.vertex(face[1]);
  const Vec3 c = mesh.vertex(face[2]);
  const int side = perturbed_side(a, b, point);
  if (side == 0 || perturbed_side(b, c, point) != side || perturbed_side(c, a, point) != side) return {};
  const int in_front = orient_3d(a, b, c, point);
  if (in_front == 0) return {0, true};
  return {in_front == side ? 0 : side, false};
}

}  // namespace

WindingNumber::WindingNumber(const TriangleMesh& mesh, std::vector<Triangle> faces)
    : mesh_(&mesh), faces_(std::move(faces)), tree_(boxes_of_faces(mesh, faces_)) {}

WindingNumber::Position WindingNumber::about(const Vec3& point) const {
  Position position;
  const auto meets_ray = [&point](const BoundingBox& box) {
    return box.max_B.x() >= point.x() && box.min_B.y() <= point.y() && point.y() <= box.max_B.y() &&
           box.min_B.z() <= point.z() && point.z() <= box.max_B.z();
  };
  tree_.for_each(meets_ray, [&](std::int32_t item) {
    const Crossing crossing = cross(*mesh_, faces_[static_cast<std::size_t>(item)], point);
    position.winding += crossing.direction;
    ++position.faces_met;
    if (crossing.touches) position.touched = true;
  });
  return position;
}

}  // namespace buoyancy
