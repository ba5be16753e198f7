#include "wave_loads/edge_division.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

namespace buoyancy {
namespace {

// A triangle turned so that its edge of the fewest parts, `base`, is opposite the first corner.
struct Rows {
  std::array<std::int32_t, 3> corners;
  // Parts of the edges from the first corner to the second, from there to the third, and back.
  std::int32_t left, base, right;

  std::int32_t count() const { return std::max(left, right); }
  // Which point of an edge of so many parts a row begins or ends at. Of two edges, one may have fewer parts
  // than there are rows: some rows then share a point.
  std::int32_t point_at(std::int32_t row, std::int32_t parts) const {
    return (2 * row * parts + count()) / (2 * count());
  }
  // Parts of the row itself.
  std::int32_t parts_at(std::int32_t row) const {
    return row == 0 ? 0 : std::max(point_at(row, base), std::int32_t{1});
  }
  // At most.
  std::size_t triangles() const {
    std::size_t sum = 0;
    for (std::int32_t row = 0; row < count(); ++row) {
      sum += static_cast<std::size_t>(parts_at(row) + parts_at(row + 1));
    }
    return sum;
  }
};

class Division {
 public:
  Division(const TriangleMesh& surface, double longest)
      : surface_(surface), longest_(longest), result_(surface) {}

  std::size_t triangles() const {
    std::size_t sum = 0;
    for (const Triangle& t : surface_.triangles) sum += rows_of(t).triangles();
    return sum;
  }

  void allow_longer_edges() { longest_ *= 1.25; }

  TriangleMesh run() {
    result_.triangles.clear();
    for (const Triangle& t : surface_.triangles) {
      const Rows rows = rows_of(t);
      if (rows.triangles() == 1) {
        result_.triangles.push_back(t);
      } else {
        add(rows);
      }
    }
    return std::move(result_);
  }

 private:
  std::int32_t parts_of(std::int32_t a, std::int32_t b) const {
    // The same from either end.
    const auto [low, high] = std::minmax(a, b);
    return std::max(static_cast<std::int32_t>(
                        std::ceil((surface_.vertex(high) - surface_.vertex(low)).norm() / longest_)),
                    std::int32_t{1});
  }

  Rows rows_of(const Triangle& t) const {
    const std::array<std::int32_t, 3> parts{parts_of(t[0], t[1]), parts_of(t[1], t[2]), parts_of(t[2], t[0])};
    const auto fewest = static_cast<std::size_t>(std::ranges::min_element(parts) - parts.begin());
    const std::size_t apex = (fewest + 2) % 3;
    return {
        {t[apex], t[(apex + 1) % 3], t[(apex + 2) % 3]}, parts[apex], parts[fewest], parts[(apex + 2) % 3]};
  }

  // The point at i / parts of the edge from a to b.
  std::int32_t on_edge(std::int32_t a, std::int32_t b, std::int32_t parts, std::int32_t i) {
    if (i == 0) return a;
    if (i == parts) return b;
    const auto [low, high] = std::minmax(a, b);
    const std::uint64_t edge = static_cast<std::uint64_t>(low) << 32U | static_cast<std::uint32_t>(high);
    const auto [first, is_new] =
        first_points_.try_emplace(edge, static_cast<std::int32_t>(result_.vertex_count()));
    for (std::int32_t n = 1; is_new && n < parts; ++n) add_between(low, high, static_cast<double>(n) / parts);
    return first->second + (a == low ? i : parts - i) - 1;
  }
  std::int32_t add_between(std::int32_t a, std::int32_t b, double share) {
    const Vec3 from = result_.vertex(a);
    result_.add_vertex(from + share * (result_.vertex(b) - from));
    return static_cast<std::int32_t>(result_.vertex_count()) - 1;
  }

  void add(const Rows& rows) {
    const auto [apex, second, third] = rows.corners;
    above_.assign(1, apex);
    for (std::int32_t row = 1; row <= rows.count(); ++row) {
      const std::int32_t parts = rows.parts_at(row);
      const std::int32_t from = on_edge(apex, second, rows.left, rows.point_at(row, rows.left));
      const std::int32_t to = on_edge(apex, third, rows.right, rows.point_at(row, rows.right));
      below_.assign(1, from);
      for (std::int32_t i = 1; i < parts; ++i) {
        below_.push_back(row == rows.count() ? on_edge(second, third, parts, i)
                                             : add_between(from, to, static_cast<double>(i) / parts));
      }
      below_.push_back(to);
      join_rows();
      above_.swap(below_);
    }
  }

  // Adds the triangles between two rows of points.
  void join_rows() {
    const std::size_t above = above_.size() - 1;
    const std::size_t below = below_.size() - 1;
    for (std::size_t i = 0, j = 0; i < above || j < below;) {
      // The next point is that of the row whose next part is less far along.
      const bool on_below = i == above || (j < below && (2 * j + 1) * above <= (2 * i + 1) * below);
      Triangle t{above_[i], below_[j], on_below ? below_[j + 1] : above_[i + 1]};
      ++(on_below ? j : i);
      // Rows that share a point have no triangle there.
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) result_.triangles.push_back(t);
    }
  }

  const TriangleMesh& surface_;
  double longest_;
  TriangleMesh result_;
  std::unordered_map<std::uint64_t, std::int32_t> first_points_;  // of the edges that have been divided
  std::vector<std::int32_t> above_, below_;
};

}  // namespace

TriangleMesh with_divided_edges(const TriangleMesh& surface, double longest, std::size_t max_triangles) {
  Division division(surface, longest);
  while (division.triangles() > max_triangles) division.allow_longer_edges();
  return division.run();
}

}  // namespace buoyancy
