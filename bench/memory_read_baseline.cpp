#include "memory_read_baseline.h"

#include <array>
#include <cstring>
#include <vector>

namespace buoyancy::bench {
namespace {

// Not under AddressSanitizer, here and below: on the stack that it moves variables to, GCC 12 does not align
// those of 64 bytes that AVX-512 needs aligned.
[[gnu::always_inline, gnu::no_sanitize_address]] inline std::uint64_t read_lines(const void* array,
                                                                                 std::size_t bytes) {
  std::array<std::uint64_t, 8> seen{};
  for (std::size_t i = 0; i + sizeof(seen) <= bytes; i += sizeof(seen)) {
    std::array<std::uint64_t, 8> line;
    std::memcpy(line.data(), static_cast<const unsigned char*>(array) + i, sizeof(line));
    for (std::size_t lane = 0; lane < line.size(); ++lane) seen[lane] ^= line[lane];
  }
  std::uint64_t all = 0;
  for (const std::uint64_t lane : seen) all ^= lane;
  return all;
}

// The same loop for each width of registers. Chosen by hand: what target_clones makes the loader choose
// crashes under ThreadSanitizer, which is not yet awake then.
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
  std::uint64_t seen = 0;
  for (const std::vector<double>* coordinate : {&mesh.x, &mesh.y, &mesh.z}) {
    seen ^= read_once(coordinate->data(), coordinate->size() * sizeof(double));
  }
  return seen ^ read_once(mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
}

}  // namespace buoyancy::bench
