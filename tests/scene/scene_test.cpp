#include "scene/scene.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/mesh_files.h"
#include "tests/scene/scene_texts.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Expected<Scene> load(const TempDir& directory, const std::string& text, const PrepareOptions& options = {}) {
  return Scene::load(directory.write("pool.toml", text), options);
}

Scene loaded(const TempDir& directory, const std::string& text) {
  Expected<Scene> scene = load(directory, text);
  if (!scene) throw std::runtime_error(scene.error().message());
  return *std::move(scene);
}

std::string body_with(int id, const std::string& keys) {
  return "[[body]]\nid = " + std::to_string(id) + "\n" + keys + "\n";
}

TEST(Scene, PreparesGeneratedShapes) {
  const TempDir directory;
  const Scene scene = loaded(directory, body_with(4, "shape = { type = \"box\", size = [1, 2, 3] }"));
  EXPECT_EQ(scene.name(), (directory.path() / "pool.toml").string());
  ASSERT_EQ(scene.meshes().size(), 1U);
  const PreparedMesh& mesh = *scene.meshes()[0];
  EXPECT_EQ(mesh.report.name, "box");
  EXPECT_EQ(mesh.report.triangles, 12);
  EXPECT_NEAR(mesh.mesh.volume, 6.0, 1e-14);
  EXPECT_NEAR(mesh.mass_properties.volume, 6.0, 1e-14);
  ASSERT_EQ(scene.bodies().size(), 1U);
  const Body& body = scene.bodies()[0];
  EXPECT_EQ(body.prepared_mesh, &mesh);
  EXPECT_EQ(&body.solver.mesh(), &mesh.mesh);
  EXPECT_EQ(body.solver.method(), Method::kHierarchical);
}

TEST(Scene, CopiesBodySettings) {
  const Scene scene =
      prepared("[water]\nlevel = 3\n" + body_with(4,
                                                  "name = \"crate\"\nshape = { type = \"box\" }\nmethod = "
                                                  "\"fast\"\ntolerance = 0.25\nreference_point = [1, 2, 3]\n"
                                                  "[body.client]\nmass = 9"));
  EXPECT_EQ(scene.water().level, 3.0);
  const Body& body = scene.bodies()[0];
  EXPECT_EQ(body.id, 4);
  EXPECT_EQ(body.name, "crate");
  EXPECT_EQ(body.solver.method(), Method::kFast);
  EXPECT_EQ(body.solver.tolerance(), 0.25);
  EXPECT_EQ(body.reference_B, Vec3(1, 2, 3));
  EXPECT_EQ(body.dynamics.mass, 9.0);
}

TEST(Scene, BuildsTreeForRequestedHydrostatics) {
  const std::string exact_box = "shape = { type = \"box\" }\nmethod = \"exact\"\n";
  const Scene without = prepared(body_with(1, exact_box));
  EXPECT_FALSE(without.bodies()[0].hydrostatics);
  EXPECT_FALSE(without.meshes()[0]->mesh.tree);
  const Scene with = prepared(body_with(1, exact_box) +
                              body_with(2, exact_box + "outputs = [\"wrench\", \"hydrostatics\"]"));
  EXPECT_FALSE(with.bodies()[0].hydrostatics);
  EXPECT_TRUE(with.bodies()[1].hydrostatics);
  ASSERT_EQ(with.meshes().size(), 1U);
  EXPECT_TRUE(with.meshes()[0]->mesh.tree);
}

TEST(Scene, BuildsMeshletsOnceForMethodsOfPaper) {
  const std::string box = "shape = { type = \"box\" }\n";
  const Scene without = prepared(body_with(1, box));
  EXPECT_FALSE(without.meshes()[0]->mesh.meshlets);
  const Scene with = prepared(body_with(1, box + "method = \"exact\"") +
                              body_with(2, box + "method = \"fast\"") + body_with(3, box));
  ASSERT_EQ(with.meshes().size(), 1U);
  ASSERT_TRUE(with.meshes()[0]->mesh.meshlets);
  EXPECT_EQ(with.meshes()[0]->mesh.meshlets.use_count(), 3) << "the mesh and two solvers";
}

