#include "geometry/welding.h"

#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "geometry/mass_properties.h"
#include "geometry/mesh_topology.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {
namespace {

TEST(Welding, MergesEqualVerticesInOrderOfOccurrence) {
  const TriangleMesh cube = cube_mesh();
  const WeldedMesh welded = weld(unwelded(cube));
  EXPECT_EQ(welded.vertices_stored, 36);
  ASSERT_EQ(welded.mesh.vertex_count(), 8U);
  ASSERT_EQ(welded.mesh.triangles.size(), 12U);
  // The first face of the cube is 0, 2, 1: its corners come first in the soup.
  EXPECT_EQ(welded.mesh.triangles.front(), (Triangle{0, 1, 2}));
  for (std::size_t f = 0; f < cube.triangles.size(); ++f) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(welded.mesh.vertex(welded.mesh.triangles[f][corner]), cube.vertex(cube.triangles[f][corner]));
    }
  }
}

TEST(Welding, LeavesWeldedMeshUnchanged) {
  const TriangleMesh sphere = rock_mesh();
  const WeldedMesh welded = weld(sphere);
  EXPECT_EQ(welded.mesh.x, sphere.x);
  EXPECT_EQ(welded.mesh.y, sphere.y);
  EXPECT_EQ(welded.mesh.z, sphere.z);
  EXPECT_EQ(welded.mesh.triangles, sphere.triangles);
}

TEST(Welding, TreatsMinusZeroAsZero) {
  TriangleMesh soup = unwelded(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  for (std::size_t v = 0; v < soup.vertex_count(); v += 2) {
    if (soup.x[v] == 0.0) soup.x[v] = -0.0;
  }
  EXPECT_EQ(weld(soup).mesh.vertex_count(), 8U);
}

TEST(Welding, RemovesUnusedVertices) {
  TriangleMesh mesh = cube_mesh();
  mesh.x.insert(mesh.x.begin(), 100.0);
  mesh.y.insert(mesh.y.begin(), 100.0);
  mesh.z.insert(mesh.z.begin(), 100.0);
  for (Triangle& face : mesh.triangles) {
    for (std::int32_t& vertex : face) ++vertex;
  }
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.vertices_stored, 9);
  EXPECT_EQ(welded.mesh.vertex_count(), 8U);
  EXPECT_EQ(welded.mesh.triangles, cube_mesh().triangles);
}

TEST(Welding, DropsAndCountsDegenerateFaces) {
  TriangleMesh mesh = cube_mesh();
  mesh.triangles.push_back({3, 3, 5});
  const std::int32_t copy = mesh.add_vertex(mesh.vertex(7));
  mesh.triangles.push_back({7, 2, copy});
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.faces_dropped, 2);
  EXPECT_EQ(welded.mesh.triangles.size(), 12U);
  EXPECT_EQ(welded.mesh.vertex_count(), 8U);
}

// Returns an unwelded sphere whose copies of a vertex are up to `jitter` apart along x [m].
TriangleMesh cracked_sphere(double jitter) {
  TriangleMesh soup = unwelded(sphere_mesh(10));
  for (std::size_t v = 0; v < soup.vertex_count(); ++v)
    soup.x[v] += jitter * static_cast<double>(v % 7) / 6.0;
  return soup;
}

// Welds exactly, then within the tolerance; returns the report on the second.
RepairReport weld_cracks(TriangleMesh& mesh) {
  mesh = weld(mesh).mesh;
  RepairReport report;
  weld_within_tolerance(mesh, 1e-6 * bounding_box(mesh).diagonal(), report);
  return report;
}

TEST(Welding, ClosesCracksBelowTolerance) {
  TriangleMesh sphere = cracked_sphere(1e-6);  // the diagonal is 2 sqrt(3)
  const std::size_t faces = sphere.triangles.size();
  const RepairReport report = weld_cracks(sphere);
  EXPECT_TRUE(mesh_topology(sphere).counts.all_matched());
  EXPECT_EQ(sphere.vertex_count(), sphere_mesh(10).vertex_count());
  EXPECT_EQ(sphere.triangles.size(), faces);
  ASSERT_EQ(report.steps.size(), 1U);
  EXPECT_EQ(report.steps[0].kind, RepairKind::kWeld);
  EXPECT_GT(report.steps[0].count, 0);
  EXPECT_GT(report.steps[0].max_move, 0.0);
  EXPECT_LE(report.steps[0].max_move, 1e-6 * (1.0 + 1e-9));
  EXPECT_GT(report.volume_bound, 0.0);
  EXPECT_LE(report.volume_bound, 4 * 3.15 * 1.01e-6);
}

