#include "geometry/moment_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/parallel_tasks.h"

namespace buoyancy {
namespace {

struct Range {
  std::size_t begin = 0, end = 0;
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
  Vec3 center() const { return 0.5 * (min + max); }
  double width() const { return (max - min).sum(); }
};

// A triangle or a leaf that is sorted into the tree. Its float32 position decides on which side of a split it
// goes.
struct Item {
  std::array<float, 3> position;
  std::uint32_t index;
};

Item make_item(const Vec3& position, std::size_t index) {
  return {
      {static_cast<float>(position.x()), static_cast<float>(position.y()), static_cast<float>(position.z())},
      static_cast<std::uint32_t>(index)};
}

// Returns the axes in descending order of the spread of the range's items along them.
std::array<std::size_t, 3> axes_by_spread(const std::vector<Item>& items, const Range& range) {
  std::array<float, 3> low = items[range.begin].position;
  std::array<float, 3> high = low;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], items[i].position[axis]);
      high[axis] = std::max(high[axis], items[i].position[axis]);
    }
  }
  std::array<std::size_t, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(),
                   [&](std::size_t a, std::size_t b) { return high[a] - low[a] > high[b] - low[b]; });
  return axes;
}

// Orders items along an axis. The index breaks ties, so that the tree depends on the mesh alone.
auto before_along(std::size_t axis) {
  return [axis](const Item& a, const Item& b) {
    return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis] : a.index < b.index;
  };
}

std::pair<Range, Range> halves_at(const Range& range, std::size_t left) {
  return {{range.begin, range.begin + left}, {range.begin + left, range.end}};
}

// Splits the range along the axis on which its items spread most; `left` of them go to the first part.
std::pair<Range, Range> split(std::vector<Item>& items, const Range& range, std::size_t left) {
  const auto at = [&items](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(range.begin), at(range.begin + left), at(range.end),
                   before_along(axes_by_spread(items, range)[0]));
  return halves_at(range, left);
}

// Returns about half of `size`: a multiple of `unit` if that leaves neither part empty.
std::size_t left_share(std::size_t size, std::size_t unit) {
  const std::size_t left = (size / 2 + unit / 2) / unit * unit;
  return left == 0 || left >= size ? size / 2 : left;
}

// The distinct vertices of some triangles.
class LeafVertices {
 public:
  LeafVertices() { index_.fill(kNone); }

  std::size_t count() const { return count_; }
  std::int32_t operator[](std::size_t i) const { return index_[i]; }
  // Adds a vertex, unless it is among them. Returns its place, or kLeafVertices if there is no room.
  std::size_t add(std::int32_t vertex) {
    std::int32_t place_from_one = 0;  // all places are compared, since vectors do so in a few instructions
    for (std::int32_t i = 0; i < kLeafVertices; ++i) {
      place_from_one |= index_[static_cast<std::size_t>(i)] == vertex ? i + 1 : 0;
    }
    if (place_from_one > 0) return static_cast<std::size_t>(place_from_one - 1);
    if (count_ == kLeafVertices) return kLeafVertices;
    index_[count_] = vertex;
    return count_++;
  }

 private:
  static constexpr std::int32_t kNone = -1;
  std::array<std::int32_t, kLeafVertices> index_;
  std::size_t count_ = 0;
};

constexpr std::size_t kRun = std::size_t{8} * kLeafTriangles;

// Cuts the triangles into leaves.
//
// A run of kRun triangles is cut into about equal parts, as few as possible. Patches of some meshes have many
// vertices (a strip of n triangles has n + 2), so that a leaf cannot hold kLeafTriangles of them. Halving
// such a leaf would leave it half empty. Therefore the last cuts are moved, or made along another axis, until
// the vertices fit. Where that is not possible everywhere, the run is also cut into more parts, and that
// number of parts is chosen whose leaves have the least total width, which is proportional to the number of
// leaves that a random plane crosses.
class LeafCutter {
 public:
  LeafCutter(const TriangleMesh& surface, std::vector<Item>& items) : surface_(surface), items_(items) {}

