// The loop that all of the paper's methods share: every triangle of a mesh, sorted into dry, wholly wet and
// cut, its contributions summed in blocks.
//
// Heights are plain dot products here (docs/mathematics.md, "Depth"): the paper's methods are the honest
// baseline.
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

// Of every vertex, computed once per vertex and not once per corner.
struct VertexHeights {
  const double* height;     // m, over the water
  const std::uint8_t* wet;  // 1 where height < 0, else 0
};

// Valid until the same thread's next call: the tables are the thread's own and grow to the largest mesh that
// it has seen.
VertexHeights vertex_heights(const TriangleMesh& surface, const WaterPlane& plane);

// Indices of triangles, in ascending order.
using TriangleList = std::span<const std::uint32_t>;

// Sum: zero by default, with operator+=. add_block(sum, wet, cut) adds those of a block's triangles that have
// three wet corners, and those that have one or two. O(triangles).
//
// A block is sorted before anything is computed: no branch then depends on the order in which the mesh
// happens to store its triangles.
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
    std::size_t wets = 0;
    std::size_t cuts = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& triangle = surface.triangles[i];
      const unsigned corners = 0U + is_wet[triangle[0]] + is_wet[triangle[1]] + is_wet[triangle[2]];
      wet[wets] = static_cast<std::uint32_t>(i);
      cut[cuts] = static_cast<std::uint32_t>(i);
      wets += static_cast<std::size_t>(corners == 3);
      cuts += static_cast<std::size_t>(corners - 1 < 2);
    }
    Sum block{};
    add_block(block, TriangleList(wet.data(), wets), TriangleList(cut.data(), cuts));
    total.add_block(block);
  }
  return total.total();
}

// add_wet(sum, a, b, c) adds one wet triangle with corners ClipVertex<double>, add_cut(sum, a, b, c) what the
// method makes of one that the water cuts. O(vertices + triangles).
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

// The whole wet surface: add(sum, a, b, c) gets the wet triangles and the wet parts of those that are cut.
template <typename Sum, typename Add>
Sum sum_over_wetted_surface(const HydrostaticMesh& mesh, const WaterPlane& plane, const Add& add) {
  return sum_over_wet_triangles<Sum>(
      mesh, plane, add, [&](Sum& sum, const auto& a, const auto& b, const auto& c) {
        for_each_wet_triangle(a, b, c,
                              [&](const auto& p, const auto& q, const auto& r) { add(sum, p, q, r); });
      });
}

// What `exact` and `exact_surface` publish beside the mesh's rounding_bound(), m^3: 0 where the gate is
// promised, else eps L sum (longest edge)^2 of the triangles that are cut. The area of what is left of one
// may be a product of two such edges, with an error of 1.5 eps of it; a sixth of that, for each of two
// triangles, times a distance from the apex of at most 2 L. O(vertices + triangles), of slender bodies and
// thin faces alone.
double rounding_of_cut_faces(const HydrostaticMesh& mesh, const WaterPlane& plane);

}  // namespace buoyancy
