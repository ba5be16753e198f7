#include "wave_loads/patch_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/surface_moments.h"

namespace buoyancy {
namespace {

struct Range {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

// What is sorted into the tree.
struct Item {
  std::array<float, 3> position;
  std::uint32_t triangle;
};

float rounded_up(double x) {
  const auto nearest = static_cast<float>(x);
  return static_cast<double>(nearest) >= x ? nearest
                                           : std::nextafter(nearest, std::numeric_limits<float>::infinity());
}

// A patch's integrals.
struct Patch {
  Vec3 center = Vec3::Zero();
  double radius = 0.0, area = 0.0, mu2 = 0.0, mu3 = 0.0, nu3 = 0.0;
  SurfaceMoments<double> moments;
};

class Builder {
 public:
  explicit Builder(const TriangleMesh& surface) : surface_(surface) {
    snap_to_grid();
    const std::size_t triangles = surface.triangles.size();
    // Leaves of small meshes are small, because the surface of the water crosses most of them.
    constexpr std::size_t kFewTriangles = 10'000;
    leaf_ = triangles < kFewTriangles ? 4 : 16;
    items_.reserve(triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
      const Vec3 sum = corner(t, 0) + corner(t, 1) + corner(t, 2);
      items_.push_back(
          {{static_cast<float>(sum.x()), static_cast<float>(sum.y()), static_cast<float>(sum.z())},
           static_cast<std::uint32_t>(t)});
    }
  }

  PatchTree build() {
    tree_.blocks.emplace_back();
    add_block(0, children_of({0, items_.size()}));
    tree_.area = 0.0;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) tree_.area += area_vector(t).norm();
    tree_.displacement = 0.5 * std::sqrt(3.0) * grid_;
    return std::move(tree_);
  }

 private:
  // The spacing of the grid is such that every coordinate, and every difference of two, has 24 bits.
  void snap_to_grid() {
    double largest = 0.0;
    for (const auto* row : {&surface_.x, &surface_.y, &surface_.z}) {
      for (const double value : *row) largest = std::max(largest, std::abs(value));
    }
    grid_ = largest > 0.0 ? std::ldexp(1.0, std::ilogb(largest) + 2 - 24) : 0.0;
    if (grid_ == 0.0) return;
    for (auto* row : {&surface_.x, &surface_.y, &surface_.z}) {
      for (double& value : *row) value = on_grid(value);
    }
  }
  double on_grid(double value) const { return grid_ * std::nearbyint(value / grid_); }

  Vec3 corner(std::size_t triangle, std::size_t i) const {
    return surface_.vertex(surface_.triangles[triangle][i]);
  }
  Vec3 area_vector(std::size_t t) const {
    return 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  }

  // Up to four ranges, each as large as a full subtree, so that only the top of the tree has unused lanes.
  std::vector<Range> children_of(const Range& range) {
    std::size_t full = leaf_;
    while (full * kSiblings < range.size()) full *= kSiblings;
    std::vector<Range> ranges{range};
    for (std::size_t i = 0; i < ranges.size();) {
      if (ranges[i].size() > full && ranges.size() < kSiblings) {
        const std::size_t left = left_share(ranges[i].size(), full);
        split(ranges[i], left);
        const Range whole = ranges[i];
        ranges[i] = {whole.begin, whole.begin + left};
        ranges.insert(ranges.begin() + static_cast<std::ptrdiff_t>(i) + 1, {whole.begin + left, whole.end});
      } else {
        ++i;
      }
    }
    return ranges;
  }

  // About half of `size`, a multiple of `unit` where that splits it.
  static std::size_t left_share(std::size_t size, std::size_t unit) {
    const std::size_t left = (size / 2 + unit / 2) / unit * unit;
    return left == 0 || left >= size ? size / 2 : left;
  }

