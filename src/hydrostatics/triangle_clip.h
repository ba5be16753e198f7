// Clips a triangle to its wet part. This code, for any number type, defines what is wet; the SIMD kernels
// follow it.
//
// Rules: a vertex is wet where its signed height z < 0; a vertex on the plane is dry. A cut point has height
// exactly 0 and is interpolated from the wet vertex to the dry one, so that the two triangles of an edge find
// the same point, bit for bit. The wet part keeps the triangle's orientation: it is a triangle (one vertex
// wet; paper, figure 3) or a quadrilateral (two vertices wet), split into two triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "hydrostatics/point.h"

namespace buoyancy {

// The corner of a triangle that is alone on its side of the water, or 0 if none is, indexed by three bits
// that tell which of a, b and c are wet. A table is faster than a branch, which cannot be predicted.
inline constexpr std::array<std::uint8_t, 8> kOddOneOut{0, 0, 1, 2, 2, 1, 0, 0};

// A point of the surface about the mesh's centre, and its signed height over the water.
template <typename T>
struct ClipVertex {
  Point<T> y;  // [m]
  T z;         // [m]

  bool wet() const { return z < T(0); }
};

// Returns the point where the edge from a wet to a dry corner meets the water.
template <typename T>
ClipVertex<T> intersect_edge(const ClipVertex<T>& wet, const ClipVertex<T>& dry) {
  const T share = wet.z / (wet.z - dry.z);
  return {wet.y + share * (dry.y - wet.y), T(0)};
}

// Calls visit(a, b, c) for the one or two wet triangles of a triangle that has both wet and dry corners.
template <typename T, typename Visit>
void for_each_wet_triangle(const ClipVertex<T>& a, const ClipVertex<T>& b, const ClipVertex<T>& c,
                           Visit&& visit) {
  // Rotates the corners so that p differs from the two others.
  const auto mask = static_cast<unsigned>(a.wet()) + 2 * static_cast<unsigned>(b.wet()) +
                    4 * static_cast<unsigned>(c.wet());
  const std::array<const ClipVertex<T>*, 5> corners{&a, &b, &c, &a, &b};
  const std::size_t first = kOddOneOut[mask];
  const ClipVertex<T>& p = *corners[first];
  const ClipVertex<T>& q = *corners[first + 1];
  const ClipVertex<T>& r = *corners[first + 2];
  if (p.wet()) {
    visit(p, intersect_edge(p, q), intersect_edge(p, r));
  } else {
    const ClipVertex<T> on_pq = intersect_edge(q, p);
    const ClipVertex<T> on_rp = intersect_edge(r, p);
    visit(on_pq, q, r);
    visit(on_pq, r, on_rp);
  }
}

}  // namespace buoyancy
