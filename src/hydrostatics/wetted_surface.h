// The loop that all of the paper's methods share: it sorts every triangle of a mesh into dry, fully submerged
// and cut, and sums the contributions in blocks.
//
// Heights are plain dot products (docs/mathematics.md, "Depth"), so that the paper's methods remain a
// baseline without improvements of this project.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "geometry/pairwise_sum.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// The heights of all vertices, computed once per vertex and not once per corner.
struct VertexHeights {
  const double* height;     // [m], over the water
  const std::uint8_t* wet;  // 1 where height < 0, else 0
};

// The result is valid until the same thread's next call: the tables are thread-local and grow to the largest
// mesh that the thread has seen.
VertexHeights vertex_heights(const TriangleMesh& surface, const WaterPlane& plane);

// Indices of triangles, in ascending order.
using TriangleList = std::span<const std::uint32_t>;

// Sum: zero by default, with operator+=. add_block(sum, wet, cut) adds a block's triangles: `wet` have three
// wet corners, `cut` one or two. Complexity: O(triangles).
//
// A block is sorted before anything is computed, so that no branch depends on the order of the mesh's
// triangles.
template <typename Sum, typename AddBlock>
Sum sum_over_blocks(const TriangleMesh& surface, const VertexHeights& heights, const AddBlock& add_block) {
  constexpr std::size_t kBlock = 256;
  std::array<std::uint32_t, kBlock> wet;
  std::array<std::uint32_t, kBlock> cut;
  const std::uint8_t* const is_wet = heights.wet;

  PairwiseSum<Sum, kBlock> total;
  const std::size_t count = surface.triangles.size();
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, count);
    std::size_t num_wet = 0;
    std::size_t num_cut = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& triangle = surface.triangles[i];
      const unsigned corners = 0U + is_wet[triangle[0]] + is_wet[triangle[1]] + is_wet[triangle[2]];
      // Branch-free: i is written at the end of both lists, and a list grows only if i belongs to it.
      wet[num_wet] = static_cast<std::uint32_t>(i);
      cut[num_cut] = static_cast<std::uint32_t>(i);
      num_wet += static_cast<std::size_t>(corners == 3);
      num_cut += static_cast<std::size_t>(corners - 1 < 2);  // 1 or 2: 0 - 1 wraps around
    }
    Sum block{};
    add_block(block, TriangleList(wet.data(), num_wet), TriangleList(cut.data(), num_cut));
    total.add_block(block);
  }
  return total.total();
}

// add_wet(sum, a, b, c) adds one fully submerged triangle with corners ClipVertex<double>, add_cut(sum, a, b,
// c) the method's contribution of one that the water cuts. Complexity: O(vertices + triangles).
template <typename Sum, typename AddWet, typename AddCut>
Sum sum_over_wet_triangles(const HydrostaticMesh& mesh, const WaterPlane& plane, const AddWet& add_wet,
                           const AddCut& add_cut) {
  const double* const x = mesh.surface.x.data();
  const double* const y = mesh.surface.y.data();
  const double* const z = mesh.surface.z.data();
  const VertexHeights heights = vertex_heights(mesh.surface, plane);
  const auto corner = [=](std::int32_t i) {
    return ClipVertex<double>{{x[i], y[i], z[i]}, heights.height[i]};
  };
  return sum_over_blocks<Sum>(mesh.surface, heights, [&](Sum& sum, TriangleList wet, TriangleList cut) {
    for (const std::uint32_t i : wet) {
      const Triangle& triangle = mesh.surface.triangles[i];
      add_wet(sum, corner(triangle[0]), corner(triangle[1]), corner(triangle[2]));
    }
    for (const std::uint32_t i : cut) {
      const Triangle& triangle = mesh.surface.triangles[i];
      add_cut(sum, corner(triangle[0]), corner(triangle[1]), corner(triangle[2]));
    }
  });
}

// Sums over the whole wetted surface: add(sum, a, b, c) receives the fully submerged triangles and the wet
// parts of those that are cut.
template <typename Sum, typename Add>
Sum sum_over_wetted_surface(const HydrostaticMesh& mesh, const WaterPlane& plane, const Add& add) {
  return sum_over_wet_triangles<Sum>(
      mesh, plane, add, [&](Sum& sum, const auto& a, const auto& b, const auto& c) {
        for_each_wet_triangle(a, b, c,
                              [&](const auto& p, const auto& q, const auto& r) { add(sum, p, q, r); });
      });
}

// [m^3], what `exact` and `exact_surface` publish in addition to the mesh's rounding_bound(): 0 where
// meets_volume_tolerance(), else eps L sum (longest edge)^2 over the triangles that are cut. The area of what
// is left of one may be a product of two such edges, with an error of 1.5 eps of it; the bound takes a sixth
// of that, for each of two triangles, times a distance from the apex of at most 2 L. Complexity: O(vertices +
// triangles), for slender bodies and thin faces only.
double rounding_of_cut_faces(const HydrostaticMesh& mesh, const WaterPlane& plane);

}  // namespace buoyancy
