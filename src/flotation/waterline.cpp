#include "flotation/waterline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hydrostatics/tree_plane.h"
#include "hydrostatics/triangle_clip.h"

namespace buoyancy {
namespace {

class WaterlineWalk {
 public:
  WaterlineWalk(const MomentTree& tree, const WaterPlane& plane, const WaterlineAxes& axes)
      : tree_(tree), plane_(plane_of_tree(tree, plane)), u_(tree.scale * axes.u), v_(tree.scale * axes.v) {
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    start_u_ = axes.u.dot(tree.offset - axes.origin);
    start_v_ = axes.v.dot(tree.offset - axes.origin);
    margin_ = 16.0 * kEpsilon * (3.0 * tree.reach + std::abs(plane_.h_c));
    visit(tree.nodes[0]);
    sums_.area /= -2.0;
    sums_.u /= -6.0;
    sums_.v /= -6.0;
    sums_.uu /= -12.0;
    sums_.uv /= -24.0;
    sums_.vv /= -12.0;
  }

  const Waterline& result() const { return sums_; }

 private:
  struct Corner {
    double u, v;  // [m]
    double z;     // height, in the tree's unit of length
  };

  void visit(const TreeNode& node) {
    const auto at = [this](const auto& by_axis, std::uint32_t i) {
      return Vec3(tree_.unit * Vec3(by_axis[0][i], by_axis[1][i], by_axis[2][i]));
    };
    for (std::uint32_t i = 0; i < node.children; ++i) {
      const double height = plane_.height(at(node.center, i));
      const double reach = plane_.up_B.cwiseAbs().dot(at(node.half, i)) + margin_;
      if (std::abs(height) > reach) continue;
      if (i < node.inner_nodes) {
        visit(tree_.nodes[node.first_node + i]);
      } else {
        const std::uint32_t leaf = node.first_leaf + i - node.inner_nodes;
        if (tree_.leaves.empty()) {
          visit(tree_.double_leaves[leaf]);
        } else {
          visit(tree_.leaves[leaf]);
        }
      }
    }
  }

  template <typename Real>
  void visit(const TreeLeaf<Real>& leaf) {
    const Vec3 center = tree_.center(leaf.center);
    const Corner middle{start_u_ + u_.dot(center), start_v_ + v_.dot(center), plane_.height(center)};
    std::array<Corner, kLeafVertices> corners;
    std::size_t wet = 0;
    for (std::size_t i = 0; i < leaf.vertices; ++i) {
      const Vec3 y = leaf.vertex(i);
      corners[i] = {middle.u + u_.dot(y), middle.v + v_.dot(y), middle.z + plane_.up_B.dot(y)};
      if (corners[i].z < 0.0) ++wet;
    }
    if (wet == 0 || wet == leaf.vertices) return;
    for (std::size_t t = 0; t < leaf.triangles; ++t) {
      const std::array<const Corner*, 5> around{&corners[leaf.corners[t].a()], &corners[leaf.corners[t].b()],
                                                &corners[leaf.corners[t].c()], &corners[leaf.corners[t].a()],
                                                &corners[leaf.corners[t].b()]};
      unsigned mask = 0;
      for (unsigned i = 0; i < 3; ++i) mask |= around[i]->z < 0.0 ? 1U << i : 0U;
      if (mask == 0U || mask == 7U) continue;
      const std::size_t first = kOddOneOut[mask];
      const Corner on_pq = cut(*around[first], *around[first + 1]);
      const Corner on_rp = cut(*around[first], *around[first + 2]);
      // The wet part is counter-clockwise seen from outside.
      if (around[first]->z < 0.0) {
        add(on_pq, on_rp);
      } else {
        add(on_rp, on_pq);
      }
    }
  }

  // The same point for both triangles of an edge.
  static Corner cut(const Corner& p, const Corner& q) {
    const Corner& wet = p.z < 0.0 ? p : q;
    const Corner& dry = p.z < 0.0 ? q : p;
    const double share = wet.z / (wet.z - dry.z);
    return {wet.u + share * (dry.u - wet.u), wet.v + share * (dry.v - wet.v), 0.0};
  }

  void add(const Corner& a, const Corner& b) {
    const double cross = a.u * b.v - a.v * b.u;
    sums_.area += cross;
    sums_.u += cross * (a.u + b.u);
    sums_.v += cross * (a.v + b.v);
    sums_.uu += cross * (a.u * a.u + a.u * b.u + b.u * b.u);
    sums_.uv += cross * (a.u * (2.0 * a.v + b.v) + b.u * (a.v + 2.0 * b.v));
    sums_.vv += cross * (a.v * a.v + a.v * b.v + b.v * b.v);
    for (const Corner* corner : {&a, &b}) {
      sums_.min_u = std::min(sums_.min_u, corner->u);
      sums_.max_u = std::max(sums_.max_u, corner->u);
      sums_.min_v = std::min(sums_.min_v, corner->v);
      sums_.max_v = std::max(sums_.max_v, corner->v);
    }
  }

  const MomentTree& tree_;
  WaterPlane plane_;                      // of the tree
  Vec3 u_, v_;                            // from the tree's coordinates to metres
  double start_u_ = 0.0, start_v_ = 0.0;  // [m], of the tree's origin
  double margin_ = 0.0;                   // exceeds the rounding error of a bound's height
  Waterline sums_;
};

}  // namespace

Waterline waterline(const HydrostaticMesh& mesh, const WaterPlane& plane, const WaterlineAxes& axes) {
  return WaterlineWalk(*mesh.tree, plane, axes).result();
}

}  // namespace buoyancy
