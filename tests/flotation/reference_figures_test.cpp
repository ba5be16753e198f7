// Closed forms of naval architecture that a hydrostatic program has to meet.
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "flotation/hydrostatic_table.h"
#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kPi = std::numbers::pi;
const Water kWater;

// A regular polygon of n corners on a circle: its area, and its second moment about any axis in its plane
// through its centre.
struct Polygon {
  Polygon(int corners, double radius)
      : area(0.5 * corners * radius * radius * std::sin(2.0 * kPi / corners)),
        second_moment(area * radius * radius * (2.0 + std::cos(2.0 * kPi / corners)) / 12.0) {}

  double area;           // [m^2]
  double second_moment;  // [m^4]
};

HydrostaticRow row_of(const HydrostaticMesh& mesh, double draft, const HydrostaticTableOptions& options = {},
                      double trim = 0.0) {
  const FloatingBody body = body_of(mesh, 0.5);
  return HydrostaticTable::make(body, kWater, options).value().row(draft, trim).value();
}

// A prism that stands on its base, with any number of sides.
TEST(ReferenceFigures, UprightPrismIsThatOfItsPolygon) {
  for (const int sides : {3, 5, 64}) {
    SCOPED_TRACE(sides);
    const double radius = 1.7;
    const double height = 2.0;
    const HydrostaticMesh mesh = mesh_of(CylinderShape{radius, height, sides, 3});
    const Polygon polygon(sides, radius);
    for (const double draft : {0.1, 0.9, 1.9}) {
      const HydrostaticRow row = row_of(mesh, draft);
      EXPECT_NEAR(row.volume, polygon.area * draft, 1e-12);
      EXPECT_NEAR(row.kb, 0.5 * draft, 1e-13);
      EXPECT_NEAR(row.waterplane_area, polygon.area, 1e-12);
      EXPECT_NEAR(row.bm_t, polygon.second_moment / row.volume, 1e-11);
      EXPECT_NEAR(row.bm_l, polygon.second_moment / row.volume, 1e-11);
      EXPECT_NEAR(row.wetted_area, polygon.area + 2.0 * sides * radius * std::sin(kPi / sides) * draft,
                  1e-11);
    }
  }
}

// A circular cylinder that lies in the water: KB is that of a circular segment, and the metacentre is on the
// axis at every draught. The error is of second order in the mesh.
TEST(ReferenceFigures, LyingCylinderHasItsMetacentreOnTheAxis) {
  const double radius = 1.0;
  const double length = 5.0;
  HydrostaticTableOptions lying;
  lying.axes = make_ship_axes(Vec3::UnitZ(), Vec3::UnitX()).value();
  for (const double draft : {0.3, 1.0, 1.6}) {
    SCOPED_TRACE(draft);
    double last = std::numeric_limits<double>::infinity();
    for (const int sides : {40, 80, 160}) {
      const HydrostaticRow row = row_of(mesh_of(CylinderShape{radius, length, sides, 2}), draft, lying);
      const double half_angle = std::acos(1.0 - draft / radius);
      const double section = radius * radius * (half_angle - 0.5 * std::sin(2.0 * half_angle));
      const double half_beam = radius * std::sin(half_angle);
      const double centroid = radius - 2.0 / 3.0 * std::pow(half_beam, 3) / section;  // over K
      const double error = std::max({std::abs(row.volume / (section * length) - 1.0),
                                     std::abs(row.kb - centroid), std::abs(row.km_t - radius)});
      EXPECT_LT(error, last / 3.0) << sides;
      EXPECT_NEAR(row.bm_l * row.volume, 2.0 * half_beam * std::pow(length, 3) / 12.0, 2.0 / sides);
      last = error;
    }
    EXPECT_LT(last, 3e-3);
  }
}

