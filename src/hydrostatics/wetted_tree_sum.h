// The loops of `hierarchical` that run per node and per leaf of the moment tree: an interface of plain types
// to a SIMD implementation.
//
// One source is compiled for every instruction set that the processor may have (Highway, run-time dispatch):
// AVX-512, AVX2, SSE4, SSSE3, NEON, and the scalar reference that every other target is tested against. Tests
// and benchmarks can force a target.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/moment_tree.h"

namespace buoyancy {

// A water plane, split so that the height of a leaf's centre is computed without rounding its large parts:
// k = k_high + k_low with k_high of 26 bits, h = h_high + h_low with h_high a multiple of grid 2^-26.
struct TreeQuery {
  std::array<double, 3> k, k_high, k_low;  // up in B
  double h_high, h_low;                    // [m]
  // The axis a of B whose component n_a of the normal all integrals use, then b and c, right-handed. k_a must
  // not be 0; the nearer |k_a| is to 1, the fewer digits the division by it loses.
  std::array<std::size_t, 3> axes;
  // [m^3], the largest total error of pruned nodes, in volume and in torque/(rho g L_r); 0: no pruning.
  double budget;
  double half_diagonal;  // [m], L / 2; read only if budget > 0
};

// The contribution of pruned nodes (pruned_node.h) besides their slopes times their moments, which
// WettedTreeSum::nodes includes.
struct PrunedSum {
  AxisMoments offsets;         // m times moments: offset times S and N; the rest is unused
  double volume = 0.0;         // [m^3], int (p2 - p1) n_a dA
  Vec3 moment = Vec3::Zero();  // [m^4], the same times y_m
  double error = 0.0;          // [m^3], bound on the total error in volume and in torque/(rho g L_r)
};

// Integrals over the wetted surface with n_a dA, in two parts that the conversion to volume integrals adds.
struct WettedTreeSum {
  AxisMoments nodes;  // about c, of the fully submerged nodes

  // Sums over the triangles of crossing leaves, with z the height and y about c:
  double volume6 = 0.0;      // [m^3], 6 int z n_a dA
  double moment_b24 = 0.0;   // [m^4], 24 int z y_b n_a dA
  double moment_c24 = 0.0;   // [m^4], 24 int z y_c n_a dA
  double z_squared12 = 0.0;  // [m^4], 12 int z^2 n_a dA

  PrunedSum pruned;  // zero if the budget is

  double rounding = 0.0;  // [m^3], of the leaves clipped (TreeLeaf)

  std::int64_t nodes_visited = 0, leaves_clipped = 0, nodes_added = 0, nodes_pruned = 0;
};

// Descends from the root. Postcondition: pruned.error <= budget. With budget 0 no node is pruned and no heap
// is used; otherwise no heap is used once the thread has seen a tree as large.
WettedTreeSum sum_wetted_tree(const MomentTree& tree, const TreeQuery& query);

// The targets that this processor can run, the best first. The last one is the least that the build requires.
std::vector<std::string> simd_targets();
std::string simd_target();  // the target in use
// Selects a target for all threads; "" selects the best. Returns false if it is not one of simd_targets().
bool force_simd_target(std::string_view name);

}  // namespace buoyancy
