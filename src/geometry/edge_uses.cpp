#include "geometry/edge_uses.h"

#include <algorithm>

#include "geometry/parallel_tasks.h"

namespace buoyancy {

EdgeUses collect_edge_uses(const TriangleMesh& mesh) {
  EdgeUses edges;
  edges.first.assign(mesh.vertex_count() + 1, 0);
  for (const Triangle& face : mesh.triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::int32_t low = std::min(face[corner], face[(corner + 1) % 3]);
      ++edges.first[static_cast<std::size_t>(low) + 1];
    }
  }
  for (std::size_t v = 1; v < edges.first.size(); ++v) edges.first[v] += edges.first[v - 1];

  edges.uses.resize(3 * mesh.triangles.size());
  std::vector<std::size_t> next(edges.first.begin(), edges.first.end() - 1);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& face = mesh.triangles[f];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::int32_t from = face[corner];
      const std::int32_t to = face[(corner + 1) % 3];
      edges.uses[next[static_cast<std::size_t>(std::min(from, to))]++] = {
          std::max(from, to), face[(corner + 2) % 3], static_cast<std::int32_t>(f), from < to};
    }
  }
  run_parallel_ranges(mesh.vertex_count(), [&edges](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::sort(edges.uses.begin() + static_cast<std::ptrdiff_t>(edges.first[v]),
                edges.uses.begin() + static_cast<std::ptrdiff_t>(edges.first[v + 1]));
    }
  });
  return edges;
}

EdgeTable::EdgeTable(const TriangleMesh& mesh)
    : uses_(collect_edge_uses(mesh)), edges_of_face_(mesh.triangles.size()) {
  std::vector<std::uint8_t> found(mesh.triangles.size(), 0);  // edges of each face so far
  first_use_.push_back(0);
  uses_.for_each_edge([&](std::int32_t low, std::span<const EdgeUse> uses) {
    const auto e = static_cast<std::int32_t>(edges_.size());
    edges_.push_back({low, uses.front().high});
    first_use_.push_back(first_use_.back() + uses.size());
    for (const EdgeUse& use : uses) {
      const auto f = static_cast<std::size_t>(use.face);
      edges_of_face_[f][found[f]++] = e;
    }
  });
}

}  // namespace buoyancy
