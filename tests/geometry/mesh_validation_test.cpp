#include "geometry/mesh_validation.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/welding.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/geometry/validated.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

void expect_refused(const MeshValidation& validation, const std::string& text) {
  EXPECT_FALSE(validation.mesh);
  ASSERT_TRUE(validation.refusal);
  EXPECT_EQ(validation.refusal->subject, "hull.stl");
  EXPECT_TRUE(contains(validation.refusal->message(), text));
  EXPECT_FALSE(validation.refusal->hint.empty());
}

TEST(MeshValidation, AcceptsAndMeasuresClosedMesh) {
  const MeshValidation cube = validate(cube_mesh(2, Vec3(10, 0, 0)));
  ASSERT_TRUE(cube.mesh);
  EXPECT_FALSE(cube.refusal);
  EXPECT_TRUE(cube.report.closed());
  EXPECT_EQ(cube.report.name, "hull.stl");
  EXPECT_EQ(cube.report.triangles, 12);
  EXPECT_EQ(cube.report.vertices_welded, 8);
  EXPECT_EQ(cube.report.box.min_B, Vec3(9, -1, -1));
  EXPECT_DOUBLE_EQ(cube.report.diagonal, std::sqrt(12.0));
  EXPECT_DOUBLE_EQ(cube.report.area, 24.0);
  EXPECT_DOUBLE_EQ(cube.report.volume, 8.0);
  EXPECT_EQ(cube.report.volume_by_axis, Vec3::Constant(8.0));
  EXPECT_EQ(cube.report.area_vector, Vec3::Zero());
  ASSERT_EQ(cube.report.components.size(), 1U);
  EXPECT_TRUE(cube.report.components[0].closed);
  EXPECT_FALSE(cube.report.flipped);
  EXPECT_TRUE(cube.mesh->boundary_vertices.empty());
}

TEST(MeshValidation, GivesSameResultForUnweldedMesh) {
  const TriangleMesh sphere = rock_mesh();
  const MeshReport welded = validate(sphere).report;
  const MeshReport soup = validate(unwelded(sphere)).report;
  EXPECT_EQ(soup.vertices_stored, 3 * welded.triangles);
  EXPECT_EQ(soup.vertices_welded, welded.vertices_welded);
  EXPECT_EQ(soup.volume, welded.volume);
  EXPECT_EQ(soup.area, welded.area);
  EXPECT_TRUE(soup.closed());
}

TEST(MeshValidation, AcceptsBalancedEdges) {
  const MeshValidation cubes =
      validate(joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)), box_mesh(Vec3(1, 1, 0), Vec3(2, 2, 1))));
  ASSERT_TRUE(cubes.mesh);
  EXPECT_EQ(cubes.report.balanced_edges, 1);
  EXPECT_DOUBLE_EQ(cubes.report.volume, 2.0);
}

TEST(MeshValidation, TurnsAndReportsInsideOutMesh) {
  const MeshValidation cube = validate(inside_out(cube_mesh()));
  ASSERT_TRUE(cube.mesh);
  EXPECT_TRUE(cube.report.flipped);
  EXPECT_TRUE(cube.report.components[0].flipped);
  EXPECT_DOUBLE_EQ(cube.report.volume, 1.0);
  EXPECT_DOUBLE_EQ(cube.report.components[0].volume, 1.0);
  EXPECT_DOUBLE_EQ(validate(cube.mesh->mesh).report.volume, 1.0);
  EXPECT_FALSE(validate(cube.mesh->mesh).report.flipped);
}

TEST(MeshValidation, RefusesOpenMeshAndLocatesHole) {
  const MeshValidation open = validate(without_face(cube_mesh(), 0));
  expect_refused(open, "3 boundary edges in 1 hole (between (-0.5, -0.5, -0.5) and (0.5, 0.5, -0.5))");
  expect_refused(open, "dry_boundary");
  EXPECT_EQ(open.report.boundary_edges, 3);
  ASSERT_EQ(open.report.holes.size(), 1U);
  EXPECT_EQ(open.report.holes[0].edges, 3);
  EXPECT_FALSE(open.report.components[0].closed);
}

TEST(MeshValidation, AcceptsOpenMeshWithDryBoundaryPolicy) {
  const MeshValidation open = validate(without_face(cube_mesh(), 2), OpenPolicy::kDryBoundary);  // 4 5 6
  ASSERT_TRUE(open.mesh);
  EXPECT_EQ(open.mesh->boundary_vertices, (std::vector<std::int32_t>{4, 5, 6}));
  EXPECT_FALSE(open.report.flipped);
}

