#include "geometry/common_volume.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kNegligible = 1e-12;  // of a box's volume and sides: meshes touch, with rounding

BoundingBox box_of(const OffsetMesh& mesh) {
  BoundingBox box = bounding_box(*mesh.mesh);
  box.min_B += mesh.offset_B;
  box.max_B += mesh.offset_B;
  return box;
}

BoundingBox common_box(const BoundingBox& a, const BoundingBox& b) {
  return {a.min_B.cwiseMax(b.min_B), a.max_B.cwiseMin(b.max_B)};
}

// The point at which a surface crosses the axis of a column.
struct Crossing {
  std::uint32_t column = 0;
  double height = 0.0;                // [m], along the axis
  std::int8_t first = 0, second = 0;  // change of either mesh's winding number there
};

// Returns the sides of the columns in one direction: `count` of equal width, divided at the meshes' vertices
// if these have at most `count` different coordinates, so that faces along the axes lie between columns.
std::vector<double> places_between(double low, double high, int count, std::span<const OffsetMesh> meshes,
                                   Eigen::Index axis) {
  std::vector<double> places;
  for (int i = 0; i <= count; ++i) places.push_back(low + (high - low) * i / count);
  std::vector<double> coordinates;
  for (const OffsetMesh& mesh : meshes) {
    for (std::size_t i = 0; i < mesh.mesh->vertex_count(); ++i) {
      coordinates.push_back(mesh.mesh->vertex(static_cast<std::int32_t>(i))[axis] + mesh.offset_B[axis]);
    }
    std::sort(coordinates.begin(), coordinates.end());
    coordinates.erase(std::unique(coordinates.begin(), coordinates.end()), coordinates.end());
    if (coordinates.size() > static_cast<std::size_t>(count)) return places;
  }
  std::copy_if(coordinates.begin(), coordinates.end(), std::back_inserter(places),
               [&](double place) { return place > low && place < high; });
  std::sort(places.begin(), places.end());
  return places;
}

// The columns over a box, and where surfaces cross their axes.
class Columns {
 public:
  Columns(const BoundingBox& box, std::span<const OffsetMesh> meshes, const ColumnLayout& layout)
      : along_(layout.along),
        across_{(along_ + 1) % 3, (along_ + 2) % 3},
        bottom_(box.min_B[along_]),
        top_(box.max_B[along_]),
        reach_(std::max(box.min_B.cwiseAbs().maxCoeff(), box.max_B.cwiseAbs().maxCoeff())) {
    for (std::size_t i = 0; i < 2; ++i) {
      places_[i] =
          places_between(box.min_B[across_[i]], box.max_B[across_[i]], layout.count, meshes, across_[i]);
      for (std::size_t column = 0; column + 1 < places_[i].size(); ++column) {
        axes_[i].push_back(places_[i][column] +
                           layout.axis_at[i] * (places_[i][column + 1] - places_[i][column]));
      }
    }
  }

  // [m^2]
  double area_of(std::uint32_t column) const {
    const auto width = [&](std::size_t i, std::size_t n) { return places_[i][n + 1] - places_[i][n]; };
    return width(0, column % axes_[0].size()) * width(1, column / axes_[0].size());
  }

  // Adds the crossings of a surface.
  void add(const OffsetMesh& mesh, bool is_first) {
    for (const Triangle& triangle : mesh.mesh->triangles) {
      std::array<Vec3, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = mesh.mesh->vertex(triangle[i]) + mesh.offset_B;
      add_triangle(corners, is_first);
    }
  }

  std::vector<Crossing>& crossings() { return crossings_; }
  double rounding() const { return rounding_; }  // [m^3], bound for all crossings together

 private:
  using Point2 = Eigen::Vector2d;

  Point2 across(const Vec3& point) const { return {point[across_[0]], point[across_[1]]}; }
  // Returns the columns whose axes lie between two coordinates: the first one, and the one after the last.
  std::array<std::size_t, 2> range(std::size_t direction, double low, double high) const {
    const std::vector<double>& axes = axes_[direction];
    const auto first = std::lower_bound(axes.begin(), axes.end(), low);
    const auto last = std::upper_bound(first, axes.end(), high);
    return {static_cast<std::size_t>(first - axes.begin()), static_cast<std::size_t>(last - axes.begin())};
  }

  // Returns whether the point is on the left of the directed edge. The reversed edge gives the opposite, so
  // that a closed surface has no gaps.
  static bool is_left(const Point2& from, const Point2& to, const Point2& point) {
    const bool is_swapped = to.x() < from.x() || (to.x() == from.x() && to.y() < from.y());
    const Point2& a = is_swapped ? to : from;
    const Point2& b = is_swapped ? from : to;
    const double side = (b.x() - a.x()) * (point.y() - a.y()) - (b.y() - a.y()) * (point.x() - a.x());
    return (side >= 0.0) != is_swapped;
  }

