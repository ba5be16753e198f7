// Finds which faces use an edge of a mesh, and in which direction. Topology and repair build on it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

using Edge = std::array<std::int32_t, 2>;  // vertex indices

// The use of an edge by one face; stored under the edge's lower vertex.
struct EdgeUse {
  std::int32_t high;
  std::int32_t third;  // the face's vertex that is not on the edge
  std::int32_t face;
  bool forward;  // from the lower to the higher vertex

  bool operator<(const EdgeUse& other) const {
    return std::tie(high, third, face) < std::tie(other.high, other.third, other.face);
  }
};

// All uses of edges, grouped by lower vertex (counting sort), each group sorted.
struct EdgeUses {
  std::vector<EdgeUse> uses;
  std::vector<std::size_t> first;  // start of each lower vertex's group, and the end of the last

  // Calls visit(low, uses) once for every edge, ascending by lower, then higher vertex. uses: those of the
  // edge, ascending by third vertex, then face.
  template <typename Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t low = 0; low + 1 < first.size(); ++low) {
      for (std::size_t begin = first[low]; begin < first[low + 1];) {
        std::size_t end = begin + 1;
        while (end < first[low + 1] && uses[end].high == uses[begin].high) ++end;
        visit(static_cast<std::int32_t>(low), std::span(uses).subspan(begin, end - begin));
        begin = end;
      }
    }
  }
};

// Requires indices in range and no face with two equal indices. Complexity: O(n) for n faces; O(n log n) if
// many faces share one vertex.
EdgeUses collect_edge_uses(const TriangleMesh& mesh);

// Numbers the edges in the order of EdgeUses::for_each_edge(), and finds the edges of a face.
class EdgeTable {
 public:
  explicit EdgeTable(const TriangleMesh& mesh);

  std::size_t size() const { return edges_.size(); }
  const Edge& edge(std::int32_t e) const { return edges_[static_cast<std::size_t>(e)]; }  // lower first
  std::span<const EdgeUse> uses(std::int32_t e) const {
    const auto i = static_cast<std::size_t>(e);
    return std::span(uses_.uses).subspan(first_use_[i], first_use_[i + 1] - first_use_[i]);
  }
  // Returns the edges of a face, in no particular order.
  const std::array<std::int32_t, 3>& edges_of(std::int32_t face) const {
    return edges_of_face_[static_cast<std::size_t>(face)];
  }

 private:
  EdgeUses uses_;
  std::vector<Edge> edges_;
  std::vector<std::size_t> first_use_;
  std::vector<std::array<std::int32_t, 3>> edges_of_face_;
};

// Returns forward minus backward uses: 0 if the edge is matched.
inline std::int64_t net_uses(std::span<const EdgeUse> uses) {
  std::int64_t net = 0;
  for (const EdgeUse& use : uses) net += use.forward ? 1 : -1;
  return net;
}

}  // namespace buoyancy
