#include "geometry/edge_insertion.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/mass_properties.h"
#include "geometry/mesh_topology.h"
#include "geometry/mesh_validation.h"
#include "geometry/swept_volume.h"
#include "geometry/welding.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

// Divides an edge of one face at a new vertex, but not in its neighbour.
TriangleMesh with_t_junction(TriangleMesh mesh, std::size_t face, const Vec3& offset_B = Vec3::Zero()) {
  const auto [a, b, c] = mesh.triangles[face];
  const std::int32_t m = mesh.add_vertex(0.25 * mesh.vertex(a) + 0.75 * mesh.vertex(b) + offset_B);
  mesh.triangles[face] = {a, m, c};
  mesh.triangles.push_back({m, b, c});
  return mesh;
}

RepairReport insert(TriangleMesh& mesh) {
  RepairReport report;
  insert_vertices_on_edges(mesh, 1e-6 * bounding_box(mesh).diagonal(), report);
  return report;
}

TEST(EdgeInsertion, ClosesTJunctionsWithoutChangingTheSolid) {
  TriangleMesh cube = with_t_junction(with_t_junction(cube_mesh(), 0), 5);
  EXPECT_EQ(mesh_topology(cube).counts.boundary, 6);
  const RepairReport report = insert(cube);
  EXPECT_TRUE(mesh_topology(cube).counts.all_matched());
  EXPECT_EQ(cube.triangles.size(), 16U);
  ASSERT_EQ(report.steps.size(), 1U);
  EXPECT_EQ(report.steps[0].kind, RepairKind::kInsertVertices);
  EXPECT_EQ(report.steps[0].count, 2);
  EXPECT_EQ(report.steps[0].max_move, 0.0);
  EXPECT_EQ(report.volume_bound, 0.0);
  EXPECT_DOUBLE_EQ(mass_properties(cube).volume, 1.0);
}

TEST(EdgeInsertion, BoundsTheVolumeThatAVertexBesideTheEdgeChanges) {
  TriangleMesh cube = with_t_junction(cube_mesh(), 0, Vec3(0, 0, 1e-6));
  const RepairReport report = insert(cube);
  ASSERT_TRUE(mesh_topology(cube).counts.all_matched());
  EXPECT_NEAR(report.steps[0].max_move, 1e-6, 1e-12);
  const double change = std::abs(mass_properties(cube).volume - 1.0);
  EXPECT_GT(change, 1e-8);
  EXPECT_LE(change, report.volume_bound);
  EXPECT_LT(report.volume_bound, 2e-6);
}

TEST(EdgeInsertion, LeavesVerticesBeyondTheTolerance) {
  TriangleMesh cube = with_t_junction(cube_mesh(), 0, Vec3(0, 0, 3e-6));
  EXPECT_TRUE(insert(cube).empty());
  EXPECT_EQ(mesh_topology(cube).counts.boundary, 3);
}

TEST(EdgeInsertion, CutsAFaceWithVerticesOnAllSidesWithoutFolds) {
  TriangleMesh mesh;
  mesh.add_vertex({0, 0, 0});
  mesh.add_vertex({4, 0, 0});
  mesh.add_vertex({0, 4, 0});
  mesh.triangles = {{1, 2, 0}, {2, 1, 0}};
  std::vector<EdgeInsertion> insertions;
  const auto add = [&](const Edge& edge, double along) {
    const Vec3 from = mesh.vertex(edge[0]);
    const Vec3 to = mesh.vertex(edge[1]);
    insertions.push_back({edge, along, mesh.add_vertex(from + along * (to - from)), 0.0});
  };
  for (const double along : {0.25, 0.5, 0.75}) add({0, 1}, along);
  for (const double along : {0.125, 0.5}) add({0, 2}, along);
  for (const double along : {0.25, 0.5}) add({1, 2}, along);
  const SplitMesh split = split_edges(mesh, insertions);
  EXPECT_TRUE(mesh_topology(split.mesh).counts.all_matched());
  EXPECT_EQ(split.mesh.triangles.size(), 2U * 8U);
  double upward = 0.0;
  for (const Triangle& face : split.mesh.triangles) {
    const Vec3 a = split.mesh.vertex(face[0]);
    const double z = (split.mesh.vertex(face[1]) - a).cross(split.mesh.vertex(face[2]) - a).z();
    EXPECT_NE(z, 0.0);
    if (z > 0.0) upward += 0.5 * z;
  }
  EXPECT_DOUBLE_EQ(upward, 8.0);
}

