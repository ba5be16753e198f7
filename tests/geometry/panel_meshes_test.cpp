// Tests of the panel meshes of WAMIT and Nemoh.
#include <string>

#include <gtest/gtest.h>

#include "geometry/mesh_import.h"
#include "geometry/mesh_validation.h"
#include "tests/geometry/import_checks.h"

namespace buoyancy {
namespace {

using PanelMeshes = ImportTest;

// The quarter x >= 0, y >= 0 of a box of 4 m x 2 m x 1 m, without the faces in the planes of symmetry.
constexpr const char* kQuarter =
    "2 0 0   2 1 0   2 1 1   2 0 1\n"
    "0 1 0   0 1 1   2 1 1   2 1 0\n"
    "0 0 1   2 0 1   2 1 1   0 1 1\n"
    "0 0 0   0 1 0   2 1 0   2 0 0\n";

std::string gdf(const std::string& header, const std::string& panels = kQuarter, int count = 4) {
  return "a box\n" + header + std::to_string(count) + "\n" + panels;
}

ImportedMesh imported(const std::filesystem::path& file) {
  Expected<ImportedMesh> result = import_mesh(file);
  EXPECT_TRUE(result) << result.error().message();
  return result ? *std::move(result) : ImportedMesh{};
}

MeshReport report_of(const ImportedMesh& mesh) {
  return validate_mesh(mesh, "panels", {.open = OpenPolicy::kDryBoundary}).report;
}

TEST_F(PanelMeshes, MirrorWamitPanelsByTheirFlags) {
  const ImportedMesh box = imported(directory_.write("box.gdf", gdf("1.0 9.80665\n1 1\n")));
  EXPECT_EQ(box.source.format, "WAMIT GDF");
  EXPECT_EQ(box.source.up_axis, "z");
  EXPECT_EQ(box.source.note, "mirrored in x = 0 (ISX); mirrored in y = 0 (ISY)");
  EXPECT_EQ(box.source.polygons.polygons, 16);
  const MeshReport report = report_of(box);
  EXPECT_TRUE(report.closed());
  EXPECT_EQ(report.misoriented_edges, 0);
  EXPECT_NEAR(report.volume, 8.0, 1e-12);
  EXPECT_EQ(report.box.min_B, Vec3(-2, -1, 0));

  const ImportedMesh half = imported(directory_.write("half.gdf", gdf("1.0 9.80665\n0 1\n")));
  EXPECT_EQ(half.source.note, "mirrored in y = 0 (ISY)");
  EXPECT_EQ(report_of(half).box.min_B, Vec3(0, -1, 0));
  EXPECT_EQ(report_of(half).boundary_edges, 6);
}

TEST_F(PanelMeshes, ReadFortranNumbersAsDoubles) {
  const ImportedMesh mesh = imported(
      directory_.write("fortran.gdf", gdf("1.0, 9.80665   ULEN, GRAV\r\n0 0  ISX ISY\r\n",
                                          "0.1D+00,0,0\n1.d0 0 0\n+1.0E0 1 0\n0.123456789012345 1 0\n", 1)));
  EXPECT_EQ(mesh.mesh.x, (std::vector<double>{0.1, 1.0, 1.0, 0.123456789012345}));
  EXPECT_EQ(mesh.mesh.triangles.size(), 2U);
}

TEST_F(PanelMeshes, MakeMetresOfFeetAndNotOfUlen) {
  const ImportedMesh feet = imported(directory_.write("feet.gdf", gdf("50 32.174\n0 0\n")));
  EXPECT_EQ(
      feet.source.note,
      "not scaled by ULEN, 50, which is a reference length; scaled by 0.3048 from feet to metres, since GRAV "
      "is 32.174");
  EXPECT_NEAR(bounding_box(feet.mesh).max_B.x(), 0.6096, 1e-15);
}

TEST_F(PanelMeshes, MirrorNemohPanelsByTheirFlag) {
  const std::string nodes =
      "1 0 0 0\n2 2 0 0\n3 2 1 0\n4 0 1 0\n5 0 0 1\n16 2 0 1\n7 2 1 1\n8 0 1 1\n0 0. 0. 0.\n";
  const std::string panels = "2 3 7 16 \n4 8 7 3\n5 16 7 8\n1 4 3 2\n0 0 0 0\n";
  const ImportedMesh half = imported(directory_.write("half.dat", "    2    1\n" + nodes + panels));
  EXPECT_EQ(half.source.format, "Nemoh");
  EXPECT_EQ(half.source.note, "mirrored in y = 0, as its first line says");
  EXPECT_EQ(half.source.polygons.polygons, 8);
  EXPECT_EQ(report_of(half).box.min_B, Vec3(0, -1, 0));
  EXPECT_EQ(report_of(half).misoriented_edges, 0);
  EXPECT_EQ(report_of(half).boundary_edges, 6);
  const ImportedMesh plain = imported(directory_.write("plain.dat", "2 0\n" + nodes + panels));
  EXPECT_EQ(plain.source.note, "");
  EXPECT_EQ(plain.source.polygons.polygons, 4);
}

TEST_F(PanelMeshes, NameFaultsWithTheirLine) {
  const auto refusal_of = [&](const char* name, const std::string& content) {
    return import_error(directory_.write(name, content));
  };
  EXPECT_TRUE(contains(refusal_of("a.gdf", "title\nno numbers\n"), "(line 2: no ULEN and GRAV)"));
  EXPECT_TRUE(contains(refusal_of("b.gdf", gdf("1 9.8\n0 2\n")), "(line 3: no ISX and ISY, each 0 or 1)"));
  EXPECT_TRUE(contains(refusal_of("c.gdf", gdf("1 9.8\n0 0\n", kQuarter, 5)), "no corner of panel 5 of 5"));
  EXPECT_TRUE(contains(refusal_of("d.gdf", gdf("1 9.8\n0 0\n", kQuarter, 3)), "no end after the last panel"));
  EXPECT_TRUE(
      contains(refusal_of("d.gdf", "title\n1 9.8\n0 0\n2 1\n4 2\n"), "no flat panels: IGDEF is not 0"));
  EXPECT_TRUE(contains(refusal_of("e.gdf", gdf("1 9.8\n0 0\n", "", 0)), "no triangles"));
  EXPECT_TRUE(
      contains(refusal_of("f.gdf", gdf("1 9.8\n0 0\n", kQuarter, 2'000'000'000)), "limit 'vertices'"));
  EXPECT_TRUE(contains(refusal_of("g.gdf", gdf("1 9.8\n0 0\n", "nan 0 0 1 0 0 1 1 0 0 1 0\n", 1)), "finite"));
  EXPECT_TRUE(contains(refusal_of("a.dat", "3 0\n"), "no first line of 2 and the flag of symmetry"));
  EXPECT_TRUE(contains(refusal_of("b.dat", "2 0\n1 0 0 0\n1 1 0 0\n0 0 0 0\n"), "node 1 appears twice"));
  EXPECT_TRUE(contains(refusal_of("c.dat", "2 0\n1 0 0 0\n0 0 0 0\n1 1 2 1\n"), "(line 4: no node 2)"));
  EXPECT_TRUE(contains(refusal_of("d.dat", "2 0\n1 0 0 0\n0 0 0 0\n1 1 1\n"), "no panel of four nodes"));
  EXPECT_TRUE(contains(refusal_of("e.dat", "2 0\n1 0 0 0\n0 0 0 0\n0 0 0 0\n"), "no triangles"));
}

}  // namespace
}  // namespace buoyancy
