// The loops of `hierarchical` that run per node and per leaf of the moment tree: plain types here, SIMD
// behind it.
//
// One source, compiled for every instruction set that the processor may have (Highway, run-time dispatch):
// AVX-512, AVX2, SSE4, SSSE3, NEON, and the scalar twin that every other target is tested against. A target
// can be forced, for tests and benchmarks.
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
  double h_high, h_low;                    // m
  // The axis a of B whose component of the normal all is integrated with, and b and c, right-handed. k_a must
  // not be 0; the nearer to 1, the less is lost in the division by it.
  std::array<std::size_t, 3> axes;
  // m^3: how much may be left undecided, in volume and in torque/(rho g L_r); 0: nothing.
  double budget;
  double half_diagonal;  // m: L / 2; read where budget > 0
};

// What undecided nodes (pruned_node.h) add besides their slopes times their moments, which are among
// WettedTreeSum::nodes.
struct PrunedSum {
  AxisMoments offsets;         // m times moments: offset times S and N; the rest is unused
  double volume = 0.0;         // m^3: int (p2 - p1) n_a dA
  Vec3 moment = Vec3::Zero();  // m^4: the same times y_m
  double error = 0.0;  // m^3: bound on what all of it can be wrong in volume, and in torque/(rho g L_r)
};

// Integrals over the wet surface with n_a dA, in two parts that the read-out adds.
struct WettedTreeSum {
  AxisMoments nodes;  // about c, of the wholly wet nodes

  // Of the triangles of crossing leaves, with z the height and y about c:
  double volume6 = 0.0;     // m^3: 6 int z n_a dA
  double moment_b24 = 0.0;  // m^4: 24 int z y_b n_a dA
  double moment_c24 = 0.0;  // m^4: 24 int z y_c n_a dA
  double height24 = 0.0;    // m^4: 12 int z^2 n_a dA

  PrunedSum undecided;  // zero where the budget is

  double rounding = 0.0;  // m^3: of the leaves clipped (TreeLeaf)

  std::int64_t nodes_visited = 0, leaves_clipped = 0, nodes_added = 0, nodes_pruned = 0;
};

// Descends from the root. undecided.error <= budget. With budget 0 nothing is left undecided, and there is no
// heap; else none once the thread has seen a tree as large.
WettedTreeSum sum_wetted_tree(const MomentTree& tree, const TreeQuery& query);

std::vector<std::string>
simd_targets();             // that this processor can run, the best first; "SCALAR" is always among them
std::string simd_target();  // the one in use
// Uses this target from now on, in all threads; "" for the best. False: not one of simd_targets().
bool force_simd_target(std::string_view name);

}  // namespace buoyancy
