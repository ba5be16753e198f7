#include "geometry/moment_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace buoyancy {
namespace {

// A triangle while the tree is built: the sum of its corners in float32 decides on which side of a split it
// goes.
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

// What a subtree tells the node above it.
struct Subtree {
  std::uint32_t child = 0;
  Bounds bounds;
  NodeMoments moments;
};

NodeMoments packed(const SurfaceMoments<double>& moments, double area) {
  NodeMoments node;
  std::size_t slot = 0;
  for (int k = 0; k < 3; ++k) node.values[slot++] = moments.S(k);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) node.values[slot++] = moments.N(i, k);
  }
  for (int pair = 0; pair < 6; ++pair) {
    for (int k = 0; k < 3; ++k) node.values[slot++] = moments.P(pair, k);
  }
  node.values[NodeMoments::kArea] = area;
  return node;
}

float with_upper_half(std::uint16_t half) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(half) << 16U);
}

std::uint16_t upper_half(double x) {
  return static_cast<std::uint16_t>(std::bit_cast<std::uint32_t>(static_cast<float>(x)) >> 16U);
}

// Of a float32 that is not less than x >= 0; infinity where there is none.
std::uint16_t upper_half_rounded_up(double x) {
  const float above = std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(above) + 0xFFFFU) >> 16U);
}

// Of n = S/A + d over a surface of area A, int |n . k| dA <= |S . k| + sqrt(A^2 - |S|^2): Cauchy's inequality
// for d, whose squares integrate to A - |S|^2/A.
void set_projected_area(TreeNode& node, std::size_t i, const NodeMoments& moments) {
  const double area = moments.area();
  const Vec3 S = moments.moments().S;
  node.area[i] = upper_half_rounded_up(area);
  node.oriented_x[i] = upper_half(S.x());
  node.oriented_y[i] = upper_half(S.y());
  node.oriented_z[i] = upper_half(S.z());
  const Vec3 stored(with_upper_half(node.oriented_x[i]), with_upper_half(node.oriented_y[i]),
                    with_upper_half(node.oriented_z[i]));
  const double spread = std::sqrt(std::max((area - S.norm()) * (area + S.norm()), 0.0));
  node.spread[i] = upper_half_rounded_up(spread + (S - stored).norm() + 1e-6 * area);
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
  // The vertices of the range's triangles, each once; false: more than a leaf holds.
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

  // The largest subtree of full leaves and full nodes that is smaller than `size` triangles.
  static std::size_t full_subtree(std::size_t size) {
    std::size_t full = kLeafTriangles;
    while (full * kTreeWidth < size) full *= kTreeWidth;
    return full;
  }

  // How many triangles of a range go left: about half, in whole full subtrees.
  static std::size_t left_share(std::size_t size, std::size_t full) {
    const std::size_t left = (size / 2 + full / 2) / full * full;
    return left == 0 || left >= size ? size / 2 : left;
  }

  // Parts the range across the longest side of its triangles' middles.
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
          // The triangle's number decides between equals: the tree then depends on the mesh alone.
          return a.corner_sum[axis] != b.corner_sum[axis] ? a.corner_sum[axis] < b.corner_sum[axis]
                                                          : a.triangle < b.triangle;
        });
    return {{range.begin, range.begin + left}, {range.begin + left, range.end}};
  }

  // The children of a node: parts as large as a full subtree, so that it is the few nodes near the root that
  // have room left and not the many above the leaves. Where there is room, parts of few triangles and too
  // many vertices for a leaf are halved here and need no node of their own.
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
      set_projected_area(node, i, child.moments);
      tree_.moments[moments_index] = child.moments;
      result.bounds.include(child.bounds);
      result.moments += child.moments;
    }
    tree_.nodes[index] = node;
    return result;
  }

  // Float32 bounds that hold what the double bounds hold, whatever was rounded.
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
    // Halves of a leaf lie together, so that a kernel that takes eight triangles at a time can pass over one
    // of them.
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
      leaf.x[i] = at.x();
      leaf.y[i] = at.y();
      leaf.z[i] = at.z();
    }
    SurfaceMoments<double> moments;
    double area = 0.0;
    double edges = 0.0;  // m: two per triangle
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
      const auto of_triangle = moments_of_triangle<double>(
          surface_.vertex(triangle[0]), surface_.vertex(triangle[1]), surface_.vertex(triangle[2]));
      moments += of_triangle;
      area += of_triangle.S.norm();
      edges += two_longest_edges(triangle);
    }
    // The heights of its vertices are within its diagonal of 0 while the water crosses it: a quarter of eps L
    // (edges) (height) in volume per triangle.
    const double height = (result.bounds.max - result.bounds.min).norm();
    leaf.rounding = static_cast<float>(0.25 * height * edges);
    tree_.rounding += static_cast<double>(leaf.rounding);
    result.moments = packed(moments, area);
    tree_.leaves.push_back(leaf);
    return result;
  }

  double two_longest_edges(const Triangle& triangle) const {
    const Vec3 a = surface_.vertex(triangle[0]);
    const Vec3 b = surface_.vertex(triangle[1]);
    const Vec3 c = surface_.vertex(triangle[2]);
    const double ab = (b - a).norm();
    const double bc = (c - b).norm();
    const double ca = (a - c).norm();
    return ab + bc + ca - std::min({ab, bc, ca});
  }

  const TriangleMesh& surface_;
  std::vector<Item> items_;
  MomentTree tree_;
};

}  // namespace

SurfaceMoments<double> NodeMoments::moments() const {
  SurfaceMoments<double> result;
  std::size_t slot = 0;
  for (int k = 0; k < 3; ++k) result.S(k) = values[slot++];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) result.N(i, k) = values[slot++];
  }
  for (int pair = 0; pair < 6; ++pair) {
    for (int k = 0; k < 3; ++k) result.P(pair, k) = values[slot++];
  }
  return result;
}

MomentTree build_moment_tree(const TriangleMesh& surface) {
  return Builder(surface).build();
}

}  // namespace buoyancy
