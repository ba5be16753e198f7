// The yardstick beside every time: reading a mesh's vertices and indices once, which any method that looks at
// every triangle must spend.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace buoyancy::bench {

// Reads every coordinate and every index, 64 bytes at a time, with the widest registers that this processor
// has; what is left of an array after its last 64 bytes is not read. Returns the exclusive or of all, so that
// nothing can be left out.
std::uint64_t read_vertices_and_indices(const TriangleMesh& mesh);

}  // namespace buoyancy::bench
