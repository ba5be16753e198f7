// Tests import and validation of real meshes against independently measured figures.
#include <algorithm>
#include <filesystem>
#include <ostream>

#include <gtest/gtest.h>

#include "geometry/mesh_import.h"
#include "geometry/mesh_repair.h"
#include "geometry/mesh_validation.h"
#include "geometry/welding.h"
#include "tests/geometry/shared_mesh_files.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

MeshValidation validate_file(const std::filesystem::path& path, OpenPolicy open = OpenPolicy::kRefuse,
                             RepairPolicy repair = RepairPolicy::kAutomatic) {
  const Expected<ImportedMesh> imported = import_mesh(path);
  EXPECT_TRUE(imported) << imported.error().message();
  if (!imported) return {};
  return validate_mesh(*imported, path.filename().string(), {open, true, repair});
}

struct Measured {
  const char* file;
  std::int64_t triangles, vertices_stored, vertices_welded;
  std::size_t components;
  double volume;  // [m^3], seven significant digits

  friend std::ostream& operator<<(std::ostream& out, const Measured& measured) {
    return out << measured.file;
  }
};

class ClosedRealMesh : public testing::TestWithParam<Measured> {};

TEST_P(ClosedRealMesh, MatchesIndependentFigures) {
  const std::filesystem::path path = shared_mesh_file(GetParam().file);
  if (!std::filesystem::exists(path)) GTEST_SKIP() << missing_shared_mesh(path);
  const MeshValidation validation = validate_file(path);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  const MeshReport& report = validation.report;
  EXPECT_EQ(report.triangles, GetParam().triangles);
  EXPECT_EQ(report.vertices_stored, GetParam().vertices_stored);
  EXPECT_EQ(report.vertices_welded, GetParam().vertices_welded);
  EXPECT_EQ(report.components.size(), GetParam().components);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.balanced_edges, 0);
  EXPECT_FALSE(report.flipped);
  EXPECT_NEAR(report.volume, GetParam().volume, 5e-7 * GetParam().volume);
  EXPECT_LE((report.volume_by_axis.array() - report.volume).abs().maxCoeff(), 1e-12 * report.volume);
  EXPECT_LE(report.area_vector.norm(), 1e-13 * report.area);
  EXPECT_EQ(report.intersecting_pairs, 0);
}

INSTANTIATE_TEST_SUITE_P(
    RealMeshes, ClosedRealMesh,
    testing::Values(Measured{"armadillo_30000.ply", 30000, 15002, 15002, 1, 0.06861869},
                    Measured{"armadillo_86482.ply", 86482, 43243, 43243, 1, 0.06861869},
                    Measured{"bunny_5002.ply", 5002, 2503, 2503, 1, 0.0007547586},
                    Measured{"bunny_69664_closed.ply", 69664, 34834, 34834, 1, 0.0007547586},
                    Measured{"hull_boat_32416.obj", 32416, 97248, 16210, 1, 11.91774},
                    Measured{"hull_dtc_116062.stl", 116062, 348186, 58033, 1, 2.436306},
                    Measured{"wheels_2comp_78164.obj", 78164, 234492, 39066, 2, 0.08689894}));

TEST(RealMeshes, CloseWaveEnergyFloatByToleranceWeld) {
  const std::filesystem::path path = shared_mesh_file("rm3_float_tolweld.stl");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << missing_shared_mesh(path);
  const MeshValidation validation = validate_file(path);
  ASSERT_TRUE(validation.mesh);
  EXPECT_EQ(validation.report.weld, WeldKind::kTolerance);
  EXPECT_GT(validation.report.weld_largest_move, 0.0);
  EXPECT_LE(validation.report.weld_largest_move, kRepairTolerance * validation.report.diagonal);
  EXPECT_NEAR(validation.report.volume, 1298.256, 1e-3);
}

TEST(RealMeshes, AcceptOpenBunnyOnlyWithDryBoundaryPolicy) {
  const std::filesystem::path path = shared_mesh_file("bunny_69451_open.ply");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << missing_shared_mesh(path);
  const MeshValidation refused = validate_file(path);
  EXPECT_FALSE(refused.mesh);
  ASSERT_TRUE(refused.refusal);
  EXPECT_TRUE(
      contains(refused.refusal->message(), "bunny_69451_open.ply: has 223 boundary edges in 5 holes"));
  EXPECT_EQ(refused.report.boundary_edges, 223);
  EXPECT_EQ(refused.report.holes.size(), 5U);

  const MeshValidation accepted = validate_file(path, OpenPolicy::kDryBoundary);
  ASSERT_TRUE(accepted.mesh);
  EXPECT_EQ(accepted.mesh->boundary_vertices.size(), 223U);
  EXPECT_FALSE(accepted.report.flipped);
}

// The independent measurement counts every edge of more than two faces as non-manifold. Here such edges of
// this mesh are balanced, since each is used equally often in both directions.
TEST(RealMeshes, RefuseCatamaranAndCountItsFaults) {
  const std::filesystem::path path = shared_mesh_file("wamv_dirty.dae");
  if (!std::filesystem::exists(path)) GTEST_SKIP() << missing_shared_mesh(path);
  for (const OpenPolicy policy : {OpenPolicy::kRefuse, OpenPolicy::kDryBoundary}) {
    const MeshValidation validation = validate_file(path, policy, RepairPolicy::kNone);
    EXPECT_FALSE(validation.mesh);
    ASSERT_TRUE(validation.refusal);
    const MeshReport& report = validation.report;
    EXPECT_EQ(report.triangles, 4564);
    EXPECT_EQ(report.vertices_welded, 2472);
    EXPECT_EQ(report.boundary_edges, 420);
    EXPECT_EQ(report.balanced_edges + report.non_manifold_edges, 55);
    EXPECT_EQ(report.misoriented_edges, 4);
    EXPECT_EQ(report.duplicate_faces, 38);
    EXPECT_EQ(report.components.size(), 51U);
    EXPECT_EQ(std::count_if(report.components.begin(), report.components.end(),
                            [](const ComponentReport& component) { return component.volume < 0.0; }),
              18);
    EXPECT_GT(report.intersecting_pairs.value_or(0), 0);
    for (const char* text :
         {"420 boundary edges in 56 holes", "4 misoriented edges (one from", "38 duplicate faces"}) {
      EXPECT_TRUE(contains(validation.refusal->message(), text));
    }
  }
  const MeshValidation repaired = validate_file(path);
  ASSERT_TRUE(repaired.refusal);
  EXPECT_TRUE(contains(repaired.refusal->message(), "424 boundary edges in 57 holes"));
  EXPECT_EQ(repaired.report.misoriented_edges + repaired.report.non_manifold_edges, 0);
}

TEST(RealMeshes, FindFourIntersectingPairsInDuck) {
  const std::filesystem::path path = "/usr/share/assimp/models/Collada/duck_triangulate.dae";
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << path << " was not found; install the Debian package assimp-testmodels";
  const MeshValidation duck = validate_file(path);
  ASSERT_TRUE(duck.mesh);
  EXPECT_EQ(duck.report.triangles, 4212);
  EXPECT_EQ(duck.report.intersecting_pairs, 4);
}

}  // namespace
}  // namespace buoyancy
