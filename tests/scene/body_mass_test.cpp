#include "scene/body_mass.h"

#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "scene/floating_bodies.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

// A box of 400 kg with tanks.
Scene box_with(const std::string& tanks) {
  return scene_of(
      "[water]\ndensity = 1000\n[[body]]\nid = 1\nshape = { type = \"box\", size = [4, 2, 1] }\n" + tanks +
      "[body.client]\nmass = 400\ncenter_of_mass = [0.1, 0.2, -0.1]\n");
}

std::string tank(double fill, const std::string& more = "") {
  return "[[body.tank]]\nshape = { type = \"box\", size = [3, 1, 1] }\nposition = [1, 2, 3]\ndensity = "
         "800\n" +
         more + "fill = " + std::to_string(fill) + "\n";
}

Mat3 inertia_of_box(double mass, const Vec3& size) {
  const Vec3 squares = size.cwiseProduct(size);
  return mass / 12.0 * Mat3((squares.sum() * Vec3::Ones() - squares).asDiagonal());
}

Mat3 moved(const Mat3& inertia, double mass, const Vec3& distance) {
  return inertia + mass * (distance.squaredNorm() * Mat3::Identity() - distance * distance.transpose());
}

// The masses of the box and of a liquid of this mass, inertia and centroid.
void expect_sum(const Scene& scene, const Vec3& up_B, double mass, const Vec3& centroid, const Mat3& inertia,
                double tolerance) {
  const Body& body = scene.bodies().front();
  const RigidBodyMass own = mass_of_body(body, scene.water()).value();
  const RigidBodyMass sum = mass_with_liquids(body, own, nullptr, up_B);
  const double total = 400.0 + mass;
  EXPECT_NEAR(sum.mass, total, 1e-12 * total);
  const Vec3 center = (400.0 * own.center_of_mass_B + mass * centroid) / total;
  EXPECT_LE((sum.center_of_mass_B - center).norm(), 1e-13);
  const Mat3 expected =
      moved(own.inertia_B, 400.0, own.center_of_mass_B - center) + moved(inertia, mass, centroid - center);
  EXPECT_LE((sum.inertia_B - expected).norm(), tolerance * expected.norm());
}

TEST(BodyMass, AddsAFullTankAsASolid) {
  const Vec3 tilted = Vec3(0.3, -0.5, 0.7).normalized();
  expect_sum(box_with(tank(1.0)), tilted, 2400.0, {1, 2, 3}, inertia_of_box(2400.0, {3, 1, 1}), 1e-13);
}

TEST(BodyMass, AddsAPartlyFilledTankAsItsLiquidLies) {
  const Scene scene = box_with(tank(0.25));
  expect_sum(scene, Vec3::UnitZ(), 600.0, {1, 2, 2.625}, inertia_of_box(600.0, {3, 1, 0.25}), 1e-12);
  expect_sum(scene, -Vec3::UnitY(), 600.0, {1, 2.375, 3}, inertia_of_box(600.0, {3, 0.25, 1}), 1e-12);
}

TEST(BodyMass, AddsATiltedTankAsAPrism) {
  // Half full at 45 degrees the liquid is a right triangle, with its legs along y and z.
  const Scene scene = box_with(tank(0.5));
  Mat3 second = Mat3::Zero();  // of the triangle's section, per area: 1/18 and -1/36 of the legs' squares
  second(0, 0) = 9.0 / 12.0;
  second(1, 1) = second(2, 2) = 1.0 / 18.0;
  second(1, 2) = second(2, 1) = -1.0 / 36.0;
  const Mat3 inertia = 1200.0 * (second.trace() * Mat3::Identity() - second);
  expect_sum(scene, Vec3(0, 1, 1).normalized(), 1200.0, {1, 2 - 1.0 / 6.0, 3 - 1.0 / 6.0}, inertia, 1e-4);
}

TEST(BodyMass, LeavesEmptyTanksOut) {
  const Scene scene = box_with(tank(0.0));
  const RigidBodyMass own = mass_of_body(scene.bodies().front(), scene.water()).value();
  const RigidBodyMass sum = mass_with_liquids(scene.bodies().front(), own, nullptr, Vec3::UnitZ());
  EXPECT_EQ(sum.mass, own.mass);
  EXPECT_EQ(sum.center_of_mass_B, own.center_of_mass_B);
  EXPECT_EQ(sum.inertia_B, own.inertia_B);
}

TEST(BodyMass, StiffnessOfWeightsIsTheirDerivative) {
  const Scene scene =
      box_with(tank(0.4, "orientation = [0.9, 0.1, 0.2, 0.3]\n") +
               "[[body.tank]]\nshape = { type = \"sphere\", radius = 0.3, segments = 20 }\nfill = 0.7\n");
  const Body& body = scene.bodies().front();
  const Water& water = scene.water();
  const RigidBodyMass own = mass_of_body(body, water).value();
  const std::vector<Tank> tanks = tanks_of(body);
  const Vec3 about_B(0.3, -0.2, 0.5);
  const auto torque_W = [&](const Eigen::Quaterniond& q_WB) {
    const Vec3 up_B = q_WB.conjugate() * water.up_W;
    const LiquidSum liquids = liquid_sum(tanks, up_B, about_B, FreeSurfaces::kNo);
    const Vec3 moment_B = own.mass * (own.center_of_mass_B - about_B) + liquids.moment;
    return Vec3(-water.gravity * (q_WB * moment_B).cross(water.up_W));
  };
  const Eigen::Quaterniond q_WB = Eigen::Quaterniond(0.8, -0.3, 0.4, 0.1).normalized();
  const Mat6 stiffness = stiffness_of_weights(own, tanks, about_B, q_WB, water);
  constexpr double kStep = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    const auto turned = [&](double angle) {
      return torque_W(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::Unit(axis))) * q_WB);
    };
    const Vec3 derivative = (turned(kStep) - turned(-kStep)) / (2.0 * kStep);
    EXPECT_LE((stiffness.block<3, 1>(3, 3 + axis) + derivative).norm(), 1e-6 * stiffness.norm()) << axis;
  }
  EXPECT_EQ(stiffness.topRows<3>().norm(), 0.0);
  EXPECT_EQ(stiffness_of_weights(own, {}, about_B, q_WB, water), Mat6(Mat6::Zero()));
}

TEST(BodyMass, AddsTheLiquidOfAPistonAtEveryAttitude) {
  const Scene scene = box_with(tank(0.25, "surface = \"none\"\nfill_axis = \"x\"\n"));
  for (const Vec3& up_B : {Vec3(0, 0, 1), Vec3(0.48, -0.6, 0.64)}) {
    expect_sum(scene, up_B, 600.0, {-0.125, 2, 3}, inertia_of_box(600.0, {0.75, 1, 1}), 1e-12);
  }
}

}  // namespace
}  // namespace buoyancy
