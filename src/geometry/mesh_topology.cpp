#include "geometry/mesh_topology.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <tuple>

#include "geometry/disjoint_sets.h"

namespace buoyancy {
namespace {

// The use of an edge by one face; stored under the edge's lower vertex.
struct EdgeUse {
  std::int32_t high;
  std::int32_t third;  // the face's vertex that is not on the edge
  std::int32_t face;
  bool forward;

  bool operator<(const EdgeUse& other) const {
    return std::tie(high, third, face) < std::tie(other.high, other.third, other.face);
  }
};

// All edge uses, grouped by lower vertex (counting sort), each group sorted.
struct EdgeUses {
  std::vector<EdgeUse> uses;
  std::vector<std::size_t> first;  // start of each lower vertex's group, and the end of the last
};

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
  for (std::size_t v = 0; v + 1 < edges.first.size(); ++v) {
    std::sort(edges.uses.begin() + static_cast<std::ptrdiff_t>(edges.first[v]),
              edges.uses.begin() + static_cast<std::ptrdiff_t>(edges.first[v + 1]));
  }
  return edges;
}

void classify_edge(std::int32_t low, const EdgeUse* begin, const EdgeUse* end, MeshTopology& topology) {
  const auto uses = end - begin;
  const auto forward = std::count_if(begin, end, [](const EdgeUse& use) { return use.forward; });
  const std::int32_t high = begin->high;
  if (uses == 1) {
    ++topology.counts.boundary;
    topology.boundary.push_back(begin->forward ? Edge{low, high} : Edge{high, low});
    topology.boundary_faces.push_back(begin->face);
  } else if (2 * forward == uses) {
    ++(uses == 2 ? topology.counts.manifold : topology.counts.balanced);
  } else if (uses == 2) {
    ++topology.counts.misoriented;
    topology.misoriented.push_back({low, high});
  } else {
    ++topology.counts.non_manifold;
    topology.non_manifold.push_back({low, high});
  }
}

// Compares faces only at the edge between their two lowest vertices, so that each face is counted once.
std::int64_t count_duplicates(const EdgeUse* begin, const EdgeUse* end) {
  std::int64_t duplicates = 0;
  for (const EdgeUse* use = begin + 1; use < end; ++use) {
    if (use->third > use->high && use->third == (use - 1)->third) ++duplicates;
  }
  return duplicates;
}

}  // namespace

MeshTopology mesh_topology(const TriangleMesh& mesh) {
  assert(mesh.triangles.size() <= static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()));
  MeshTopology topology;
  const EdgeUses edges = collect_edge_uses(mesh);
  DisjointSets connected(mesh.triangles.size());
  for (std::size_t v = 0; v + 1 < edges.first.size(); ++v) {
    const EdgeUse* const last = edges.uses.data() + edges.first[v + 1];
    for (const EdgeUse* begin = edges.uses.data() + edges.first[v]; begin != last;) {
      const EdgeUse* end = begin + 1;
      for (; end != last && end->high == begin->high; ++end) connected.unite(begin->face, end->face);
      classify_edge(static_cast<std::int32_t>(v), begin, end, topology);
      topology.duplicate_faces += count_duplicates(begin, end);
      begin = end;
    }
  }

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
