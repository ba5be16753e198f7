#include "geometry/duplicate_faces.h"

#include <algorithm>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/mesh_validation.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/geometry/validated.h"

namespace buoyancy {
namespace {

TEST(DuplicateFaces, StoresAPartOnceThatIsStoredTwice) {
  const TriangleMesh part = rock_mesh(4);
  const double volume = validate(part).report.volume;
  const MeshValidation twice = validate(joined(joined(part, cube_mesh(1, Vec3(9, 0, 0))), part));
  ASSERT_TRUE(twice.mesh);
  EXPECT_NEAR(twice.report.volume, volume + 1.0, 1e-12);
  EXPECT_EQ(twice.report.duplicate_faces, 0);
  const RepairStep* const step = step_of(twice, RepairKind::kRemoveDuplicates);
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->count, static_cast<std::int64_t>(part.triangles.size()));
  EXPECT_NEAR(step->area, validate(part).report.area, 1e-12);
  EXPECT_NEAR(step->before.value().volume, 2.0 * volume + 1.0, 1e-12);
  EXPECT_NEAR(step->after.value().volume, volume + 1.0, 1e-12);
}

TEST(DuplicateFaces, RemovesSingleCopies) {
  TriangleMesh cube = cube_mesh();
  for (int copy = 0; copy < 3; ++copy) cube.triangles.push_back(cube.triangles[4]);
  cube.triangles.push_back({cube.triangles[7][1], cube.triangles[7][2], cube.triangles[7][0]});
  const MeshValidation validation = validate(cube);
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(validation.mesh->mesh.triangles, cube_mesh().triangles);
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveDuplicates)->count, 4);
}

// The smaller box shares a whole face with the larger one. Without a copy of it, one of them would be open.
TEST(DuplicateFaces, KeepsCopiesThatTheirSurfacesNeed) {
  TriangleMesh flush = box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1));
  flush = joined(flush, box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 0.5)));
  const MeshValidation validation = validate(flush);
  ASSERT_TRUE(validation.mesh);
  EXPECT_TRUE(validation.report.repair.steps.empty());
  EXPECT_EQ(validation.report.duplicate_faces, 2);
  EXPECT_DOUBLE_EQ(validation.report.volume, 1.5);
}

TEST(DuplicateFaces, LeavesOneSideOfASurfaceStoredForBothSides) {
  const TriangleMesh rock = rock_mesh(4);
  const MeshValidation validation = validate(joined(rock, inside_out(rock)));
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(validation.mesh->mesh.triangles, rock.triangles);
  const RepairStep* const step = step_of(validation, RepairKind::kRemoveBackFaces);
  ASSERT_NE(step, nullptr);
  EXPECT_EQ(step->count, static_cast<std::int64_t>(rock.triangles.size()));
}

// The two sides of each of the box's faces are divided by different diagonals.
TEST(DuplicateFaces, RecognisesSidesThatAreDividedOtherwise) {
  TriangleMesh box = box_mesh(Vec3(0, 0, 0), Vec3(2, 1, 1));
  const std::size_t faces = box.triangles.size();
  for (std::size_t f = 0; f < faces; f += 2) {
    // a b c and the triangle on its longest edge become the two triangles of the other diagonal.
    const Triangle s = box.triangles[f];
    const Triangle t = box.triangles[f + 1];
    std::size_t lone_s = 0;
    while (std::find(t.begin(), t.end(), s[lone_s]) != t.end()) ++lone_s;
    std::size_t lone_t = 0;
    while (std::find(s.begin(), s.end(), t[lone_t]) != s.end()) ++lone_t;
    const std::int32_t a = s[lone_s];
    const std::int32_t b = s[(lone_s + 1) % 3];
    const std::int32_t c = t[lone_t];
    const std::int32_t d = s[(lone_s + 2) % 3];
    box.triangles.push_back({a, c, b});
    box.triangles.push_back({a, d, c});
  }
  const MeshValidation validation = validate(box);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_DOUBLE_EQ(validation.report.volume, 2.0);
  EXPECT_EQ(validation.mesh->mesh.triangles, box_mesh(Vec3(0, 0, 0), Vec3(2, 1, 1)).triangles);
}

