#include "scene/start_pose.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "base/format.h"
#include "geometry/rotation_between.h"
#include "tests/geometry/mesh_files.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

// A bar of square section along x. world: sections before the body; client: lines of [body.client].
Scene bar(const std::string& client, const std::string& world = "[water]\ndensity = 1000\n") {
  return scene_of(world +
                  "[[body]]\nid = 1\nname = \"bar\"\nshape = { type = \"box\", size = [4, 1, 1] }\n"
                  "[body.client]\nstart = \"equilibrium\"\n" +
                  client);
}

DynamicsSpec start_of(const Scene& scene) {
  Expected<DynamicsSpec> start = StartFinder(scene).start_of(scene.bodies().front());
  if (!start) throw std::runtime_error(start.error().message());
  return *start;
}

std::string start_error(const Scene& scene) {
  const Expected<DynamicsSpec> start = StartFinder(scene).start_of(scene.bodies().front());
  return start ? "it starts" : start.error().message();
}

TEST(StartPose, IsThatOfTheSceneWithoutStart) {
  const Scene scene = scene_of(scene_with_crate("[body.client]\nposition = [1, 2, 3]\n"));
  const DynamicsSpec start = start_of(scene);
  EXPECT_EQ(start.position, Vec3(1, 2, 3));
  EXPECT_EQ(start.orientation.coeffs(), Eigen::Quaterniond::Identity().coeffs());
}

TEST(StartPose, TurnsAndSinksToTheEquilibrium) {
  // A relative density of 0.5 floats on its edge. The height in `position` plays no part.
  const Scene scene = bar("density = 500\nposition = [7, -5, 100]\norientation = [0.98, 0.2, 0, 0]\n",
                          "[water]\ndensity = 1000\nlevel = 3\n");
  const DynamicsSpec start = start_of(scene);
  EXPECT_LE((start.position - Vec3(7, -5, 3)).norm(), 1e-13);
  const Vec3 up_B = start.orientation.conjugate() * Vec3::UnitZ();
  EXPECT_LE((up_B - Vec3(0, std::sqrt(0.5), std::sqrt(0.5))).norm(), 1e-9);
  EXPECT_LE((start.orientation * Vec3::UnitX() - Vec3::UnitX()).norm(), 1e-9);
}

// The heading of a body axis [rad]: of its projection on the horizontal plane.
double heading_of(const Vec3& axis_W, const Vec3& up_W) {
  const Vec3 ahead_W = rotation_between(Vec3::UnitZ(), up_W).conjugate() * axis_W;
  return std::atan2(ahead_W.y(), ahead_W.x());
}

// Bars that float level, trimmed and on end, from every heading, pitch and heel, under several up directions:
// the heading is that of x, or of y where x is nearly vertical before or after.
TEST(StartPose, KeepsTheHeading) {
  std::array<int, 3> kept{};  // by axis
  for (const std::string client : {"density = 100\n", "density = 300\ncenter_of_mass = [0.25, 0.05, -0.4]\n",
                                   "density = 400\ncenter_of_mass = [-1.7, 0.02, 0]\n"}) {
    for (const Vec3& up_W : {Vec3(0, 0, 1), Vec3(0.3, -0.8, 0.2), Vec3(-1, 0, 0.1)}) {
      const std::string world =
          "[world]\nup = [" + format_vector(up_W) + "]\n[water]\ndensity = 1000\nlevel = 3\n";
      for (const double heading : {-170.0, -90.0, 35.0, 120.0}) {
        for (const double pitch : {-80.0, -50.0, 0.0, 20.0}) {
          const Eigen::Quaterniond before = rotation_between(Vec3::UnitZ(), up_W.normalized()) *
                                            Eigen::AngleAxisd(heading * kDegree, Vec3::UnitZ()) *
                                            Eigen::AngleAxisd(pitch * kDegree, Vec3::UnitY()) *
                                            Eigen::AngleAxisd(0.2, Vec3::UnitX());
          const std::string q = format_shortest(before.w()) + ", " + format_vector(before.vec(), 17);
          const Scene scene = bar(client + "orientation = [" + q + "]\n", world);
          const Eigen::Quaterniond after = start_of(scene).orientation;
          const Vec3& up = scene.water().up_W;
          const auto is_steep = [&](const Vec3& axis_B) {
            return std::abs(up.dot(before * axis_B)) > 0.9 || std::abs(up.dot(after * axis_B)) > 0.9;
          };
          const int axis = !is_steep(Vec3::UnitX()) ? 0 : !is_steep(Vec3::UnitY()) ? 1 : 2;
          ++kept[static_cast<std::size_t>(axis)];
          const double turned =
              heading_of(after * Vec3::Unit(axis), up) - heading_of(before * Vec3::Unit(axis), up);
          EXPECT_NEAR(std::remainder(turned, 2.0 * std::numbers::pi), 0.0, 1e-9)
              << client << up_W.transpose() << ": " << heading << ", " << pitch << ", axis " << axis;
        }
      }
    }
  }
  EXPECT_GT(kept[0], 40);
  EXPECT_GT(kept[1], 40);
}

