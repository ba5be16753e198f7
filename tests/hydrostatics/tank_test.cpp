// The liquid in a tank: its volume, its centre and its free surface, at any attitude.
#include "hydrostatics/tank.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "tests/hydrostatics/climb.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/ball.h"

namespace buoyancy {
namespace {

Tank filled(const HydrostaticMesh& mesh, double fill, double density = 850.0) {
  return {.mesh = &mesh, .liquid_volume = fill * mesh.volume, .density = density};
}

// [J] over g: the liquid's weight at its centre's height over the mesh's centre.
double energy_of(const Tank& tank, const Vec3& up_B) {
  return tank.liquid_mass() * up_B.dot(tank_liquid(tank, up_B).centroid);
}

// A unit vector, turned from up by an angle towards another direction.
Vec3 turned(const Vec3& up, const Vec3& towards, double angle) {
  const Vec3 across = (towards - towards.dot(up) * up).normalized();
  return std::cos(angle) * up + std::sin(angle) * across;
}

// The error of the volume under the surface that was found, over its bound.
double volume_ratio(const HydrostaticMesh& mesh, RandomPoses& random) {
  const Tank tank = filled(mesh, random.uniform(0.02, 0.98));
  const TankLiquid liquid = tank_liquid(tank, random.direction());
  EXPECT_TRUE(liquid.has_free_surface);
  EXPECT_NEAR(liquid.volume / tank.liquid_volume, 1.0, 1e-12);
  const Water surface{.up_W = liquid.surface.up_B, .level = liquid.surface.h_c};
  const Ball truth = exact_displacement<Ball>(mesh.surface, Pose{}, surface).volume;
  return static_cast<double>(std::max(truth.distance(tank.liquid_volume), truth.distance(liquid.volume))) /
         liquid.volume_error;
}

TEST(TankLiquid, KeepsItsVolumeAtEveryAttitude) {
  for (const NamedMesh& named : closed_test_meshes()) {
    SCOPED_TRACE(named.name);
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    EXPECT_LE(highest(71, {.draws = 60, .climbs = 0},
                      [&mesh](RandomPoses& random) { return volume_ratio(mesh, random); }),
              1.0);
  }
}

TEST(TankLiquid, IsTheSameAfterAnyOtherAttitude) {
  const HydrostaticMesh mesh = mesh_of(TorusKnotShape{});
  const Tank tank = filled(mesh, 0.3);
  RandomPoses random(72);
  const Vec3 up_B = random.direction();
  const TankLiquid first = tank_liquid(tank, up_B);
  for (int i = 0; i < 20; ++i) tank_liquid(tank, random.direction());
  EXPECT_EQ(tank_liquid(tank, up_B).centroid, first.centroid);
  EXPECT_EQ(tank_liquid(tank, up_B).surface.h_c, first.surface.h_c);
}

TEST(TankLiquid, FollowsTheWallSidedFormula) {
  const double length = 5.0;
  const double breadth = 2.0;
  const HydrostaticMesh mesh = mesh_of(BoxShape{.size = {length, breadth, 1.5}});
  const Tank tank = filled(mesh, 0.5);
  const double i = length * breadth * breadth * breadth / 12.0;
  for (const double degrees : {0.0, 1.0, 10.0, 20.0, 30.0}) {
    const double tangent = std::tan(degrees * M_PI / 180.0);
    const Vec3 up_B = turned(Vec3::UnitZ(), Vec3::UnitY(), degrees * M_PI / 180.0);
    const TankLiquid liquid = tank_liquid(tank, up_B);
    // The liquid runs to the low side, away from where up leans to.
    const Vec3 expected(0.0, -i * tangent / tank.liquid_volume,
                        -0.375 + 0.5 * i * tangent * tangent / tank.liquid_volume);
    EXPECT_LE((liquid.centroid - expected).norm(), 1e-13) << degrees;
  }
}

TEST(TankLiquid, HasTheSecondMomentsOfItsFreeSurface) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{.size = {5.0, 2.0, 1.5}});
  const Tank tank = filled(mesh, 0.4);
  const Mat3 moments = free_surface_second_moments(tank, tank_liquid(tank, Vec3::UnitZ()));
  EXPECT_NEAR(moments(0, 0), 2.0 * 125.0 / 12.0, 1e-12);
  EXPECT_NEAR(moments(1, 1), 5.0 * 8.0 / 12.0, 1e-12);
  EXPECT_NEAR(moments(0, 1), 0.0, 1e-12);
  EXPECT_NEAR(moments(2, 2), 0.0, 1e-12);
}

