// Poses of the paper's table 1: a body is lowered from almost dry to almost submerged in 100 steps.
#pragma once

#include <random>
#include <vector>

#include "geometry/triangle_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy::bench {

// Returns `count` poses with random rotations from `seed`, for water at level 0 with up +z. In the first pose
// all but 1 % of the body's height in its attitude is above the water, in the last pose all but 1 % is below.
inline std::vector<Pose> sweep_of_poses(const TriangleMesh& mesh, int count = 100, std::uint64_t seed = 1) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    Pose pose;
    for (const int part : {2, 1, 0, 3}) pose.q_WB.coeffs()[part] = normal(generator);  // z, y, x, w
    pose.q_WB.normalize();
    const Vec3 up_B = pose.q_WB.conjugate() * Vec3::UnitZ();
    double min_height = 1e300;
    double max_height = -1e300;
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
      const double height = up_B.dot(mesh.vertex(static_cast<std::int32_t>(v)));
      min_height = std::min(min_height, height);
      max_height = std::max(max_height, height);
    }
    const double wet_share = 0.01 + 0.98 * i / (count - 1);
    pose.p_WB.z() = -(min_height + wet_share * (max_height - min_height));
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace buoyancy::bench