TEST(StartPose, FollowsUpAndTheWaterLevel) {
  const DynamicsSpec start =
      start_of(bar("density = 100\nposition = [3, 8, 4]\norientation = [0.7, -0.7, 0, 0.1]\n",
                   "[world]\nup = [0, 1, 0]\n[water]\ndensity = 1000\nlevel = 2\n"));
  EXPECT_LE((start.position - Vec3(3, 2.4, 4)).norm(), 1e-12);
  EXPECT_LE((start.orientation * Vec3::UnitZ() - Vec3::UnitY()).norm(), 1e-9);
}

TEST(StartPose, TakesCompartmentsAndTanksIntoAccount) {
  // 4 x 1 x 1 m of 400 kg with 200 kg of liquid in the middle, and a quarter of the length open to the sea on
  // either side: it sinks until the other half displaces 600 kg.
  const Scene scene = scene_of(
      "[water]\ndensity = 1000\n[[body]]\nid = 1\nshape = { type = \"box\", size = [4, 1, 1] }\n"
      "[[body.tank]]\nshape = { type = \"box\", size = [1, 0.4, 0.5] }\nposition = [0, 0, -0.25]\n"
      "density = 1000\nfill = 1\n"
      "[[body.compartment]]\nshape = { type = \"box\", size = [1, 1, 1] }\nposition = [1.5, 0, 0]\n"
      "[[body.compartment]]\nshape = { type = \"box\", size = [1, 1, 1] }\nposition = [-1.5, 0, 0]\n"
      "[body.client]\nstart = \"equilibrium\"\ndensity = 100\ncenter_of_mass = [0, 0, -0.4]\n");
  EXPECT_NEAR(start_of(scene).position.z(), 0.5 - 0.3, 1e-12);
}

TEST(StartPose, ExplainsWhereThereIsNone) {
  const std::string sinks = start_error(bar("density = 2000\n"));
  EXPECT_EQ(
      sinks,
      "body 1 (bar), start = \"equilibrium\": a mass of 8000 kg; expected less than the 4000 kg of water "
      "that it can displace. Likely cause: the body sinks. Reduce mass or density, or what is flooded and "
      "filled, or start at a pose: remove start.");
  EXPECT_THAT(start_error(bar("density = 1000\n")), HasSubstr("neutrally buoyant"));
  const TempDir directory;
  const std::string mesh = directory.write("open.obj", kOpenObj);
  const std::string open = "[[body]]\nid = 1\nmesh = \"" + mesh +
                           "\"\nopen = \"dry_boundary\"\n[body.client]\nstart = \"equilibrium\"\n";
  EXPECT_THAT(start_error(scene_of(open + "mass = 9\n")),
              HasSubstr("without center_of_mass, inertia; expected"));
  const std::string heavy = open + "mass = 1e4\ncenter_of_mass = [0, 0, 0]\ninertia = [1, 1, 1]\n";
  EXPECT_THAT(start_error(scene_of(heavy)), HasSubstr("takes in water"));
}

TEST(StartPose, RefusesVelocitiesAndOtherWords) {
  for (const char* key : {"linear_velocity", "angular_velocity"}) {
    EXPECT_THAT(parse_error(scene_with_crate("[body.client]\nstart = \"equilibrium\"\n" + std::string(key) +
                                             " = [0, 0, 1]\n")),
                AllOf(HasSubstr(key), HasSubstr("at rest")));
  }
  EXPECT_EQ(parse_error(scene_with_crate("[body.client]\nstart = \"pose\"\nlinear_velocity = [0, 0, 1]\n")),
            "accepted");
  EXPECT_THAT(parse_error(scene_with_crate("[body.client]\nstart = \"floating\"\n")),
              HasSubstr("equilibrium"));
}

}  // namespace
}  // namespace buoyancy