TEST(EdgeInsertion, RemovesNeedlesWhoseTipLiesOnTheirBase) {
  // Both faces of an edge are divided at the same vertex, and a needle between them is left over.
  TriangleMesh cube = with_t_junction(cube_mesh(), 0, Vec3(0, 0, 1e-9));
  const std::int32_t m = 8;
  cube.triangles[8] = {0, 4, m};  // was 0 4 2
  cube.triangles.push_back({m, 4, 2});
  ASSERT_TRUE(mesh_topology(cube).counts.all_matched());
  cube.triangles.push_back({0, 2, m});
  EXPECT_EQ(mesh_topology(cube).counts.unmatched(), 3);
  insert(cube);
  EXPECT_TRUE(mesh_topology(cube).counts.all_matched());
  EXPECT_EQ(cube.triangles.size(), 14U);
  EXPECT_NEAR(mass_properties(cube).volume, 1.0, 1e-9);
}

TEST(EdgeInsertion, UndoesInsertionsThatMatchNothing) {
  // The corner of a separate open cup touches the middle of an edge of another.
  const TriangleMesh cup = without_face(cube_mesh(), 2);
  TriangleMesh two = joined(cup, without_face(cube_mesh(1, Vec3(0.5, 1.0, 1.0)), 2));
  two = weld(two).mesh;
  const std::vector<Triangle> before = two.triangles;
  EXPECT_TRUE(insert(two).empty());
  EXPECT_EQ(two.triangles, before);
}

TEST(EdgeInsertion, DividesARingOfTwoDivisionsOnBothSides) {
  // Two fans over one circle of a square, divided in 12 and in 16.
  TriangleMesh mesh;
  const auto add_fan = [&mesh](int divisions, double z, bool up) {
    std::vector<std::int32_t> ring;
    for (int side = 0; side < 4; ++side) {
      const Vec3 from(side == 1 || side == 2 ? 1 : 0, side >= 2 ? 1 : 0, 0);
      const Vec3 to(side <= 1 ? 1 : 0, side == 1 || side == 2 ? 1 : 0, 0);
      for (int i = 0; i < divisions / 4; ++i)
        ring.push_back(mesh.add_vertex(from + (to - from) * (4.0 * i / divisions)));
    }
    const std::int32_t tip = mesh.add_vertex({0.5, 0.5, z});
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::int32_t next = ring[(i + 1) % ring.size()];
      mesh.triangles.push_back(up ? Triangle{ring[i], next, tip} : Triangle{next, ring[i], tip});
    }
  };
  add_fan(12, 1.0, true);
  add_fan(16, -1.0, false);
  mesh = weld(mesh).mesh;
  EXPECT_EQ(mesh_topology(mesh).counts.boundary, 28);
  const RepairReport report = insert(mesh);
  EXPECT_TRUE(mesh_topology(mesh).counts.all_matched());
  EXPECT_EQ(report.steps[0].count, 20);
  EXPECT_NEAR(mass_properties(mesh).volume, 2.0 / 3.0, 1e-15);
}

