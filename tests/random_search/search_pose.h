// A request about a mesh, random or adversarial: the water plane through vertices, edges and faces or a few
// ulp beside them, grazing, along the axes, tilted by tiny angles, far away and deep.
#pragma once

#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {

struct SearchPose {
  Pose pose;
  Water water;
  Vec3 reference_B = Vec3::Zero();
  double tolerance = 0.0;  // for the second evaluation by `hierarchical`
};

SearchPose random_search_pose(const TriangleMesh& mesh, RandomPoses& random);

}  // namespace buoyancy