  // Sorts `left` items of the range before the others along the axis on which they spread most. The index
  // breaks ties, so that the tree depends on the mesh alone.
  void split(const Range& range, std::size_t left) {
    std::array<float, 3> low = items_[range.begin].position;
    std::array<float, 3> high = low;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], items_[i].position[axis]);
        high[axis] = std::max(high[axis], items_[i].position[axis]);
      }
    }
    std::size_t axis = 0;
    for (std::size_t other = 1; other < 3; ++other) {
      if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
    }
    const auto at = [this](std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(range.begin), at(range.begin + left), at(range.end),
                     [axis](const Item& a, const Item& b) {
                       return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis]
                                                                   : a.triangle < b.triangle;
                     });
  }

  Patch integrate(const Range& range) const {
    Patch patch;
    Vec3 weighted = Vec3::Zero();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::size_t t = items_[i].triangle;
      const double area = area_vector(t).norm();
      patch.area += area;
      weighted += area * (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
    }
    const Vec3 center =
        patch.area > 0.0 ? Vec3(weighted / patch.area) : corner(items_[range.begin].triangle, 0);
    patch.center = grid_ > 0.0 ? center.unaryExpr([this](double value) { return on_grid(value); }) : center;
    double radius_squared = 0.0;
    double mu4 = 0.0;
    ThirdMoments third = ThirdMoments::Zero();
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::size_t t = items_[i].triangle;
      const std::array<Vec3, 3> y{corner(t, 0) - patch.center, corner(t, 1) - patch.center,
                                  corner(t, 2) - patch.center};
      patch.moments += moments_of_triangle(y[0], y[1], y[2]);
      for (const Vec3& v : y) radius_squared = std::max(radius_squared, v.squaredNorm());
      const Vec3 normal = area_vector(t);
      const double area = normal.norm();
      Cubes cubes = Cubes::Zero();
      for_each_point_of_rule(y, [&](double weight, const Vec3& p) {
        const double squared = p.squaredNorm();
        patch.mu2 += area * weight * squared;
        mu4 += area * weight * squared * squared;
        cubes += weight * cubes_of(p);
      });
      third += cubes * normal.transpose();
    }
    patch.radius = std::sqrt(radius_squared);
    patch.mu3 = std::sqrt(patch.mu2 * mu4);  // Cauchy's inequality
    constexpr double kRounding = 1e-12;      // of the sums, which cancel
    patch.nu3 = third.norm() + kRounding * patch.mu3;
    return patch;
  }

  // Calls take(weight, point) for the points of Dunavant's rule of degree 4, which lie between the triangle's
  // centroid and its corners.
  template <typename Take>
  static void for_each_point_of_rule(const std::array<Vec3, 3>& y, const Take& take) {
    constexpr std::array<double, 2> kBarycentric{0.445948490915965, 0.091576213509771};
    constexpr std::array<double, 2> kWeights{0.223381589678011, 0.109951743655322};
    const Vec3 middle = (y[0] + y[1] + y[2]) / 3.0;
    for (std::size_t ring = 0; ring < 2; ++ring) {
      for (const Vec3& v : y) {
        take(kWeights[ring], Vec3(middle + (1.0 - 3.0 * kBarycentric[ring]) * (v - middle)));
      }
    }
  }

  // y_i y_j y_l for i <= j <= l, times the root of the number of their permutations: the sum of their squares
  // is that over all i, j and l.
  using Cubes = Eigen::Matrix<double, 10, 1>;
  using ThirdMoments = Eigen::Matrix<double, 10, 3>;
  static Cubes cubes_of(const Vec3& y) {
    constexpr double kRoot3 = 1.7320508075688772;
    constexpr double kRoot6 = 2.449489742783178;
    const Vec3 squares = y.cwiseProduct(y);
    Cubes cubes;
    cubes.head<3>() = squares.cwiseProduct(y);
    cubes.segment<3>(3) = kRoot3 * y.x() * Vec3(squares.y(), squares.z(), y.x() * y.y());
    cubes.segment<3>(6) = kRoot3 * Vec3(squares.x() * y.z(), squares.y() * y.z(), squares.z() * y.y());
    cubes(9) = kRoot6 * y.x() * y.y() * y.z();
    return cubes;
  }

  void add_block(std::size_t block, const std::vector<Range>& ranges) {
    std::array<Patch, kSiblings> patches;
    for (std::size_t lane = 0; lane < ranges.size(); ++lane) {
      patches[lane] = integrate(ranges[lane]);
      fill(tree_.blocks[block], lane, patches[lane]);
    }
    for (std::size_t lane = ranges.size(); lane < kSiblings; ++lane) {
      fill(tree_.blocks[block], lane, {.center = patches[0].center, .moments = {}});
    }
    tree_.blocks[block].patches = static_cast<std::uint8_t>(ranges.size());
    // The children's blocks follow each other, so that a patch's relatives lie together in memory.
    for (std::size_t lane = 0; lane < ranges.size(); ++lane) {
      if (ranges[lane].size() <= leaf_) {
        add_leaf(block, lane, ranges[lane], patches[lane].center);
      } else {
        const std::size_t child = tree_.blocks.size();
        tree_.blocks.emplace_back();
        tree_.blocks[block].child[lane] = static_cast<std::uint32_t>(child);
        add_block(child, children_of(ranges[lane]));
      }
    }
  }

  static void fill(PatchBlock& block, std::size_t lane, const Patch& patch) {
    for (int i = 0; i < 3; ++i) {
      const auto n = static_cast<std::size_t>(i);
      block.center[n][lane] = static_cast<float>(patch.center[i]);
      block.S[n][lane] = static_cast<float>(patch.moments.S(i));
      for (int k = 0; k < 3; ++k) {
        block.N[3 * n + static_cast<std::size_t>(k)][lane] = static_cast<float>(patch.moments.N(i, k));
      }
    }
    for (int pair = 0; pair < 6; ++pair) {
      for (int k = 0; k < 3; ++k) {
        block.P[3 * static_cast<std::size_t>(pair) + static_cast<std::size_t>(k)][lane] =
            static_cast<float>(patch.moments.P(pair, k));
      }
    }
    block.radius[lane] = rounded_up(patch.radius);
    block.area[lane] = rounded_up(patch.area);
    block.mu2[lane] = rounded_up(patch.mu2);
    block.mu3[lane] = rounded_up(patch.mu3);
    block.nu3[lane] = rounded_up(patch.nu3);
    block.child[lane] = 0;
    block.triangle_blocks[lane] = 0;
  }

  void add_leaf(std::size_t block, std::size_t lane, const Range& range, const Vec3& center) {
    tree_.blocks[block].child[lane] = static_cast<std::uint32_t>(tree_.triangles.size());
    const std::size_t count = (range.size() + kSiblings - 1) / kSiblings;
    tree_.blocks[block].triangle_blocks[lane] = static_cast<std::uint8_t>(count);
    for (std::size_t n = 0; n < count * kSiblings; ++n) {
      if (n % kSiblings == 0) tree_.triangles.emplace_back();
      if (n >= range.size()) continue;
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 y = corner(items_[range.begin + n].triangle, i) - center;
        for (int axis = 0; axis < 3; ++axis) {
          tree_.triangles.back().corners[3 * i + static_cast<std::size_t>(axis)][n % kSiblings] =
              static_cast<float>(y[axis]);
        }
      }
    }
  }

  TriangleMesh surface_;
  double grid_ = 0.0;     // [m]
  std::size_t leaf_ = 0;  // triangles per leaf, at most
  std::vector<Item> items_;
  PatchTree tree_;
};

}  // namespace

std::size_t PatchTree::bytes() const {
  return blocks.size() * sizeof(PatchBlock) + triangles.size() * sizeof(TriangleBlock);
}

PatchTree build_patch_tree(const TriangleMesh& surface) {
  return Builder(surface).build();
}

}  // namespace buoyancy
