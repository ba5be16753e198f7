// The sums that the paper's methods take over all triangles: an interface of plain types to a SIMD
// implementation.
//
// Every triangle is sorted into dry, fully submerged and cut by the heights of its three corners. Heights are
// plain dot products (docs/mathematics.md, "Depth"), so that the paper's methods remain a baseline without
// improvements of this project. The sums of the meshlets are added pairwise. One source is compiled for every
// instruction set that the processor may have, as in wetted_tree_sum.h; all of them give the same bits.
//
// Complexity: O(vertices + triangles). No heap.
#pragma once

#include <array>
#include <vector>

#include "geometry/meshlets.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/pressure_elements.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// What becomes of the triangles that the water cuts: a bound on their contribution, or their wet parts.
enum class CutTriangles { kBound, kClip };

// Elements: VolumeElements or PressureElements, of the wet triangles.
template <typename Elements>
struct WettedSum {
  Elements wet;
  // [m^3], if not clipped. Volume: 6 sum |V_i(o)| of the cut triangles; pressure: the sum over them of twice
  // the area times the sum of the corners' depths.
  double cut_bound6 = 0.0;
  double cut_edges_squared = 0.0;  // [m^2], sum of (longest edge)^2 of the cut triangles, if clipped

  WettedSum& operator+=(const WettedSum& other) {
    wet += other.wet;
    cut_bound6 += other.cut_bound6;
    cut_edges_squared += other.cut_edges_squared;
    return *this;
  }
};

using VolumeElementSum = WettedSum<VolumeElements>;
using PressureElementSum = WettedSum<PressureElements>;

VolumeElementSum sum_volume_elements(const Meshlets& meshlets, const WaterPlane& plane, const Vec3& apex,
                                     CutTriangles cut);
PressureElementSum sum_pressure_elements(const Meshlets& meshlets, const WaterPlane& plane, CutTriangles cut);

// A triangle's precomputed volume element (paper_methods.h, `fast`): V_i, and V_i C_i.
using TableElement = std::array<double, 4>;  // [m^3], [m^4]

struct TableSum {
  TableElement wet{};
  double cut_bound = 0.0;       // [m^3], sum |V_i| of the cut triangles
  bool fully_submerged = true;  // true if all triangles are

  TableSum& operator+=(const TableSum& other) {
    for (std::size_t i = 0; i < wet.size(); ++i) wet[i] += other.wet[i];
    cut_bound += other.cut_bound;
    fully_submerged = fully_submerged && other.fully_submerged;
    return *this;
  }
};

// elements: one per triangle of the meshlets' groups, in their order; zero for the missing ones.
TableSum sum_table(const Meshlets& meshlets, const WaterPlane& plane,
                   const std::vector<TableElement>& elements);

// Returns what `exact` and `exact_surface` publish in addition to the mesh's rounding_bound() [m^3]: 0 where
// meets_volume_tolerance(), else eps L sum (longest edge)^2 over the cut triangles. The area of a clipped
// part may be a product of two such edges, with an error of 1.5 eps of it; a sixth of that, for each of two
// triangles, times a distance from the apex of at most 2 L, gives this bound.
double rounding_of_cut_faces(const HydrostaticMesh& mesh, double cut_edges_squared);

}  // namespace buoyancy
