// Baseline for all times: the paper's `exact` method (section 4.3) as a competent user would write it, in
// plain double precision.
//
// It transforms all vertices, and visits every triangle: nothing is precomputed, skipped or bounded, sums are
// running sums, and whatever SIMD there is comes from the compiler. The same flags as the product's.
#pragma once

#include <vector>

#include "geometry/triangle_mesh.h"
#include "hydrostatics/point.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy::bench {

struct PlainWrench {
  double volume;           // [m^3]
  Vec3 force_W, torque_W;  // [N], [N m]
};

class PlainExact {
 public:
  // mesh must outlive the object.
  explicit PlainExact(const TriangleMesh& mesh);

  // Requires up_W = +z. reference_B: the torque is about this point of the body. Uses no heap.
  PlainWrench operator()(const Pose& pose, const Water& water, const Vec3& reference_B);

 private:
  const std::vector<Triangle>* triangles_;
  std::vector<Point<double>> vertices_B_;
  std::vector<Point<double>> vertices_;  // of the last pose
};

}  // namespace buoyancy::bench
