// Random closed meshes, small enough for the oracle to check thousands of poses per second: convex,
// star-shaped, knotted, hollow, in several parts, with slivers and needles, stretched, of 1e-6 to 1e6 m, up
// to 1e6 times their size from B's origin, in double and in float32 coordinates.
#pragma once

#include <string>

#include "geometry/mesh_validation.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {

struct RandomMesh {
  std::string kind;  // "knot with slivers, 3.1e+02 m, far from B's origin"
  ValidatedMesh validated;
};

// Draws again if validation rejects a mesh.
RandomMesh random_mesh(RandomPoses& random);

}  // namespace buoyancy
