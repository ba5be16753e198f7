// Poses for property tests: random ones over all depths of a body, and adversarial ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

#include "geometry/triangle_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

class RandomPoses {
 public:
  explicit RandomPoses(std::uint64_t seed) : generator_(seed) {}

  double uniform(double low, double high);
  Eigen::Quaterniond rotation();
  Vec3 direction();

  // Any rotation; the height of the box's centre over the water is uniform in +-0.55 times the diagonal.
  Pose crossing(const BoundingBox& box, const Water& water);

  // The water plane passes through, or within a few ulp of, a vertex, the midpoint of an edge or a face of
  // the mesh; the rotation often maps axes to axes, or nearly so.
  Pose adversarial(const TriangleMesh& mesh, const Water& water);

  // Uniform in 0 .. count - 1.
  std::size_t pick(std::size_t count);

 private:
  Eigen::Quaterniond quarter_turns();

  std::mt19937_64 generator_;
};

}  // namespace buoyancy
