// Tank tables against closed forms of box tanks.
#include "flotation/tank_table.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// 6 x 4 x 2 m, with its centre at (1, 2, 3).
class TankTable : public testing::Test {
 protected:
  TankTableRow row(const HeelTrim& angles, double sounding) const {
    return tank_table_row(tank_, axes_, angles, sounding_pipe(tank_, axes_), sounding);
  }

  HydrostaticMesh mesh_ =
      make_hydrostatic_mesh({moved_and_scaled(make_shape(BoxShape{{6, 4, 2}}), {1, 2, 3}), {}});
  Tank tank_{.mesh = &mesh_, .density = 900.0};
  ShipAxes axes_;
};

TEST_F(TankTable, HasVolumeCentreAndMomentsOfAnUprightBox) {
  const SoundingPipe pipe = sounding_pipe(tank_, axes_);
  EXPECT_LE((pipe.foot_B - Vec3(1, 2, 2)).norm(), 1e-14);
  EXPECT_NEAR(pipe.depth, 2.0, 1e-14);
  const TankTableRow at = row({}, 0.5);
  EXPECT_NEAR(at.volume, 12.0, 1e-13);
  EXPECT_NEAR(at.mass, 10800.0, 1e-10);
  EXPECT_LE((at.centroid_B - Vec3(1, 2, 2.25)).norm(), 1e-13);
  EXPECT_NEAR(at.free_surface_moment_t, 900.0 * 6.0 * 64.0 / 12.0, 1e-9);
  EXPECT_NEAR(at.free_surface_moment_l, 900.0 * 4.0 * 216.0 / 12.0, 1e-9);
}

TEST_F(TankTable, EndsWithAnEmptyAndAFullTank) {
  for (const double sounding : {-1.0, 0.0}) {
    const TankTableRow empty = row({}, sounding);
    EXPECT_EQ(empty.volume, 0.0);
    EXPECT_TRUE(std::isnan(empty.centroid_B.x()));
    EXPECT_EQ(empty.free_surface_moment_t, 0.0);
  }
  for (const double sounding : {2.0, 3.0}) {
    const TankTableRow full = row({}, sounding);
    EXPECT_EQ(full.volume, mesh_.volume);
    EXPECT_LE((full.centroid_B - Vec3(1, 2, 3)).norm(), 1e-13);
    EXPECT_EQ(full.free_surface_moment_t, 0.0);
    EXPECT_EQ(full.free_surface_moment_l, 0.0);
  }
}

// Wall-sided: a pipe in the middle reads the mean depth, and the surface is longer by the angle's cosine.
TEST_F(TankTable, ReadsTheMeanDepthInTheMiddleOfAWallSidedTank) {
  const double tangent = std::tan(10.0 * kDegree);
  const double cosine = std::cos(10.0 * kDegree);
  const TankTableRow heeled = row({.heel = 10.0 * kDegree}, 1.0);
  EXPECT_NEAR(heeled.volume, 24.0, 1e-12);
  EXPECT_NEAR(heeled.centroid_B.y(), 2.0 - 16.0 / 12.0 * tangent, 1e-12) << "to starboard";
  EXPECT_NEAR(heeled.centroid_B.z(), 2.5 + 16.0 / 24.0 * tangent * tangent, 1e-12);
  EXPECT_NEAR(heeled.free_surface_moment_t, 900.0 * 32.0 / (cosine * cosine * cosine), 1e-8);
  EXPECT_NEAR(heeled.free_surface_moment_l, 900.0 * 72.0 / cosine, 1e-8);
  const double slope = std::tan(5.0 * kDegree);
  const TankTableRow trimmed = row({.trim = 5.0 * kDegree}, 1.0);
  EXPECT_NEAR(trimmed.volume, 24.0, 1e-12);
  EXPECT_NEAR(trimmed.centroid_B.x(), 1.0 - 36.0 / 12.0 * slope, 1e-12) << "aft";
  EXPECT_NEAR(trimmed.free_surface_moment_l, 900.0 * 72.0 / std::pow(std::cos(5.0 * kDegree), 3), 1e-8);
}

// With a dry pipe at the high end, a wedge is left at the low one.
TEST_F(TankTable, LeavesAWedgeLowerThanThePipe) {
  const SoundingPipe forward = sounding_pipe(tank_, axes_, Vec3(4, 2, 2));
  EXPECT_NEAR(forward.depth, 2.0, 1e-14);
  const double rise = 6.0 * std::tan(10.0 * kDegree);
  const TankTableRow left = tank_table_row(tank_, axes_, {.trim = 10.0 * kDegree}, forward, 0.0);
  EXPECT_NEAR(left.volume, 0.5 * 6.0 * rise * 4.0, 1e-12);
  EXPECT_LE((left.centroid_B - Vec3(0, 2, 2.0 + rise / 3.0)).norm(), 1e-12);
}

TEST_F(TankTable, HasTheTravelOfAPistonAtAnyAttitude) {
  tank_.piston_axis_B = -Vec3::UnitX();
  EXPECT_NEAR(sounding_pipe(tank_, axes_, Vec3(7, 7, 7)).depth, 6.0, 1e-14);
  for (const HeelTrim& angles : {HeelTrim{}, HeelTrim{.heel = 0.5, .trim = -0.4}}) {
    const TankTableRow at = row(angles, 1.5);
    EXPECT_NEAR(at.volume, 12.0, 1e-13);
    EXPECT_LE((at.centroid_B - Vec3(3.25, 2, 3)).norm(), 1e-13);
    EXPECT_EQ(at.free_surface_moment_t, 0.0);
  }
}

}  // namespace
}  // namespace buoyancy
