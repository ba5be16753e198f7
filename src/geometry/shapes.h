// Generated closed meshes: shapes whose hydrostatics have a closed form, or that serve as benchmarks.
//
// Every mesh is welded, outward oriented, closed and, unless stated otherwise, centred on B's origin. Sizes
// are in metres, from 1e-9 to 1e9. The coordinates of spheres, knots and rocks are rounded to float32, as in
// a mesh file; those of the other shapes are double, so that their hydrostatics are those of the closed form.
// check_shape checks the arguments; make_shape requires a checked shape.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>

#include "base/error.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// Edges along x, y, z; each face is a grid of rectangles, two triangles each: 4 (ab + bc + ca) triangles for
// segments a, b, c. The two cubes of the paper, section 5, have segments 10 10 10 (1,200 triangles) and
// 100 100 100 (120,000).
struct BoxShape {
  std::array<double, 3> size{1, 1, 1};
  std::array<std::int32_t, 3> segments{1, 1, 1};

  bool operator==(const BoxShape&) const = default;
};
// n meridians and n + 1 bands of latitude between the poles along z: 2 n^2 triangles for n segments. Vertices
// lie on the sphere to within rounding. The two spheres of the paper, section 5, have n = 50 (5,000
// triangles) and n = 200 (80,000).
struct SphereShape {
  double radius = 1;
  std::int32_t segments = 50;

  bool operator==(const SphereShape&) const = default;
};
// A regular prism of `segments` sides, inscribed in the cylinder, with `stacks` bands along its axis z.
struct CylinderShape {
  double radius = 0.5;
  double height = 1;
  std::int32_t segments = 64;
  std::int32_t stacks = 1;

  bool operator==(const CylinderShape&) const = default;
};
// Axis along z, base circle of `radius` at z = 0, apex at z = height.
struct ConeShape {
  double radius = 0.5;
  double height = 1;
  std::int32_t segments = 64;
  std::int32_t stacks = 1;

  bool operator==(const ConeShape&) const = default;
};
// Tube of radius `tube` around the (p, q) torus knot of radius `radius`: the curve makes q turns about the z
// axis and p turns about the ring: (radius (2 + cos p t)/3 cos q t, ..). It has 2 tubular radial triangles;
// 110 x 8 gives the paper's 1,760.
struct TorusKnotShape {
  double radius = 1;
  double tube = 0.2;
  std::int32_t p = 3;  // p and q: 1 to 32, without a common divisor
  std::int32_t q = 2;
  std::int32_t tubular = 110;
  std::int32_t radial = 8;

  bool operator==(const TorusKnotShape&) const = default;
};
// The Wigley hull: y = beam/2 (1 - (2x/length)^2) (1 - (z/draft)^2) for -draft <= z <= 0, wall-sided above up
// to z = freeboard, with a flat deck. The length is along x and the waterplane at z = 0.
struct WigleyShape {
  double length = 10;
  double beam = 1;
  double draft = 0.625;
  double freeboard = 0.3;
  std::int32_t segments = 64;  // along the length
  std::int32_t levels = 16;    // along the draft

  bool operator==(const WigleyShape&) const = default;
};
// An icosphere of 20 frequency^2 triangles whose radius is perturbed by smooth noise of relative height
// `roughness` from `seed`: star-shaped, never self-intersecting. It is computed with +, -, *, / and sqrt
// only, so that every machine gives the same bits.
struct RockShape {
  double radius = 1;
  std::int32_t frequency = 16;
  double roughness = 0.25;  // 0 to 0.6
  std::uint64_t seed = 1;

  bool operator==(const RockShape&) const = default;
};

using Shape =
    std::variant<BoxShape, SphereShape, CylinderShape, ConeShape, TorusKnotShape, WigleyShape, RockShape>;

// Returns the shape's name in a scene file: "box", "torus_knot".
std::string_view type_name(const Shape& shape);

// Errors: sizes outside 1e-9 to 1e9 m, counts below the shape's minimum, more than 20,000,000 triangles, a
// knot whose p and q have a common divisor or whose tube is wider than 0.9 of the maximum radius without
// contact. The error states the key, the value and the range.
Expected<Shape> check_shape(const Shape& shape);

// Requires a shape that check_shape accepts.
TriangleMesh make_shape(const Shape& shape);

}  // namespace buoyancy
