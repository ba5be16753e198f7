#include "geometry/loop_caps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "geometry/swept_volume.h"
#include "geometry/triangulation.h"

namespace buoyancy {
namespace {

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

}  // namespace

std::vector<Triangle> cap_loop(const TriangleMesh& mesh, const Loop& loop, std::size_t max_for_least_area,
                               std::int64_t& work_left) {
  std::vector<Triangle> cap;
  cap.reserve(loop.size() - 2);
  const auto n = static_cast<std::int64_t>(loop.size());
  if (loop.size() <= max_for_least_area && n * n * n / 6 <= work_left) {
    work_left -= n * n * n / 6;
    cap_with_least_area(mesh, loop, cap);
  } else {
    cap_by_shortest_diagonals(mesh, loop, cap);
  }
  return cap;
}

std::vector<Triangle> cap_in_projection(const TriangleMesh& mesh, const Loop& loop) {
  TriangleMesh alone;
  std::vector<std::int32_t> corners;
  for (const std::int32_t v : loop) corners.push_back(alone.add_vertex(mesh.vertex(v)));
  Polygons polygon;
  polygon.add(corners);
  triangulate(polygon, alone, AddCenters::kNo);
  for (Triangle& face : alone.triangles) {
    for (std::int32_t& v : face) v = loop[static_cast<std::size_t>(v)];
  }
  return std::move(alone.triangles);
}

double area_of(const TriangleMesh& mesh, const std::vector<Triangle>& faces) {
  double area = 0.0;
  for (const Triangle& face : faces) area += area_of_face(mesh, face);
  return area;
}

double bulge_of(double area) {
  constexpr double kHemisphere = 0.376;  // volume of a hemisphere over a disc of area 1: 2 / (3 sqrt(pi))
  return kHemisphere * area * std::sqrt(area);
}

}  // namespace buoyancy
