#include "query/query_mesh.h"

#include <barrier>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "query/pose_evaluation.h"
#include "scene/up_axis.h"
#include "tests/query/pose_table.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

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
  EXPECT_THAT(error_of(kTetrahedron, faces), HasSubstr("face 1 has the vertex index 4; expected 0 to 3"));
  faces[4] = -1;
  EXPECT_THAT(error_of(kTetrahedron, faces), HasSubstr("index -1"));
  faces[4] = std::int64_t{1} << 32;
  EXPECT_THAT(error_of(kTetrahedron, faces), HasSubstr("4294967296"));
  EXPECT_THAT(error_of(kTetrahedron, {0, 1}), HasSubstr("three indices per triangle"));
  EXPECT_THAT(error_of({0, 1}, kFaces), HasSubstr("2 coordinates"));
  EXPECT_THAT(error_of(kTetrahedron, {}), HasSubstr("no face"));
  EXPECT_THAT(error_of({}, kFaces), HasSubstr("index"));
  EXPECT_THAT(error_of(kTetrahedron, {0, 2, 1, 0, 1, 3}), HasSubstr("open"));
  std::vector<double> vertices = kTetrahedron;
  vertices[7] = kInfinity;
  EXPECT_THAT(error_of(vertices, kFaces), HasSubstr("finite"));
  const auto error_with = [](const MeshPlacement& placement) {
    return error_of(kTetrahedron, kFaces, {.placement = placement});
  };
  for (const double bad : {0.0, kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(error_with({.scale = {1.0, bad, 1.0}}), HasSubstr("arrays: scale = 1, "));
    EXPECT_THAT(error_with({.orientation_B = {bad, 0.0, 0.0, 0.0}}), HasSubstr("orientation"));
  }
  EXPECT_THAT(error_with({.position_B = {0.0, kInfinity, 0.0}}), HasSubstr("position"));
}

TEST(QueryMesh, SaysWhichFileIsMissing) {
  const auto mesh = QueryMesh::load("no/such/mesh.obj");
  ASSERT_FALSE(mesh);
  EXPECT_THAT(mesh.error().message(), HasSubstr("no/such/mesh.obj"));
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
    EXPECT_THAT(body.error().message(), HasSubstr("Use hierarchical"));
  }
  EXPECT_EQ(mesh->body(Method::kHierarchical, 0.0, true).value()->solver.tolerance(), kDefaultWaveTolerance);
  for (const bool waves : {false, true}) {
    for (const double tolerance : {1e-9, 1.0})
      EXPECT_TRUE(mesh->body(Method::kHierarchical, tolerance, waves));
    for (const double tolerance :
         {-5e-324, std::nextafter(1.0, 2.0), std::numeric_limits<double>::quiet_NaN()}) {
      EXPECT_FALSE(mesh->body(Method::kHierarchical, tolerance, waves)) << tolerance;
    }
  }
}

TEST(QueryMesh, PreparesABodyOnce) {
  const auto mesh = QueryMesh::make(kTetrahedron, kFaces, "tetrahedron").value();
  const auto body = mesh->body(Method::kExact, 0.0, false).value();
  EXPECT_EQ(body, mesh->body(Method::kExact, 0.5, false).value());
  // The last 32 are kept, and those in use stay valid.
  const auto with = [&](int i) { return mesh->body(Method::kHierarchical, 1e-3 * i, false).value(); };
  std::vector<std::shared_ptr<const Body>> bodies;
  for (int i = 0; i < 32; ++i) bodies.push_back(with(i));
  for (int i = 0; i < 32; ++i) EXPECT_EQ(with(i), bodies[static_cast<std::size_t>(i)]);
  EXPECT_NE(mesh->body(Method::kExact, 0.0, false).value(), body) << "prepared again";
  EXPECT_EQ(with(1), bodies[1]);
  EXPECT_NE(with(0), bodies[0]);
  for (int i = 0; i < 32; ++i) EXPECT_EQ(bodies[static_cast<std::size_t>(i)]->solver.tolerance(), 1e-3 * i);
}

// Threads that ask for the same body at the same time get the one that the first of them prepares.
TEST(QueryMesh, PreparesABodyOnceForAllThreads) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 40, .seed = 5});
  std::vector<double> vertices;
  for (std::size_t i = 0; i < rock.vertex_count(); ++i) {
    vertices.insert(vertices.end(), {rock.x[i], rock.y[i], rock.z[i]});
  }
  std::vector<std::int64_t> faces;
  for (const Triangle& triangle : rock.triangles) faces.insert(faces.end(), triangle.begin(), triangle.end());
  for (int round = 0; round < 8; ++round) {
    const auto mesh = QueryMesh::make(vertices, faces, "rock").value();
    const bool in_waves = round % 2 == 0;
    const Method method = in_waves ? Method::kHierarchical : Method::kExact;
    std::vector<std::shared_ptr<const Body>> bodies(4);
    std::barrier begin(static_cast<std::ptrdiff_t>(bodies.size()));
    std::vector<std::thread> threads;
    for (std::shared_ptr<const Body>& body : bodies) {
      threads.emplace_back([&] {
        begin.arrive_and_wait();
        body = mesh->body(method, 1e-3, in_waves).value();
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (const auto& body : bodies) ASSERT_EQ(body, bodies[0]) << "round " << round;
  }
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