// The same, but not flat: a tetrahedron is two pairs of triangles with the same rim.
TEST(DuplicateFaces, KeepsATetrahedronBesideAnEdgeOfAnother) {
  TriangleMesh two = tetrahedron_mesh();
  const std::int32_t c = two.add_vertex({0, 0, -1});
  const std::int32_t d = two.add_vertex({0, -1, 0});
  for (const Triangle& face : {Triangle{0, 1, c}, {0, d, 1}, {0, c, d}, {1, d, c}})
    two.triangles.push_back(face);
  const MeshValidation validation = validate(two);
  ASSERT_TRUE(validation.mesh);
  EXPECT_TRUE(validation.report.repair.empty());
  EXPECT_EQ(validation.report.triangles, 8);
}

TEST(DuplicateFaces, LeavesOneSideOfAFaceThatItsNeighboursNeed) {
  TriangleMesh cube = cube_mesh();
  cube.triangles.push_back({cube.triangles[3][0], cube.triangles[3][2], cube.triangles[3][1]});
  const MeshValidation validation = validate(cube);
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(validation.mesh->mesh.triangles, cube_mesh().triangles);
}

TEST(DuplicateFaces, RemovesTheWallBetweenTwoSolids) {
  const TriangleMesh boxes =
      joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)), box_mesh(Vec3(1, 0, 0), Vec3(3, 1, 1)));
  const MeshValidation validation = validate(boxes);
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveBackFaces)->count, 2);
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveInnerFaces)->count, 2);
  EXPECT_EQ(validation.report.balanced_edges, 0);
  EXPECT_EQ(validation.report.components.size(), 1U);
  EXPECT_DOUBLE_EQ(validation.report.volume, 3.0);
  EXPECT_DOUBLE_EQ(validation.report.repair.steps.front().before.value().volume, 3.0);
}

// Where a part crosses the surface, walls cannot be told from it; but both their sides cancel.
TEST(DuplicateFaces, KeepsBothSidesOfAWallInASurfaceThatIntersectsItself) {
  TriangleMesh boxes = joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)), box_mesh(Vec3(1, 0, 0), Vec3(3, 1, 1)));
  // A tetrahedron on an edge of the first box that crosses its side.
  TriangleMesh crossing = tetrahedron_mesh();
  crossing.x = {0, 0, 0.3, -0.3};
  crossing.y = {0, 1, 0.4, 0.4};
  crossing.z = {1, 1, 0.8, 1.2};
  boxes = joined(boxes, crossing);
  const MeshValidation validation = validate(boxes);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_TRUE(validation.report.repair.steps.empty());
  ASSERT_EQ(validation.report.repair.skipped.size(), 1U);
  EXPECT_EQ(validation.report.repair.skipped[0].obstacle, RepairObstacle::kSelfIntersection);
}

TEST(DuplicateFaces, RemovesBothSidesOfAFinOnAClosedHull) {
  TriangleMesh hull = cube_mesh();
  const std::int32_t tip = hull.add_vertex({0, -3, -3});
  hull.triangles.push_back({0, 1, tip});
  hull.triangles.push_back({1, 0, tip});
  const MeshValidation validation = validate(hull);
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveBackFaces)->count, 1);
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveSheets)->count, 1);
  EXPECT_EQ(validation.mesh->mesh.triangles, cube_mesh().triangles);
  EXPECT_EQ(validation.mesh->mesh.vertex_count(), 8U);
}

TEST(DuplicateFaces, RemovesBothSidesOfAFlatSheetBesideAHull) {
  TriangleMesh sheet = box_mesh(Vec3(3, 0, 0), Vec3(4, 1, 1));
  sheet.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 1, 2}, {1, 3, 2}};
  const MeshValidation validation = validate(joined(cube_mesh(), sheet));
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveSheets)->count, 2);
  EXPECT_EQ(validation.report.triangles, 12);
  EXPECT_FALSE(validate(sheet).mesh);
}

TEST(DuplicateFaces, EndsOnManyCoincidentFaces) {
  TriangleMesh cube = cube_mesh();
  for (int copy = 0; copy < 10'000; ++copy) {
    cube.triangles.push_back(cube.triangles[0]);
    std::swap(cube.triangles.back()[0], cube.triangles.back()[copy % 3 == 0 ? 1 : 0]);
  }
  const MeshValidation validation = validate(cube);
  ASSERT_TRUE(validation.mesh);
  EXPECT_DOUBLE_EQ(validation.report.volume, 1.0);
}

}  // namespace
}  // namespace buoyancy