  // Appends the leaves of a range in spatial order.
  void cut(const Range& range, std::vector<Range>& leaves) {
    if (range.size() > kRun) {
      const auto [left, right] = split(items_, range, left_share(range.size(), kRun));
      cut(left, leaves);
      cut(right, leaves);
      return;
    }
    double min_width = std::numeric_limits<double>::infinity();
    const std::size_t min_parts = (range.size() + kLeafTriangles - 1) / kLeafTriangles;
    const auto first = items_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto last = items_.begin() + static_cast<std::ptrdiff_t>(range.end);
    std::size_t parts = min_parts;
    while (parts <= 2 * min_parts) {
      leaves_.clear();
      width_ = 0.0;
      const bool all_fit = cut_run(range, parts);
      if (width_ < min_width) {
        min_width = width_;
        best_leaves_ = leaves_;
        best_items_.assign(first, last);
      }
      if (all_fit) break;
      // Other cuts can avoid only a few of the surplus leaves.
      parts = std::max(parts + 1, 3 * leaves_.size() / 4);
    }
    std::copy(best_items_.begin(), best_items_.end(), first);
    leaves.insert(leaves.end(), best_leaves_.begin(), best_leaves_.end());
  }

 private:
  // Cuts a range into `parts` leaves of about the same number of triangles, or into more if these have too
  // many vertices. Returns false if there were such.
  bool cut_run(const Range& range, std::size_t parts) {
    if (parts == 1) {
      if (add_leaf(range)) return true;
      cut_run(range, 2);
      return false;
    }
    if (parts == 2) {
      if (cut_in_two(range)) return true;
      cut_run(range, 3);
      return false;
    }
    if (parts == 3 && cut_in_three(range)) return true;
    const std::size_t left_parts = parts / 2;
    // The left part gets leaves of `size` triangles, as far as each of the right parts keeps one triangle.
    const std::size_t size = (range.size() + parts - 1) / parts;
    const std::size_t left = std::min(left_parts * size, range.size() - (parts - left_parts));
    const auto [first, second] = split(items_, range, left);
    const bool first_fits = cut_run(first, left_parts);
    return cut_run(second, parts - left_parts) && first_fits;
  }

  // Cuts a range into two leaves, as near its middle as their vertices allow. Returns false if that is not
  // possible along any axis.
  bool cut_in_two(const Range& range) {
    const auto first = items_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto last = items_.begin() + static_cast<std::ptrdiff_t>(range.end);
    for (const std::size_t axis : axes_by_spread(items_, range)) {
      std::sort(first, last, before_along(axis));
      const std::size_t max_left = count_that_fit(first, last);
      const std::size_t max_right =
          count_that_fit(std::make_reverse_iterator(last), std::make_reverse_iterator(first));
      if (max_left + max_right < range.size()) continue;
      const std::size_t left = std::clamp(range.size() / 2, range.size() - max_right, max_left);
      const auto [one, other] = halves_at(range, left);
      return add_leaf(one) && add_leaf(other);
    }
    return false;
  }

  // Cuts a range into three leaves, of about the same size as far as their vertices allow. Returns false if
  // that is not possible along any axis.
  bool cut_in_three(const Range& range) {
    const auto first = items_.begin() + static_cast<std::ptrdiff_t>(range.begin);
    const auto last = items_.begin() + static_cast<std::ptrdiff_t>(range.end);
    for (const std::size_t axis : axes_by_spread(items_, range)) {
      std::sort(first, last, before_along(axis));
      const std::size_t left = std::min((range.size() + 2) / 3, count_that_fit(first, last));
      const auto [one, others] = halves_at(range, left);
      if (cut_in_two(others)) return add_leaf(one);
    }
    return false;
  }

  // Returns how many of the items from the first on fit into one leaf.
  template <typename Iterator>
  std::size_t count_that_fit(Iterator first, Iterator last) const {
    LeafVertices vertices;
    const auto max = std::min<std::ptrdiff_t>(last - first, kLeafTriangles);
    for (std::ptrdiff_t i = 0; i < max; ++i) {
      for (const std::int32_t vertex : surface_.triangles[first[i].index]) {
        if (vertices.add(vertex) == kLeafVertices) return static_cast<std::size_t>(i);
      }
    }
    return static_cast<std::size_t>(max);
  }

