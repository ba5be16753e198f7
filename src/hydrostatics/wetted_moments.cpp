#include "hydrostatics/wetted_moments.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include "base/double_double.h"
#include "geometry/pairwise_sum.h"
#include "hydrostatics/tree_plane.h"
#include "hydrostatics/triangle_clip.h"

namespace buoyancy {
namespace {

// The descent sums one of these over the wetted surface: all moments and the area, or the area alone.
struct MomentPatch {
  SurfaceMoments<double> moments;
  double area = 0.0;

  static MomentPatch of_node(const MomentTree& tree, std::uint32_t index) {
    return {tree.moments_of(index), tree.areas[index]};
  }
  static MomentPatch of_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
    MomentPatch patch{moments_of_triangle<double>(a, b, c), 0.0};
    patch.area = patch.moments.S.norm();
    return patch;
  }
  MomentPatch& operator+=(const MomentPatch& other) {
    moments += other.moments;
    area += other.area;
    return *this;
  }
};

struct AreaPatch {
  double area = 0.0;

  static AreaPatch of_node(const MomentTree& tree, std::uint32_t index) { return {tree.areas[index]}; }
  AreaPatch& operator+=(const AreaPatch& other) {
    area += other.area;
    return *this;
  }
};

using LeafHeights = std::array<double, kLeafVertices>;

template <typename Patch>
class WettedSurfaceWalk {
 public:
  WettedSurfaceWalk(const MomentTree& tree, const WaterPlane& plane) : tree_(tree), plane_(plane) {
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    margin_ = 16.0 * kEpsilon * (3.0 * tree.reach + std::abs(plane.h_c));
    visit(tree.nodes[0]);
  }

  Patch nodes() const { return wet_nodes_.total(); }  // about c
  Patch clipped() const { return clipped_.total(); }  // about point()
  const std::optional<Vec3>& point() const { return point_; }
  double height() const { return height_; }

 private:
  void visit(const TreeNode& node) {
    for (std::uint32_t i = 0; i < node.children; ++i) {
      const double height = plane_.height(tree_.center_of_child(node, i));
      const double reach = plane_.up_B.cwiseAbs().dot(tree_.half_of_child(node, i)) + margin_;
      if (height - reach > 0.0) continue;
      if (height + reach < 0.0) {
        add_wet_node(node.first_moments + i);
      } else {
        tree_.visit_child(node, i, [this](const auto& child) { visit(child); });
      }
    }
  }

  // Returns the height of a leaf's centre, rounded once.
  double exact_height(const Vec3& center) const {
    DoubleDouble sum{-plane_.h_c, -plane_.h_c_rest};
    for (int i = 0; i < 3; ++i) sum = sum + DoubleDouble{plane_.up_B[i], plane_.up_B_rest[i]} * center[i];
    return sum.hi;
  }

  template <typename Real>
  void visit(const TreeLeaf<Real>& leaf) {
    const Vec3 center = tree_.center(leaf.center);
    const double center_height = exact_height(center);
    LeafHeights heights;
    std::size_t wet = 0;
    std::size_t first_wet = leaf.vertices;
    for (std::size_t i = 0; i < leaf.vertices; ++i) {
      heights[i] = center_height + plane_.up_B.dot(leaf.vertex(i));
      if (!(heights[i] < 0.0)) continue;
      ++wet;
      first_wet = std::min(first_wet, i);
    }
    if (wet == 0) return;
    if (wet == leaf.vertices) {
      add_wet_node(leaf.moments);
      return;
    }
    if constexpr (std::is_same_v<Patch, AreaPatch>) {
      clip_area(leaf, heights);
    } else {
      if (!point_) {
        point_ = center + leaf.vertex(first_wet);
        height_ = center_height + plane_.up_B.dot(*point_ - center);
      }
      clip_moments(leaf, heights, center - *point_);
    }
  }

