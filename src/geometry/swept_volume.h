// Computes areas of faces, and bounds on the volume that moving vertices changes.
#pragma once

#include <Eigen/Geometry>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline double area_of_face(const TriangleMesh& mesh, const Triangle& face) {
  const Vec3 a = mesh.vertex(face[0]);
  return 0.5 * (mesh.vertex(face[1]) - a).cross(mesh.vertex(face[2]) - a).norm();
}

// Bounds the volume that a face sweeps while points on it move by at most `move` [m], each on a straight
// line, and linearly over the face. Two sides of lengths p and q change by at most 2 move each, so that the
// area stays below A + (p + q) move + 2 move^2.
inline double swept_volume_bound(const TriangleMesh& mesh, const Triangle& face, double move) {
  const Vec3 a = mesh.vertex(face[0]);
  const double sides = (mesh.vertex(face[1]) - a).norm() + (mesh.vertex(face[2]) - a).norm();
  return move * (area_of_face(mesh, face) + sides * move + 2.0 * move * move);
}

}  // namespace buoyancy
