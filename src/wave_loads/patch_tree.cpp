#include "wave_loads/patch_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/surface_moments.h"
#include "wave_loads/edge_division.h"

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

void fill(PatchBlock& block, std::size_t lane, const Patch& patch) {
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

// Half of the diagonal of a cell of the grid.
double displacement_by(double grid) {
  return 0.5 * std::sqrt(3.0) * grid;
}

// The integrals over what a triangle's corners on the grid sweep on their way from those of the surface. y:
// the corners, from the patch's centre.
struct SweptTriangle {
  SweptTriangle(const std::array<Vec3, 3>& y, double displacement) {
    const Vec3 ab = y[1] - y[0];
    const Vec3 ac = y[2] - y[0];
    normal = 0.5 * ab.cross(ac);
    area = normal.norm();
    // Both edges change by at most twice the displacement.
    largest_area = area + displacement * (ab.norm() + ac.norm()) + 2.0 * displacement * displacement;
  }
  Vec3 normal;                // [m^2], area vector
  double area, largest_area;  // [m^2], on the grid; a bound on all
};

// Makes the root of area and mu2 a bound on the integral of |y| on the way as well. area: on the grid.
void add_sweep(double area, double displacement, Patch& patch) {
  patch.radius += displacement;
  const double moved = displacement * patch.area + patch.radius * (patch.area - area);
  if (patch.area > 0.0) patch.mu2 += moved * (2.0 * patch.radius + moved / patch.area);
}

// The patch of one triangle. y: its corners from `center`, which is its centroid but for the grid.
Patch patch_of_triangle(const Vec3& center, const std::array<Vec3, 3>& y, double displacement) {
  const SweptTriangle triangle(y, displacement);
  Patch patch;
  patch.center = center;
  patch.moments = moments_of_triangle(y[0], y[1], y[2]);
  patch.area = triangle.largest_area;
  const Vec3 centroid = (y[0] + y[1] + y[2]) / 3.0;
  const std::array<Vec3, 3> c{y[0] - centroid, y[1] - centroid, y[2] - centroid};
  double squares = 0.0;
  double fourths = 0.0;
  double farthest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double squared = c[i].squaredNorm();
    squares += squared;
    fourths += squared * squared;
    farthest = std::max(farthest, y[i].squaredNorm());
  }
  const double off = centroid.norm();
  const double mean_square = squares / 12.0;
  patch.radius = std::sqrt(farthest);
  // The means of |y|^2 and |y|^4 about the centroid are the sums over the corners over 12 and, at most,
  // over 30.
  const double reach = patch.radius + off;
  patch.mu2 = triangle.area * (mean_square + off * off);
  const double mu4 = triangle.area * (fourths / 30.0 + 4.0 * off * reach * reach * reach);
  patch.mu3 = std::sqrt(patch.mu2 * mu4);
  // The mean of y_i y_j y_l is the symmetric part of the product of the corners over 10; the square of its
  // norm is the permanent of their Gram matrix over 6.
  const double aa = c[0].squaredNorm();
  const double bb = c[1].squaredNorm();
  const double cc = c[2].squaredNorm();
  const double ab = c[0].dot(c[1]);
  const double bc = c[1].dot(c[2]);
  const double ca = c[2].dot(c[0]);
  const double permanent = aa * (bb * cc + bc * bc) + bb * ca * ca + cc * ab * ab + 2.0 * ab * bc * ca;
  patch.nu3 =
      triangle.area * (std::sqrt(std::max(permanent, 0.0) / 600.0) + 3.0 * off * (mean_square + off * off));
  add_sweep(triangle.area, displacement, patch);
  return patch;
}

class Builder {
 public:
  explicit Builder(const TriangleMesh& surface) : surface_(patch_surface(surface)) {
    snap_to_grid();
    const std::size_t triangles = surface_.triangles.size();
    // Leaves of small meshes are small, because the surface of the water crosses most of them.
    constexpr std::size_t kFewTriangles = 10'000;
    constexpr std::size_t kFewParts = 40'000;
    leaf_ = surface.triangles.size() < kFewTriangles && triangles < kFewParts ? 4 : 16;
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
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) tree_.area += swept(t).largest_area;
    tree_.displacement = displacement_by(grid_);
    tree_.grid = grid_;
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
  SweptTriangle swept(std::size_t t, const Vec3& center = Vec3::Zero()) const {
    return {{corner(t, 0) - center, corner(t, 1) - center, corner(t, 2) - center}, displacement_by(grid_)};
  }

