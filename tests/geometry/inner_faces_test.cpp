#include "geometry/inner_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/mesh_validation.h"
#include "geometry/welding.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/geometry/validated.h"

namespace buoyancy {
namespace {

void add_quad(TriangleMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  std::vector<std::int32_t> v;
  for (const Vec3& corner : {a, b, c, d}) v.push_back(mesh.add_vertex(corner));
  mesh.triangles.push_back({v[0], v[1], v[2]});
  mesh.triangles.push_back({v[0], v[2], v[3]});
}

// A box of two boxes' walls, one on the other, without the walls between them.
TriangleMesh two_storeys() {
  TriangleMesh lower = box_mesh(Vec3(0, 0, 0), Vec3(2, 1, 1));
  lower.triangles.erase(lower.triangles.begin() + 2, lower.triangles.begin() + 4);
  TriangleMesh upper = box_mesh(Vec3(0, 0, 1), Vec3(2, 1, 2));
  upper.triangles.erase(upper.triangles.begin(), upper.triangles.begin() + 2);
  return weld(joined(lower, upper)).mesh;
}

TEST(InnerFaces, RemovesADeck) {
  for (const bool turned : {false, true}) {
    TriangleMesh hull = two_storeys();
    add_quad(hull, {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1});
    if (turned) std::swap(hull.triangles.back()[0], hull.triangles.back()[1]);
    const MeshValidation validation = validate(hull);
    ASSERT_TRUE(validation.mesh) << validation.refusal->message();
    const RepairStep* const step = step_of(validation, RepairKind::kRemoveInnerFaces);
    ASSERT_NE(step, nullptr);
    EXPECT_EQ(step->count, 2);
    EXPECT_DOUBLE_EQ(step->area, 2.0);
    EXPECT_DOUBLE_EQ(validation.report.volume, 4.0);
    EXPECT_EQ(validation.report.repair.steps.size(), 1U);
    EXPECT_EQ(validation.mesh->mesh.triangles, two_storeys().triangles);
  }
}

// A cap over the deck's rim would replace the roof by the bent deck.
TEST(InnerFaces, RemovesABentDeckAndAFin) {
  TriangleMesh hull = two_storeys();
  const Vec3 tip(1, 0.5, 1.4);
  const std::vector<Vec3> rim{{0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1}};
  for (std::size_t i = 0; i < 4; ++i) add_quad(hull, rim[i], rim[(i + 1) % 4], tip, tip);
  add_quad(hull, {2, 0, 1}, {3, 0, 1}, {3, 1, 1}, {2, 1, 1});
  const MeshValidation validation = validate(hull);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveInnerFaces)->count, 4);
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveSheets)->count, 2);
  EXPECT_DOUBLE_EQ(step_of(validation, RepairKind::kRemoveSheets)->area, 1.0);
  EXPECT_DOUBLE_EQ(validation.report.volume, 4.0);
}

TEST(InnerFaces, GivesTheSurfaceAConsistentWinding) {
  TriangleMesh hull = two_storeys();
  add_quad(hull, {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1});
  for (const std::size_t f : {1U, 6U, 7U, 12U}) std::swap(hull.triangles[f][0], hull.triangles[f][1]);
  const MeshValidation validation = validate(hull);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_EQ(step_of(validation, RepairKind::kTurnFaces)->count, 4);
  EXPECT_DOUBLE_EQ(validation.report.volume, 4.0);
  const MeshValidation reversed = validate(inside_out(hull));
  ASSERT_TRUE(reversed.mesh);
  EXPECT_TRUE(reversed.report.flipped);
  EXPECT_DOUBLE_EQ(reversed.report.volume, 4.0);
}

