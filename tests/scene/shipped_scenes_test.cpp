// Tests of the scenes that are installed with the project.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "flotation/equilibrium.h"
#include "flotation/righting_arms.h"
#include "scene/floating_bodies.h"
#include "scene/scene.h"
#include "tests/support/build_paths.h"

namespace buoyancy {
namespace {

std::filesystem::path shipped(const std::string& name) {
  return source_dir() / "scenes" / name;
}

// Not the folder of the meshes beside them.
std::vector<std::filesystem::path> shipped_scenes() {
  std::vector<std::filesystem::path> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(shipped(""))) {
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path());
  }
  return scenes;
}

TEST(ShippedScenes, AreReadable) {
  const std::vector<std::filesystem::path> scenes = shipped_scenes();
  for (const std::filesystem::path& path : scenes) {
    const Expected<SceneDescription> scene = read_scene_file(path);
    EXPECT_TRUE(scene) << scene.error().message();
  }
  EXPECT_GE(scenes.size(), 5U);
}

TEST(ShippedScenes, HaveFloatingBodies) {
  for (const std::filesystem::path& path : shipped_scenes()) {
    // Their mesh is in another package.
    if (path.filename().string().starts_with("duck")) continue;
    const Expected<Scene> scene = Scene::load(path);
    ASSERT_TRUE(scene) << scene.error().message();
    const double densest = deepest_density(scene->water());
    for (const Body& body : scene->bodies()) {
      EXPECT_TRUE(body.dynamics.given) << path << ", body " << body.id;
      EXPECT_LT(body.dynamics.density.value_or(0.0), densest) << path << ", body " << body.id;
      EXPECT_LT(body.dynamics.mass.value_or(0.0), densest * body.prepared_mesh->mass_properties.volume)
          << path << ", body " << body.id;
      EXPECT_EQ(body.loads, body.hydrodynamics != nullptr) << path << ", body " << body.id;
    }
  }
}

TEST(ShippedScenes, ScaleDuckToPlausibleSize) {
  const Expected<SceneDescription> description = read_scene_file(shipped("duck.toml"));
  ASSERT_TRUE(description) << description.error().message();
  const std::filesystem::path model = std::get<MeshFile>(description->bodies.at(0).mesh.source).path;
  if (!std::filesystem::exists(model)) {
    GTEST_SKIP() << model << " was not found; install the Debian package assimp-testmodels";
  }
  const Expected<Scene> scene = Scene::prepare(*description);
  ASSERT_TRUE(scene) << scene.error().message();
  const Body& duck = scene->bodies().at(0);
  EXPECT_EQ(duck.prepared_mesh->report.triangles, 4'212);
  EXPECT_TRUE(duck.prepared_mesh->report.closed());

  // Its lowest point is above the water and its head is up.
  double min_z = 1e9;
  double max_z = -1e9;
  const HydrostaticMesh& mesh = duck.prepared_mesh->mesh;
  for (std::size_t i = 0; i < mesh.surface.x.size(); ++i) {
    const Vec3 vertex_B = mesh.center_B + Vec3(mesh.surface.x[i], mesh.surface.y[i], mesh.surface.z[i]);
    const Vec3 vertex_W = duck.dynamics.position + duck.dynamics.orientation * vertex_B;
    min_z = std::min(min_z, vertex_W.z());
    max_z = std::max(max_z, vertex_W.z());
  }
  EXPECT_GT(min_z, 0.0);
  EXPECT_LT(max_z, 3.0);
  const Vec3 head_up_W = duck.dynamics.orientation * Vec3::UnitY();
  EXPECT_GT(head_up_W.z(), 0.7);
}

FloatingBody floating(const Scene& scene, std::int32_t id) {
  const Body& body = *scene.find(id);
  return floating_body_of(body, body.solver.mesh(), mass_of_body(body, scene.water()).value()).value();
}

double degrees(double radians) {
  return radians * 180.0 / std::numbers::pi;
}

TEST(ShippedScenes, HaveFerryThatCapsizesWithWaterOnDeck) {
  const Scene scene = Scene::load(shipped("ferry_flooding_deck.toml")).value();
  std::vector<double> heels;
  for (int degree = 0; degree <= 90; degree += 5) heels.push_back(degree * std::numbers::pi / 180.0);
  const auto curve_of = [&](std::int32_t id) {
    return righting_curve(floating(scene, id), scene.water(), heels).value();
  };
  const RightingCurve dry = curve_of(1);
  EXPECT_NEAR(degrees(dry.vanishing_starboard().value()), 56.66, 0.01);
  EXPECT_NEAR(dry.max_starboard.value().gz, 0.4746, 0.001);
  for (const RightingCurvePoint& point : curve_of(2).points) {
    if (point.arm.heel == 0.0) continue;
    EXPECT_LT(point.arm.gz, -0.05) << degrees(point.arm.heel);
  }
}

TEST(ShippedScenes, HaveBargeWhoseBulkheadQuartersTheFreeSurface) {
  const Scene scene = Scene::load(shipped("barge_half_full_tank.toml")).value();
  const auto upright_gm = [&](std::int32_t id) {
    const Equilibrium found =
        find_equilibrium_from(floating(scene, id), scene.water(), Eigen::Quaterniond::Identity()).value();
    EXPECT_NEAR(degrees(found.angles.heel), 0.0, 1e-6);
    return found.state.hydrostatics.metacentric_heights[0];
  };
  const double mass = floating(scene, 1).total_mass();
  const double reduction = scene.water().density * 18.0 * std::pow(8.0, 3) / 12.0 / mass;
  EXPECT_NEAR(reduction, 2.14, 0.005);
  EXPECT_NEAR(upright_gm(2) - upright_gm(1), 0.75 * reduction, 1e-9);
  EXPECT_NEAR(upright_gm(1), 0.36, 0.005);
  EXPECT_NEAR(upright_gm(2), 1.96, 0.005);
}

TEST(ShippedScenes, HaveLogThatFloatsOnOneEdge) {
  const Scene scene = Scene::load(shipped("square_log.toml")).value();
  const Equilibria found = find_equilibria(floating(scene, 1), scene.water());
  ASSERT_EQ(found.attitudes.size(), 4U);
  for (const Equilibrium& attitude : found.attitudes) {
    EXPECT_NEAR(std::fmod(std::abs(degrees(attitude.angles.heel)), 90.0), 45.0, 1e-6);
  }
}

TEST(ShippedScenes, HaveFloatThatRestsWhereTheWaterBegins) {
  const Scene scene = Scene::load(shipped("interface_float.toml")).value();
  const auto found = find_equilibrium_from(floating(scene, 1), scene.water(), Eigen::Quaterniond::Identity());
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->draft, 1.0 + 0.5 * 0.2, 1e-12) << "half of its height is in the water";
  EXPECT_NEAR(degrees(found->angles.heel), 0.0, 1e-6);
}

}  // namespace
}  // namespace buoyancy