  // Up to four ranges, each as large as a full subtree, so that only the top of the tree has unused lanes.
  std::vector<Range> children_of(const Range& range) {
    std::size_t full = leaf_;
    while (full * kSiblings < range.size()) full *= kSiblings;
    std::vector<Range> ranges{range};
    for (std::size_t i = 0; i < ranges.size();) {
      if (ranges[i].size() > full && ranges.size() < kSiblings) {
        const Range whole = ranges[i];
        const std::size_t left = split(whole, left_share(whole.size(), full));
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

  using Position = std::array<float, 3>;
  struct Box {
    Position low{}, high{};

    explicit Box(const Position& p) : low(p), high(p) {}
    void add(const Position& p) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
      }
    }
    float extent(std::size_t axis) const { return high[axis] - low[axis]; }
    std::size_t longest_axis() const {
      std::size_t axis = 0;
      for (std::size_t other = 1; other < 3; ++other) {
        if (extent(other) > extent(axis)) axis = other;
      }
      return axis;
    }
    double diagonal() const {
      return std::hypot(static_cast<double>(extent(0)), static_cast<double>(extent(1)),
                        static_cast<double>(extent(2)));
    }
  };

  Box box_of(const Range& range) const {
    Box box(items_[range.begin].position);
    for (std::size_t i = range.begin; i < range.end; ++i) box.add(items_[i].position);
    return box;
  }

  // The index breaks ties, so that the tree depends on the mesh alone.
  static auto by_position(std::size_t axis) {
    return [axis](const Item& a, const Item& b) {
      return a.position[axis] != b.position[axis] ? a.position[axis] < b.position[axis]
                                                  : a.triangle < b.triangle;
    };
  }
  auto at(std::size_t i) { return items_.begin() + static_cast<std::ptrdiff_t>(i); }

  // Sorts `left` items of the range before the others along the axis on which they spread most, or another
  // number along another axis where a part would be about as wide as the whole. Returns the number.
  std::size_t split(const Range& range, std::size_t left) {
    const Box whole = box_of(range);
    std::nth_element(at(range.begin), at(range.begin + left), at(range.end),
                     by_position(whole.longest_axis()));
    constexpr std::size_t kFew = 256;  // of larger ranges the parts are split again
    constexpr double kAsWide = 0.9;
    const auto wide = [&](const Range& part) { return box_of(part).diagonal() > kAsWide * whole.diagonal(); };
    if (range.size() > kFew) return left;
    if (!wide({range.begin, range.begin + left}) && !wide({range.begin + left, range.end})) return left;
    return split_apart(range, whole);
  }

  // Splits a range where its parts are the narrowest: patches that hold triangles of two sides of a thin body
  // are too wide for their models. Every triangle counts with the third power of its part's width.
  std::size_t split_apart(const Range& range, const Box& whole) {
    const double typical = whole.diagonal() / std::sqrt(static_cast<double>(range.size()));
    const auto cost = [typical](std::size_t count, const Box& box) {
      return static_cast<double>(count) * std::pow(box.diagonal() + typical, 3);
    };
    double least = std::numeric_limits<double>::infinity();
    std::size_t best_axis = 0;
    std::size_t best = 1;
    std::vector<double> of_left(range.size());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::sort(at(range.begin), at(range.end), by_position(axis));
      Box box(items_[range.begin].position);
      for (std::size_t n = 1; n < range.size(); ++n) {
        of_left[n] = cost(n, box);
        box.add(items_[range.begin + n].position);
      }
      box = Box(items_[range.end - 1].position);
      for (std::size_t n = range.size() - 1; n > 0; --n) {
        box.add(items_[range.begin + n].position);
        const double sum = of_left[n] + cost(range.size() - n, box);
        if (sum < least) {
          least = sum;
          best_axis = axis;
          best = n;
        }
      }
    }
    std::sort(at(range.begin), at(range.end), by_position(best_axis));
    return best;
  }

