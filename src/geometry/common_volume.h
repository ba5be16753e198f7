// Computes the volume that two closed meshes share, and the volume of one outside the other: for checks of
// how meshes are arranged, not for loads.
//
// The meshes are cut into columns along their longest common direction. On the axis of a column the crossings
// of each surface, with their directions, say where it is inside (winding number above 0), so that nested,
// touching and coincident surfaces need no special case. Lengths along the axes are exact; the sum over the
// columns is a midpoint rule, of 256 columns and more per direction: exact for faces along the axes,
// otherwise within some 1e-3 of the mesh's volume.
#pragma once

#include <array>
#include <optional>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// A surface with an offset: its vertices are mesh->vertex(i) + offset_B. [m]
struct OffsetMesh {
  const TriangleMesh* mesh = nullptr;
  Vec3 offset_B = Vec3::Zero();
};

// Returns the volume inside both [m^3]. Complexity: O(triangles + 256^2 columns and their crossings), some 20
// ms; O(vertices) for meshes whose bounding boxes have nothing in common, or at most touch.
double common_volume(const OffsetMesh& a, const OffsetMesh& b);

// Returns the volume inside `inner` and outside `outer` [m^3]. Complexity: as common_volume();
// O(vertices) where `outer` does not enter the bounding box of `inner`, or at most touches it.
double volume_outside(const OffsetMesh& inner, const OffsetMesh& outer);

// Returns the volume [m^3] that the integrals over a closed mesh count more than once, because its parts
// overlap or lie in each other; nullopt if a line along the longest side of its box crosses the surface more
// than 32 times on average. Complexity: as common_volume(), times half these crossings.
std::optional<double> overlap_volume(const TriangleMesh& mesh);

// How a box is cut into columns.
struct ColumnLayout {
  Eigen::Index along = 2;  // the axis of B that the columns are along
  int count = 256;         // per direction, at least 1
  // Position of a column's axis as shares of its widths. The default is just off the middle, so that the axis
  // meets no edge of a mesh with round coordinates.
  std::array<double, 2> axis_at{0.4939, 0.5047};
};

struct ColumnSum {
  double volume = 0.0;    // [m^3]
  double rounding = 0.0;  // [m^3], bound on the rounding error of the sum
};

// Returns the volume in the box that is inside one mesh and outside the other. Complexity: as
// common_volume(), in proportion to the number of columns.
ColumnSum volume_inside_one(const OffsetMesh& a, const OffsetMesh& b, const BoundingBox& box,
                            const ColumnLayout& layout);

}  // namespace buoyancy
