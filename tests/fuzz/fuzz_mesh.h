// A mesh and what validation is asked of it, out of a fuzzer's bytes:
//
//   options   1 byte: bit 0 open policy, bit 1 counts intersecting pairs, bits 2-3 how coordinates are
//   written
//             (0 an int8 each; 1 two int8, the second 2^-26 of the first; 2 float32; 3 double), bit 4 faces
//             are tetrahedra of four indices instead of triangles of three
//   scale     1 int8 e: coordinates are multiplied by 2^(8 e)
//   vertices  1 byte: how many, then their coordinates
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

inline double coordinate(FuzzBytes& bytes, unsigned writing) {
  switch (writing) {
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
  const bool tetrahedra = (options & 16U) != 0;
  const int scale = 8 * bytes.small();
  const std::uint8_t vertices = bytes.byte();
  TriangleMesh& mesh = input.imported.mesh;
  for (int v = 0; v < vertices; ++v) {
    std::array<double, 3> place{};
    for (double& value : place) value = std::ldexp(coordinate(bytes, (options >> 2U) & 3U), scale);
    mesh.add_vertex({place[0], place[1], place[2]});
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