  void add_triangle(const std::array<Vec3, 3>& corners, bool is_first) {
    const Point2 a = across(corners[0]);
    const Point2 b = across(corners[1]);
    const Point2 c = across(corners[2]);
    const double twice_area = (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
    const std::array<std::size_t, 2> rows =
        range(1, std::min({a.y(), b.y(), c.y()}), std::max({a.y(), b.y(), c.y()}));
    const std::array<std::size_t, 2> columns =
        range(0, std::min({a.x(), b.x(), c.x()}), std::max({a.x(), b.x(), c.x()}));
    if (rows[0] == rows[1] || columns[0] == columns[1]) return;
    const double rounding = rounding_of_heights(corners, {a, b, c}, twice_area);
    for (std::size_t row = rows[0]; row < rows[1]; ++row) {
      for (std::size_t column = columns[0]; column < columns[1]; ++column) {
        const Point2 point(axes_[0][column], axes_[1][row]);
        const bool left = is_left(a, b, point);
        if (is_left(b, c, point) != left || is_left(c, a, point) != left) continue;
        // Upward, the axis enters the solid where the normal points down: the triangle is clockwise there.
        const auto change = static_cast<std::int8_t>(left ? -1 : 1);
        const auto index = static_cast<std::uint32_t>(row * axes_[0].size() + column);
        crossings_.push_back({index,
                              std::clamp(height_at(corners, {a, b, c}, twice_area, point), bottom_, top_),
                              is_first ? change : std::int8_t{0}, is_first ? std::int8_t{0} : change});
        rounding_ += rounding * area_of(index);
      }
    }
  }

  // Returns a bound on the error of height_at() [m]: the error of the weights, which are products of
  // differences of coordinates, times the differences of height, plus the rounding of the result.
  double rounding_of_heights(const std::array<Vec3, 3>& corners, const std::array<Point2, 3>& at,
                             double twice_area) const {
    double size = 0.0;
    double rise = 0.0;
    double reach = reach_;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t next = (i + 1) % 3;
      size = std::max(size, (at[next] - at[i]).cwiseAbs().maxCoeff());
      rise = std::max(rise, std::abs(corners[next][along_] - corners[i][along_]));
      reach = std::max(reach, corners[i].cwiseAbs().maxCoeff());
    }
    const double of_weights = 32.0 * kEpsilon * reach * size;
    const double share = of_weights < std::abs(twice_area) ? of_weights / std::abs(twice_area) : 1.0;
    return share * rise + 8.0 * kEpsilon * reach;
  }

  double height_at(const std::array<Vec3, 3>& corners, const std::array<Point2, 3>& at, double twice_area,
                   const Point2& point) const {
    const double bottom = std::min({corners[0][along_], corners[1][along_], corners[2][along_]});
    const double top = std::max({corners[0][along_], corners[1][along_], corners[2][along_]});
    if (twice_area == 0.0) return bottom;
    const auto weight = [&](std::size_t i, std::size_t j) {
      return (at[i].x() - point.x()) * (at[j].y() - point.y()) -
             (at[i].y() - point.y()) * (at[j].x() - point.x());
    };
    const double height = (weight(1, 2) * corners[0][along_] + weight(2, 0) * corners[1][along_] +
                           weight(0, 1) * corners[2][along_]) /
                          twice_area;
    return std::clamp(height, bottom, top);
  }

  Eigen::Index along_;
  std::array<Eigen::Index, 2> across_;
  double bottom_, top_;                        // [m], of the box, along the columns
  double reach_;                               // [m], the largest coordinate of the box
  double rounding_ = 0.0;                      // [m^3]
  std::array<std::vector<double>, 2> places_;  // [m], the sides of the columns
  std::array<std::vector<double>, 2> axes_;    // [m]
  std::vector<Crossing> crossings_;
};

// Integrates counts(winding number of the first mesh, that of the second) over the box [m^3].
template <typename Counts>
ColumnSum volume_where(const BoundingBox& box, const OffsetMesh& first, const OffsetMesh& second,
                       const ColumnLayout& layout, const Counts& counts) {
  if (!((box.max_B - box.min_B).minCoeff() > 0.0)) return {};
  const std::array<OffsetMesh, 2> meshes{first, second};
  Columns columns(box, meshes, layout);
  columns.add(first, true);
  columns.add(second, false);
  std::vector<Crossing>& crossings = columns.crossings();
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.column != b.column ? a.column < b.column : a.height < b.height;
  });
  double volume = 0.0;
  int first_winding = 0;
  int second_winding = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    first_winding += crossings[i].first;
    second_winding += crossings[i].second;
    if (crossings[i + 1].column != crossings[i].column) {
      first_winding = 0;
      second_winding = 0;
      continue;
    }
    const int times = counts(first_winding, second_winding);
    if (times == 0) continue;
    volume += times * columns.area_of(crossings[i].column) * (crossings[i + 1].height - crossings[i].height);
  }
  return {volume, columns.rounding()};
}

