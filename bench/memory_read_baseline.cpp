#include "memory_read_baseline.h"

#include <array>
#include <cstring>
#include <vector>

namespace buoyancy::bench {
namespace {

// No AddressSanitizer here and below: on its own stack GCC 12 does not align variables of 64 bytes as AVX-512
// requires.
[[gnu::always_inline, gnu::no_sanitize_address]] inline std::uint64_t read_lines(const void* array,
                                                                                 std::size_t bytes) {
  std::array<std::uint64_t, 8> lanes{};
  for (std::size_t i = 0; i + sizeof(lanes) <= bytes; i += sizeof(lanes)) {
    std::array<std::uint64_t, 8> line;
    std::memcpy(line.data(), static_cast<const unsigned char*>(array) + i, sizeof(line));
    for (std::size_t lane = 0; lane < line.size(); ++lane) lanes[lane] ^= line[lane];
  }
  std::uint64_t combined = 0;
  for (const std::uint64_t lane : lanes) combined ^= lane;
  return combined;
}

// The same loop for each register width. The choice is explicit, because the resolvers of target_clones run
// in the loader, before ThreadSanitizer is initialised, and crash.
#if defined(__x86_64__)
[[gnu::target("avx512f"), gnu::no_sanitize_address]] std::uint64_t read_512(const void* array,
                                                                            std::size_t bytes) {
  return read_lines(array, bytes);
}
[[gnu::target("avx2"), gnu::no_sanitize_address]] std::uint64_t read_256(const void* array,
                                                                         std::size_t bytes) {
  return read_lines(array, bytes);
}
#endif

[[gnu::no_sanitize_address]] std::uint64_t read_once(const void* array, std::size_t bytes) {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx512f") != 0) return read_512(array, bytes);
  if (__builtin_cpu_supports("avx2") != 0) return read_256(array, bytes);
#endif
  return read_lines(array, bytes);
}

}  // namespace

std::uint64_t read_vertices_and_indices(const TriangleMesh& mesh) {
  std::uint64_t combined = 0;
  for (const std::vector<double>* coordinate : {&mesh.x, &mesh.y, &mesh.z}) {
    combined ^= read_once(coordinate->data(), coordinate->size() * sizeof(double));
  }
  return combined ^ read_once(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
}

}  // namespace buoyancy::bench