TEST(Scene, DerivesCentreOfMassFromDynamics) {
  const TempDir directory;
  const std::string open_mesh = directory.write("open.obj", kOpenObj);
  const std::string cone = "shape = { type = \"cone\", height = 2 }\n";
  const std::string open = "mesh = \"" + open_mesh + "\"\nopen = \"dry_boundary\"\n";
  const auto center = [&](const std::string& keys) {
    const auto scene = load(directory, body_with(1, keys));
    EXPECT_TRUE(scene) << scene.error().message();
    return scene->bodies()[0].center_of_mass_B;
  };
  EXPECT_FALSE(center(cone));
  EXPECT_FALSE(center(cone + "[body.client]\nposition = [1, 2, 3]"));
  for (const char* keys : {"mass = 3", "density = 300"}) {
    const std::optional<Vec3> found = center(cone + "[body.client]\n" + keys);
    ASSERT_TRUE(found) << keys;
    EXPECT_LE((*found - Vec3(0, 0, 0.5)).norm(), 1e-14) << "the volume's centroid";
  }
  EXPECT_EQ(center(cone + "[body.client]\nmass = 3\ncenter_of_mass = [1, 2, 3]"), Vec3(1, 2, 3));
  EXPECT_EQ(center(cone + "[body.client]\ncenter_of_mass = [1, 2, 3]"), Vec3(1, 2, 3));
  EXPECT_FALSE(center(open + "[body.client]\nmass = 3")) << "an open mesh encloses no volume";
  EXPECT_EQ(center(open + "[body.client]\nmass = 3\ncenter_of_mass = [1, 2, 3]"), Vec3(1, 2, 3));
}

TEST(Scene, LoadsSharedMeshOnce) {
  const TempDir directory;
  directory.write("tetrahedron.obj", tetrahedron::obj());
  std::filesystem::create_symlink(directory.path() / "tetrahedron.obj", directory.path() / "alias.obj");
  const Scene scene = loaded(directory, body_with(1, "mesh = \"tetrahedron.obj\"") +
                                            body_with(2, "mesh = \"./tetrahedron.obj\"\nmethod = \"fast\"") +
                                            body_with(3, "mesh = \"alias.obj\""));
  ASSERT_EQ(scene.meshes().size(), 1U);
  for (const Body& body : scene.bodies()) EXPECT_EQ(body.prepared_mesh, scene.meshes()[0].get());
}

TEST(Scene, PreparesMeshPerScaleAndOpenPolicy) {
  const TempDir directory;
  directory.write("tetrahedron.obj", tetrahedron::obj());
  const Scene scene =
      loaded(directory, body_with(1, "mesh = \"tetrahedron.obj\"") +
                            body_with(2, "mesh = \"tetrahedron.obj\"\nscale = 2") +
                            body_with(3, "mesh = \"tetrahedron.obj\"\nopen = \"dry_boundary\""));
  EXPECT_EQ(scene.meshes().size(), 3U);
}

TEST(Scene, SharesOnlyEqualShapes) {
  const Scene scene = prepared(body_with(1, "shape = { type = \"rock\", seed = 1 }") +
                               body_with(2, "shape = { type = \"rock\", seed = 2 }") +
                               body_with(3, "shape = { type = \"rock\" }"));
  EXPECT_EQ(scene.meshes().size(), 2U);
  EXPECT_EQ(scene.bodies()[0].prepared_mesh, scene.bodies()[2].prepared_mesh);
}

TEST(Scene, ScalesMeshesInDouble) {
  const TempDir directory;
  directory.write("tetrahedron.ply", tetrahedron::binary_ply());
  const Scene scene = loaded(directory, body_with(1, "mesh = \"tetrahedron.ply\"\nscale = 0.1"));
  EXPECT_EQ(scene.meshes()[0]->report.box.max_B, Vec3(0.1, 0.1, 0.1));
  EXPECT_NEAR(scene.meshes()[0]->mass_properties.volume, 1e-3 / 6.0, 1e-18);
}

TEST(Scene, FindsBodiesById) {
  const Scene scene =
      prepared(body_with(9, "shape = { type = \"box\" }") + body_with(-5, "shape = { type = \"box\" }") +
               body_with(2, "shape = { type = \"box\" }"));
  EXPECT_EQ(scene.index_of(9), 0U);
  EXPECT_EQ(scene.index_of(-5), 1U);
  EXPECT_EQ(scene.index_of(2), 2U);
  EXPECT_EQ(scene.find(2), &scene.bodies()[2]);
  EXPECT_EQ(scene.index_of(3), std::nullopt);
  EXPECT_EQ(scene.index_of(10), std::nullopt);
  EXPECT_EQ(scene.find(3), nullptr);
}

TEST(Scene, StaysValidAfterMove) {
  Scene scene = prepared(body_with(1, "shape = { type = \"box\" }\nmethod = \"fast\""));
  const WaterPlane fully_submerged{Vec3::UnitZ(), 10.0};
  const Displacement before = scene.bodies()[0].solver.displacement(fully_submerged);
  const Scene moved = std::move(scene);
  EXPECT_EQ(moved.bodies()[0].solver.displacement(fully_submerged).volume, before.volume);
  EXPECT_NEAR(before.volume, 1.0, 1e-15);
}