ColumnLayout along_longest_side(const BoundingBox& box) {
  ColumnLayout layout;
  (box.max_B - box.min_B).maxCoeff(&layout.along);
  return layout;
}

double volume_of(const BoundingBox& box) {
  return (box.max_B - box.min_B).prod();
}

// Returns whether a surface goes through the inside of a box; may return true where it only comes near.
bool enters(const OffsetMesh& mesh, const BoundingBox& box) {
  const Vec3 center = 0.5 * (box.min_B + box.max_B);
  const Vec3 half = 0.5 * (1.0 - kNegligible) * (box.max_B - box.min_B);
  return std::ranges::any_of(mesh.mesh->triangles, [&](const Triangle& triangle) {
    const Vec3 a = mesh.mesh->vertex(triangle[0]) + mesh.offset_B - center;
    const Vec3 b = mesh.mesh->vertex(triangle[1]) + mesh.offset_B - center;
    const Vec3 c = mesh.mesh->vertex(triangle[2]) + mesh.offset_B - center;
    if ((a.cwiseMin(b).cwiseMin(c).array() >= half.array()).any()) return false;
    if ((a.cwiseMax(b).cwiseMax(c).array() <= -half.array()).any()) return false;
    const Vec3 normal = (b - a).cross(c - a);
    return std::abs(normal.dot(a)) < normal.cwiseAbs().dot(half);
  });
}

// Returns whether a box lies inside a surface, for which the surface may touch it.
bool encloses(const OffsetMesh& outer, const BoundingBox& box) {
  if (enters(outer, box)) return false;
  ColumnLayout one = along_longest_side(box);
  one.count = 1;
  Columns column(box, {}, one);
  column.add(outer, true);
  const double middle = 0.5 * (box.min_B[one.along] + box.max_B[one.along]);
  int winding = 0;
  for (const Crossing& crossing : column.crossings()) {
    if (crossing.height < middle) winding += crossing.first;
  }
  return winding > 0;
}

}  // namespace

double common_volume(const OffsetMesh& a, const OffsetMesh& b) {
  const BoundingBox box_a = box_of(a);
  const BoundingBox box_b = box_of(b);
  const BoundingBox box = common_box(box_a, box_b);
  if (volume_of(box) <= kNegligible * std::min(volume_of(box_a), volume_of(box_b))) return 0.0;
  return volume_where(box, a, b, along_longest_side(box),
                      [](int in_a, int in_b) { return in_a > 0 && in_b > 0; })
      .volume;
}

double volume_outside(const OffsetMesh& inner, const OffsetMesh& outer) {
  const BoundingBox box = box_of(inner);
  if (encloses(outer, box)) return 0.0;
  return volume_where(box, inner, outer, along_longest_side(box),
                      [](int in_inner, int in_outer) { return in_inner > 0 && in_outer <= 0; })
      .volume;
}

std::optional<double> overlap_volume(const TriangleMesh& mesh) {
  const TriangleMesh none;
  const OffsetMesh only{&mesh, Vec3::Zero()};
  const BoundingBox box = box_of(only);
  const ColumnLayout layout = along_longest_side(box);
  // The surface's crossings per column on average, which the memory for them is proportional to.
  constexpr double kMaxCrossings = 32.0;
  const Vec3 sides = box.max_B - box.min_B;
  double crossed_area = 0.0;
  for (const Triangle& face : mesh.triangles) {
    const Vec3 a = mesh.vertex(face[0]);
    const Vec3 normal = 0.5 * (mesh.vertex(face[1]) - a).cross(mesh.vertex(face[2]) - a);
    crossed_area += std::abs(normal[layout.along]);
  }
  if (!(crossed_area <= kMaxCrossings * sides.prod() / sides[layout.along])) return std::nullopt;
  return volume_where(box, only, {&none, Vec3::Zero()}, layout,
                      [](int winding, int) { return std::max(winding - 1, 0); })
      .volume;
}

ColumnSum volume_inside_one(const OffsetMesh& a, const OffsetMesh& b, const BoundingBox& box,
                            const ColumnLayout& layout) {
  return volume_where(box, a, b, layout, [](int in_a, int in_b) { return (in_a > 0) != (in_b > 0); });
}

}  // namespace buoyancy
