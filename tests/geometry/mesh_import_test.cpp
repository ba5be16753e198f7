#include "geometry/mesh_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "base/format.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_export.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_validation.h"
#include "geometry/shapes.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/geometry/shared_mesh_files.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

namespace fs = std::filesystem;
const fs::path kTestModels = "/usr/share/assimp/models";  // Debian's assimp-testmodels

ImportedMesh imported(const fs::path& file) {
  Expected<ImportedMesh> result = import_mesh(file);
  EXPECT_TRUE(result) << result.error().message();
  return result ? *std::move(result) : ImportedMesh{};
}

class MeshImport : public testing::Test {
 protected:
  TempDir directory_;
};

TEST_F(MeshImport, ReadsTetrahedronFromEveryFormat) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  for (const auto& [name, content] : tetrahedron_files()) {
    SCOPED_TRACE(name);
    const ImportedMesh found = imported(directory_.write(name, content));
    EXPECT_EQ(found.mesh.triangles.size(), 4U);
    EXPECT_NEAR(volume_of(found.mesh), 1.0 / 6.0, 1e-15);
    EXPECT_EQ(found.source.nodes, 1);
    EXPECT_EQ(found.source.ignored_primitives, 0);
    EXPECT_EQ(found.source.format, to_string(*format_from_path(name)));
  }
}

TEST_F(MeshImport, IgnoresCaseOfExtension) {
  EXPECT_EQ(imported(directory_.write("TETRAHEDRON.OFF", tetrahedron::off())).source.format, "OFF");
  EXPECT_EQ(imported(directory_.write("Tetrahedron.Stl", tetrahedron::binary_stl())).source.format, "STL");
}

TEST_F(MeshImport, AcceptsSpacesDotsAndUnicodeInFileNames) {
  for (const char* name : {"a hull.off", "hull.v2.off", "bärenrumpf.off", "hull%20.off"}) {
    EXPECT_EQ(imported(directory_.write(name, tetrahedron::off())).mesh.triangles.size(), 4U) << name;
  }
}

TEST_F(MeshImport, KeepsUnweldedVerticesAndDegenerateTriangles) {
  const ImportedMesh stl = imported(directory_.write("soup.stl", tetrahedron::binary_stl()));
  EXPECT_EQ(stl.mesh.vertex_count(), 12U);
  // At 1 um, assimp's own steps take face areas for zero; the last triangle here is degenerate.
  const ImportedMesh off = imported(directory_.write(
      "small.off",
      "OFF\n4 5 0\n0 0 0\n1e-6 0 0\n0 1e-6 0\n0 0 1e-6\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n3 0 1 1\n"));
  EXPECT_EQ(off.mesh.triangles.size(), 5U);
  EXPECT_NEAR(volume_of(off.mesh), 1e-18 / 6.0, 1e-24);
}

// The program's own reader, and assimp, which reads text.
TEST_F(MeshImport, ReadsBinaryStlAsTextStl) {
  TriangleMesh mesh = as_imported(make_shape(RockShape{.frequency = 30}));  // more than it reads at a time
  ASSERT_GT(mesh.triangles.size(), 16'384U);
  mesh.x[0] = -0.0;
  std::string text = "solid rock\n";
  for (const Triangle& triangle : mesh.triangles) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const std::int32_t v : triangle) {
      const Vec3 vertex = mesh.vertex(v);
      text += "vertex " + format_number(vertex.x(), 17) + " " + format_number(vertex.y(), 17) + " " +
              format_number(vertex.z(), 17) + "\n";
    }
    text += "endloop\nendfacet\n";
  }
  const ImportedMesh binary = imported(directory_.write("binary.stl", export_mesh(mesh, ExportFormat::kStl)));
  const ImportedMesh read = imported(directory_.write("text.stl", text + "endsolid rock\n"));
  EXPECT_TRUE(binary.mesh.triangles == read.mesh.triangles);
  EXPECT_TRUE(binary.mesh.x == read.mesh.x);
  EXPECT_TRUE(binary.mesh.y == read.mesh.y);
  EXPECT_TRUE(binary.mesh.z == read.mesh.z);
  EXPECT_TRUE(std::ranges::none_of(binary.mesh.x, [](double x) { return x == 0.0 && std::signbit(x); }));
  EXPECT_EQ(binary.source.up_axis, read.source.up_axis);
  EXPECT_EQ(binary.source.note, read.source.note);
  EXPECT_EQ(binary.source.nodes, read.source.nodes);
}