  // Returns false, without adding it, if the leaf is too large.
  bool add_leaf(const Range& range) {
    if (range.size() > kLeafTriangles) return false;
    LeafVertices vertices;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (const std::int32_t vertex : surface_.triangles[items_[i].index]) {
        if (vertices.add(vertex) == kLeafVertices) return false;
      }
    }
    Bounds bounds;
    for (std::size_t v = 0; v < vertices.count(); ++v) bounds.include(surface_.vertex(vertices[v]));
    width_ += bounds.width();
    leaves_.push_back(range);
    return true;
  }

  const TriangleMesh& surface_;
  std::vector<Item>& items_;
  // Of the current run: the latest attempt, and the best one.
  std::vector<Range> leaves_, best_leaves_;
  std::vector<Item> best_items_;
  double width_ = 0.0;  // [m], total of leaves_
};

AxisMoments of_axis(const SurfaceMoments<double>& moments, int a) {
  AxisMoments result;
  result.S = moments.S(a);
  for (int i = 0; i < 3; ++i) result.N[static_cast<std::size_t>(i)] = moments.N(i, a);
  for (int pair = 0; pair < 6; ++pair) result.P[static_cast<std::size_t>(pair)] = moments.P(pair, a);
  return result;
}

// Returns the upper half of a float32 that is at least x; infinity if x exceeds the range. Requires x >= 0.
std::uint16_t upper_half_rounded_up(double x) {
  const float above = std::nextafter(static_cast<float>(x), std::numeric_limits<float>::infinity());
  return static_cast<std::uint16_t>((std::bit_cast<std::uint32_t>(above) + 0xFFFFU) >> 16U);
}

// Returns the exponent e of the least power of two above x: x < 2^e.
int exponent_above(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return exponent;
}

class Builder {
 public:
  Builder(const TriangleMesh& surface, const Vec3& file_origin)
      : surface_(surface),
        file_origin_(file_origin),
        threads_(surface.triangles.size() < kMinParallel ? 1 : max_parallel_tasks()) {}

  MomentTree build() {
    sort_triangles();
    set_units();
    cut_leaves();
    build_nodes();
    fill_leaves();
    fill_nodes();
    return std::move(tree_);
  }

 private:
  static constexpr std::size_t kMinParallel = 20'000;  // triangles; fewer take less than a few ms
  static constexpr std::size_t kTask = 12'000;         // triangles
  static constexpr std::size_t kLeavesPerTask = 256;

  // The sums and bounds of a child, from which those of its parent follow.
  struct Subtree {
    Bounds bounds;
    SurfaceMoments<double> moments;
    double area = 0.0;                   // [m^2]
    Vec3 projected_area = Vec3::Zero();  // int |n_a| dA [m^2]

    Subtree& operator+=(const Subtree& other) {
      bounds.include(other.bounds);
      moments += other.moments;
      area += other.area;
      projected_area += other.projected_area;
      return *this;
    }
  };

