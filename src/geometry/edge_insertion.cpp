#include "geometry/edge_insertion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/aabb_tree.h"
#include "geometry/mesh_topology.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

constexpr int kMaxRounds = 8;

// A vertex on one of a face's sides.
struct SidePoint {
  double along;  // from the side's start, 0, to its end, 1
  std::int32_t vertex;
};

std::span<const EdgeInsertion> insertions_of(std::span<const EdgeInsertion> all, const Edge& edge) {
  const auto before = [](const EdgeInsertion& insertion, const Edge& e) { return insertion.edge < e; };
  const auto after = [](const Edge& e, const EdgeInsertion& insertion) { return e < insertion.edge; };
  const auto first = std::lower_bound(all.begin(), all.end(), edge, before);
  const auto last = std::upper_bound(first, all.end(), edge, after);
  return {first, last};
}

// Appends a triangle unless it uses a vertex twice.
void add_piece(std::int32_t a, std::int32_t b, std::int32_t c, std::vector<Triangle>& pieces) {
  if (a != b && b != c && c != a) pieces.push_back({a, b, c});
}

// Triangulates a face of three different corners whose sides have different further vertices. It cuts strips
// between the two sides at the first corner. The last triangle, which has the third side, becomes a fan.
void triangulate_strips(const Triangle& corners, const std::array<std::vector<SidePoint>, 3>& sides,
                        std::vector<Triangle>& pieces) {
  std::vector<SidePoint> right = sides[0];  // from the first corner to the second
  right.push_back({1.0, corners[1]});
  std::vector<SidePoint> left;  // from the first corner to the third
  for (auto point = sides[2].rbegin(); point != sides[2].rend(); ++point) {
    left.push_back({1.0 - point->along, point->vertex});
  }
  left.push_back({1.0, corners[2]});

  std::int32_t apex = corners[0];
  std::size_t r = 0;
  std::size_t l = 0;
  // Each triangle has the edge between the two sides' next vertices, and the vertex before one of them.
  while (r + 1 < right.size() || l + 1 < left.size()) {
    pieces.push_back({apex, right[r].vertex, left[l].vertex});
    const bool advance_right =
        l + 1 == left.size() || (r + 1 < right.size() && right[r + 1].along <= left[l + 1].along);
    apex = advance_right ? right[r++].vertex : left[l++].vertex;
  }
  std::int32_t from = corners[1];
  for (const SidePoint& point : sides[1]) {
    pieces.push_back({apex, from, point.vertex});
    from = point.vertex;
  }
  pieces.push_back({apex, from, corners[2]});
}

// Removes spikes a-b-a from a closed walk until there are none.
std::vector<std::int32_t> without_spikes(const std::vector<std::int32_t>& walk) {
  std::vector<std::int32_t> kept;
  for (const std::int32_t v : walk) {
    if (!kept.empty() && kept.back() == v) continue;
    if (kept.size() >= 2 && kept[kept.size() - 2] == v) {
      kept.pop_back();
    } else {
      kept.push_back(v);
    }
  }
  std::size_t begin = 0;
  while (kept.size() - begin >= 2) {
    const std::size_t size = kept.size() - begin;
    if (kept[begin] == kept.back() || (size >= 3 && kept[begin] == kept[kept.size() - 2])) {
      kept.pop_back();  // a repeated start, or the tip of a spike that begins and ends there
    } else if (size >= 3 && kept[begin + 1] == kept.back()) {
      ++begin;  // the start is a spike's tip
    } else {
      break;
    }
  }
  return {kept.begin() + static_cast<std::ptrdiff_t>(begin), kept.end()};
}

// Cuts one face into pieces whose edges are those of the face with the vertices inserted. Returns false if
// the face is so thin that one of its vertices was inserted into an edge of its own, or one into two edges.
bool split_face(const Triangle& face, std::span<const EdgeInsertion> insertions,
                std::vector<Triangle>& pieces) {
  std::array<std::vector<SidePoint>, 3> sides;
  std::vector<std::int32_t> walk;
  for (std::size_t side = 0; side < 3; ++side) {
    const std::int32_t from = face[side];
    const std::int32_t to = face[(side + 1) % 3];
    const auto inserted = insertions_of(insertions, {std::min(from, to), std::max(from, to)});
    for (const EdgeInsertion& insertion : inserted) {
      sides[side].push_back({from < to ? insertion.along : 1.0 - insertion.along, insertion.vertex});
    }
    if (from > to) std::reverse(sides[side].begin(), sides[side].end());
    walk.push_back(from);
    for (const SidePoint& point : sides[side]) walk.push_back(point.vertex);
  }
  std::vector<std::int32_t> sorted = walk;
  std::sort(sorted.begin(), sorted.end());
  if (std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end()) {
    triangulate_strips(face, sides, pieces);
    return true;
  }
  // What is left of the walk encloses next to nothing; a fan has the same edges.
  const std::vector<std::int32_t> rest = without_spikes(walk);
  for (std::size_t i = 2; i < rest.size(); ++i) add_piece(rest[0], rest[i - 1], rest[i], pieces);
  return false;
}

