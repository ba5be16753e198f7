// The true result of a request, and the distances of results from it. Nothing is rounded before a difference
// is taken: the truth comes from balls, and from rational arithmetic where a ball is too wide to decide.
#pragma once

#include <memory>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

class Truth {
 public:
  // source_B: the mesh as validated; several count as one body. They must outlive this object.
  Truth(std::vector<const TriangleMesh*> sources_B, const Pose& pose, const Water& water,
        const Vec3& reference_B);
  ~Truth();
  Truth(const Truth&) = delete;
  Truth& operator=(const Truth&) = delete;

  // Upper bounds on the norms of the errors; they exceed these by at most a hundredth of the limit, and by
  // nothing where they are above it.
  double volume_error(double volume, double limit = 0.0) const;         // [m^3]
  double force_error(const Vec3& force_W, double limit = 0.0) const;    // [N]
  double torque_error(const Vec3& torque_W, double limit = 0.0) const;  // [N m], about the reference point

 private:
  struct Exact;
  std::unique_ptr<Exact> exact_;
};

}  // namespace buoyancy