  void sort_triangles() {
    items_.resize(surface_.triangles.size());
    run_parallel_ranges(items_.size(), [this](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        const Triangle& triangle = surface_.triangles[t];
        items_[t] = make_item(
            surface_.vertex(triangle[0]) + surface_.vertex(triangle[1]) + surface_.vertex(triangle[2]), t);
      }
    });
  }

  void set_units() {
    const BoundingBox box = bounding_box(surface_);
    const double reach = box.min_B.cwiseAbs().cwiseMax(box.max_B.cwiseAbs()).maxCoeff();
    // The powers are at least the smallest normal number, so that divisions by them do not overflow.
    const auto power_of_two = [](int exponent) {
      return std::ldexp(1.0, std::max(exponent, std::numeric_limits<double>::min_exponent - 1));
    };
    const int exponent = exponent_above(reach);
    tree_.grid = power_of_two(exponent - 22);
    tree_.unit = power_of_two(exponent - 15);
  }

  void cut_leaves() {
    std::vector<Range> tasks{{0, items_.size()}};
    while (std::ranges::any_of(tasks, [](const Range& range) { return range.size() > kTask; })) {
      std::vector<Range> halves(2 * tasks.size());
      run_parallel_tasks(tasks.size(), threads_, [&](std::size_t task) {
        const Range& range = tasks[task];
        const auto [left, right] = range.size() > kTask ? split(items_, range, left_share(range.size(), kRun))
                                                        : halves_at(range, range.size());
        halves[2 * task] = left;
        halves[2 * task + 1] = right;
      });
      std::erase_if(halves, [](const Range& range) { return range.size() == 0; });
      tasks = std::move(halves);
    }
    std::vector<std::vector<Range>> leaves(tasks.size());
    run_parallel_tasks(tasks.size(), threads_, [&](std::size_t task) {
      LeafCutter(surface_, items_).cut(tasks[task], leaves[task]);
    });
    for (const std::vector<Range>& some : leaves) leaves_.insert(leaves_.end(), some.begin(), some.end());
  }

  // Builds a full tree over the leaves. The children of a node are numbered before their own children.
  void build_nodes() {
    std::vector<Item> order;
    order.reserve(leaves_.size());
    for (std::size_t leaf = 0; leaf < leaves_.size(); ++leaf) {
      Vec3 sum = Vec3::Zero();
      for (std::size_t i = leaves_[leaf].begin; i < leaves_[leaf].end; ++i) {
        sum += Vec3(items_[i].position[0], items_[i].position[1], items_[i].position[2]);
      }
      order.push_back(make_item(sum / static_cast<double>(leaves_[leaf].size()), leaf));
    }
    leaf_places_.reserve(leaves_.size());
    tree_.nodes.reserve(leaves_.size() / (kTreeWidth - 1) + 1);
    tree_.nodes.emplace_back();
    parents_.push_back(0);
    build_node(0, order, {0, order.size()}, 1);
  }

  // Splits the range into a node's children, each as large as a full subtree, so that the few nodes near the
  // root have unused slots and not the many nodes above the leaves.
  static std::vector<Range> children_of(std::vector<Item>& order, const Range& range) {
    std::size_t full = 1;
    while (full * kTreeWidth < range.size()) full *= kTreeWidth;
    std::vector<Range> ranges{range};
    for (std::size_t i = 0; i < ranges.size();) {
      if (ranges[i].size() > full && ranges.size() < kTreeWidth) {
        const auto [left, right] = split(order, ranges[i], left_share(ranges[i].size(), full));
        ranges[i] = left;
        ranges.insert(ranges.begin() + static_cast<std::ptrdiff_t>(i) + 1, right);
      } else {
        ++i;
      }
    }
    std::stable_partition(ranges.begin(), ranges.end(), [](const Range& part) { return part.size() > 1; });
    return ranges;
  }

  // Descents reserve room for kMaxTreeLevels and do not check again.
  void build_node(std::size_t index, std::vector<Item>& order, const Range& range, std::size_t level) {
    if (level > kMaxTreeLevels) throw std::length_error("a moment tree has more levels than descents allow");
    const std::vector<Range> ranges = children_of(order, range);
    TreeNode node{};
    node.first_node = static_cast<std::uint32_t>(tree_.nodes.size());
    node.first_leaf = static_cast<std::uint32_t>(leaf_places_.size());
    node.first_moments = static_cast<std::uint32_t>(num_children_);
    node.children = static_cast<std::uint8_t>(ranges.size());
    for (const Range& part : ranges) {
      const auto place = static_cast<std::uint32_t>(num_children_++);
      if (part.size() > 1) {
        ++node.inner_nodes;
        tree_.nodes.emplace_back();
        parents_.push_back(place);
      } else {
        leaf_places_.push_back({order[part.begin].index, place});
      }
    }
    tree_.nodes[index] = node;
    for (std::size_t i = 0; i < node.inner_nodes; ++i)
      build_node(node.first_node + i, order, ranges[i], level + 1);
  }

  void fill_leaves() {
    subtrees_.resize(num_children_);
    if (fill_leaves(tree_.leaves)) return;
    tree_.leaves = {};
    fill_leaves(tree_.double_leaves);
  }

  // Returns false if a vertex is not exact.
  template <typename Real>
  bool fill_leaves(LargePageArray<TreeLeaf<Real>>& leaves) {
    leaves.resize(leaf_places_.size());
    std::atomic<bool> exact{true};
    const std::size_t tasks = (leaves.size() + kLeavesPerTask - 1) / kLeavesPerTask;
    run_parallel_tasks(tasks, threads_, [&](std::size_t task) {
      const std::size_t end = std::min(leaves.size(), (task + 1) * kLeavesPerTask);
      for (std::size_t i = task * kLeavesPerTask; i < end && exact; ++i) {
        if (!fill_leaf(leaf_places_[i], leaves[i])) exact = false;
      }
    });
    for (const TreeLeaf<Real>& leaf : leaves)
      tree_.rounding += exact ? static_cast<double>(leaf.rounding) : 0.0;
    return exact;
  }

  struct LeafPlace {
    std::uint32_t range;  // index into leaves_
    std::uint32_t child;  // number of the child, over all nodes
  };

  template <typename Real>
  bool fill_leaf(const LeafPlace& place, TreeLeaf<Real>& leaf) {
    const Range& range = leaves_[place.range];
    LeafVertices vertices;
    leaf.corners = {};
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Triangle& triangle = surface_.triangles[items_[i].index];
      std::size_t word = 0;
      for (std::size_t corner = 0; corner < 3; ++corner) {
        word |= vertices.add(triangle[corner]) << (corner * LeafCorners::kBits);
      }
      leaf.corners[i - range.begin].word = static_cast<std::uint16_t>(word);
    }
    Subtree& subtree = subtrees_[place.child];
    subtree = {};
    for (std::size_t v = 0; v < vertices.count(); ++v) {
      subtree.bounds.include(surface_.vertex(vertices[v]));
    }
    leaf.moments = place.child;
    leaf.vertices = static_cast<std::uint8_t>(vertices.count());
    leaf.triangles = static_cast<std::uint8_t>(range.size());
    const Vec3 center = subtree.bounds.center();
    for (int axis = 0; axis < 3; ++axis) {
      if (place_vertices(axis, vertices, center[axis], leaf)) continue;
      if (place_vertices(axis, vertices, file_origin_[axis], leaf)) continue;
      return false;
    }

    double rounding = 0.0;  // [m^3]
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Triangle& triangle = surface_.triangles[items_[i].index];
      const auto moments = moments_of_triangle<double>(
          surface_.vertex(triangle[0]), surface_.vertex(triangle[1]), surface_.vertex(triangle[2]));
      subtree.moments += moments;
      subtree.area += moments.S.norm();
      subtree.projected_area += moments.S.cwiseAbs();
      rounding += edges_cubed(triangle);
    }
    leaf.rounding = static_cast<float>(0.5 * rounding);
    return true;
  }

  // Sets one coordinate of the leaf's centre, near `middle`, and of its vertices. Returns false if a vertex
  // is not exact.
  //
  // Float32 coordinates about the middle of the leaf are float32 numbers if they differ by less than a factor
  // of three: then all of them are multiples of a unit that is small enough. If they do not, the leaf is not
  // small in comparison with its distance from the file's origin, and that origin serves as its centre.
  template <typename Real>
  bool place_vertices(int axis, const LeafVertices& vertices, double middle, TreeLeaf<Real>& leaf) const {
    const auto n = static_cast<std::size_t>(axis);
    const double steps = std::nearbyint(middle / tree_.grid);
    if (!(std::abs(steps) <= 0x1p23)) return false;
    leaf.center[n] = static_cast<std::int32_t>(steps);
    for (std::size_t i = 0; i < kLeafVertices; ++i) {
      const double at = surface_.vertex(vertices[i < vertices.count() ? i : 0])[axis] - steps * tree_.grid;
      leaf.y[n][i] = static_cast<Real>(at);
      if (static_cast<double>(leaf.y[n][i]) != at) return false;
    }
    return true;
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

  // Goes from the last node to the root, since a node's number is greater than its parent's.
  void fill_nodes() {
    for (auto& moments : tree_.moments) moments.resize(num_children_);
    tree_.areas.resize(num_children_);
    tree_.projected_areas.resize(tree_.nodes.size());
    for (std::size_t n = tree_.nodes.size(); n-- > 0;) {
      TreeNode& node = tree_.nodes[n];
      Subtree sum;
      for (std::size_t i = 0; i < node.children; ++i) {
        const std::size_t child = node.first_moments + i;
        const Subtree& subtree = subtrees_[child];
        sum += subtree;
        set_bounds(node, i, subtree.bounds);
        for (std::size_t a = 0; a < 3; ++a) {
          const auto axis = static_cast<int>(a);
          tree_.moments[a][child] = of_axis(subtree.moments, axis);
          tree_.projected_areas[n].values[a][i] = upper_half_rounded_up(subtree.projected_area[axis]);
        }
        tree_.areas[child] = subtree.area;
      }
      if (n > 0) {
        subtrees_[parents_[n]] = sum;
      } else {
        tree_.total = sum.moments;
      }
    }
  }

  // Divisions and products are exact, because the unit is a power of two.
  void set_bounds(TreeNode& node, std::size_t i, const Bounds& bounds) {
    for (std::size_t a = 0; a < 3; ++a) {
      const auto axis = static_cast<int>(a);
      const auto low = static_cast<std::int32_t>(std::floor(bounds.min[axis] / tree_.unit));
      const auto high = static_cast<std::int32_t>(std::ceil(bounds.max[axis] / tree_.unit));
      const std::int32_t center = (low + high) >> 1;
      const std::int32_t half = std::max(high - center, center - low);
      node.center[a][i] = static_cast<std::int16_t>(center);
      node.half[a][i] = static_cast<std::uint16_t>(half);
      tree_.reach = std::max(tree_.reach, tree_.unit * (std::abs(center) + half));
    }
  }

  const TriangleMesh& surface_;
  Vec3 file_origin_;
  std::size_t threads_;
  MomentTree tree_;
  std::vector<Item> items_;             // triangles
  std::vector<Range> leaves_;           // of items_
  std::vector<LeafPlace> leaf_places_;  // by index into MomentTree::leaves
  std::vector<std::uint32_t> parents_;  // of each node but the root: the number of the child that it is
  std::size_t num_children_ = 0;        // of all nodes
  std::vector<Subtree> subtrees_;       // of each child
};

template <typename T>
std::size_t bytes_of(const LargePageArray<T>& array) {
  return array.size() * sizeof(T);
}

}  // namespace

SurfaceMoments<double> MomentTree::moments_of(std::size_t i) const {
  SurfaceMoments<double> result;
  for (int a = 0; a < 3; ++a) {
    const AxisMoments& from = moments[static_cast<std::size_t>(a)][i];
    result.S(a) = from.S;
    for (int j = 0; j < 3; ++j) result.N(j, a) = from.N[static_cast<std::size_t>(j)];
    for (int pair = 0; pair < 6; ++pair) result.P(pair, a) = from.P[static_cast<std::size_t>(pair)];
  }
  return result;
}

std::size_t MomentTree::bytes() const {
  std::size_t sum = bytes_of(nodes) + bytes_of(projected_areas) + bytes_of(leaves) + bytes_of(double_leaves) +
                    bytes_of(areas);
  for (const auto& of_axis : moments) sum += bytes_of(of_axis);
  return sum;
}

MomentTree build_moment_tree(const TriangleMesh& surface, const Vec3& file_origin) {
  return Builder(surface, file_origin).build();
}

}  // namespace buoyancy
