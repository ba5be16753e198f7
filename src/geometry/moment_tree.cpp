#include "geometry/moment_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace buoyancy {
namespace {

// A triangle during the build. The float32 sum of its corners decides on which side of a split it goes.
struct Item {
  std::array<float, 3> corner_sum;
  std::int32_t triangle;
};

struct Range {
  std::size_t begin, end;
  std::size_t size() const { return end - begin; }
};

struct Bounds {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = -min;

  void include(const Vec3& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void include(const Bounds& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
};

// The result of building a subtree, for its parent.
struct Subtree {
  std::uint32_t child = 0;
  Bounds bounds;
  NodeMoments moments;
  Vec3 projected_area = Vec3::Zero();  // int |n_a| dA [m^2]
};

NodeMoments pack(const SurfaceMoments<double>& moments, double area) {
  NodeMoments node;
  for (int a = 0; a < 3; ++a) {
    std::size_t n = 0;
    const auto put = [&](double value) {
      node.values[NodeMoments::slot(static_cast<std::size_t>(a), n++)] = value;
    };
    put(moments.S(a));
    for (int i = 0; i < 3; ++i) put(moments.N(i, a));
    for (int pair = 0; pair < 6; ++pair) put(moments.P(pair, a));
  }
  node.values[NodeMoments::kArea] = area;
  return node;
}

// Returns the upper half of a float32 that is at least x; infinity if x exceeds the range. Requires x >= 0.
std::uint16_t upper_half_rounded_up(double x) {
  const float above = std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(above) + 0xFFFFU) >> 16U);
}

class Builder {
 public:
  explicit Builder(const TriangleMesh& surface) : surface_(surface) {
    items_.reserve(surface.triangles.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const Triangle& triangle = surface.triangles[t];
      const Vec3 sum =
          surface.vertex(triangle[0]) + surface.vertex(triangle[1]) + surface.vertex(triangle[2]);
      items_.push_back(
          {{static_cast<float>(sum.x()), static_cast<float>(sum.y()), static_cast<float>(sum.z())},
           static_cast<std::int32_t>(t)});
    }
    Bounds bounds;
    for (const Triangle& triangle : surface.triangles) {
      for (const std::int32_t vertex : triangle) bounds.include(surface.vertex(vertex));
    }
    int exponent = 0;
    std::frexp(bounds.min.cwiseAbs().cwiseMax(bounds.max.cwiseAbs()).maxCoeff(), &exponent);
    tree_.grid = std::ldexp(1.0, exponent - 22);
    const std::size_t leaves = surface.triangles.size() / (kLeafTriangles / 2) + 1;
    tree_.leaves.reserve(leaves);
    tree_.moments.reserve(leaves + leaves / 4);
    tree_.nodes.reserve(leaves / 4 + 1);
  }

  MomentTree build() {
    const Subtree root = build_node({0, items_.size()});
    tree_.total = root.moments;
    return std::move(tree_);
  }

 private:
  // Collects the distinct vertices of the range's triangles; returns false if a leaf cannot hold them.
  bool leaf_vertices(const Range& range, std::array<std::int32_t, kLeafVertices>& vertices,
                     std::size_t& count) const {
    count = 0;
    if (range.size() > kLeafTriangles) return false;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (const std::int32_t vertex : surface_.triangles[static_cast<std::size_t>(items_[i].triangle)]) {
        const auto last = vertices.begin() + static_cast<std::ptrdiff_t>(count);
        if (std::find(vertices.begin(), last, vertex) != last) continue;
        if (count == kLeafVertices) return false;
        vertices[count++] = vertex;
      }
    }
    return true;
  }

  bool fits_a_leaf(const Range& range) const {
    std::array<std::int32_t, kLeafVertices> vertices;
    std::size_t count = 0;
    return leaf_vertices(range, vertices, count);
  }

  // Returns the size in triangles of the largest full subtree below `size`, at least that of a leaf.
  static std::size_t full_subtree(std::size_t size) {
    std::size_t full = kLeafTriangles;
    while (full * kTreeWidth < size) full *= kTreeWidth;
    return full;
  }

  // Returns the number of triangles that go left: about half, in multiples of a full subtree.
  static std::size_t left_share(std::size_t size, std::size_t full) {
    const std::size_t left = (size / 2 + full / 2) / full * full;
    return left == 0 || left >= size ? size / 2 : left;
  }