TEST_F(MeshImport, SplitsPolygonsIntoTriangles) {
  // A pyramid over a concave pentagon has 5 sides and 3 triangles in its base.
  const ImportedMesh found =
      imported(directory_.write("pyramid.obj",
                                "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nv 1 0.25 1\n"
                                "f 5 4 3 2 1\nf 1 2 6\nf 2 3 6\nf 3 4 6\nf 4 5 6\nf 5 1 6\n"));
  EXPECT_EQ(found.mesh.triangles.size(), 8U);
  EXPECT_NEAR(volume_of(found.mesh), 2.5 / 3.0, 1e-12);  // base area 4 - 1.5, height 1
  EXPECT_EQ(found.source.polygons.polygons, 1);
  EXPECT_EQ(found.source.polygons.non_planar, 0);
}

// assimp's own triangulation drops corners of planar polygons that lie on a line.
TEST_F(MeshImport, KeepsCornersOnEdgesOfPolygons) {
  // A box of 3 m x 2 m x 1 m, one of whose edges has n corners between its ends.
  for (int n = 0; n < 40; ++n) {
    std::string text = "v 0 0 0\nv 3 0 0\nv 3 2 0\nv 0 2 0\nv 0 0 1\nv 3 0 1\nv 3 2 1\nv 0 2 1\n";
    std::string forward;
    std::string backward;
    for (int i = 0; i < n; ++i) {
      text += "v " + std::to_string(0.07 + 2.9 * i / n) + " 2 0\n";
      forward += " " + std::to_string(9 + i);
      backward = " " + std::to_string(9 + i) + backward;
    }
    text +=
        "f 1 4" + forward + " 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 4 1 5 8\nf 8 7 3" + backward + " 4\n";
    const MeshValidation validation = validate_mesh(imported(directory_.write("box.obj", text)), "box");
    ASSERT_FALSE(validation.refusal) << n << ": " << validation.refusal->message();
    EXPECT_TRUE(validation.report.closed());
    EXPECT_EQ(validation.report.degenerate_faces, 0);
    EXPECT_EQ(validation.report.vertices_welded, 8 + n);
    EXPECT_NEAR(validation.report.volume, 6.0, 1e-12);
  }
}

TEST_F(MeshImport, SplitsMirroredPolygonsSymmetrically) {
  // A punt that is symmetric about y = 0, with two non-planar quads that start at different corners.
  const ImportedMesh found = imported(directory_.write(
      "punt.obj",
      "v 0 -1 0\nv 5 -1 0\nv 5 0 -0.3\nv 0 0 -0.7\nv 5 1 0\nv 0 1 0\n"
      "v 0 -1 1\nv 5 -1 1\nv 5 1 1\nv 0 1 1\n"
      "f 1 4 3 2\nf 3 4 6 5\nf 7 8 9 10\nf 1 2 8 7\nf 6 10 9 5\nf 2 3 5 9 8\nf 1 7 10 6 4\n"));
  EXPECT_EQ(found.source.polygons.polygons, 7);
  EXPECT_EQ(found.source.polygons.non_planar, 2);
  EXPECT_EQ(found.source.polygons.centers, 2);
  const MeshValidation validation = validate_mesh(found, "punt");
  ASSERT_FALSE(validation.refusal);
  EXPECT_EQ(validation.report.vertices_welded, 12);
  EXPECT_EQ(mass_properties(validation.mesh->mesh).centroid_B.y(), 0.0);
  // Between the splits of each quad lies a tetrahedron of 1/6 x 5 m x 1 m x 0.4 m.
  EXPECT_NEAR(validation.report.source.polygons.split_volume, 2.0 / 3.0, 1e-6);
  EXPECT_NEAR(validation.report.volume, 5.0 * 2.0 * 1.0 + 5.0 * 0.5, 1e-6);
}

TEST_F(MeshImport, ReadsPolygonsOfMirroredNodes) {
  std::string collada = tetrahedron::collada(
      "",
      R"(<node><matrix>1 0 0 0 0 -1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#mesh"/></node>)");
  const std::string triangles = "<triangles count=\"4\">";
  collada.replace(collada.find(triangles), triangles.size(), "<polylist count=\"4\">");
  collada.replace(collada.find("</triangles>"), 12, "</polylist>");
  collada.replace(collada.find("<p>"), 3, "<vcount>4 3 3 3</vcount><p>2 ");
  collada.replace(collada.find("<p>2 0 2 1"), 10, "<p>0 2 2 1");
  const ImportedMesh found = imported(directory_.write("mirrored.dae", collada));
  EXPECT_EQ(found.source.polygons.polygons, 1);
  EXPECT_EQ(found.mesh.triangles.size(), 4U);
  EXPECT_NEAR(volume_of(found.mesh), 1.0 / 6.0, 1e-15);
  EXPECT_EQ(bounding_box(found.mesh).min_B.y(), -1.0);
}

TEST_F(MeshImport, CountsIgnoredPointsAndLines) {
  const ImportedMesh found =
      imported(directory_.write("mixed.obj", tetrahedron::obj() + "l 1 2 3\np 1\np 2\n"));
  EXPECT_EQ(found.mesh.triangles.size(), 4U);
  EXPECT_EQ(found.source.ignored_primitives, 4);  // a line of three points is two lines
  EXPECT_NEAR(volume_of(found.mesh), 1.0 / 6.0, 1e-15);
}

