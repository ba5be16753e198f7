#include "read_mesh.h"

#include <array>
#include <cstring>
#include <functional>
#include <numeric>

namespace buoyancy {
namespace {

[[gnu::target_clones("avx512f", "avx2", "default")]] std::uint64_t read_once(const void* array,
                                                                             std::size_t bytes) {
  std::array<std::uint64_t, 8> seen{};
  for (std::size_t i = 0; i + sizeof(seen) <= bytes; i += sizeof(seen)) {
    std::array<std::uint64_t, 8> line;
    std::memcpy(line.data(), static_cast<const unsigned char*>(array) + i, sizeof(line));
    for (std::size_t lane = 0; lane < line.size(); ++lane) seen[lane] ^= line[lane];
  }
  return std::accumulate(seen.begin(), seen.end(), std::uint64_t{0}, std::bit_xor());
}

}  // namespace

std::uint64_t read_vertices_and_indices(const TriangleMesh& mesh) {
  std::uint64_t seen = 0;
  for (const std::vector<double>* coordinate : {&mesh.x, &mesh.y, &mesh.z}) {
    seen ^= read_once(coordinate->data(), coordinate->size() * sizeof(double));
  }
  return seen ^ read_once(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
}

}  // namespace buoyancy
