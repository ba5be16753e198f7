// The tree that wave loads are integrated with: patches of a closed surface with their surface moments about
// their own centroids.
//
// The pressure of waves is not linear, so that a patch is integrated with a quadratic model of the pressure
// about its own centroid; what the model leaves out grows with the patch's radius and moments of distance
// (docs/wave_mathematics.md). Four siblings lie side by side, as SIMD code reads them. Numbers are float32:
// their rounding is part of the published bound, and a thousandth of the smallest tolerance that is of use.
//
// Built once per mesh and scale, only where a scene has waves; immutable, shared by all threads.
// Complexity: build O(n log n), about 1 us per triangle; memory about 65 B per triangle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

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

  alignas(64) FourFloats area;  // [m^2], rounded up
  FourFloats mu3;               // [m^5], bound on the integral of |y|^3 dA
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
  double area = 0.0;  // [m^2]
  // [m], to which the corners of the tree's triangles are from those of the surface. They lie on a grid on
  // which float32 arithmetic is exact, so that neighbours share their corners and the surface stays closed.
  double displacement = 0.0;

  std::size_t bytes() const;
};

// surface: vertices relative to c; at least one triangle, valid indices, finite coordinates.
PatchTree build_patch_tree(const TriangleMesh& surface);

}  // namespace buoyancy
