// The tree that wave loads are integrated with: patches of a closed surface with their surface moments about
// their own centroids.
//
// The pressure of waves is not linear, so that a patch is integrated with a quadratic model of the pressure
// about its own centroid; what the model leaves out grows with the patch's radius and moments of distance
// (docs/wave_mathematics.md). Four siblings lie side by side, as SIMD code reads them. Numbers are float32:
// their rounding is part of the published bound, and a thousandth of the smallest tolerance that is of use.
//
// Long edges are divided first (edge_division.h): the surface stays the same.
//
// Built once per mesh and scale, only where a scene has waves; immutable, shared by all threads.
// Complexity: build O(n log n), about 1 us per triangle; memory about 65 B per triangle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/large_page_array.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline constexpr std::size_t kSiblings = 4;

using FourFloats = std::array<float, kSiblings>;

// Up to four sibling patches. Unused lanes repeat the first patch's centre and have no area. In the order in
// which a descent asks for it, a cache line each: where patches are, how large and what they hold, the rest.
struct PatchBlock {
  // [m], surface centroid m, B axes, relative to the mesh's centre c
  alignas(64) std::array<FourFloats, 3> center;
  FourFloats radius;  // [m], max |y| over the patch, y = x - m; rounded up

  // [m^2], of the patch on the grid, of that of the surface, and of all on the way between them; rounded up.
  // So are radius and mu2.
  alignas(64) FourFloats area;
  FourFloats mu3;  // [m^5], bound on the integral of |y|^3 dA
  // Of an inner patch: the index of its children's block. Of a leaf: that of its first triangle block.
  std::array<std::uint32_t, kSiblings> child;
  // Of an inner patch 0; of a leaf the number of its triangle blocks.
  std::array<std::uint8_t, kSiblings> triangle_blocks;
  std::uint8_t patches;  // 1 to kSiblings

  alignas(64) FourFloats mu2;    // [m^4], bound on the integral of |y|^2 dA
  FourFloats nu3;                // [m^5], bound on the norm of the integral of y_i y_j y_l n_k dA
  std::array<FourFloats, 3> S;   // [m^2], integral of n_k dA
  std::array<FourFloats, 9> N;   // [m^3], integral of y_i n_k dA, at 3 i + k
  std::array<FourFloats, 18> P;  // [m^4], integral of y_i y_j n_k dA, at 3 kSymmetricPair[i][j] + k
};

// Up to four triangles of a leaf. Unused lanes are points at the leaf's centroid.
struct TriangleBlock {
  // [m], at 3 corner + axis: corners relative to the leaf's centroid, counter-clockwise seen from outside.
  alignas(16) std::array<FourFloats, 9> corners;
};

struct PatchTree {
  LargePageArray<PatchBlock> blocks;  // blocks[0] holds the patches of the first level
  LargePageArray<TriangleBlock> triangles;
  double area = 0.0;  // [m^2], sum of the areas of the patches
  // [m], to which the corners of the tree's triangles are from those of the surface. They lie on a grid on
  // which float32 arithmetic is exact, so that neighbours share their corners and the surface stays closed.
  double displacement = 0.0;

  double grid = 0.0;  // [m], its spacing

  std::size_t bytes() const;
};

// The patches of a tree, and those of single triangles that a query has made of leaves. Their blocks, and
// their triangles' blocks, are numbered after those of the tree.
class QueryPatches {
 public:
  // tree: must outlive the query. Keeps the memory of earlier queries.
  void start(const PatchTree& tree);

  const PatchBlock& block(std::uint32_t number) const {
    const std::size_t of_tree = tree_->blocks.size();
    return number < of_tree ? tree_->blocks[number] : blocks_[number - of_tree];
  }
  const TriangleBlock& triangles(std::uint32_t number) const {
    const std::size_t of_tree = tree_->triangles.size();
    return number < of_tree ? tree_->triangles[number] : triangles_[number - of_tree];
  }

  struct Blocks {
    std::uint32_t first, end;
  };
  // Makes blocks of the triangles of a leaf, each a leaf of one triangle. References to blocks become
  // invalid. None where the leaf is one of one triangle already. About 0.1 us per triangle.
  Blocks add_triangles_of_leaf(std::uint32_t block, std::size_t lane);

 private:
  const PatchTree* tree_ = nullptr;
  std::vector<PatchBlock> blocks_;
  std::vector<TriangleBlock> triangles_;
};

// The surface with its long edges divided, so that patches of its triangles are small enough for most
// tolerances and waves: the one that is sorted into the tree. Complexity: O(triangles).
TriangleMesh patch_surface(const TriangleMesh& surface);

// surface: vertices relative to c; at least one triangle, valid indices, finite coordinates.
PatchTree build_patch_tree(const TriangleMesh& surface);

}  // namespace buoyancy