std::vector<Edge> unmatched_edges(const MeshTopology& topology) {
  std::vector<Edge> edges = topology.boundary;
  edges.insert(edges.end(), topology.misoriented.begin(), topology.misoriented.end());
  edges.insert(edges.end(), topology.non_manifold.begin(), topology.non_manifold.end());
  return edges;
}

// Counts boundary edges twice: one that gains a face is then an improvement even if it gets three faces.
std::int64_t count_faults(const MeshTopology& topology) {
  return topology.counts.unmatched() + topology.counts.boundary;
}

// Finds vertices of some edges along lines.
class VertexTree {
 public:
  VertexTree(const TriangleMesh& mesh, const std::vector<Edge>& edges)
      : mesh_(&mesh), vertices_(vertices_of(edges)), tree_(boxes_of(mesh, vertices_)) {}

  // Appends the vertices within the tolerance of the edge, between its ends.
  void find_on(const Edge& edge, double tolerance, std::int64_t& visits_left,
               std::vector<EdgeInsertion>& found) const {
    const Vec3 from = mesh_->vertex(edge[0]);
    const Vec3 along = mesh_->vertex(edge[1]) - from;
    const double length_squared = along.squaredNorm();
    if (!(length_squared > 0.0)) return;
    const auto meets = [&](const BoundingBox& box) {
      return --visits_left > 0 && segment_meets(from, along, box, 2.0 * tolerance);
    };
    tree_.for_each(meets, [&](std::int32_t item) {
      const std::int32_t v = vertices_[static_cast<std::size_t>(item)];
      if (v == edge[0] || v == edge[1]) return;
      const Vec3 to_vertex = mesh_->vertex(v) - from;
      const double t = to_vertex.dot(along) / length_squared;
      const double distance = (to_vertex - t * along).norm();
      if (t > 0.0 && t < 1.0 && distance <= tolerance) found.push_back({edge, t, v, distance});
    });
  }

 private:
  static std::vector<std::int32_t> vertices_of(const std::vector<Edge>& edges) {
    std::vector<std::int32_t> vertices;
    for (const Edge& edge : edges) vertices.insert(vertices.end(), edge.begin(), edge.end());
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }
  static std::vector<BoundingBox> boxes_of(const TriangleMesh& mesh,
                                           const std::vector<std::int32_t>& vertices) {
    std::vector<BoundingBox> boxes;
    boxes.reserve(vertices.size());
    for (const std::int32_t v : vertices) boxes.push_back({mesh.vertex(v), mesh.vertex(v)});
    return boxes;
  }
  // Returns whether the segment meets the box enlarged by the margin on all sides.
  static bool segment_meets(const Vec3& from, const Vec3& along, const BoundingBox& box, double margin) {
    double enter = 0.0;
    double leave = 1.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double low = box.min_B(axis) - margin - from(axis);
      const double high = box.max_B(axis) + margin - from(axis);
      const double step = along(axis);
      if (step == 0.0) {
        if (low > 0.0 || high < 0.0) return false;
        continue;
      }
      enter = std::max(enter, std::min(low / step, high / step));
      leave = std::min(leave, std::max(low / step, high / step));
    }
    return enter <= leave;
  }

  const TriangleMesh* mesh_;
  std::vector<std::int32_t> vertices_;
  AabbTree tree_;
};

// Returns the insertions of unmatched edges' vertices into the edges on which they lie, ascending; nullopt if
// there are too many.
std::optional<std::vector<EdgeInsertion>> find_insertions(const TriangleMesh& mesh,
                                                          const std::vector<Edge>& unmatched,
                                                          double tolerance) {
  const auto faces = static_cast<std::int64_t>(mesh.triangles.size());
  std::int64_t visits_left = 50'000'000 + 300 * faces;
  const auto most = static_cast<std::size_t>(1'000'000 + 10 * faces);
  const VertexTree tree(mesh, unmatched);
  std::vector<EdgeInsertion> insertions;
  collect_edge_uses(mesh).for_each_edge([&](std::int32_t low, std::span<const EdgeUse> uses) {
    if (visits_left > 0 && insertions.size() <= most)
      tree.find_on({low, uses.front().high}, tolerance, visits_left, insertions);
  });
  if (visits_left <= 0 || insertions.size() > most) return std::nullopt;
  std::sort(insertions.begin(), insertions.end());
  return insertions;
}

std::size_t count_uses(const EdgeUses& edges, std::int32_t a, std::int32_t b) {
  const auto low = static_cast<std::size_t>(std::min(a, b));
  const std::int32_t high = std::max(a, b);
  const auto begin = edges.uses.begin() + static_cast<std::ptrdiff_t>(edges.first[low]);
  const auto end = edges.uses.begin() + static_cast<std::ptrdiff_t>(edges.first[low + 1]);
  const auto before = [](const EdgeUse& use, std::int32_t vertex) { return use.high < vertex; };
  const auto after = [](std::int32_t vertex, const EdgeUse& use) { return vertex < use.high; };
  const auto first = std::lower_bound(begin, end, high, before);
  return static_cast<std::size_t>(std::upper_bound(first, end, high, after) - first);
}

