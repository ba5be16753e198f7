#include "geometry/boundary_loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

namespace buoyancy {

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

}  // namespace buoyancy
