// Poses for property tests: random ones over all depths of a body, and ones aimed at difficult cases.
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

  // Any rotation; the water's surface cuts the box at a share of its height drawn evenly over a little more
  // than all.
  Pose crossing(const BoundingBox& box, const Water& water);

  // The water's surface passes through, or within a few ulp of, a vertex, an edge's middle or a face of the
  // mesh; the rotation is often one that maps axes to axes, or off it by a hair.
  Pose adversarial(const TriangleMesh& mesh, const Water& water);

  std::size_t pick(std::size_t count);

 private:
  Eigen::Quaterniond quarter_turns();

  std::mt19937_64 generator_;
};

}  // namespace buoyancy
