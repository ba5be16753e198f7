// Reads a mesh and its validation options from a fuzzer's bytes:
//
//   options   1 byte: bit 0 open policy; bit 1 count intersecting pairs; bits 2-3 encoding of coordinates
//             (0 an int8 each; 1 two int8, the second in units of 2^-26; 2 float32; 3 double); bit 4 faces
//             are tetrahedra of four indices instead of triangles of three; bit 5 close holes up to the
//             volume of the mesh; bit 6 close all rims; bit 7 raise rims
//   scale     1 int8 e: coordinates are multiplied by 2^(8 e)
//   vertices  1 byte: their number, then their coordinates
//   indices   1 byte each, modulo the number of vertices, to the end
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "geometry/mesh_validation.h"
#include "tests/fuzz/fuzz_bytes.h"

namespace buoyancy {

struct FuzzMesh {
  ImportedMesh imported;
  ValidationOptions options;
};

inline double coordinate(FuzzBytes& bytes, unsigned encoding) {
  switch (encoding) {
    case 0:
      return bytes.small();
    case 1:
      return bytes.beside_grid();
    case 2:
      return bytes.raw_float();
    default:
      return bytes.raw_double();
  }
}

inline FuzzMesh read_mesh(FuzzBytes bytes) {
  FuzzMesh input;
  const unsigned options = bytes.byte();
  input.options.open = (options & 1U) != 0 ? OpenPolicy::kDryBoundary : OpenPolicy::kRefuse;
  input.options.count_intersecting_pairs = (options & 2U) != 0;
  ClosingOptions& closing = input.options.closing;
  closing.holes = (options & 32U) != 0;
  closing.all_rims = (options & 64U) != 0;
  if (closing.holes) closing.max_change = 1.0;
  const bool tetrahedra = (options & 16U) != 0;
  const int scale = 8 * bytes.small();
  if ((options & 128U) != 0) closing.freeboard = std::ldexp(1.0, scale);
  const std::uint8_t vertices = bytes.byte();
  TriangleMesh& mesh = input.imported.mesh;
  for (int v = 0; v < vertices; ++v) {
    std::array<double, 3> position{};
    for (double& value : position) value = std::ldexp(coordinate(bytes, (options >> 2U) & 3U), scale);
    mesh.add_vertex({position[0], position[1], position[2]});
  }
  const auto index = [&] { return static_cast<std::int32_t>(bytes.byte() % vertices); };
  while (vertices > 0 && !bytes.empty()) {
    const std::int32_t a = index();
    const std::int32_t b = index();
    const std::int32_t c = index();
    if (tetrahedra) {
      const std::int32_t d = index();
      for (const Triangle& face :
           {Triangle{a, b, c}, Triangle{a, c, d}, Triangle{a, d, b}, Triangle{b, d, c}})
        mesh.triangles.push_back(face);
    } else {
      mesh.triangles.push_back({a, b, c});
    }
  }
  return input;
}

}  // namespace buoyancy