  // Splits the range along the axis on which its triangles' centroids spread most.
  std::pair<Range, Range> split(const Range& range, std::size_t left) {
    std::array<float, 3> low = items_[range.begin].corner_sum;
    std::array<float, 3> high = low;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], items_[i].corner_sum[axis]);
        high[axis] = std::max(high[axis], items_[i].corner_sum[axis]);
      }
    }
    std::size_t axis = 0;
    for (std::size_t other = 1; other < 3; ++other) {
      if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
    }
    const auto at = [this](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(
        at(range.begin), at(range.begin + left), at(range.end), [axis](const Item& a, const Item& b) {
          // The triangle's index breaks ties, so that the tree depends on the mesh alone.
          return a.corner_sum[axis] != b.corner_sum[axis] ? a.corner_sum[axis] < b.corner_sum[axis]
                                                          : a.triangle < b.triangle;
        });
    return {{range.begin, range.begin + left}, {range.begin + left, range.end}};
  }

  // Splits the range into a node's children, each as large as a full subtree, so that the few nodes near the
  // root have unused slots and not the many nodes above the leaves. Unused slots serve to halve parts that
  // have few triangles but too many vertices for a leaf, which then need no node of their own.
  std::vector<Range> children_of(const Range& range) {
    const std::size_t full = full_subtree(range.size());
    std::vector<Range> ranges{range};
    const auto split_at = [&](std::size_t i) {
      const auto [left, right] = split(ranges[i], left_share(ranges[i].size(), full));
      ranges[i] = left;
      ranges.insert(ranges.begin() + static_cast<std::ptrdiff_t>(i) + 1, right);
    };
    for (std::size_t i = 0; i < ranges.size();) {
      if (ranges[i].size() > full && ranges.size() < kTreeWidth) {
        split_at(i);
      } else {
        ++i;
      }
    }
    for (std::size_t i = 0; i < ranges.size() && ranges.size() < kTreeWidth;) {
      if (ranges[i].size() > 1 && ranges[i].size() <= kLeafTriangles && !fits_a_leaf(ranges[i])) {
        split_at(i);
      } else {
        ++i;
      }
    }
    return ranges;
  }

  Subtree build_node(const Range& range) {
    const auto index = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.emplace_back();
    const std::vector<Range> ranges = children_of(range);
    const auto first_moments = static_cast<std::uint32_t>(tree_.moments.size());
    tree_.moments.resize(tree_.moments.size() + ranges.size());

    TreeNode node{};
    node.first_moments = first_moments;
    node.children = static_cast<std::uint32_t>(ranges.size());
    Subtree result;
    result.child = index;
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const auto moments_index = first_moments + static_cast<std::uint32_t>(i);
      const Subtree child =
          fits_a_leaf(ranges[i]) ? build_leaf(ranges[i], moments_index) : build_node(ranges[i]);
      node.child[i] = child.child;
      set_bounds(node, i, child.bounds);
      for (std::size_t a = 0; a < 3; ++a) {
        node.projected_area[a][i] = upper_half_rounded_up(child.projected_area[static_cast<int>(a)]);
      }
      tree_.moments[moments_index] = child.moments;
      result.bounds.include(child.bounds);
      result.moments += child.moments;
      result.projected_area += child.projected_area;
    }
    tree_.nodes[index] = node;
    return result;
  }

  // Sets float32 bounds that contain the double bounds despite rounding.
  void set_bounds(TreeNode& node, std::size_t i, const Bounds& bounds) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto set = [&](int axis, float& center, float& half) {
      center = static_cast<float>(0.5 * (bounds.min[axis] + bounds.max[axis]));
      const double needed = std::max(bounds.max[axis] - static_cast<double>(center),
                                     static_cast<double>(center) - bounds.min[axis]);
      half = std::nextafter(static_cast<float>(needed), kInfinity);
      tree_.reach = std::max(tree_.reach, std::nextafter(std::abs(center) + half, kInfinity));
    };
    set(0, node.center_x[i], node.half_x[i]);
    set(1, node.center_y[i], node.half_y[i]);
    set(2, node.center_z[i], node.half_z[i]);
  }

  Subtree build_leaf(Range range, std::uint32_t moments_index) {
    // The halves of a leaf are spatially coherent, so that a kernel for eight triangles can skip one half.
    if (range.size() > kLeafTriangles / 2) split(range, kLeafTriangles / 2);
    std::array<std::int32_t, kLeafVertices> vertices;
    std::size_t count = 0;
    leaf_vertices(range, vertices, count);

    Subtree result;
    result.child = TreeNode::kLeafBit + static_cast<std::uint32_t>(tree_.leaves.size());
    for (std::size_t i = 0; i < count; ++i) result.bounds.include(surface_.vertex(vertices[i]));

    TreeLeaf leaf{};
    leaf.moments = moments_index;
    leaf.vertices = static_cast<std::uint8_t>(count);
    leaf.triangles = static_cast<std::uint8_t>(range.size());
    const Vec3 middle = 0.5 * (result.bounds.min + result.bounds.max);
    const Vec3 center = (middle / tree_.grid).array().round().matrix() * tree_.grid;
    leaf.center = {center.x(), center.y(), center.z()};
    for (std::size_t i = 0; i < kLeafVertices; ++i) {
      const Vec3 at = surface_.vertex(vertices[i < count ? i : 0]) - center;
      for (std::size_t axis = 0; axis < 3; ++axis) leaf.y[axis][i] = at[static_cast<int>(axis)];
    }
    SurfaceMoments<double> moments;
    double area = 0.0;
    double rounding = 0.0;  // [m^3]
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Triangle& triangle = surface_.triangles[static_cast<std::size_t>(items_[i].triangle)];
      const auto slot = i - range.begin;
      const auto local = [&](std::int32_t vertex) {
        return static_cast<std::uint8_t>(std::find(vertices.begin(), vertices.end(), vertex) -
                                         vertices.begin());
      };
      leaf.a[slot] = local(triangle[0]);
      leaf.b[slot] = local(triangle[1]);
      leaf.c[slot] = local(triangle[2]);
      leaf.corners[slot] = static_cast<std::uint16_t>(leaf.a[slot] | leaf.b[slot] << 4U | leaf.c[slot] << 8U);
      const auto of_triangle = moments_of_triangle<double>(
          surface_.vertex(triangle[0]), surface_.vertex(triangle[1]), surface_.vertex(triangle[2]));
      moments += of_triangle;
      area += of_triangle.S.norm();
      result.projected_area += of_triangle.S.cwiseAbs();
      rounding += edges_cubed(triangle);
    }
    leaf.rounding = static_cast<float>(0.5 * rounding);
    tree_.rounding += static_cast<double>(leaf.rounding);
    result.moments = pack(moments, area);
    tree_.leaves.push_back(leaf);
    return result;
  }

  // Twice the area of a cut triangle is a product of two edges, at worst the longest two, with a relative
  // error of 1.5 eps. The error of the volume is a sixth of that error times the height of the corner that is
  // cut off, at most an edge; the conversion to volume integrals divides it by k_a: 0.43 eps in all.
  double edges_cubed(const Triangle& triangle) const {
    const Vec3 a = surface_.vertex(triangle[0]);
    const Vec3 b = surface_.vertex(triangle[1]);
    const Vec3 c = surface_.vertex(triangle[2]);
    std::array<double, 3> edges{(b - a).norm(), (c - b).norm(), (a - c).norm()};
    std::sort(edges.begin(), edges.end());
    return edges[1] * edges[2] * edges[2];
  }

  const TriangleMesh& surface_;
  std::vector<Item> items_;
  MomentTree tree_;
};

}  // namespace

SurfaceMoments<double> NodeMoments::moments() const {
  SurfaceMoments<double> result;
  for (int a = 0; a < 3; ++a) {
    std::size_t n = 0;
    const auto next = [&] { return values[slot(static_cast<std::size_t>(a), n++)]; };
    result.S(a) = next();
    for (int i = 0; i < 3; ++i) result.N(i, a) = next();
    for (int pair = 0; pair < 6; ++pair) result.P(pair, a) = next();
  }
  return result;
}

MomentTree build_moment_tree(const TriangleMesh& surface) {
  return Builder(surface).build();
}

}  // namespace buoyancy