  template <typename Real>
  void clip_moments(const TreeLeaf<Real>& leaf, const LeafHeights& heights, const Vec3& from_point) {
    const auto corner = [&](std::size_t i) {
      return ClipVertex<double>{Point<double>::from(from_point + leaf.vertex(i)), heights[i]};
    };
    for (std::size_t t = 0; t < leaf.triangles; ++t) {
      const ClipVertex<double> a = corner(leaf.corners[t].a());
      const ClipVertex<double> b = corner(leaf.corners[t].b());
      const ClipVertex<double> c = corner(leaf.corners[t].c());
      const int num_wet = static_cast<int>(a.wet()) + static_cast<int>(b.wet()) + static_cast<int>(c.wet());
      if (num_wet == 3) add(a, b, c);
      if (num_wet == 1 || num_wet == 2) {
        for_each_wet_triangle(a, b, c, [this](const auto& p, const auto& q, const auto& r) { add(p, q, r); });
      }
    }
  }

  // The part at the corner that is alone on its side has the triangle's area times the fractions of the two
  // edges at that corner that lie on its side.
  template <typename Real>
  void clip_area(const TreeLeaf<Real>& leaf, const LeafHeights& heights) {
    for (std::size_t t = 0; t < leaf.triangles; ++t) {
      const std::array<std::size_t, 5> around{leaf.corners[t].a(), leaf.corners[t].b(), leaf.corners[t].c(),
                                              leaf.corners[t].a(), leaf.corners[t].b()};
      unsigned mask = 0;
      for (unsigned i = 0; i < 3; ++i) mask |= static_cast<unsigned>(heights[around[i]] < 0.0) << i;
      if (mask == 0U) continue;
      const std::size_t first = kOddOneOut[mask];
      const std::size_t p = around[first];
      const std::size_t q = around[first + 1];
      const std::size_t r = around[first + 2];
      const Vec3 at_p = leaf.vertex(p);
      const double area = 0.5 * (leaf.vertex(q) - at_p).cross(leaf.vertex(r) - at_p).norm();
      if (mask == 7U) {
        clipped_.add({area});
        continue;
      }
      const double z = heights[p];
      const double part = area * (z / (z - heights[q])) * (z / (z - heights[r]));
      clipped_.add({z < 0.0 ? part : area - part});
    }
  }

  void add_wet_node(std::uint32_t index) { wet_nodes_.add(Patch::of_node(tree_, index)); }

  void add(const ClipVertex<double>& a, const ClipVertex<double>& b, const ClipVertex<double>& c) {
    clipped_.add(Patch::of_triangle(a.y.vec3(), b.y.vec3(), c.y.vec3()));
  }

  const MomentTree& tree_;
  const WaterPlane& plane_;
  double margin_ = 0.0;           // [m], exceeds the rounding error of a bound's height
  PairwiseSum<Patch> wet_nodes_;  // about c
  PairwiseSum<Patch> clipped_;    // about point_
  std::optional<Vec3> point_;     // [m], from c: the first wet vertex of a leaf that the water cuts
  double height_ = 0.0;           // [m], of point_
};

}  // namespace

WettedMoments wetted_moments(const MomentTree& tree, const WaterPlane& plane) {
  const WaterPlane tree_plane = plane_of_tree(tree, plane);
  const WettedSurfaceWalk<MomentPatch> walk(tree, tree_plane);
  const MomentPatch nodes = walk.nodes();
  WettedMoments wet{nodes.moments, Vec3::Zero(), -tree_plane.h_c, nodes.area};
  if (walk.point()) {
    const MomentPatch clipped = walk.clipped();
    wet.moments = nodes.moments.moved(*walk.point());
    wet.moments += clipped.moments;
    wet.point = *walk.point();
    wet.height = walk.height();
    wet.area += clipped.area;
  }
  const double length = tree.scale;
  const double area = length * length;
  wet.moments.S *= area;
  wet.moments.N *= area * length;
  wet.moments.P *= area * area;
  wet.point = length * wet.point + tree.offset;
  wet.height *= length;
  wet.area *= area;
  return wet;
}

double wetted_area(const MomentTree& tree, const WaterPlane& plane) {
  const WaterPlane tree_plane = plane_of_tree(tree, plane);
  const WettedSurfaceWalk<AreaPatch> walk(tree, tree_plane);
  return tree.scale * tree.scale * (walk.nodes().area + walk.clipped().area);
}

}  // namespace buoyancy