// The centre is where the energy has its derivative, and the second moments are its curvature.
TEST(TankLiquid, AgreesWithItsEnergyOverTheAttitudes) {
  RandomPoses random(73);
  for (const Shape& shape : {Shape(RockShape{.frequency = 6}), Shape(TorusKnotShape{}), Shape(ConeShape{})}) {
    const HydrostaticMesh mesh = mesh_of(shape);
    for (int i = 0; i < 20; ++i) {
      const Tank tank = filled(mesh, random.uniform(0.1, 0.9));
      const Vec3 up_B = random.direction();
      const Vec3 towards = up_B.cross(random.direction()).normalized();
      const TankLiquid liquid = tank_liquid(tank, up_B);
      const double slope = tank.liquid_mass() * towards.dot(liquid.centroid);
      const double curvature =
          -tank.density * towards.dot(free_surface_second_moments(tank, liquid) * towards) -
          tank.liquid_mass() * up_B.dot(liquid.centroid);
      const double step = 1e-4;
      const double before = energy_of(tank, turned(up_B, towards, -step));
      const double after = energy_of(tank, turned(up_B, towards, step));
      const double scale = tank.liquid_mass() * mesh.diagonal;
      EXPECT_NEAR((after - before) / (2.0 * step), slope, 1e-6 * scale);
      EXPECT_NEAR((after - 2.0 * energy_of(tank, up_B) + before) / (step * step), curvature, 1e-3 * scale);
    }
  }
}

TEST(TankLiquid, HasNoFreeSurfaceWhereItIsEmptyOrFull) {
  const HydrostaticMesh mesh = mesh_of(SphereShape{});
  const TankLiquid empty = tank_liquid(filled(mesh, 0.0), Vec3::UnitX());
  EXPECT_FALSE(empty.has_free_surface);
  EXPECT_EQ(empty.centroid, Vec3::Zero());
  EXPECT_EQ(empty.volume, 0.0);
  const TankLiquid full = tank_liquid(filled(mesh, 1.0), Vec3::UnitX());
  EXPECT_FALSE(full.has_free_surface);
  EXPECT_EQ(full.centroid, mesh.centroid);
  EXPECT_EQ(free_surface_second_moments(filled(mesh, 1.0), full), Mat3::Zero());
}

TEST(TankLiquid, KeepsATraceOfLiquid) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 4});
  for (const double fill : {1e-9, 1e-6, 1e-3, 1.0 - 1e-6}) {
    const Tank tank = filled(mesh, fill);
    const TankLiquid liquid = tank_liquid(tank, Vec3(0.6, 0.0, 0.8));
    EXPECT_LE(std::abs(liquid.volume - tank.liquid_volume), liquid.volume_error) << fill;
    EXPECT_LE(std::abs(liquid.volume - tank.liquid_volume), 4e-16 * mesh.volume) << fill;
  }
}

TEST(TankWithAPiston, HasItsCentreAtTheFilledShareOfABox) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{.size = {5.0, 2.0, 1.5}});
  RandomPoses random(74);
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)}) {
    for (const double fill : {0.1, 0.5, 0.9}) {
      Tank tank = filled(mesh, fill);
      tank.piston_axis_B = axis;
      const double length = std::abs(axis.dot(Vec3(5.0, 2.0, 1.5)));
      const TankLiquid liquid = tank_liquid(tank, random.direction());
      EXPECT_LE((liquid.centroid - 0.5 * (fill - 1.0) * length * axis).norm(), 1e-14) << fill;
      EXPECT_NEAR(liquid.surface.h_c, (fill - 0.5) * length, 1e-14) << fill;
      EXPECT_EQ(tank_liquid(tank, random.direction()).centroid, liquid.centroid);
      EXPECT_FALSE(liquid.has_free_surface);
      EXPECT_EQ(free_surface_second_moments(tank, liquid), Mat3::Zero());
      EXPECT_LE(std::abs(liquid.volume - tank.liquid_volume), liquid.volume_error);
    }
  }
}

// From its apex on, a cone is filled as far as the cube root of the share.
TEST(TankWithAPiston, FillsAConeByTheCubeOfTheLength) {
  const HydrostaticMesh mesh = mesh_of(ConeShape{});
  const double height = mesh.box_max.z() - mesh.box_min.z();
  for (const double fill : {0.01, 0.3, 0.8}) {
    Tank tank = filled(mesh, fill);
    tank.piston_axis_B = -Vec3::UnitZ();
    const double length = height * std::cbrt(fill);
    const TankLiquid liquid = tank_liquid(tank, Vec3::UnitX());
    EXPECT_NEAR(liquid.centroid.z(), mesh.box_max.z() - 0.75 * length, 1e-13) << fill;
    EXPECT_NEAR(-liquid.surface.h_c, mesh.box_max.z() - length, 1e-13) << fill;
  }
}

}  // namespace
}  // namespace buoyancy