// Copies of a vertex in any direction from each other, in meshes of any size and place: merged up to the
// tolerance, and not beyond.
TEST(Welding, MergesVerticesUpToTheToleranceInEveryDirection) {
  RandomPoses random(19);
  for (int i = 0; i < 200; ++i) {
    const double scale = std::array{1e-3, 1.0, 1e3}.at(random.pick(3));
    const Vec3 corner = 0.1 * scale * random.direction();
    const Vec3 sides{random.uniform(0.5, 2.0), random.uniform(0.5, 2.0), random.uniform(0.5, 2.0)};
    const TriangleMesh box = box_mesh(corner, corner + scale * sides);
    const double tolerance = 1e-6 * bounding_box(box).diagonal();
    const Vec3 crack = random.direction();
    for (const double share : {0.999, 1.001}) {
      TriangleMesh soup = unwelded(box);
      for (std::size_t v = 0; v < soup.vertex_count(); ++v) {
        if (random.pick(2) == 0) continue;
        soup.x[v] += share * tolerance * crack.x();
        soup.y[v] += share * tolerance * crack.y();
        soup.z[v] += share * tolerance * crack.z();
      }
      soup = weld(soup).mesh;
      RepairReport report;
      weld_within_tolerance(soup, tolerance, report);
      EXPECT_EQ(soup.vertex_count() == 8U, share < 1.0) << i << ": " << soup.vertex_count();
      EXPECT_EQ(report.empty(), share > 1.0) << i;
      // Faces that move along their normals sweep what the bound allows, up to terms of second order.
      if (share < 1.0) {
        const double moved = std::abs(mass_properties(soup).volume - mass_properties(box).volume);
        EXPECT_LE(moved, report.volume_bound);
      }
    }
  }
}

TEST(Welding, KeepsToleranceWeldThatLeavesAHole) {
  TriangleMesh sphere = without_face(cracked_sphere(1e-6), 17);
  EXPECT_EQ(weld_cracks(sphere).steps.size(), 1U);
  EXPECT_EQ(mesh_topology(sphere).counts.unmatched(), 3);
}

TEST(Welding, LeavesWiderCracks) {
  TriangleMesh sphere = cracked_sphere(1e-4);
  EXPECT_TRUE(weld_cracks(sphere).empty());
}

TEST(Welding, MovesOnlyVerticesOfUnmatchedEdges) {
  // A closed tetrahedron far smaller than the tolerance is unchanged next to the cracked sphere.
  TriangleMesh tiny = tetrahedron_mesh();
  for (auto* coordinates : {&tiny.x, &tiny.y, &tiny.z}) {
    for (double& coordinate : *coordinates) coordinate *= 1e-8;
  }
  TriangleMesh both = joined(cracked_sphere(1e-6), tiny);
  EXPECT_EQ(weld_cracks(both).steps.size(), 1U);
  EXPECT_EQ(both.vertex_count(), sphere_mesh(10).vertex_count() + 4);
}

TEST(Welding, KeepsChainsOfCloseVertices) {
  // The 2000 vertices around this hole are 0.3 tolerances apart; closing it would move vertices far.
  TriangleMesh ring;
  constexpr std::int32_t kVertices = 2000;
  const double radius = 0.3e-6 * kVertices / 6.283;
  const std::int32_t apex = ring.add_vertex({0, 0, 1});
  for (std::int32_t i = 0; i < kVertices; ++i) {
    const double angle = 6.283185307179586 * i / kVertices;
    ring.add_vertex({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  for (std::int32_t i = 0; i < kVertices; ++i)
    ring.triangles.push_back({apex, 1 + i, 1 + (i + 1) % kVertices});
  TriangleMesh both = joined(ring, cube_mesh(0.5, Vec3(0, 0, 2)));
  EXPECT_TRUE(weld_cracks(both).empty());
  EXPECT_EQ(both.vertex_count(), 2001U + 8U);
}

}  // namespace
}  // namespace buoyancy
