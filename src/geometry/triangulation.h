// Splits the polygons of a mesh into triangles that keep every corner.
//
// A polygon is planar if its corners lie within 1e-6 of its size (the diagonal of its bounding box) of a
// plane across its Newell vector (the area vector of its boundary). It is split by ear clipping in the
// projection along that vector's largest component, with exact predicates: an ear is strictly convex, and no
// other corner lies in its closed triangle, except at the place of one of its three corners. The ear of the
// shortest diagonal is cut first. If no ear is left, as in polygons that cross themselves, the rest is split
// into a fan. Every triangulation of a planar polygon gives the same volume, moments and area vector; ears
// avoid folds.
//
// A polygon that is not planar gets a vertex at the mean of its corners and a fan around it. This does not
// depend on the corner that it starts with, and polygons that mirror each other in a coordinate plane get
// triangles that do, bit for bit; on four corners, the volume is the mean of those of both diagonals. Where
// such a fan would fold, because a corner hides others from the mean, the polygon is split by ear clipping.
//
// Source of ear clipping: G. H. Meisters, "Polygons have ears", American Mathematical Monthly 82 (1975).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Faces of three or more corners, counter-clockwise seen from outside.
struct Polygons {
  std::vector<std::int32_t> corners;  // vertex indices, one polygon after another
  std::vector<std::int64_t> ends;     // of each polygon: where it ends in `corners`, ascending

  std::size_t size() const { return ends.size(); }
  std::span<const std::int32_t> operator[](std::size_t i) const {
    const std::int64_t first = i == 0 ? 0 : ends[i - 1];
    return {corners.data() + first, static_cast<std::size_t>(ends[i] - first)};
  }
  void add(std::span<const std::int32_t> polygon) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
};

// How polygons were split, for the report.
struct PolygonSplit {
  std::int64_t polygons = 0;      // faces of four or more corners
  std::int64_t non_planar = 0;    // of these
  std::int64_t centers = 0;       // vertices added
  double largest_distance = 0.0;  // of a corner from the plane amid its polygon's corners [m]
  // Of all non-planar polygons: between the largest and the smallest volume that triangulations without
  // further vertices give [m^3]. For more than 16 corners it is an upper bound, area times thickness.
  double split_volume = 0.0;
};

// Says whether polygons that are not planar get a vertex at their mean. Without it they are split as planar
// ones are.
enum class AddCenters { kNo, kYes };

// Appends the triangles of the polygons to mesh.triangles, in order, and the added vertices to its vertices.
// Triangles stay as they are. In larger polygons, consecutive corners at the same place count once. Requires
// finite coordinates, valid indices and at least three corners per polygon. Complexity: O(n log n) for a
// polygon of n corners in most cases. A search for ears that takes more than about 3 us per corner and 10 ms
// per polygon ends, and the rest is split into a fan.
PolygonSplit triangulate(const Polygons& polygons, TriangleMesh& mesh, AddCenters centers = AddCenters::kYes);

}  // namespace buoyancy
