// Baseline for all times: one read of a mesh's vertices and indices, a lower bound for any method that visits
// every triangle.
#pragma once

#include <cstdint>

#include "geometry/triangle_mesh.h"

namespace buoyancy::bench {

// Reads all coordinates and indices in blocks of 64 bytes with the widest registers of this processor; an
// incomplete block at the end of an array is not read. Returns the exclusive or of all blocks, so that the
// compiler cannot omit a read.
std::uint64_t read_vertices_and_indices(const TriangleMesh& mesh);

}  // namespace buoyancy::bench
