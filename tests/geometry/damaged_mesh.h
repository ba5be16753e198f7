// Closed meshes that are damaged in known ways, for tests of mesh repair.
#pragma once

#include <cstdint>
#include <string>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

struct DamagedMesh {
  TriangleMesh clean;          // closed, without faults
  TriangleMesh damaged;        // the same surface with faults that repair can mend, if `repairable`
  std::string damage;          // in words
  bool moved = false;          // vertices moved, by up to 1e-6 L
  double missing_bulge = 0.0;  // of holes [m^3]
  bool repairable = true;      // else a hole is too large
};

// The case depends on the seed alone.
DamagedMesh make_damaged_mesh(std::uint64_t seed);

}  // namespace buoyancy