TEST(Scene, CountsIntersectionsOnlyOnRequest) {
  const TempDir directory;
  const std::string text = body_with(1, "shape = { type = \"box\" }");
  const auto plain = load(directory, text);
  ASSERT_TRUE(plain) << plain.error().message();
  EXPECT_FALSE(plain->meshes()[0]->report.intersecting_pairs);
  const auto counted = load(directory, text, {.count_intersecting_pairs = true});
  ASSERT_TRUE(counted) << counted.error().message();
  EXPECT_EQ(counted->meshes()[0]->report.intersecting_pairs, 0);
}

std::string load_error(const Expected<Scene>& scene) {
  return scene ? "accepted" : scene.error().message();
}

TEST(Scene, NamesFileLineBodyAndMeshInErrors) {
  const TempDir directory;
  directory.write("open.obj", kOpenObj);
  for (const std::string mesh : {"missing.obj", "open.obj"}) {
    const std::string message = load_error(load(
        directory, body_with(1, "shape = { type = \"box\" }") + body_with(22, "mesh = \"" + mesh + "\"")));
    const std::string start = (directory.path() / "pool.toml").string() + ":4: body 22, ";
    EXPECT_THAT(message, AllOf(StartsWith(start), HasSubstr(directory.path(mesh))));
  }
}

const std::string kBox = "shape = { type = \"box\" }\n";
const std::string kWaves = "[water.waves]\ntype = \"regular\"\nheight = 1\nperiod = 8\n";
const std::string kStillWaves = "[water.waves]\ntype = \"regular\"\nheight = 0\nperiod = 8\n";

TEST(Scene, MakesItsSea) {
  const std::string water = "[water]\nlevel = 2\ndepth = 30\nramp = 4\n";
  Scene scene = prepared(water + kWaves + body_with(1, kBox));
  const Sea* sea = scene.sea();
  ASSERT_NE(sea, nullptr);
  EXPECT_EQ(sea->water().level, 2.0);
  EXPECT_EQ(sea->depth(), 30.0);
  EXPECT_EQ(sea->ramp(), 4.0);
  ASSERT_EQ(sea->components().size(), 1U);
  EXPECT_EQ(sea->components()[0].amplitude, 0.5);
  ASSERT_EQ(scene.wave_systems().size(), 1U);
  EXPECT_EQ(scene.wave_systems()[0].type, "regular");
  const Scene moved = std::move(scene);
  EXPECT_EQ(moved.sea(), sea) << "the same sea after a move";
}

TEST(Scene, HasNoSeaInWaterAtRest) {
  for (const std::string& water : {std::string(), std::string("[water]\ndepth = 30\n"), kStillWaves}) {
    const Scene scene = prepared(water + body_with(1, kBox));
    EXPECT_EQ(scene.sea(), nullptr);
    EXPECT_TRUE(scene.wave_systems().empty());
    EXPECT_EQ(scene.bodies()[0].solver.tolerance(), 0.0);
    EXPECT_FALSE(scene.receives_sea());
    EXPECT_FALSE(scene.bodies()[0].prepared_mesh->wave_mesh);
  }
}

TEST(Scene, UsesAToleranceInWaves) {
  const TempDir directory;
  const auto tolerance = [&](const std::string& keys) {
    const auto scene = load(directory, kWaves + body_with(1, kBox + keys));
    if (!scene) throw std::runtime_error(scene.error().message());
    return scene->bodies()[0].solver.tolerance();
  };
  EXPECT_EQ(tolerance(""), 1e-3);
  EXPECT_EQ(tolerance("tolerance = 0.02"), 0.02);
  EXPECT_EQ(tolerance("method = \"exact_surface\"\ntolerance = 0"), 0.0);
}

TEST(Scene, RefusesInWavesWhatNeedsPlaneWater) {
  const TempDir directory;
  const auto load_with = [&](const std::string& water, const std::string& keys) {
    return load_error(load(directory, water + body_with(1, kBox) + body_with(7, kBox + keys)));
  };
  const std::string file = directory.path("pool.toml");
  EXPECT_EQ(
      load_with(kWaves, "method = \"exact\""),
      file +
          ":9: body 7: method = \"exact\"; expected hierarchical, fast_surface or exact_surface in "
          "waves. Likely cause: the methods fast, improved and exact sum volumes under a plane water "
          "surface, which waves are not. Use hierarchical; fast_surface and exact_surface are baselines "
          "without an error bound.");
  const std::vector<std::pair<std::string, std::string>> refused{
      {"method = \"fast\"", "method = \"fast\"; expected hierarchical"},
      {"method = \"improved\"", "method = \"improved\"; expected hierarchical"},
      {"method = \"exact\"", "method = \"exact\"; expected hierarchical"},
      {"tolerance = 0", "tolerance = 0; expected a number above 0, at most 1, in waves"},
      {"tolerance = 0.0", "tolerance = 0; expected a number above 0, at most 1, in waves"},
      {"outputs = [\"wrench\", \"hydrostatics\"]", "hydrostatics\"]; expected [\"wrench\"] in waves"}};
  for (const auto& [keys, expected] : refused) {
    const std::string message = load_with(kWaves, keys);
    EXPECT_THAT(message, AllOf(StartsWith(file + ":9: body 7: "), HasSubstr(expected)));
    const std::string received = load_with("[water]\nwaves = \"received\"\n", keys);
    EXPECT_THAT(received, AllOf(StartsWith(file + ":7: body 7: "), HasSubstr(expected)));
    EXPECT_EQ(load_with(kStillWaves, keys), "accepted") << keys;
    EXPECT_EQ(load_with("", keys), "accepted") << keys;
  }
}

