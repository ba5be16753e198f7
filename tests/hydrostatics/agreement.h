// Measures the difference between `hierarchical` and `exact` over many poses, on every instruction set of
// this processor.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hydrostatics/hierarchical.h"
#include "hydrostatics/solver.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {

// Poses per mesh. ThreadSanitizer is some thirty times slower and cannot find anything on one thread.
#ifdef __SANITIZE_THREAD__
inline constexpr int kAgreementPoses = 50;
#else
inline constexpr int kAgreementPoses = 2000;
#endif

// The largest differences, as multiples of G_V and G_V L_r.
struct Agreement {
  std::string target;  // instruction set
  double volume = 0.0, torque = 0.0, moment = 0.0;
};

// Half of the poses are random and half adversarial; a quarter have an up direction other than z. source: the
// mesh that `mesh` was made from.
inline std::vector<Agreement> agreement_with_exact(const TriangleMesh& source, const HydrostaticMesh& mesh,
                                                   int poses, std::uint64_t seed) {
  const BoundingBox box = bounding_box(source);
  const double tolerance = mesh.volume_tolerance();
  const double lever = mesh.max_lever_arm(mesh.center_B);
  std::vector<Agreement> found;
  for (const std::string& target : simd_targets()) found.push_back({.target = target});
  const Solver exact(mesh, Method::kExact);
  RandomPoses random(seed);
  for (int i = 0; i < poses; ++i) {
    Water water{.level = 0.25, .density = 1.0, .gravity = 1.0};
    if (i % 4 == 3) water.up_W = random.direction();
    const Pose pose = i % 2 == 0 ? random.crossing(box, water) : random.adversarial(source, water);
    const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
    // `hierarchical` evaluates a submerged body from its constants; `exact` loses digits with depth.
    const double depth = std::max(1.0, std::abs(plane.h_c) / mesh.diagonal);
    const Displacement brute = exact.displacement(plane);
    for (Agreement& agreement : found) {
      EXPECT_TRUE(force_simd_target(agreement.target));
      const Displacement fast = hierarchical(mesh, plane);
      const auto update_max = [](double& max, double value) {
        if (!(value <= max)) max = value;  // also true for NaN
      };
      update_max(agreement.volume, std::abs(fast.volume - brute.volume) / (tolerance * depth));
      update_max(agreement.torque, (fast.torque - brute.torque).norm() / (tolerance * lever * depth));
      update_max(agreement.moment, (fast.moment - brute.moment).norm() / (tolerance * lever * depth));
    }
  }
  force_simd_target("");
  return found;
}

}  // namespace buoyancy
