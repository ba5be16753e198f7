#include "tests/wave_loads/reference_load.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/wave_loads/brute_force.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SeaDescription three_waves(WavePressure pressure, double depth) {
  SeaDescription description;
  description.pressure = pressure;
  description.depth = depth;
  description.systems = {
      WaveComponents{{0.2, 2.0, 30.0, 40.0}, {0.1, 3.0, -60.0, 140.0}, {0.02, 5.0, 170.0, 300.0}}};
  return description;
}

TEST(ReferenceLoad, AgreesWithUniformSubdivision) {
  RandomPoses random(1);
  for (const double depth : {kInfinity, 3.0}) {
    for (const WavePressure pressure : {WavePressure::kWheeler, WavePressure::kHydrostatic}) {
      const TriangleMesh mesh = make_shape(RockShape{1.0, 3, 0.4, random.pick(1000)});
      const HydrostaticMesh body = make_hydrostatic_mesh(ValidatedMesh{mesh, {}}, WithTree::kNo);
      Water water;
      water.level = random.uniform(-2.0, 2.0);
      const Sea sea = Sea::make(three_waves(pressure, depth), water).value();
      Pose pose;
      pose.q_WB = random.rotation();
      pose.p_WB = {random.uniform(-50.0, 50.0), random.uniform(-50.0, 50.0), water.level};
      SeaSnapshot snapshot(sea);
      snapshot.set_time(12'345'678, 0.02);
      const Vec3 reference_B(0.3, -0.2, 0.5);
      const BruteForceLoad uniform =
          brute_force_load(body.surface, body.center_B, snapshot, pose, reference_B, 48);
      const ReferenceSea reference(sea, 12'345'678, 0.02, pose, body.center_B);
      const ReferenceLoad load =
          reference_load(mesh, body.center_B, reference, reference_B,
                         {.force_error = 1e-4, .torque_error = 1e-4, .volume_error = 1e-4});
      EXPECT_TRUE(load.resolved);
      EXPECT_LE((load.force - uniform.force).norm(), load.force_error + uniform.force_error);
      EXPECT_LE((load.torque - uniform.torque).norm(), load.torque_error + uniform.torque_error);
      EXPECT_NEAR(load.volume, uniform.volume, load.volume_error + uniform.force_error);
    }
  }
}

TEST(ReferenceLoad, SaysThatItsWorkDidNotSuffice) {
  const TriangleMesh mesh = make_shape(BoxShape{{30.0, 20.0, 2.0}, {1, 1, 1}});
  const HydrostaticMesh body = make_hydrostatic_mesh(ValidatedMesh{mesh, {}}, WithTree::kNo);
  const Sea sea = Sea::make(three_waves(WavePressure::kWheeler, kInfinity), Water{}).value();
  const ReferenceSea reference(sea, 0, 0.0, Pose{}, body.center_B);
  const ReferenceLoad load =
      reference_load(mesh, body.center_B, reference, Vec3::Zero(),
                     {.force_error = 1e-6, .torque_error = 1e-6, .volume_error = 1e-6, .max_work = 20'000});
  EXPECT_FALSE(load.resolved);
  EXPECT_GT(load.force_error, 1e-6);
}

TEST(ReferenceSea, AgreesWithTheSnapshotFarAwayAndToday) {
  Water water;
  water.up_W = Vec3(0.2, -0.5, 0.8).normalized();
  water.level = 3.0;
  SeaDescription description = three_waves(WavePressure::kWheeler, 4.0);
  description.ramp = 100.0;
  description.time_origin = 1'790'000'000'000'000;
  const Sea sea = Sea::make(description, water).value();
  Pose pose;
  pose.q_WB = Eigen::Quaterniond(0.3, 0.5, -0.2, 0.7).normalized();
  pose.p_WB = 1e6 * sea.axes().e1_W - 4e5 * sea.axes().e2_W + 2.5 * water.up_W;
  const std::int64_t utime = description.time_origin + 40'000'000;
  SeaSnapshot snapshot(sea);
  snapshot.set_time(utime, 0.05);
  const ReferenceSea reference(sea, utime, 0.05, pose, Vec3(1.0, 2.0, -1.0));
  SeaPoints points;
  points.add({0.1, 0.2, -0.4});
  points.add({-1.1, 0.7, 0.3});
  reference.set_pressures(points);
  int wet = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 x_B = Vec3(points.x[i], points.y[i], points.z[i]) + Vec3(1.0, 2.0, -1.0);
    const WaterAtPoint at = snapshot.at(pose.p_WB + pose.q_WB * x_B);
    EXPECT_NEAR(at.height, points.height[i], 2e-9);
    if (at.height >= 0.0) continue;
    ++wet;
    EXPECT_NEAR(at.pressure / (water.density * water.gravity), points.pressure[i], 4e-9);
  }
  EXPECT_GT(wet, 0);
  EXPECT_LE(reference.error(), 1e-8);
}

}  // namespace
}  // namespace buoyancy
