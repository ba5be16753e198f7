#include "geometry/hole_caps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "geometry/disjoint_sets.h"
#include "geometry/enclosed_solid.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

constexpr double kHemisphere = 0.376;  // volume of a hemisphere over a disc of area 1: 2 / (3 sqrt(pi))
constexpr std::size_t kMaxForLeastArea = 64;

using Loop = std::vector<std::int32_t>;  // vertices in the direction of the cap's edges

// Divides directed edges into closed loops that use no vertex twice. A walk that ends without returning to
// its start counts as a loop with one edge more. edges: ascending.
std::vector<Loop> find_loops(const std::vector<Edge>& edges) {
  std::vector<std::int32_t> vertices;
  for (const Edge& edge : edges) vertices.insert(vertices.end(), edge.begin(), edge.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const auto position = [&vertices](std::int32_t v) {
    return static_cast<std::size_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
  };
  const std::size_t n = vertices.size();
  std::vector<std::size_t> next(n + 1, 0);  // first edge from each vertex that is not used yet
  std::vector<std::int64_t> surplus(n, 0);
  for (const Edge& edge : edges) {
    ++next[position(edge[0]) + 1];
    ++surplus[position(edge[0])];
    --surplus[position(edge[1])];
  }
  for (std::size_t i = 1; i <= n; ++i) next[i] += next[i - 1];
  const std::vector<std::size_t> end(next.begin() + 1, next.end());

  constexpr std::size_t kOffPath = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> place_on_path(n, kOffPath);
  std::vector<Loop> loops;
  std::vector<std::size_t> path;
  const auto cut_loop = [&](std::size_t from) {
    Loop loop;
    for (std::size_t i = from; i < path.size(); ++i) {
      loop.push_back(vertices[path[i]]);
      place_on_path[path[i]] = kOffPath;
    }
    path.resize(from);
    if (loop.size() >= 3) loops.push_back(std::move(loop));
  };
  const auto walk = [&](std::size_t v) {
    while (true) {
      if (place_on_path[v] != kOffPath) cut_loop(place_on_path[v]);
      place_on_path[v] = path.size();
      path.push_back(v);
      if (next[v] == end[v]) break;
      v = position(edges[next[v]++][1]);
    }
    if (!path.empty()) cut_loop(0);
  };
  for (std::size_t v = 0; v < n; ++v) {
    for (; surplus[v] > 0; --surplus[v]) walk(v);
  }
  for (std::size_t v = 0; v < n; ++v) {
    while (next[v] < end[v]) walk(v);
  }
  return loops;
}

// Appends the triangulation of least area, by dynamic programming over all sub-polygons.
void cap_with_least_area(const TriangleMesh& mesh, const Loop& loop, std::vector<Triangle>& cap) {
  const std::size_t n = loop.size();
  std::vector<double> area(n * n, 0.0);  // least area of the polygon from i to j
  std::vector<std::size_t> middle(n * n, 0);
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t j = i + span;
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t k = i + 1; k < j; ++k) {
        const double sum =
            area[i * n + k] + area[k * n + j] + area_of_face(mesh, {loop[i], loop[k], loop[j]});
        if (sum < least || k == i + 1) {
          least = sum;
          middle[i * n + j] = k;
        }
      }
      area[i * n + j] = least;
    }
  }
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, n - 1}};
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    if (j - i < 2) continue;
    const std::size_t k = middle[i * n + j];
    cap.push_back({loop[i], loop[k], loop[j]});
    open.emplace_back(i, k);
    open.emplace_back(k, j);
  }
}

