#include "geometry/welding.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "base/large_page_array.h"
#include "geometry/disjoint_sets.h"
#include "geometry/mesh_topology.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

// Maximum displacement of a vertex, in tolerances. A longer chain of close neighbours is not a crack but a
// finely divided edge, which must not collapse.
constexpr double kMaxMove = 2.0;

bool uses_vertex_twice(const Triangle& face) {
  return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

// Returns the bits of the coordinates; adding 0 turns -0 into 0.
std::array<std::uint64_t, 3> position_bits(const TriangleMesh& mesh, std::size_t v) {
  return {std::bit_cast<std::uint64_t>(mesh.x[v] + 0.0), std::bit_cast<std::uint64_t>(mesh.y[v] + 0.0),
          std::bit_cast<std::uint64_t>(mesh.z[v] + 0.0)};
}

std::uint64_t mix(std::uint64_t bits) {
  bits ^= bits >> 32U;
  bits *= 0xd6e8feb86659fd93ULL;
  bits ^= bits >> 32U;
  bits *= 0xd6e8feb86659fd93ULL;
  return bits ^ (bits >> 32U);
}

// Returns the first vertex at each vertex's position, by an open-addressing hash table of vertex indices.
std::vector<std::int32_t> first_at_same_position(const TriangleMesh& mesh) {
  constexpr std::int32_t kEmpty = -1;
  constexpr std::size_t kAhead = 32;  // vertices: their slots, and then what these name, arrive meanwhile
  const std::size_t n = mesh.vertex_count();
  const std::size_t mask = std::bit_ceil(2 * n + 1) - 1;
  LargePageArray<std::int32_t> slots(mask + 1, kEmpty);
  std::vector<std::int32_t> first(n);
  std::array<std::size_t, 2 * kAhead> ahead{};  // the first slot of a vertex, by its number modulo the size
  const auto prefetch_slot = [&](std::size_t v) {
    const auto bits = position_bits(mesh, v);
    std::size_t& slot = ahead[v % ahead.size()];
    slot = mix(mix(mix(bits[0]) + bits[1]) + bits[2]) & mask;
    __builtin_prefetch(&slots[slot]);
  };
  const auto prefetch_vertex_in_slot = [&](std::size_t v) {
    const std::int32_t known = slots[ahead[v % ahead.size()]];
    if (known == kEmpty) return;
    const auto at = static_cast<std::size_t>(known);
    for (const auto* coordinates : {&mesh.x, &mesh.y, &mesh.z}) __builtin_prefetch(&(*coordinates)[at]);
  };
  for (std::size_t v = 0; v < std::min(n, 2 * kAhead - 1); ++v) prefetch_slot(v);
  for (std::size_t v = 0; v < n; ++v) {
    if (v + 2 * kAhead - 1 < n) prefetch_slot(v + 2 * kAhead - 1);
    if (v + kAhead < n) prefetch_vertex_in_slot(v + kAhead);
    const auto bits = position_bits(mesh, v);
    std::size_t slot = ahead[v % ahead.size()];
    while (slots[slot] != kEmpty && position_bits(mesh, static_cast<std::size_t>(slots[slot])) != bits) {
      slot = (slot + 1) & mask;
    }
    if (slots[slot] == kEmpty) slots[slot] = static_cast<std::int32_t>(v);
    first[v] = slots[slot];
  }
  return first;
}

// A cell of a grid so fine that all vertices of a cell are within the tolerance of each other.
struct Cell {
  std::array<std::int32_t, 3> index;   // z, y, x
  std::vector<std::int32_t> vertices;  // ascending
};
constexpr double kCellsPerTolerance = 1.7321;  // just above the square root of 3
constexpr std::int32_t kMaxCellOffset = 2;     // pairs within the tolerance are at most this many cells apart

// Returns the occupied cells in the order of their indices.
std::vector<Cell> sort_into_cells(const TriangleMesh& mesh, const std::vector<std::int32_t>& vertices,
                                  double tolerance) {
  const Vec3 corner_B = bounding_box(mesh).min_B;
  std::vector<std::pair<std::array<std::int32_t, 3>, std::int32_t>> placed;
  placed.reserve(vertices.size());
  for (const std::int32_t v : vertices) {
    const Vec3 cell = (mesh.vertex(v) - corner_B) / tolerance * kCellsPerTolerance;
    placed.push_back({{static_cast<std::int32_t>(cell.z()), static_cast<std::int32_t>(cell.y()),
                       static_cast<std::int32_t>(cell.x())},
                      v});
  }
  std::sort(placed.begin(), placed.end());
  std::vector<Cell> cells;
  for (const auto& [index, v] : placed) {
    if (cells.empty() || cells.back().index != index) cells.push_back({index, {}});
    cells.back().vertices.push_back(v);
  }
  return cells;
}

// comparisons_left is reduced by the comparisons made, perhaps to below 0.
void unite_cells(const TriangleMesh& mesh, const Cell& a, const Cell& b, double tolerance,
                 DisjointSets& clusters, std::int64_t& comparisons_left) {
  if (clusters.representative(a.vertices.front()) == clusters.representative(b.vertices.front())) return;
  for (const std::int32_t v : a.vertices) {
    comparisons_left -= static_cast<std::int64_t>(b.vertices.size());
    if (comparisons_left < 0) return;
    for (const std::int32_t w : b.vertices) {
      if ((mesh.vertex(v) - mesh.vertex(w)).norm() <= tolerance) {
        clusters.unite(v, w);
        return;
      }
    }
  }
}

// Unites the given vertices that are within the tolerance of each other. Each cell is compared with the rest
// of its row and with the rows ahead. A row's neighbours are contiguous in the order of the cells and form a
// sliding window. Returns nullopt if too many vertices are close to the tolerance, but not within it.
std::optional<DisjointSets> unite_close_vertices(const TriangleMesh& mesh,
                                                 const std::vector<std::int32_t>& vertices,
                                                 double tolerance) {
  DisjointSets clusters(mesh.vertex_count());
  std::int64_t comparisons_left = 100'000'000 + 1'000 * static_cast<std::int64_t>(vertices.size());
  const std::vector<Cell> cells = sort_into_cells(mesh, vertices, tolerance);
  for (const Cell& cell : cells) {
    for (const std::int32_t v : cell.vertices) clusters.unite(cell.vertices.front(), v);
  }
  for (std::int32_t ahead_z = 0; ahead_z <= kMaxCellOffset; ++ahead_z) {
    for (std::int32_t ahead_y = ahead_z == 0 ? 0 : -kMaxCellOffset; ahead_y <= kMaxCellOffset; ++ahead_y) {
      std::size_t window = 0;
      for (const Cell& cell : cells) {
        const auto& [z, y, x] = cell.index;
        const std::array<std::int32_t, 3> begin{z + ahead_z, y + ahead_y, x - kMaxCellOffset};
        const std::array<std::int32_t, 3> end{z + ahead_z, y + ahead_y, x + kMaxCellOffset};
        while (window < cells.size() && cells[window].index < begin) ++window;
        for (std::size_t i = window; i < cells.size() && cells[i].index <= end; ++i) {
          unite_cells(mesh, cell, cells[i], tolerance, clusters, comparisons_left);
        }
        if (comparisons_left < 0) return std::nullopt;
      }
    }
  }
  return clusters;
}

// Returns the vertices of unmatched edges, ascending.
std::vector<std::int32_t> vertices_of_unmatched_edges(const MeshTopology& topology) {
  std::vector<std::int32_t> vertices;
  for (const auto* edges : {&topology.boundary, &topology.misoriented, &topology.non_manifold}) {
    for (const Edge& edge : *edges) vertices.insert(vertices.end(), edge.begin(), edge.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// Returns the vertex with which each vertex is merged.
std::vector<std::int32_t> representatives(const TriangleMesh& mesh, DisjointSets& clusters,
                                          double tolerance) {
  std::vector<std::int32_t> representative(mesh.vertex_count());
  std::vector<bool> too_long(mesh.vertex_count(), false);
  for (std::size_t v = 0; v < representative.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    representative[v] = clusters.representative(vertex);
    const double move = (mesh.vertex(vertex) - mesh.vertex(representative[v])).norm();
    if (!(move <= kMaxMove * tolerance)) too_long[static_cast<std::size_t>(representative[v])] = true;
  }
  for (std::size_t v = 0; v < representative.size(); ++v) {
    if (too_long[static_cast<std::size_t>(representative[v])])
      representative[v] = static_cast<std::int32_t>(v);
  }
  return representative;
}

}  // namespace

// Returns the mesh with each vertex replaced by its representative, without faces that then use a vertex
// twice and without unused vertices.
TriangleMesh merge_vertices(const TriangleMesh& mesh, const std::vector<std::int32_t>& representative) {
  constexpr std::int32_t kUnused = -1;
  constexpr std::int32_t kUsed = 0;
  std::vector<std::int32_t> new_index(mesh.vertex_count(), kUnused);
  TriangleMesh merged;
  merged.triangles.reserve(mesh.triangles.size());
  for (const Triangle& stored : mesh.triangles) {
    Triangle face{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      face[corner] = representative[static_cast<std::size_t>(stored[corner])];
    }
    if (uses_vertex_twice(face)) continue;
    for (const std::int32_t vertex : face) new_index[static_cast<std::size_t>(vertex)] = kUsed;
    merged.triangles.push_back(face);
  }
  for (std::size_t v = 0; v < new_index.size(); ++v) {
    if (new_index[v] == kUsed) new_index[v] = merged.add_vertex(mesh.vertex(static_cast<std::int32_t>(v)));
  }
  for (Triangle& face : merged.triangles) {
    for (std::int32_t& vertex : face) vertex = new_index[static_cast<std::size_t>(vertex)];
  }
  return merged;
}

WeldedMesh weld(const TriangleMesh& mesh) {
  WeldedMesh welded;
  welded.vertices_stored = static_cast<std::int64_t>(mesh.vertex_count());
  welded.mesh = merge_vertices(mesh, first_at_same_position(mesh));
  welded.faces_dropped = static_cast<std::int64_t>(mesh.triangles.size() - welded.mesh.triangles.size());
  return welded;
}

void weld_within_tolerance(TriangleMesh& mesh, double tolerance, RepairReport& report) {
  const MeshTopology topology = mesh_topology(mesh);
  if (topology.counts.all_matched()) return;
  std::optional<DisjointSets> clusters =
      unite_close_vertices(mesh, vertices_of_unmatched_edges(topology), tolerance);
  if (!clusters) {
    report.skipped.push_back({RepairKind::kWeld, RepairObstacle::kTooMany, topology.counts.unmatched()});
    return;
  }
  const std::vector<std::int32_t> representative = representatives(mesh, *clusters, tolerance);
  RepairStep step;
  step.kind = RepairKind::kWeld;
  std::vector<double> moves(mesh.vertex_count(), 0.0);
  for (std::size_t v = 0; v < representative.size(); ++v) {
    const auto vertex = static_cast<std::int32_t>(v);
    if (representative[v] == vertex) continue;
    ++step.count;
    moves[v] = (mesh.vertex(vertex) - mesh.vertex(representative[v])).norm();
    step.max_move = std::max(step.max_move, moves[v]);
  }
  if (step.count == 0) return;

  TriangleMesh merged = merge_vertices(mesh, representative);
  if (merged.triangles.empty() || mesh_topology(merged).counts.unmatched() >= topology.counts.unmatched())
    return;
  for (const Triangle& face : mesh.triangles) {
    double move = 0.0;
    for (const std::int32_t v : face) move = std::max(move, moves[static_cast<std::size_t>(v)]);
    if (move == 0.0) continue;
    step.area += area_of_face(mesh, face);
    report.volume_bound += swept_volume_bound(mesh, face, move);
  }
  mesh = std::move(merged);
  report.steps.push_back(step);
}

}  // namespace buoyancy