  Patch integrate(const Range& range) const {
    Patch patch;
    Vec3 weighted = Vec3::Zero();
    double area_of_surface = 0.0;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::size_t t = items_[i].triangle;
      const SweptTriangle triangle = swept(t);
      area_of_surface += triangle.area;
      patch.area += triangle.largest_area;
      weighted += triangle.area * (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
    }
    const Vec3 center =
        area_of_surface > 0.0 ? Vec3(weighted / area_of_surface) : corner(items_[range.begin].triangle, 0);
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
      const SweptTriangle triangle = swept(t);
      Cubes cubes = Cubes::Zero();
      for_each_point_of_rule(y, [&](double weight, const Vec3& p) {
        const double squared = p.squaredNorm();
        patch.mu2 += triangle.area * weight * squared;
        mu4 += triangle.area * weight * squared * squared;
        cubes += weight * cubes_of(p);
      });
      third += cubes * triangle.normal.transpose();
    }
    patch.radius = std::sqrt(radius_squared);
    patch.mu3 = std::sqrt(patch.mu2 * mu4);  // Cauchy's inequality
    constexpr double kRounding = 1e-12;      // of the sums, which cancel
    patch.nu3 = third.norm() + kRounding * patch.mu3;
    add_sweep(area_of_surface, displacement_by(grid_), patch);
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

void QueryPatches::start(const PatchTree& tree) {
  tree_ = &tree;
  blocks_.clear();
  triangles_.clear();
}

QueryPatches::Blocks QueryPatches::add_triangles_of_leaf(std::uint32_t number, std::size_t lane) {
  const auto first = static_cast<std::uint32_t>(tree_->blocks.size() + blocks_.size());
  if (number >= tree_->blocks.size()) return {first, first};
  const PatchBlock& leaf = tree_->blocks[number];
  const Vec3 leaf_center(leaf.center[0][lane], leaf.center[1][lane], leaf.center[2][lane]);
  const double displacement = tree_->displacement;
  for (std::uint32_t b = 0; b < leaf.triangle_blocks[lane]; ++b) {
    const TriangleBlock& source = tree_->triangles[leaf.child[lane] + b];
    PatchBlock& block = blocks_.emplace_back();
    for (std::size_t i = 0; i < kSiblings; ++i) {
      std::array<Vec3, 3> y;
      Vec3 centroid = Vec3::Zero();
      for (std::size_t n = 0; n < 3; ++n) {
        y[n] = Vec3(source.corners[3 * n][i], source.corners[3 * n + 1][i], source.corners[3 * n + 2][i]);
        centroid += y[n] / 3.0;
      }
      const bool used = y[0] != y[1] || y[0] != y[2];
      const Vec3 center = used && tree_->grid > 0.0 ? Vec3(centroid.unaryExpr([&](double x) {
        return tree_->grid * std::nearbyint(x / tree_->grid);
      }))
                                                    : centroid;
      for (Vec3& corner : y) corner -= center;
      fill(block, i,
           used ? patch_of_triangle(leaf_center + center, y, displacement)
                : Patch{.center = leaf_center, .moments = {}});
      if (!used) continue;
      block.patches = static_cast<std::uint8_t>(i + 1);
      block.triangle_blocks[i] = 1;
      block.child[i] = static_cast<std::uint32_t>(tree_->triangles.size() + triangles_.size());
      TriangleBlock& triangle = triangles_.emplace_back();
      for (std::size_t n = 0; n < 3; ++n) {
        for (int axis = 0; axis < 3; ++axis) {
          triangle.corners[3 * n + static_cast<std::size_t>(axis)][0] = static_cast<float>(y[n][axis]);
        }
      }
    }
  }
  return {first, static_cast<std::uint32_t>(tree_->blocks.size() + blocks_.size())};
}

std::size_t PatchTree::bytes() const {
  return blocks.size() * sizeof(PatchBlock) + triangles.size() * sizeof(TriangleBlock);
}

TriangleMesh patch_surface(const TriangleMesh& surface) {
  // With fewer triangles patches are too large for fine tolerances and short waves; needles have more.
  constexpr double kFewest = 12'000.0;
  constexpr std::size_t kMost = 150'000;
  double area = 0.0;
  for (const Triangle& t : surface.triangles) {
    const Vec3 corner = surface.vertex(t[0]);
    area += 0.5 * (surface.vertex(t[1]) - corner).cross(surface.vertex(t[2]) - corner).norm();
  }
  constexpr double kEdge = 1.5;  // of an equilateral triangle, over the root of its area
  return with_divided_edges(surface, kEdge * std::sqrt(area / kFewest),
                            std::max(2 * surface.triangles.size(), kMost));
}

PatchTree build_patch_tree(const TriangleMesh& surface) {
  return Builder(surface).build();
}

}  // namespace buoyancy
