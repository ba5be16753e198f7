#include "flotation/hydrostatic_table.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

const Water kWater;

HydrostaticTable table_of(const FloatingBody& body, const HydrostaticTableOptions& options = {}) {
  return HydrostaticTable::make(body, kWater, options).value();
}

TEST(HydrostaticTable, OfABoxHasItsClosedForm) {
  const double length = 60.0;
  const double beam = 20.0;
  const HydrostaticMesh mesh = make_hydrostatic_mesh(
      {moved_and_scaled(make_shape(BoxShape{{length, beam, 12}, {3, 2, 2}}), Vec3(5, 1, 6)), {}});
  const FloatingBody body = body_of(mesh, 0.5, Vec3(5, 1, 8));
  const HydrostaticTable table = table_of(body);
  EXPECT_EQ(table.keel(), 0.0);
  EXPECT_EQ(table.midship(), 5.0);
  EXPECT_EQ(table.length_between_perpendiculars(), length);
  for (const double draft : {0.5, 3.0, 6.0, 11.0}) {
    const auto row = table.row(draft);
    ASSERT_TRUE(row);
    const double volume = length * beam * draft;
    EXPECT_NEAR(row->volume, volume, 1e-10);
    EXPECT_NEAR(row->mass, 1025.0 * volume, 1e-7);
    EXPECT_NEAR(row->lcb, 0.0, 1e-12);
    EXPECT_NEAR(row->tcb, 1.0, 1e-12);
    EXPECT_NEAR(row->kb, draft / 2, 1e-12);
    EXPECT_NEAR(row->lcf, 0.0, 1e-12);
    EXPECT_NEAR(row->waterplane_area, length * beam, 1e-10);
    EXPECT_NEAR(row->bm_t, beam * beam / (12 * draft), 1e-10);
    EXPECT_NEAR(row->bm_l, length * length / (12 * draft), 1e-9);
    EXPECT_NEAR(row->km_t, row->kb + row->bm_t, 1e-12);
    EXPECT_NEAR(row->km_l, row->kb + row->bm_l, 1e-12);
    EXPECT_NEAR(row->mass_per_cm, 10.25 * length * beam, 1e-8);
    EXPECT_NEAR(row->moment_per_cm, row->mass * (row->km_l - 8.0) / (100 * length), 1e-7);
    EXPECT_NEAR(row->moment_per_degree, row->mass * (row->km_t - 8.0) * std::sin(std::numbers::pi / 180),
                1e-6);
    EXPECT_NEAR(row->wetted_area, length * beam + 2 * (length + beam) * draft, 1e-10);
    EXPECT_NEAR(row->lwl, length, 1e-12);
    EXPECT_NEAR(row->bwl, beam, 1e-12);
    EXPECT_NEAR(row->midship, 1.0, 1e-13);
    for (const FormCoefficients& on : {row->on_lpp, row->on_lwl}) {
      EXPECT_NEAR(on.length, length, 1e-12);
      EXPECT_NEAR(on.block, 1.0, 1e-12);
      EXPECT_NEAR(on.prismatic, 1.0, 1e-12);
      EXPECT_NEAR(on.waterplane, 1.0, 1e-12);
    }
  }
}

// A trimmed box, by the trapezoid under water.
TEST(HydrostaticTable, OfATrimmedBoxHasItsClosedForm) {
  const double length = 40.0;
  const double beam = 10.0;
  const HydrostaticMesh mesh = mesh_of(BoxShape{{length, beam, 8}, {3, 2, 2}});
  const FloatingBody body = body_of(mesh, 0.5);
  const double trim = 0.05;
  const double draft = 4.0;
  const auto row = table_of(body).row(draft, trim);
  ASSERT_TRUE(row);
  // Along the base line the draft grows aft: T(x) = T - x tan trim.
  const double slope = std::tan(trim);
  const double area = length * draft;
  EXPECT_NEAR(row->volume, area * beam, 1e-11);
  EXPECT_NEAR(row->lcb, -slope * length * length * length / 12.0 / area, 1e-12);
  EXPECT_NEAR(row->kb, (draft * draft * length + slope * slope * std::pow(length, 3) / 12.0) / 2.0 / area,
              1e-12);
  const double along = length / std::cos(trim);
  EXPECT_NEAR(row->lwl, along, 1e-12);
  EXPECT_NEAR(row->bm_l, along * along * along * beam / 12.0 / row->volume, 1e-11);
  EXPECT_NEAR(row->bm_t, along * beam * beam * beam / 12.0 / row->volume, 1e-11);
  EXPECT_NEAR(row->km_t, row->kb + row->bm_t * std::cos(trim), 1e-13);
  EXPECT_NEAR(row->lcf, 0.0, 1e-12);
  EXPECT_NEAR(row->on_lwl.block, row->volume / (along * beam * draft), 1e-13);
  EXPECT_NEAR(row->on_lpp.block, 1.0, 1e-12);
}