TEST(Scene, AcceptsTheOtherMethodsAndOpenMeshesInWaves) {
  const TempDir directory;
  directory.write("open.obj", kOpenObj);
  const Scene scene = loaded(directory, kWaves + body_with(1, kBox + "method = \"hierarchical\"") +
                                            body_with(2, kBox + "method = \"fast_surface\"") +
                                            body_with(3, kBox + "method = \"exact_surface\"") +
                                            body_with(4, "mesh = \"open.obj\"\nopen = \"dry_boundary\""));
  EXPECT_TRUE(scene.bodies()[3].prepared_mesh->mesh.is_open());
}

TEST(Scene, NamesTheBodyInWavesWithoutASceneFile) {
  SceneDescription description = single_mesh_scene("missing.obj", Method::kExact, 0.0, OpenPolicy::kRefuse);
  description.sea.systems = {RegularWave{1.0, 8.0, 0.0, 0.0}};
  EXPECT_THAT(load_error(Scene::prepare(description)), StartsWith("body 1: method = \"exact\""));
  description.sea.systems = {RegularWave{-1.0, 8.0, 0.0, 0.0}};
  EXPECT_THAT(load_error(Scene::prepare(description)), StartsWith("wave system 1: height = -1"));
}

// A mesh of exactly this size is imported, and one byte, vertex or face more is not.
TEST(Scene, RejectsMeshesBeyondLimits) {
  const TempDir directory;
  directory.write("tetrahedron.obj", tetrahedron::obj());
  for (const auto& [key, size] :
       {std::pair{"mesh_bytes", tetrahedron::obj().size()}, {"vertices", 12UL}, {"faces", 4UL}}) {
    for (const std::size_t limit : {size, size - 1}) {
      const std::string limits = "[limits]\n" + std::string(key) + " = " + std::to_string(limit) + "\n";
      EXPECT_THAT(load_error(load(directory, limits + body_with(1, "mesh = \"tetrahedron.obj\""))),
                  HasSubstr(limit == size ? "accepted" : "body 1, "))
          << limits;
    }
  }
}

TEST(Scene, NamesOnlyMeshWithoutSceneFile) {
  const TempDir directory;
  const std::filesystem::path mesh = directory.path() / "missing.obj";
  EXPECT_THAT(load_error(Scene::prepare(single_mesh_scene(mesh, Method::kExact, 0.0, OpenPolicy::kRefuse))),
              StartsWith(mesh.string() + ": "));
}

TEST(Scene, PreparesBodiesForWavesThatAreReceived) {
  for (const std::string messages : {"received", "grid"}) {
    const Scene scene = prepared("[water]\nwaves = \"" + messages + "\"\n" + body_with(1, kBox));
    EXPECT_TRUE(scene.receives_sea());
    EXPECT_EQ(scene.receives_grids(), messages == "grid");
    EXPECT_EQ(scene.sea(), nullptr);
    EXPECT_EQ(scene.bodies()[0].solver.tolerance(), 1e-3);
    EXPECT_TRUE(scene.bodies()[0].prepared_mesh->wave_mesh);
  }
}

TEST(Scene, RefusesEventsThatOverfillATank) {
  const auto with_volume = [](const std::string& volume) {
    return preparation_error(scene_with_crate(
        "[[body.tank]]\nname = \"fuel\"\nshape = { type = \"box\" }\nfill = 0\n[body.client]\n"
        "[[body.client.event]]\ntime = 1\ntank = 0\nliquid_volume = " +
        volume + "\n"));
  };
  for (const std::string rounded : {"1.0", "1.0000000009"}) EXPECT_EQ(with_volume(rounded), "accepted");
  for (const std::string more : {"1.0000000011", "1.5"}) {
    EXPECT_THAT(with_volume(more),
                AllOf(HasSubstr("event of tank 'fuel'"), HasSubstr("at most the tank's volume, 1 m^3")));
  }
}

}  // namespace
}  // namespace buoyancy
