// The scenes that come with the project, as a user meets them.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene.h"

namespace buoyancy {
namespace {

std::filesystem::path shipped(const std::string& name) {
  return std::filesystem::path(BUOYANCY_SOURCE_DIR) / "scenes" / name;
}

TEST(ShippedScenes, AreAllReadable) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shipped(""))) {
    const Expected<SceneDescription> scene = read_scene_file(entry.path());
    EXPECT_TRUE(scene) << scene.error().message();
    ++count;
  }
  EXPECT_GE(count, 5U);
}

TEST(ShippedScenes, OfGeneratedShapesHoldBodiesThatFloat) {
  for (const auto& entry : std::filesystem::directory_iterator(shipped(""))) {
    if (entry.path().filename() == "duck.toml") continue;
    const Expected<Scene> scene = Scene::load(entry.path());
    ASSERT_TRUE(scene) << scene.error().message();
    for (const Body& body : scene->bodies()) {
      EXPECT_TRUE(body.client.given) << entry.path() << ", body " << body.id;
      EXPECT_LT(body.client.density.value_or(0.0), scene->water().density)
          << entry.path() << ", body " << body.id;
    }
  }
}

TEST(ShippedScenes, LetADuckOfSensibleSizeFallIntoTheWater) {
  const Expected<SceneDescription> description = read_scene_file(shipped("duck.toml"));
  ASSERT_TRUE(description) << description.error().message();
  const std::filesystem::path model = std::get<MeshFile>(description->bodies.at(0).source).path;
  if (!std::filesystem::exists(model)) {
    GTEST_SKIP() << model << " is not there: the package assimp-testmodels is not installed";
  }
  const Expected<Scene> scene = Scene::prepare(*description);
  ASSERT_TRUE(scene) << scene.error().message();
  const Body& duck = scene->bodies().at(0);
  EXPECT_EQ(duck.prepared_mesh->report.triangles, 4'212);
  EXPECT_TRUE(duck.prepared_mesh->report.closed());

  // Its lowest point is above the water, its head is up.
  double lowest = 1e9;
  double highest = -1e9;
  const HydrostaticMesh& mesh = duck.prepared_mesh->mesh;
  for (std::size_t i = 0; i < mesh.surface.x.size(); ++i) {
    const Vec3 vertex_B = mesh.center_B + Vec3(mesh.surface.x[i], mesh.surface.y[i], mesh.surface.z[i]);
    const Vec3 vertex_W = duck.client.position + duck.client.orientation * vertex_B;
    lowest = std::min(lowest, vertex_W.z());
    highest = std::max(highest, vertex_W.z());
  }
  EXPECT_GT(lowest, 0.0);
  EXPECT_LT(highest, 3.0);
  const Vec3 head_up_W = duck.client.orientation * Vec3::UnitY();
  EXPECT_GT(head_up_W.z(), 0.7);
}

}  // namespace
}  // namespace buoyancy