// Returns the insertions next to which an edge has gained a face.
std::vector<EdgeInsertion> useful_insertions(const TriangleMesh& mesh, const TriangleMesh& split,
                                             const std::vector<EdgeInsertion>& insertions) {
  const EdgeUses before = collect_edge_uses(mesh);
  const EdgeUses after = collect_edge_uses(split);
  std::vector<EdgeInsertion> useful;
  for (std::size_t i = 0; i < insertions.size(); ++i) {
    const Edge& edge = insertions[i].edge;
    const std::int32_t vertex = insertions[i].vertex;
    const bool first = i == 0 || insertions[i - 1].edge != edge;
    const bool last = i + 1 == insertions.size() || insertions[i + 1].edge != edge;
    const std::size_t uses = count_uses(before, edge[0], edge[1]);
    const auto joined = [&](std::int32_t other) {
      const std::size_t now = count_uses(after, vertex, other);
      return now >= 2 && now != uses;
    };
    if (joined(first ? edge[0] : insertions[i - 1].vertex) ||
        joined(last ? edge[1] : insertions[i + 1].vertex)) {
      useful.push_back(insertions[i]);
    }
  }
  return useful;
}

}  // namespace

bool EdgeInsertion::operator<(const EdgeInsertion& other) const {
  return std::tie(edge, along, vertex) < std::tie(other.edge, other.along, other.vertex);
}

SplitMesh split_edges(const TriangleMesh& mesh, std::span<const EdgeInsertion> insertions) {
  std::vector<bool> has_insertion(mesh.vertex_count(), false);  // by lower vertex of an edge
  for (const EdgeInsertion& insertion : insertions)
    has_insertion[static_cast<std::size_t>(insertion.edge[0])] = true;

  SplitMesh split;
  split.mesh.x = mesh.x;
  split.mesh.y = mesh.y;
  split.mesh.z = mesh.z;
  split.mesh.triangles.reserve(mesh.triangles.size() + 2 * insertions.size());
  for (const Triangle& face : mesh.triangles) {
    double distance = -1.0;  // the largest of an inserted vertex
    for (std::size_t side = 0; side < 3; ++side) {
      const std::int32_t low = std::min(face[side], face[(side + 1) % 3]);
      if (!has_insertion[static_cast<std::size_t>(low)]) continue;
      const Edge edge{low, std::max(face[side], face[(side + 1) % 3])};
      for (const EdgeInsertion& insertion : insertions_of(insertions, edge)) {
        distance = std::max(distance, insertion.distance);
      }
    }
    if (distance < 0.0) {
      split.mesh.triangles.push_back(face);
      continue;
    }
    const std::size_t first = split.mesh.triangles.size();
    const bool collapsed = !split_face(face, insertions, split.mesh.triangles);
    split.area += area_of_face(mesh, face);
    if (collapsed) split.volume_bound += swept_volume_bound(mesh, face, distance);
    for (std::size_t piece = first; piece < split.mesh.triangles.size(); ++piece) {
      split.volume_bound += swept_volume_bound(mesh, split.mesh.triangles[piece], distance);
    }
  }
  return split;
}

void insert_vertices_on_edges(TriangleMesh& mesh, double tolerance, RepairReport& report) {
  RepairStep step;
  step.kind = RepairKind::kInsertVertices;
  MeshTopology topology = mesh_topology(mesh);
  for (int round = 0; round < kMaxRounds && !topology.counts.all_matched(); ++round) {
    std::optional<std::vector<EdgeInsertion>> insertions =
        find_insertions(mesh, unmatched_edges(topology), tolerance);
    if (!insertions) {
      report.skipped.push_back({step.kind, RepairObstacle::kTooMany, topology.counts.unmatched()});
      break;
    }
    if (insertions->empty()) break;
    SplitMesh split = split_edges(mesh, *insertions);
    std::vector<EdgeInsertion> useful = useful_insertions(mesh, split.mesh, *insertions);
    if (useful.empty()) break;
    if (useful.size() < insertions->size()) split = split_edges(mesh, useful);
    MeshTopology after = mesh_topology(split.mesh);
    if (count_faults(after) >= count_faults(topology)) break;
    topology = std::move(after);
    mesh = std::move(split.mesh);
    step.count += static_cast<std::int64_t>(useful.size());
    step.area += split.area;
    for (const EdgeInsertion& insertion : useful) step.max_move = std::max(step.max_move, insertion.distance);
    report.volume_bound += split.volume_bound;
  }
  if (step.count > 0) report.steps.push_back(step);
}

}  // namespace buoyancy