// Appends a triangulation that cuts off the corner with the shortest diagonal first.
void cap_by_shortest_diagonals(const TriangleMesh& mesh, const Loop& loop, std::vector<Triangle>& cap) {
  const std::size_t n = loop.size();
  std::vector<std::size_t> next(n);
  std::vector<std::size_t> previous(n);
  std::vector<std::int64_t> version(n, 0);                       // -1: cut off
  using Corner = std::tuple<double, std::size_t, std::int64_t>;  // diagonal, place on the loop, version
  std::priority_queue<Corner, std::vector<Corner>, std::greater<>> corners;
  const auto push = [&](std::size_t i) {
    const double diagonal = (mesh.vertex(loop[next[i]]) - mesh.vertex(loop[previous[i]])).squaredNorm();
    corners.emplace(diagonal, i, version[i]);
  };
  for (std::size_t i = 0; i < n; ++i) {
    next[i] = (i + 1) % n;
    previous[i] = (i + n - 1) % n;
  }
  for (std::size_t i = 0; i < n; ++i) push(i);
  for (std::size_t left = n; left >= 3;) {
    const auto [diagonal, i, pushed] = corners.top();
    corners.pop();
    if (version[i] != pushed) continue;
    cap.push_back({loop[previous[i]], loop[i], loop[next[i]]});
    version[i] = -1;
    next[previous[i]] = next[i];
    previous[next[i]] = previous[i];
    if (--left < 3) break;
    for (const std::size_t neighbour : {previous[i], next[i]}) {
      ++version[neighbour];
      push(neighbour);
    }
  }
}

std::vector<Triangle> cap_loop(const TriangleMesh& mesh, const Loop& loop, std::int64_t& work_left) {
  std::vector<Triangle> cap;
  cap.reserve(loop.size() - 2);
  const auto n = static_cast<std::int64_t>(loop.size());
  if (loop.size() <= kMaxForLeastArea && n * n * n / 6 <= work_left) {
    work_left -= n * n * n / 6;
    cap_with_least_area(mesh, loop, cap);
  } else {
    cap_by_shortest_diagonals(mesh, loop, cap);
  }
  return cap;
}

// Turns edges so that they follow each other along trails, as long as these go; ascending. Where faces around
// a hole have no consistent winding, its edges do not follow each other.
std::vector<Edge> directed_along_trails(const std::vector<Edge>& edges) {
  std::vector<std::array<std::int32_t, 3>> ends;  // vertex, other vertex, edge; ascending
  for (std::size_t e = 0; e < edges.size(); ++e) {
    ends.push_back({edges[e][0], edges[e][1], static_cast<std::int32_t>(e)});
    ends.push_back({edges[e][1], edges[e][0], static_cast<std::int32_t>(e)});
  }
  std::sort(ends.begin(), ends.end());
  std::vector<bool> used(edges.size(), false);
  std::vector<std::size_t> next(ends.size());  // by the first end at a vertex: the next one to look at
  std::iota(next.begin(), next.end(), std::size_t{0});
  const auto first_end = [&ends](std::int32_t v) {
    return static_cast<std::size_t>(
        std::lower_bound(ends.begin(), ends.end(), std::array<std::int32_t, 3>{v, -1, -1}) - ends.begin());
  };
  std::vector<Edge> directed;
  for (const Edge& edge : edges) {
    for (std::int32_t v = edge[0];;) {
      std::size_t& i = next[first_end(v)];
      while (i < ends.size() && ends[i][0] == v && used[static_cast<std::size_t>(ends[i][2])]) ++i;
      if (i == ends.size() || ends[i][0] != v) break;
      used[static_cast<std::size_t>(ends[i][2])] = true;
      directed.push_back({v, ends[i][1]});
      v = ends[i][1];
    }
  }
  std::sort(directed.begin(), directed.end());
  return directed;
}

double area_of(const TriangleMesh& mesh, const std::vector<Triangle>& faces) {
  double area = 0.0;
  for (const Triangle& face : faces) area += area_of_face(mesh, face);
  return area;
}

double bulge_of(double area) {
  return kHemisphere * area * std::sqrt(area);
}

// Returns the edges that a mesh lacks, ascending.
std::vector<Edge> missing_edges(const TriangleMesh& mesh) {
  std::vector<Edge> missing;
  collect_edge_uses(mesh).for_each_edge([&missing](std::int32_t low, std::span<const EdgeUse> uses) {
    const std::int64_t net = net_uses(uses);
    const std::int32_t high = uses.front().high;
    for (std::int64_t i = 0; i < std::abs(net); ++i)
      missing.push_back(net > 0 ? Edge{high, low} : Edge{low, high});
  });
  std::sort(missing.begin(), missing.end());
  return missing;
}

}  // namespace

