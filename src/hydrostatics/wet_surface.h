// The loop that all of the paper's methods share: every triangle of a mesh, sorted into dry, wholly wet and
// cut, its contributions summed in blocks.
//
// Heights are plain dot products here (docs/mathematics.md, "Depth"): the paper's methods are the honest
// baseline.
#pragma once

#include <algorithm>
#include <cstddef>

#include "geometry/pairwise_sum.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

enum class CutTriangles { kLeaveOut, kClip };

// Sum: zero by default, with operator+=. accumulate(sum, a, b, c) adds one wet triangle with corners
// Corner<double>. kClip also hands over the wet parts of the triangles that the water cuts. O(triangles), no
// heap.
template <typename Sum, CutTriangles kCut, typename Accumulate>
Sum sum_over_wet_surface(const HydrostaticMesh& mesh, const WaterPlane& plane, const Accumulate& accumulate) {
  constexpr std::size_t kBlock = 256;
  const double* const x = mesh.surface.x.data();
  const double* const y = mesh.surface.y.data();
  const double* const z = mesh.surface.z.data();
  const auto k = Point<double>::from(plane.up_B);
  const double h_c = plane.h_c;
  const auto corner = [=](std::int32_t i) {
    const Point<double> at{x[i], y[i], z[i]};
    return Corner<double>{at, dot(k, at) - h_c};
  };

  PairwiseSum<Sum, kBlock> total;
  const std::size_t count = mesh.surface.triangles.size();
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, count);
    Sum block{};
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& triangle = mesh.surface.triangles[i];
      const Corner<double> a = corner(triangle[0]);
      const Corner<double> b = corner(triangle[1]);
      const Corner<double> c = corner(triangle[2]);
      const int wet = static_cast<int>(a.wet()) + static_cast<int>(b.wet()) + static_cast<int>(c.wet());
      if (wet == 0) continue;
      if (wet == 3) {
        accumulate(block, a, b, c);
      } else if constexpr (kCut == CutTriangles::kClip) {
        visit_wet_part(a, b, c,
                       [&](const auto& p, const auto& q, const auto& r) { accumulate(block, p, q, r); });
      }
    }
    total.add_block(block);
  }
  return total.total();
}

}  // namespace buoyancy