TEST(HydrostaticTable, OfAWigleyHullConvergesToItsClosedFormQuadratically) {
  double last = std::numeric_limits<double>::infinity();
  for (const int refinement : {1, 2, 4, 8}) {
    const WigleyShape hull{.segments = 16 * refinement, .levels = 4 * refinement};
    const HydrostaticMesh mesh = mesh_of(hull);
    const FloatingBody body = body_of(mesh, 0.4, Vec3(0, 0, -0.2));
    const auto row = table_of(body).row(hull.draft);
    ASSERT_TRUE(row);
    const double L = hull.length;
    const double B = hull.beam;
    const double T = hull.draft;
    const double error = std::max(
        {std::abs(row->volume / (4 * L * B * T / 9) - 1), std::abs(row->kb / (5 * T / 8) - 1),
         std::abs(row->bm_t / (3 * B * B / (35 * T)) - 1), std::abs(row->bm_l / (3 * L * L / (40 * T)) - 1),
         std::abs(row->on_lpp.block / (4.0 / 9.0) - 1), std::abs(row->midship / (2.0 / 3.0) - 1),
         std::abs(row->on_lpp.prismatic / (2.0 / 3.0) - 1),
         std::abs(row->on_lpp.waterplane / (2.0 / 3.0) - 1)});
    EXPECT_NEAR(row->lwl, L, 1e-12);
    EXPECT_NEAR(row->bwl, B, 1e-12);
    EXPECT_LT(error, last / 3.5) << refinement;
    last = error;
  }
  EXPECT_LT(last, 1e-3);
}

// BM is about the waterplane's own centroid wherever B's origin lies.
TEST(HydrostaticTable, DoesNotDependOnTheOriginOfTheMesh) {
  const TriangleMesh rock = make_shape(RockShape{.radius = 4, .frequency = 8, .roughness = 0.4, .seed = 6});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  const HydrostaticMesh moved = make_hydrostatic_mesh({moved_and_scaled(rock, Vec3(128, 0, -32)), {}});
  const FloatingBody body = body_of(mesh, 0.5, Vec3(0.1, 0.2, 0.3));
  const FloatingBody other = body_of(moved, 0.5, Vec3(128.1, 0.2, -31.7));
  for (const double trim : {-0.2, 0.0, 0.1}) {
    const auto a = table_of(body).row(3.0, trim);
    const auto b = table_of(other).row(3.0, trim);
    EXPECT_NEAR(a->volume, b->volume, 1e-9);
    EXPECT_NEAR(a->lcb, b->lcb, 1e-10);
    EXPECT_NEAR(a->lcf, b->lcf, 1e-10);
    EXPECT_NEAR(a->bm_l, b->bm_l, 1e-9);
    EXPECT_NEAR(a->km_t, b->km_t, 1e-9);
    EXPECT_NEAR(a->moment_per_cm, b->moment_per_cm, 1e-6);
    EXPECT_NEAR(a->midship_area, b->midship_area, 1e-9);
  }
}

TEST(HydrostaticTable, TakesPerpendicularsAndKeel) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{{60, 20, 12}, {1, 1, 1}});
  const FloatingBody body = body_of(mesh, 0.5);
  HydrostaticTableOptions options;
  options.keel = -5.0;
  options.aft_perpendicular = -28.0;
  options.forward_perpendicular = 22.0;
  const HydrostaticTable table = table_of(body, options);
  const auto row = table.row(5.0);
  EXPECT_NEAR(row->lcb, 3.0, 1e-12);
  EXPECT_NEAR(row->kb, 2.0, 1e-12);
  EXPECT_NEAR(row->on_lpp.length, 50.0, 1e-12);
  EXPECT_NEAR(row->on_lwl.length, 60.0, 1e-12);
  options.aft_perpendicular = 30.0;
  const auto wrong = HydrostaticTable::make(body, kWater, options);
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(contains(wrong.error().message(), "perpendicular"));
}

TEST(HydrostaticTable, HasNoCentreWhereNothingIsDisplaced) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  const FloatingBody body = body_of(mesh, 0.5);
  const auto dry = table_of(body).row(-0.1);
  ASSERT_TRUE(dry);
  EXPECT_EQ(dry->volume, 0.0);
  EXPECT_TRUE(std::isnan(dry->kb));
  EXPECT_TRUE(std::isnan(dry->lcf));
  const auto submerged = table_of(body).row(2.0);
  EXPECT_NEAR(submerged->volume, 1.0, 1e-15);
  EXPECT_EQ(submerged->waterplane_area, 0.0);
  EXPECT_EQ(submerged->bm_t, 0.0);
  EXPECT_NEAR(submerged->midship_area, 1.0, 1e-14);
}

}  // namespace
}  // namespace buoyancy