TEST_F(MeshImport, AppliesNodeTransformsInDouble) {
  // 2^24 + 0.25 is not representable in single precision: a float product would lose the child's translation.
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  const ImportedMesh found = imported(directory_.write(
      "far.gltf", tetrahedron::gltf(R"([{"translation":[16777216,0,0],"children":[1]},)"
                                    R"({"translation":[0.25,0,0],"scale":[2,2,2],"mesh":0}])")));
  const BoundingBox box = bounding_box(found.mesh);
  EXPECT_EQ(box.min_B.x(), 16777216.25);
  EXPECT_EQ(box.max_B.x(), 16777218.25);
  EXPECT_EQ(box.max_B.y(), 2.0);
}

TEST_F(MeshImport, PlacesEveryInstance) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  const ImportedMesh found = imported(directory_.write(
      "three.gltf",
      tetrahedron::gltf(
          R"([{"mesh":0,"children":[1,2,3]},{"translation":[5,0,0],"mesh":0},)"
          R"({"translation":[0,5,0],"rotation":[0,0,0.70710678,0.70710678],"mesh":0},{"name":"empty"}])")));
  EXPECT_EQ(found.source.nodes, 3);
  EXPECT_EQ(found.mesh.triangles.size(), 12U);
  EXPECT_EQ(found.mesh.vertex_count(), 12U);
  EXPECT_NEAR(volume_of(found.mesh), 3.0 / 6.0, 1e-6);
  const BoundingBox box = bounding_box(found.mesh);
  EXPECT_EQ(box.max_B.x(), 6.0);
  EXPECT_NEAR(box.min_B.x(), -1.0, 1e-6);  // the third is rotated by 90 degrees about z
}

TEST_F(MeshImport, ReversesWindingOfMirroredNodes) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  const ImportedMesh once =
      imported(directory_.write("mirrored.gltf", tetrahedron::gltf(R"([{"scale":[-1,1,1],"mesh":0}])")));
  EXPECT_EQ(bounding_box(once.mesh).min_B.x(), -1.0);
  EXPECT_NEAR(volume_of(once.mesh), 1.0 / 6.0, 1e-15);
  const ImportedMesh twice = imported(directory_.write(
      "twice.gltf", tetrahedron::gltf(R"([{"scale":[-1,1,1],"children":[1]},{"scale":[1,-3,1],"mesh":0}])")));
  EXPECT_NEAR(volume_of(twice.mesh), 3.0 / 6.0, 1e-15);
}

TEST_F(MeshImport, IgnoresUnreferencedMeshes) {
  std::string two_meshes = tetrahedron::gltf();
  const std::string mesh = R"({"primitives":[{"attributes":{"POSITION":0},"indices":1}]})";
  two_meshes.insert(two_meshes.find(mesh), mesh + ",");
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  EXPECT_EQ(imported(directory_.write("two.gltf", two_meshes)).mesh.triangles.size(), 4U);
}

TEST_F(MeshImport, KeepsAxesAndAppliesUnitOfColladaFiles) {
  struct Case {
    const char* asset;
    const char* up_axis;
    const char* note;
    Vec3 top_B;  // image of the file's corner (0, 0, 1)
  };
  const std::vector<Case> cases{
      {"", "not stated", "", {0, 0, 1}},
      {"<up_axis>Y_UP</up_axis>", "y", "", {0, 0, 1}},
      {"<up_axis>Z_UP</up_axis>", "z", "", {0, 0, 1}},
      {"<up_axis>X_UP</up_axis>", "x", "", {0, 0, 1}},
      {R"(<unit name="centimeter" meter="0.01"/><up_axis> Z_UP </up_axis>)",
       "z",
       "scaled by 0.01 to metres by the importer",
       {0, 0, 0.01}},
      {R"(<unit name="inch" meter="0.0254"/>)",
       "not stated",
       "scaled by 0.0254 to metres by the importer",
       {0, 0, 0.0254}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.asset);
    const ImportedMesh found = imported(directory_.write("axes.dae", tetrahedron::collada(c.asset)));
    EXPECT_EQ(found.source.up_axis, c.up_axis);
    EXPECT_EQ(found.source.note, c.note);
    bool there = false;
    for (std::size_t v = 0; v < found.mesh.vertex_count(); ++v) {
      there = there || (found.mesh.vertex(static_cast<std::int32_t>(v)) - c.top_B).norm() < 1e-8;
    }
    EXPECT_TRUE(there);
    EXPECT_GT(volume_of(found.mesh), 0.0);
  }
}