TEST(InnerFaces, RefusesAHullWhoseUpperStoreyIsOpen) {
  // The deck closes the lower storey; a volume without the upper one would be wrong.
  TriangleMesh hull = two_storeys();
  add_quad(hull, {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1});
  hull = weld(hull).mesh;
  for (std::size_t f = 0; f < hull.triangles.size(); ++f) {
    double lowest = 9.0;
    for (const std::int32_t v : hull.triangles[f])
      lowest = std::min(lowest, hull.z[static_cast<std::size_t>(v)]);
    if (lowest < 2.0) continue;
    hull.triangles.erase(hull.triangles.begin() + static_cast<std::ptrdiff_t>(f));
    break;
  }
  const MeshValidation validation = validate(hull);
  EXPECT_FALSE(validation.mesh);
  ASSERT_FALSE(validation.report.repair.skipped.empty());
  EXPECT_EQ(validation.report.repair.skipped[0].kind, RepairKind::kRemoveInnerFaces);
  EXPECT_EQ(validation.report.repair.skipped[0].obstacle, RepairObstacle::kLeak);
}

// The deck closes the lower storey; but the roof above it, that has a window, is no fin.
TEST(InnerFaces, RefusesAFlatWallWithAHole) {
  for (const bool at_corner : {false, true}) {
    TriangleMesh hull = cube_mesh();
    const std::int32_t tip = hull.add_vertex({0, 0, 0.2});
    const std::vector<std::int32_t> rim{4, 5, 7, 6};  // the top: faces 2 and 3, 4 5 6 and 5 7 6
    for (std::size_t i = 0; i < 4; ++i) hull.triangles.push_back({rim[i], rim[(i + 1) % 4], tip});
    if (at_corner) {
      const std::int32_t a = hull.add_vertex({-0.4, -0.5, 0.5});
      const std::int32_t b = hull.add_vertex({-0.5, -0.4, 0.5});
      hull.triangles[2] = {a, 5, 6};
      hull.triangles.push_back({a, 6, b});
    } else {
      std::vector<std::int32_t> window;
      for (const Vec3& corner : {Vec3(-0.3, -0.3, 0.5), Vec3(-0.1, -0.3, 0.5), Vec3(-0.3, -0.1, 0.5)})
        window.push_back(hull.add_vertex(corner));
      hull.triangles[2] = {4, 5, window[0]};
      for (const Triangle& piece : {Triangle{5, window[1], window[0]},
                                    {5, 6, window[1]},
                                    {6, window[2], window[1]},
                                    {6, 4, window[2]},
                                    {4, window[0], window[2]}})
        hull.triangles.push_back(piece);
    }
    EXPECT_FALSE(validate(hull).mesh) << to_text(validate(hull).report);
  }
}

TEST(InnerFaces, LeavesFacesWhereTheSurfaceIntersectsItself) {
  TriangleMesh hull = two_storeys();
  add_quad(hull, {0, 0, 1}, {2, 0, 1}, {2, 1, 1}, {0, 1, 1});
  add_quad(hull, {0, 0, 1}, {2, 0, 1}, {3, 0.5, 5}, {0, 0.5, 5});
  const MeshValidation validation = validate(hull);
  EXPECT_FALSE(validation.mesh);
  EXPECT_EQ(validation.report.repair.skipped.at(0).obstacle, RepairObstacle::kSelfIntersection);
}

TEST(InnerFaces, SeesThroughHolesInBulkheads) {
  TriangleMesh hull = two_storeys();
  add_quad(hull, {0, 0, 1}, {2, 0, 1}, {1.5, 0.25, 1}, {0.5, 0.25, 1});
  const MeshValidation validation = validate(hull);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveInnerFaces)->count, 2);
}

TEST(InnerFaces, OrientsSolidsThatTouchInAnEdge) {
  // Most faces of the second box are turned.
  TriangleMesh second = box_mesh(Vec3(1, 1, 0), Vec3(2, 2, 1));
  for (std::size_t f = 0; f < 9; ++f) std::swap(second.triangles[f][0], second.triangles[f][1]);
  const MeshValidation validation = validate(joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)), second));
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_DOUBLE_EQ(validation.report.volume, 2.0);
  EXPECT_EQ(validation.report.balanced_edges, 1);
}