// Nearly every vertex lies on nearly every edge: millions of insertions.
TEST(EdgeInsertion, EndsOnBundlesOfNeedles) {
  TriangleMesh bundle;
  constexpr std::int32_t kNeedles = 3'000;
  for (std::int32_t i = 0; i < kNeedles; ++i) {
    const double at = static_cast<double>(i) / kNeedles;
    const std::int32_t a = bundle.add_vertex({at, 0, 1e-9 * i});
    const std::int32_t b = bundle.add_vertex({1.0 + at, 0, -1e-9 * i});
    const std::int32_t c = bundle.add_vertex({1.0 + 0.5 * at, 0, 1e-9});
    bundle.triangles.push_back({a, b, c});
  }
  const MeshValidation validation = validate_mesh({bundle, {}}, "bundle");
  EXPECT_FALSE(validation.mesh);
  ASSERT_FALSE(validation.report.repair.skipped.empty());
  EXPECT_EQ(validation.report.repair.skipped[0].obstacle, RepairObstacle::kTooMany);
}

TEST(MeshRepair, ClosesACrackAndATJunctionTogether) {
  TriangleMesh cube = with_t_junction(unwelded(cube_mesh()), 5);
  cube.x[2] += 1e-6;
  const MeshValidation validation = validate_mesh({cube, {}}, "cube");
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_EQ(validation.report.weld, WeldKind::kTolerance);
  ASSERT_EQ(validation.report.repair.steps.size(), 2U);
  EXPECT_FALSE(validation.report.repair.steps[0].after);
  EXPECT_FALSE(validation.report.repair.steps[1].before);
  ASSERT_TRUE(validation.report.repair.steps[1].after);
  EXPECT_NEAR(validation.report.repair.steps[1].after->volume, 1.0, 2e-6);
  EXPECT_LE(std::abs(validation.report.volume - 1.0), validation.report.repair.volume_bound);
}

TEST(MeshRepair, KeepsTrianglesOfACleanMesh) {
  const TriangleMesh rock = rock_mesh();
  const MeshValidation validation = validate_mesh({rock, {}}, "rock");
  ASSERT_TRUE(validation.mesh);
  EXPECT_TRUE(validation.report.repair.empty());
  EXPECT_EQ(validation.mesh->mesh.triangles, rock.triangles);
  EXPECT_EQ(validation.mesh->mesh.x, rock.x);
}

// All of it is within the tolerance of a line; what the steps would leave of it is no body.
TEST(MeshRepair, RefusesAStripThinnerThanTheTolerance) {
  TriangleMesh strip;
  constexpr std::int32_t kLength = 1'000;
  for (std::int32_t i = 0; i <= kLength; ++i) {
    strip.add_vertex({0.1 * i, 0, 0});
    strip.add_vertex({0.1 * i, 5e-7 * (i % 3), 1e-6});
  }
  for (std::int32_t i = 0; i < 2 * kLength; i += 2) {
    strip.triangles.push_back({i, i + 2, i + 1});
    strip.triangles.push_back({i + 1, i + 2, i + 3});
  }
  const MeshValidation validation = validate_mesh({strip, {}}, "strip");
  EXPECT_FALSE(validation.mesh) << to_text(validation.report);
}

TEST(MeshRepair, IsSwitchedOff) {
  const TriangleMesh cube = with_t_junction(cube_mesh(), 0);
  EXPECT_TRUE(validate_mesh({cube, {}}, "cube").mesh);
  const MeshValidation off = validate_mesh({cube, {}}, "cube", {.repair = RepairPolicy::kNone});
  EXPECT_FALSE(off.mesh);
  EXPECT_TRUE(off.report.repair.empty());
}

TEST(MeshRepair, LeavesARepairedMeshAsItIs) {
  const MeshValidation first = validate_mesh({with_t_junction(rock_mesh(), 3), {}}, "rock");
  ASSERT_TRUE(first.mesh);
  EXPECT_FALSE(first.report.repair.empty());
  const MeshValidation second = validate_mesh({first.mesh->mesh, {}}, "rock");
  ASSERT_TRUE(second.mesh);
  EXPECT_TRUE(second.report.repair.empty());
  EXPECT_EQ(second.mesh->mesh.triangles, first.mesh->mesh.triangles);
}

}  // namespace
}  // namespace buoyancy