TEST(MeshValidation, TurnsInsideOutOpenMesh) {
  TriangleMesh cup = cube_mesh();
  cup.triangles.erase(cup.triangles.begin() + 2, cup.triangles.begin() + 4);
  const MeshValidation turned = validate(inside_out(cup), OpenPolicy::kDryBoundary);
  ASSERT_TRUE(turned.mesh);
  EXPECT_TRUE(turned.report.flipped);
  EXPECT_EQ(validate(turned.mesh->mesh, OpenPolicy::kDryBoundary).report.flipped, false);
}

// Returns a basin of 1 m by 1 m by 1 m, open at the top, with a flange of 10 m by 10 m around its rim.
TriangleMesh flanged_basin() {
  TriangleMesh basin = box_mesh(Vec3(-0.5, -0.5, -1), Vec3(0.5, 0.5, 0));
  basin.triangles.erase(basin.triangles.begin() + 2, basin.triangles.begin() + 4);
  const std::array<std::int32_t, 4> rim{4, 5, 7, 6};
  std::array<std::int32_t, 4> outer{};
  for (std::size_t i = 0; i < 4; ++i) outer[i] = basin.add_vertex(10.0 * basin.vertex(rim[i]));
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    basin.triangles.push_back({rim[i], rim[next], outer[next]});
    basin.triangles.push_back({rim[i], outer[next], outer[i]});
  }
  return basin;
}

TEST(MeshValidation, OrientsOpenMeshByVolumeWithClosedHoles) {
  const MeshValidation basin = validate(flanged_basin(), OpenPolicy::kDryBoundary);
  ASSERT_TRUE(basin.mesh);
  EXPECT_LT(basin.report.volume, 0.0);
  EXPECT_FALSE(basin.report.flipped);
  EXPECT_TRUE(validate(inside_out(flanged_basin()), OpenPolicy::kDryBoundary).report.flipped);
}

TEST(MeshValidation, RefusesMisorientedAndNonManifoldWithEitherPolicy) {
  TriangleMesh misoriented = cube_mesh();
  std::swap(misoriented.triangles[5][0], misoriented.triangles[5][1]);
  // The fin crosses the cube.
  TriangleMesh finned = cube_mesh();
  const std::int32_t fin = finned.add_vertex({5, 5, 5});
  finned.triangles.push_back({0, 1, fin});
  for (const OpenPolicy policy : {OpenPolicy::kRefuse, OpenPolicy::kDryBoundary}) {
    expect_refused(validate_mesh({misoriented, {}}, "hull.stl", {policy, false, RepairPolicy::kNone}),
                   "3 misoriented edges (one from");
    expect_refused(validate(finned, policy), "1 non-manifold edge (one from");
    expect_refused(validate(finned, policy), "2 boundary edges");
  }
}

TEST(MeshValidation, RefusesNonFiniteVertices) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TriangleMesh cube = cube_mesh();
    cube.y[3] = value;
    expect_refused(validate(cube), "vertex 3 (counted from 0) is (0.5, ");
  }
}

TEST(MeshValidation, RefusesMeshesWithoutTriangles) {
  expect_refused(validate(TriangleMesh{}), "has no triangles");
  TriangleMesh line = tetrahedron_mesh();
  line.triangles = {{0, 1, 0}, {2, 2, 2}};
  expect_refused(validate(line), "2 faces used a vertex twice");
}

TEST(MeshValidation, RefusesMeshesWithoutVolume) {
  TriangleMesh sheet = tetrahedron_mesh();
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  expect_refused(validate(sheet), "3 boundary edges in 1 hole");  // stored for both sides
  expect_refused(validate(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1e-17))), "not above the rounding error");
  expect_refused(validate(cube_mesh(0.0)), "has no triangles");
}

// The area of a slanted needle is a difference of products whose rounding errors exceed the area.
TEST(MeshValidation, RefusesSheetsOfThinFaces) {
  for (const double thin : {1e-3, 1e-6, 1e-9, 1e-12}) {
    TriangleMesh sheet;
    sheet.add_vertex({0.1, 0.2, 0.3});
    sheet.add_vertex({0.7, -0.6, 0.9});
    sheet.add_vertex({0.4 + 0.3 * thin, -0.2 + 0.5 * thin, 0.6 - 0.7 * thin});
    sheet.add_vertex({-0.2, 0.6, 0.0});
    sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 0, 2}, {2, 0, 3}, {1, 3, 0}};
    expect_refused(validate_mesh({sheet, {}}, "hull.stl", {.repair = RepairPolicy::kNone}),
                   "not above the rounding error");
    EXPECT_FALSE(validate(sheet).mesh);
  }
}

