#include "geometry/mesh_topology.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <span>

#include "geometry/disjoint_sets.h"

namespace buoyancy {
namespace {

void classify_edge(std::int32_t low, std::span<const EdgeUse> uses, MeshTopology& topology) {
  const std::int32_t high = uses.front().high;
  if (uses.size() == 1) {
    ++topology.counts.boundary;
    topology.boundary.push_back(uses.front().forward ? Edge{low, high} : Edge{high, low});
    topology.boundary_faces.push_back(uses.front().face);
  } else if (net_uses(uses) == 0) {
    ++(uses.size() == 2 ? topology.counts.manifold : topology.counts.balanced);
  } else if (uses.size() == 2) {
    ++topology.counts.misoriented;
    topology.misoriented.push_back({low, high});
  } else {
    ++topology.counts.non_manifold;
    topology.non_manifold.push_back({low, high});
  }
}

// Compares faces only at the edge between their two lowest vertices, so that each face is counted once.
std::int64_t count_duplicates(std::span<const EdgeUse> uses) {
  std::int64_t duplicates = 0;
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].third > uses[i].high && uses[i].third == uses[i - 1].third) ++duplicates;
  }
  return duplicates;
}

}  // namespace

MeshTopology mesh_topology(const TriangleMesh& mesh) {
  assert(mesh.triangles.size() <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()));
  MeshTopology topology;
  const EdgeUses edges = collect_edge_uses(mesh);
  DisjointSets connected(mesh.triangles.size());
  edges.for_each_edge([&](std::int32_t low, std::span<const EdgeUse> uses) {
    for (const EdgeUse& use : uses.subspan(1)) connected.unite(uses.front().face, use.face);
    classify_edge(low, uses, topology);
    topology.duplicate_faces += count_duplicates(uses);
  });

  topology.component_of_face.resize(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto first = static_cast<std::size_t>(connected.representative(static_cast<std::int32_t>(f)));
    topology.component_of_face[f] = first == f ? topology.components++ : topology.component_of_face[first];
  }
  return topology;
}

std::vector<Hole> find_holes(const TriangleMesh& mesh, const std::vector<Edge>& boundary) {
  std::vector<std::int32_t> vertices;
  for (const Edge& edge : boundary) vertices.insert(vertices.end(), edge.begin(), edge.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto position = [&vertices](std::int32_t vertex) {
    return static_cast<std::int32_t>(std::lower_bound(vertices.begin(), vertices.end(), vertex) -
                                     vertices.begin());
  };

  DisjointSets connected(vertices.size());
  for (const Edge& edge : boundary) connected.unite(position(edge[0]), position(edge[1]));

  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const BoundingBox empty{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  std::map<std::int32_t, std::size_t> hole_of_representative;
  std::vector<Hole> holes;
  for (const Edge& edge : boundary) {
    const auto [found, is_new] =
        hole_of_representative.try_emplace(connected.representative(position(edge[0])), holes.size());
    if (is_new) holes.push_back({{}, empty});
    Hole& hole = holes[found->second];
    hole.edges.push_back(edge);
    for (const std::int32_t vertex : edge) {
      hole.box.min_B = hole.box.min_B.cwiseMin(mesh.vertex(vertex));
      hole.box.max_B = hole.box.max_B.cwiseMax(mesh.vertex(vertex));
    }
  }
  std::stable_sort(holes.begin(), holes.end(),
                   [](const Hole& a, const Hole& b) { return a.edges.size() > b.edges.size(); });
  return holes;
}

}  // namespace buoyancy
