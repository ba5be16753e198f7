// Places the coordinates of a mesh file in the frame of a body.
#pragma once

#include <Eigen/Geometry>

#include "base/vec3.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Vertices are at x_B = R (S x) + position.
struct MeshPlacement {
  Vec3 scale = Vec3::Ones();  // S, the factors of x, y and z: not 0; an odd number of negative ones mirrors
  Vec3 position_B = Vec3::Zero();                                     // [m]
  Eigen::Quaterniond orientation_B = Eigen::Quaterniond::Identity();  // R: any norm but 0; read as q/|q|

  // The factor of a uniform, positive scale; 1 for any other scale.
  double size_factor() const {
    const bool is_uniform = scale.x() > 0.0 && scale.y() == scale.x() && scale.z() == scale.x();
    return is_uniform ? scale.x() : 1.0;
  }
  bool mirrors() const { return (scale.array() < 0.0).count() % 2 == 1; }
};

// Returns the placement in the body of a mesh that `inner` places in a frame which `outer`, whose scale is
// 1, places in the body.
MeshPlacement compose(const MeshPlacement& outer, const MeshPlacement& inner);

// Moves the vertices; the winding of a mesh that is mirrored is reversed, so that normals keep pointing
// outward. They are computed in double-double and rounded once: a mesh far from its own origin that is turned
// back to its body loses no digits. O(n).
void place(TriangleMesh& mesh, const MeshPlacement& placement);

}  // namespace buoyancy