HoleSize measure_hole(const TriangleMesh& mesh, const Hole& hole, std::int64_t& work_left) {
  HoleSize size;
  std::vector<Edge> edges;
  for (const auto& [from, to] : hole.edges) {
    edges.push_back({to, from});
    size.perimeter += (mesh.vertex(to) - mesh.vertex(from)).norm();
  }
  std::sort(edges.begin(), edges.end());
  for (const Loop& loop : find_loops(edges)) {
    const double area = area_of(mesh, cap_loop(mesh, loop, work_left));
    size.area += area;
    size.bulge += bulge_of(area);
  }
  return size;
}

bool has_closed_loop(const std::vector<Edge>& edges) {
  std::vector<std::int32_t> vertices;
  for (const Edge& edge : edges) vertices.insert(vertices.end(), edge.begin(), edge.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  DisjointSets connected(vertices.size());
  for (const Edge& edge : edges) {
    const auto end = [&](std::int32_t v) {
      const auto found = std::lower_bound(vertices.begin(), vertices.end(), v);
      return connected.representative(static_cast<std::int32_t>(found - vertices.begin()));
    };
    if (end(edge[0]) == end(edge[1])) return true;
    connected.unite(end(edge[0]), end(edge[1]));
  }
  return false;
}

void cap_small_holes(TriangleMesh& mesh, RepairReport& report) {
  const std::vector<Edge> boundary = mesh_topology(mesh).boundary;
  if (boundary.empty()) return;
  const std::vector<Edge> trails = directed_along_trails(boundary);
  std::vector<Edge> wanted;
  wanted.reserve(boundary.size());
  for (const auto& [from, to] : boundary) wanted.push_back({to, from});
  std::sort(wanted.begin(), wanted.end());
  const BoundingBox box = bounding_box(mesh);
  const double most = kNegligibleBulge * (box.max_B - box.min_B).prod();
  RepairStep step;
  step.kind = RepairKind::kCapHoles;
  std::int64_t work_left = kCapWork;
  for (Loop& loop : find_loops(trails)) {
    if (!std::binary_search(trails.begin(), trails.end(), Edge{loop.back(), loop.front()})) continue;
    std::size_t matching = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Edge edge{loop[i], loop[(i + 1) % loop.size()]};
      if (std::binary_search(wanted.begin(), wanted.end(), edge)) ++matching;
    }
    if (2 * matching < loop.size()) std::reverse(loop.begin(), loop.end());
    const std::vector<Triangle> cap = cap_loop(mesh, loop, work_left);
    const double area = area_of(mesh, cap);
    if (!(bulge_of(area) <= most)) continue;
    mesh.triangles.insert(mesh.triangles.end(), cap.begin(), cap.end());
    ++step.count;
    step.area += area;
    report.cap_bulge += bulge_of(area);
  }
  if (step.count > 0) report.steps.push_back(step);
}

void cap_negligible_holes(TriangleMesh& mesh, RepairReport& report) {
  RepairStep step;
  step.kind = RepairKind::kCapHoles;
  std::int64_t work_left = kCapWork;
  double bulge = 0.0;
  TriangleMesh capped = mesh;
  for (const Loop& loop : find_loops(missing_edges(mesh))) {
    const std::vector<Triangle> cap = cap_loop(mesh, loop, work_left);
    const double area = area_of(mesh, cap);
    capped.triangles.insert(capped.triangles.end(), cap.begin(), cap.end());
    ++step.count;
    step.area += area;
    bulge += bulge_of(area);
  }
  if (step.count == 0) return;
  const std::optional<EnclosedSolid> solid = enclosed_solid(capped);
  if (!solid || !(bulge <= kNegligibleBulge * solid->volume)) return;
  mesh = std::move(capped);
  report.cap_bulge += bulge;
  report.steps.push_back(step);
}

}  // namespace buoyancy