TEST(InnerFaces, KeepsAnOpenMeshWithItsDeckIfItStaysOpen) {
  TriangleMesh hull = two_storeys();
  add_quad(hull, {4, 0, 1}, {5, 0, 1}, {5, 1, 1}, {4, 1, 1});
  hull = without_face(weld(hull).mesh, 9);
  const MeshValidation validation = validate(hull, OpenPolicy::kDryBoundary);
  ASSERT_TRUE(validation.mesh);
  EXPECT_TRUE(validation.report.repair.empty());
  EXPECT_EQ(validation.mesh->mesh.triangles.size(), hull.triangles.size());
}

TEST(FlatSheets, RemovesAPlateBesideAHull) {
  TriangleMesh hull = two_storeys();
  add_quad(hull, {0, 0, -1}, {2, 0, -1}, {2, 1, -1.2}, {0, 1, -1.2});
  const MeshValidation validation = validate(hull);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  ASSERT_EQ(validation.report.repair.steps.size(), 1U);
  EXPECT_EQ(validation.report.repair.steps[0].kind, RepairKind::kRemoveSheets);
  EXPECT_EQ(validation.report.repair.steps[0].count, 2);
  EXPECT_NEAR(validation.report.repair.steps[0].area, 2 * std::sqrt(1.04), 1e-12);
  EXPECT_DOUBLE_EQ(validation.report.volume, 4.0);
  EXPECT_EQ(validation.report.triangles, 20);
}

TEST(FlatSheets, RefusesABentPlate) {
  TriangleMesh hull = two_storeys();
  add_quad(hull, {0, 0, -1}, {2, 0, -1}, {2, 1, -1.2}, {0, 1, -1});
  EXPECT_FALSE(validate(hull).mesh);
}

// Without its walls, which do not quite meet, the mesh would be the small box alone.
TEST(FlatSheets, RefusesWallsThatDoNotQuiteMeet) {
  TriangleMesh walls = cube_mesh(0.1, Vec3(3, 0, 0));
  const TriangleMesh cube = cube_mesh(1.0);
  for (std::size_t f = 0; f < 12; f += 2) {
    TriangleMesh wall = cube;
    wall.triangles = {cube.triangles[f], cube.triangles[f + 1]};
    Vec3 center = Vec3::Zero();
    for (const std::int32_t v : wall.triangles[0]) center += cube.vertex(v) / 3.0;
    for (const std::int32_t v : wall.triangles[1]) center += cube.vertex(v) / 3.0;
    walls = joined(walls, moved_mesh(wall, Mat3::Identity(), 1e-4 * center));
  }
  const MeshValidation validation = validate(walls);
  EXPECT_FALSE(validation.mesh);
  EXPECT_EQ(validation.report.repair.skipped.at(0).obstacle, RepairObstacle::kAmbiguous);
}

TEST(FlatSheets, StaysIfNothingElseIsThere) {
  TriangleMesh plate;
  add_quad(plate, {0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0});
  const MeshValidation validation = validate(plate);
  EXPECT_FALSE(validation.mesh);
  EXPECT_EQ(validation.report.triangles, 2);
}

TEST(InnerFaces, RemovesManyDecks) {
  TriangleMesh tower;
  constexpr int kStoreys = 5'000;
  for (int i = 0; i < kStoreys; ++i) {
    const double z = i;
    add_quad(tower, {0, 0, z}, {1, 0, z}, {1, 0, z + 1}, {0, 0, z + 1});
    add_quad(tower, {1, 0, z}, {1, 1, z}, {1, 1, z + 1}, {1, 0, z + 1});
    add_quad(tower, {1, 1, z}, {0, 1, z}, {0, 1, z + 1}, {1, 1, z + 1});
    add_quad(tower, {0, 1, z}, {0, 0, z}, {0, 0, z + 1}, {0, 1, z + 1});
    add_quad(tower, {0, 0, z}, {0, 1, z}, {1, 1, z}, {1, 0, z});
  }
  add_quad(tower, {0, 0, kStoreys}, {1, 0, kStoreys}, {1, 1, kStoreys}, {0, 1, kStoreys});
  const MeshValidation validation = validate(tower);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_EQ(step_of(validation, RepairKind::kRemoveInnerFaces)->count, 2 * (kStoreys - 1));
  EXPECT_NEAR(validation.report.volume, kStoreys, 1e-9);
}

}  // namespace
}  // namespace buoyancy