// A triangular prism on an edge: V = L T^2 tan(a), KB = 2/3 T, BMt = 2/3 T tan^2(a), BMl = L^2/(6 T), with a
// the half angle of the edge.
TEST(ReferenceFigures, PrismOnAnEdgeHasItsClosedForm) {
  const double length = 6.0;
  const HydrostaticMesh mesh = mesh_of(CylinderShape{1.0, length, 3, 4});
  HydrostaticTableOptions on_edge;  // the corner at +x is the lowest
  on_edge.axes = make_ship_axes(Vec3::UnitZ(), -Vec3::UnitX()).value();
  const double tangent = std::tan(kPi / 6.0);
  for (const double draft : {0.2, 0.8, 1.4}) {
    const HydrostaticRow row = row_of(mesh, draft, on_edge);
    EXPECT_NEAR(row.volume, length * draft * draft * tangent, 1e-13);
    EXPECT_NEAR(row.kb, 2.0 / 3.0 * draft, 1e-13);
    EXPECT_NEAR(row.bm_t, 2.0 / 3.0 * draft * tangent * tangent, 1e-12);
    EXPECT_NEAR(row.bm_l, length * length / (6.0 * draft), 1e-11);
  }
}

// A cone on its apex: V = A T/3, KB = 3/4 T, BM = 3 I/(A T), with A and I of the waterplane: 3 r^2/(4 T) for
// a circle.
TEST(ReferenceFigures, ConeOnItsApexHasItsClosedForm) {
  const double radius = 0.8;
  const double height = 2.0;
  HydrostaticTableOptions on_apex;
  on_apex.axes = make_ship_axes(Vec3::UnitX(), -Vec3::UnitZ()).value();
  for (const int sides : {4, 7, 96}) {
    SCOPED_TRACE(sides);
    const HydrostaticMesh mesh = mesh_of(ConeShape{radius, height, sides, 3});
    // A part of 1e-9 of the volume keeps its digits.
    for (const double draft : {2e-3, 0.3, 1.2, 1.9}) {
      const Polygon waterplane(sides, radius * draft / height);
      const HydrostaticRow row = row_of(mesh, draft, on_apex);
      EXPECT_NEAR(row.volume / (waterplane.area * draft / 3.0), 1.0, draft < 0.01 ? 1e-9 : 1e-12);
      EXPECT_NEAR(row.kb / draft, 0.75, draft < 0.01 ? 1e-9 : 1e-12);
      if (draft < 0.01) continue;
      EXPECT_NEAR(row.bm_t, 3.0 * waterplane.second_moment / (waterplane.area * draft), 1e-12);
      EXPECT_NEAR(row.bm_l, row.bm_t, 1e-12);
    }
  }
}

// A wedge-shaped barge: an equilateral triangle in plan. BM is about the waterplane's own centroid with the
// origin at the aft perpendicular; about the origin it would be larger by A x_F^2/V.
TEST(ReferenceFigures, LongitudinalRadiusIsAboutTheCentroidOfTheWaterplane) {
  const double radius = 4.0;
  const double draft = 1.0;
  const TriangleMesh centred = make_shape(CylinderShape{radius, 2.0, 3, 1});
  const double aft = -0.5 * radius;  // the middle of the side opposite the corner at +x
  const HydrostaticMesh mesh = make_hydrostatic_mesh({moved_and_scaled(centred, Vec3(-aft, 0, 0)), {}});
  HydrostaticTableOptions options;
  options.aft_perpendicular = 0.0;
  options.forward_perpendicular = 1.5 * radius;
  const HydrostaticRow row = row_of(mesh, draft, options);
  const Polygon waterplane(3, radius);
  const double from_origin = row.lcf + 0.75 * radius;  // x_F; lcf is measured from midship
  EXPECT_NEAR(from_origin, 0.5 * radius, 1e-13);
  EXPECT_NEAR(row.bm_l, waterplane.second_moment / (waterplane.area * draft), 1e-12);
  EXPECT_NEAR(row.bm_t, row.bm_l, 1e-12);
  EXPECT_NEAR(row.bm_l, radius * radius / (8.0 * draft), 1e-12);
  EXPECT_GT(from_origin * from_origin / draft, row.bm_l);  // what the wrong one would add
}

}  // namespace
}  // namespace buoyancy
