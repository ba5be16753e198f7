#include "query/query_mesh.h"

#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "query/pose_evaluation.h"
#include "scene/up_axis.h"
#include "tests/query/pose_table.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

const std::vector<double> kTetrahedron{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
const std::vector<std::int64_t> kFaces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

std::string error_of(const std::vector<double>& vertices, const std::vector<std::int64_t>& faces,
                     const QueryMeshOptions& options = {}) {
  const auto mesh = QueryMesh::make(vertices, faces, "arrays", options);
  return mesh ? "" : mesh.error().message();
}

TEST(QueryMesh, IsMadeOfArrays) {
  const auto mesh =
      QueryMesh::make(kTetrahedron, kFaces, "tetrahedron", {.placement = {.scale = Vec3::Constant(2.0)}});
  ASSERT_TRUE(mesh) << mesh.error().message();
  EXPECT_EQ((*mesh)->report().name, "tetrahedron");
  EXPECT_EQ((*mesh)->report().triangles, 4);
  EXPECT_NEAR((*mesh)->report().volume, 8.0 / 6.0, 1e-15);
  EXPECT_NEAR((*mesh)->mass_properties().centroid_B.x(), 0.5, 1e-15);
}

TEST(QueryMesh, IsPlacedAsAMeshOfASceneIs) {
  const Eigen::Quaterniond up_y = orientation_with_up(Vec3::UnitY(), {2.0, 3.0, -1.0});
  const auto mesh = QueryMesh::make(
      kTetrahedron, kFaces, "tetrahedron",
      {.placement = {.scale = {2.0, 3.0, -1.0}, .position_B = {0.0, 0.0, 5.0}, .orientation_B = up_y}});
  ASSERT_TRUE(mesh) << mesh.error().message();
  EXPECT_NEAR((*mesh)->report().volume, 1.0, 1e-15);
  EXPECT_FALSE((*mesh)->report().flipped);
  EXPECT_EQ((*mesh)->report().box.min_B, Vec3(0.0, 0.0, 5.0));
  EXPECT_EQ((*mesh)->report().box.max_B, Vec3(2.0, 1.0, 8.0));
}

TEST(QueryMesh, SaysWhatIsWrongWithArrays) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<std::int64_t> faces = kFaces;
  faces[4] = 4;
  EXPECT_NE(error_of(kTetrahedron, faces).find("face 1 has the vertex index 4; expected 0 to 3"),
            std::string::npos);
  faces[4] = -1;
  EXPECT_NE(error_of(kTetrahedron, faces).find("index -1"), std::string::npos);
  faces[4] = std::int64_t{1} << 32;
  EXPECT_NE(error_of(kTetrahedron, faces).find("4294967296"), std::string::npos);
  EXPECT_NE(error_of(kTetrahedron, {0, 1}).find("three indices per triangle"), std::string::npos);
  EXPECT_NE(error_of({0, 1}, kFaces).find("2 coordinates"), std::string::npos);
  EXPECT_NE(error_of(kTetrahedron, {}).find("no face"), std::string::npos);
  EXPECT_NE(error_of({}, kFaces).find("index"), std::string::npos);
  EXPECT_NE(error_of(kTetrahedron, {0, 2, 1, 0, 1, 3}).find("open"), std::string::npos);
  std::vector<double> vertices = kTetrahedron;
  vertices[7] = kInfinity;
  EXPECT_NE(error_of(vertices, kFaces).find("finite"), std::string::npos);
  const auto error_with = [](const MeshPlacement& placement) {
    return error_of(kTetrahedron, kFaces, {.placement = placement});
  };
  for (const double bad : {0.0, kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_NE(error_with({.scale = {1.0, bad, 1.0}}).find("arrays: scale = 1, "), std::string::npos);
    EXPECT_NE(error_with({.orientation_B = {bad, 0.0, 0.0, 0.0}}).find("orientation"), std::string::npos);
  }
  EXPECT_NE(error_with({.position_B = {0.0, kInfinity, 0.0}}).find("position"), std::string::npos);
}

TEST(QueryMesh, SaysWhichFileIsMissing) {
  const auto mesh = QueryMesh::load("no/such/mesh.obj");
  ASSERT_FALSE(mesh);
  EXPECT_NE(mesh.error().message().find("no/such/mesh.obj"), std::string::npos);
}

TEST(QueryMesh, GivesWhatASceneWithTheSameMeshGives) {
  for (const std::string water :
       {"", "[water]\nwaves = { type = \"regular\", height = 0.4, period = 3.0 }\n"}) {
    for (const std::string method : {"hierarchical", "exact_surface"}) {
      const std::string text = water + "[[body]]\nid = 0\nmethod = \"" + method +
                               "\"\nshape = { type = \"rock\", frequency = 6, radius = 1.0, seed = 5 }\n";
      const Scene scene = scene_of(text);
      const TriangleMesh rock =
          make_shape(std::get<Shape>(parse_scene(text, "rock", {}).value().bodies[0].mesh.source));
      std::vector<double> vertices;
      for (std::size_t i = 0; i < rock.vertex_count(); ++i) {
        vertices.insert(vertices.end(), {rock.x[i], rock.y[i], rock.z[i]});
      }
      std::vector<std::int64_t> faces;
      for (const Triangle& triangle : rock.triangles)
        faces.insert(faces.end(), triangle.begin(), triangle.end());
      const auto mesh = QueryMesh::make(vertices, faces, "rock").value();
      const QueryWater in = water_of(QuerySea::parse(water, "sea", {}).value());
      const auto body = mesh->body(method_from_name(method).value(), 0.0, in.waves != nullptr).value();
      PoseTable poses = random_poses(100, 1.0, 4);
      poses.utimes = {1'000'000};
      WrenchTable wrenches(poses.size());
      WrenchTable of_scene(poses.size());
      evaluate_poses(*body, in, poses.arrays(), wrenches.arrays());
      evaluate_poses(scene.bodies()[0], water_of(scene), poses.arrays(), of_scene.arrays());
      EXPECT_EQ(wrenches, of_scene);
    }
  }
}

TEST(QueryMesh, RefusesMethodsThatDoNotWorkInWaves) {
  const auto mesh = QueryMesh::make(kTetrahedron, kFaces, "tetrahedron").value();
  for (const Method method : {Method::kFast, Method::kImproved, Method::kExact}) {
    EXPECT_TRUE(mesh->body(method, 0.0, false));
    const auto body = mesh->body(method, 0.0, true);
    ASSERT_FALSE(body);
    EXPECT_NE(body.error().message().find("Use hierarchical"), std::string::npos);
  }
  EXPECT_EQ(mesh->body(Method::kHierarchical, 0.0, true).value()->solver.tolerance(), kDefaultWaveTolerance);
  for (const double tolerance : {-1e-9, 1.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_FALSE(mesh->body(Method::kHierarchical, tolerance, false));
  }
}

TEST(QueryMesh, PreparesABodyOnce) {
  const auto mesh = QueryMesh::make(kTetrahedron, kFaces, "tetrahedron").value();
  const auto body = mesh->body(Method::kExact, 0.0, false).value();
  EXPECT_EQ(body, mesh->body(Method::kExact, 0.5, false).value());
  // However many tolerances are asked for, few are kept, and those in use stay valid.
  const auto kept = mesh->body(Method::kHierarchical, 1e-3, false).value();
  for (int i = 1; i < 100; ++i) EXPECT_TRUE(mesh->body(Method::kHierarchical, 1e-5 * i, false));
  EXPECT_EQ(kept->solver.tolerance(), 1e-3);
}

TEST(QueryMesh, PreparesBodiesOnSeveralThreadsAtOnce) {
  const auto mesh = QueryMesh::make(kTetrahedron, kFaces, "tetrahedron").value();
  const QuerySea sea =
      QuerySea::parse("[water]\nwaves = { type = \"regular\", height = 0.4, period = 3.0 }", "sea", {})
          .value();
  const PoseTable poses = random_poses(50, 0.5, 3);
  std::vector<WrenchTable> wrenches(8, WrenchTable(poses.size()));
  std::vector<std::thread> threads;
  for (std::size_t n = 0; n < wrenches.size(); ++n) {
    threads.emplace_back([&, n] {
      const bool waves = n % 2 == 0;
      const auto body = mesh->body(Method::kHierarchical, 1e-3, waves).value();
      evaluate_poses(*body, waves ? water_of(sea) : QueryWater{}, poses.arrays(), wrenches[n].arrays());
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t n = 2; n < wrenches.size(); ++n) EXPECT_EQ(wrenches[n], wrenches[n - 2]);
}

}  // namespace
}  // namespace buoyancy
