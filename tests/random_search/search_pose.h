// A request about a mesh, drawn at random or aimed at trouble: the water's surface through vertices, edges
// and faces and a few ulp beside them, grazing, along the axes, tilted by next to nothing, far away and deep.
#pragma once

#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {

struct SearchPose {
  Pose pose;
  Water water;
  Vec3 reference_B = Vec3::Zero();
  double tolerance = 0.0;  // that `hierarchical` is asked a second time with
};

SearchPose random_request(const TriangleMesh& mesh, RandomPoses& random);

}  // namespace buoyancy