TEST_F(MeshImport, ReportsUnitOfUnscaledFbxFiles) {
  const ImportedMesh inches = imported(directory_.write(
      "inches.fbx", tetrahedron::fbx("\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\",2\n"
                                     "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",2.54\n")));
  EXPECT_EQ(inches.source.up_axis, "z");
  EXPECT_EQ(inches.source.note,
            "not scaled by the importer; by the file one unit is 2.54 cm, so that scale = 0.0254 makes "
            "metres of it");
  EXPECT_EQ(bounding_box(inches.mesh).max_B, Vec3(1, 1, 1));
  const ImportedMesh metres = imported(directory_.write(
      "metres.fbx", tetrahedron::fbx("\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",100\n")));
  EXPECT_EQ(metres.source.note, "");
}

TEST_F(MeshImport, KeepsAxesOf3dsFiles) {
  const ImportedMesh found = imported(directory_.write("hull.3ds", tetrahedron::file_3ds()));
  EXPECT_EQ(found.source.up_axis, "not stated");
  EXPECT_EQ(found.source.note, "");
  EXPECT_EQ(bounding_box(found.mesh).min_B, Vec3(0, 0, 0));
  EXPECT_EQ(bounding_box(found.mesh).max_B, Vec3(1, 1, 1));
  EXPECT_GT(volume_of(found.mesh), 0.0);
}

TEST_F(MeshImport, ReportsNoAxesIfFormatHasNone) {
  for (const auto& [name, content] : tetrahedron_files()) {
    const MeshFormat format = *format_from_path(name);
    if (format != MeshFormat::kObj && format != MeshFormat::kPly && format != MeshFormat::kStl) continue;
    const ImportedMesh found = imported(directory_.write(name, content));
    EXPECT_EQ(found.source.up_axis, "not stated");
    EXPECT_EQ(found.source.note, "");
  }
}

TEST_F(MeshImport, ReportsErrorsLoggedByImporter) {
  const ImportedMesh found = imported(directory_.write("odd.obj", tetrahedron::obj() + "f\n"));
  EXPECT_TRUE(contains(found.source.note, "the importer reported 1 error: "));
  // Errors about materials are ignored.
  const ImportedMesh plain =
      imported(directory_.write("plain.obj", "mtllib none.mtl\n" + tetrahedron::obj()));
  EXPECT_EQ(plain.source.note, "");
}

struct SharedMesh {
  const char* name;
  std::size_t triangles, vertices_stored;
};

// The counts are those of PROVENANCE.md in the directory of the meshes.
TEST(MeshImportRealFiles, MatchIndependentTriangleAndVertexCounts) {
  constexpr std::array kMeshes{
      SharedMesh{"armadillo_30000.ply", 30'000, 15'002},
      SharedMesh{"armadillo_86482.ply", 86'482, 43'243},
      SharedMesh{"bunny_5002.ply", 5'002, 2'503},
      SharedMesh{"bunny_69451_open.ply", 69'451, 35'947},
      SharedMesh{"bunny_69664_closed.ply", 69'664, 34'834},
      SharedMesh{"hull_boat_32416.obj", 32'416, 97'248},
      SharedMesh{"hull_dtc_116062.stl", 116'062, 348'186},
      SharedMesh{"rm3_float_tolweld.stl", 516, 1'548},
      SharedMesh{"wamv_dirty.dae", 4'564, 13'692},
      SharedMesh{"wheels_2comp_78164.obj", 78'164, 234'492},
  };
  const fs::path first = shared_mesh_file(kMeshes[0].name);
  if (!fs::exists(first)) GTEST_SKIP() << missing_shared_mesh(first);
  for (const SharedMesh& expected : kMeshes) {
    const ImportedMesh found = imported(shared_mesh_file(expected.name));
    EXPECT_EQ(found.mesh.triangles.size(), expected.triangles) << expected.name;
    EXPECT_EQ(found.mesh.vertex_count(), expected.vertices_stored) << expected.name;
  }
}

TEST(MeshImportRealFiles, ReadDuck) {
  const fs::path duck = kTestModels / "Collada/duck.dae";
  if (!fs::exists(duck))
    GTEST_SKIP() << duck << " was not found; install the Debian package assimp-testmodels";
  const ImportedMesh found = imported(duck);
  // 2,060 quads and 92 triangles. 2,043 quads are not planar: fans of four triangles, but for two that would
  // fold.
  EXPECT_EQ(found.source.polygons.polygons, 2'060);
  EXPECT_EQ(found.source.polygons.non_planar, 2'043);
  EXPECT_EQ(found.mesh.triangles.size(), 2U * 17U + 92U + 4U * 2'041U + 2U * 2U);
  EXPECT_EQ(found.source.format, "Collada");
  EXPECT_EQ(found.source.up_axis, "y");
  EXPECT_GT(volume_of(found.mesh), 0.0);
}

}  // namespace
}  // namespace buoyancy