// Regression, found by the fuzzer: a mesh of negative volume was accepted, with a downward buoyant force.
TEST(MeshValidation, RefusesCavitiesLargerThanTheirSolid) {
  const TriangleMesh one_cavity = joined(cube_mesh(2), inside_out(cube_mesh(1.8, Vec3(0.05, 0, 0))));
  ASSERT_TRUE(validate(one_cavity).mesh);
  const TriangleMesh overlapping = joined(one_cavity, inside_out(cube_mesh(1.8, Vec3(-0.05, 0, 0))));
  expect_refused(validate(overlapping), "encloses -3.664 m^3");
  expect_refused(validate(inside_out(overlapping)), "encloses -3.664 m^3");
}

TEST(MeshValidation, AcceptsPlateThickerThanRoundingError) {
  EXPECT_TRUE(validate(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1e-8))).mesh);
}

TEST(MeshValidation, RefusesExtentsThatOverflowOrVanish) {
  expect_refused(validate(cube_mesh(1e300)), "too large to compute with");
  expect_refused(validate(cube_mesh(1e-300)), "which squared is 0");
  expect_refused(validate(cube_mesh(1e-120)), "its area squared is 0");
  expect_refused(validate(cube_mesh(1e-90)), "its area squared is 0");
}

TEST(MeshValidation, KeepsAndReportsFacesOfZeroArea) {
  // A cube's edge is split on one side only; a sliver of zero area fills the gap.
  TriangleMesh cube = cube_mesh();
  const std::int32_t middle = cube.add_vertex({0, -0.5, -0.5});
  cube.triangles[4] = {0, middle, 4};  // was 0 1 4
  cube.triangles.push_back({middle, 1, 4});
  cube.triangles.push_back({0, 1, middle});
  const MeshValidation validation = validate(cube);
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(validation.report.degenerate_faces, 1);
  EXPECT_EQ(validation.report.triangles, 14);
  EXPECT_DOUBLE_EQ(validation.report.volume, 1.0);
}

TEST(MeshValidation, DropsDegenerateAndReportsDuplicateFaces) {
  TriangleMesh cube = cube_mesh();
  cube.triangles.push_back({1, 1, 2});
  EXPECT_EQ(validate(cube).report.dropped_faces, 1);
  EXPECT_TRUE(validate(cube).mesh);

  TriangleMesh doubled = cube_mesh();
  doubled.triangles.push_back(doubled.triangles[0]);
  expect_refused(validate_mesh({doubled, {}}, "hull.stl", {.repair = RepairPolicy::kNone}),
                 "1 duplicate face");
  EXPECT_TRUE(validate(doubled).mesh);
}

TEST(MeshValidation, StaysAccurateFarFromOrigin) {
  const Vec3 far(1e6, 2e6, -3e6);
  const MeshReport report = validate(box_mesh(far, far + Vec3(1, 2, 4))).report;
  EXPECT_DOUBLE_EQ(report.volume, 8.0);
}

// Tetrahedra around the origin, each this factor as large as the one before.
TriangleMesh concentric_tetrahedra(int count, double factor) {
  TriangleMesh all;
  double size = 1.0;
  for (int i = 0; i < count; ++i, size *= factor) {
    const auto first = static_cast<std::int32_t>(all.vertex_count());
    for (const Vec3& v : {Vec3(1, 1, 1), Vec3(1, -1, -1), Vec3(-1, -1, 1), Vec3(-1, 1, -1)}) {
      all.add_vertex(size * v);
    }
    for (const Triangle& t : {Triangle{0, 1, 3}, {0, 3, 2}, {0, 2, 1}, {1, 2, 3}}) {
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return all;
}

TEST(MeshValidation, RefusesTooManyPartsWithinEachOther) {
  EXPECT_EQ(validate(concentric_tetrahedra(100, 1.001)).report.components.size(), 100U);
  expect_refused(validate(concentric_tetrahedra(2'500, 1.001)), "so many parts inside or across each other");
}

TEST(MeshValidation, CutsOffCountOfIntersectingFaces) {
  TriangleMesh crossing = concentric_tetrahedra(1'500, 1.0);
  for (std::size_t v = 0; v < crossing.vertex_count(); ++v) crossing.x[v] += 1e-4 * std::floor(v / 4.0);
  const MeshReport report = validate_mesh({crossing, {}}, "hull.stl", {OpenPolicy::kRefuse, true}).report;
  EXPECT_TRUE(report.intersections_cut_off);
  EXPECT_GT(report.intersecting_pairs.value_or(0), 100'000);
  EXPECT_TRUE(contains(to_text(report), "at least, too many to count"));
  const MeshReport few =
      validate_mesh({concentric_tetrahedra(20, 1.001), {}}, "hull.stl", {OpenPolicy::kRefuse, true}).report;
  EXPECT_FALSE(few.intersections_cut_off);
}

}  // namespace
}  // namespace buoyancy
