// Tests of the errors of import_mesh(). mesh_import_test.cpp tests successful imports.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "geometry/mesh_import.h"
#include "tests/geometry/import_checks.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/shared_mesh_files.h"

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

using MeshImportErrors = ImportTest;

TEST_F(MeshImportErrors, NameMissingFile) {
  const std::string message = import_error(directory_.path() / "none.ply");
  EXPECT_TRUE(contains(message, "no such file"));
}

TEST_F(MeshImportErrors, RejectNonRegularFiles) {
  EXPECT_TRUE(contains(import_error(directory_.path()), "is a directory"));
  EXPECT_TRUE(contains(import_error("/dev/zero"), "is a device"));
  const fs::path pipe = directory_.path() / "pipe.stl";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(contains(import_error(pipe), "is a named pipe"));
  fs::create_directory(directory_.path() / "folder.obj");
  EXPECT_TRUE(contains(import_error(directory_.path() / "folder.obj"), "is a directory"));
}

TEST_F(MeshImportErrors, RejectEmptyLargeAndUnreadableFiles) {
  EXPECT_TRUE(contains(import_error(directory_.write("empty.obj", "")), "0 bytes"));

  ImportLimits small;
  small.mesh_bytes = 100;
  const std::string large = import_error(directory_.write("large.ply", tetrahedron::ascii_ply()), small);
  EXPECT_TRUE(contains(large, std::to_string(tetrahedron::ascii_ply().size()) + " bytes"));
  EXPECT_TRUE(contains(large, "at most 100 (limit 'mesh_bytes')"));

  const fs::path closed = directory_.write("closed.obj", tetrahedron::obj());
  fs::permissions(closed, fs::perms::none);
  if (::geteuid() != 0) {  // root can read every file
    EXPECT_TRUE(contains(import_error(closed), "Permission denied"));
  }
}

TEST_F(MeshImportErrors, ListAcceptedExtensions) {
  for (const char* name :
       {"mesh.3mf", "mesh.blend", "mesh.x", "mesh.zae", "mesh.xml", "mesh.stl.gz", "mesh"}) {
    const std::string message = import_error(directory_.write(name, tetrahedron::obj()));
    EXPECT_TRUE(contains(message, ".obj, .stl, .ply, .off, .dae, .gltf, .glb, .fbx, .3ds, .gdf, .dat"));
  }
  EXPECT_TRUE(
      contains(import_error(directory_.write("m.3MF", "PK\x03\x04")), "format '.3MF' is not accepted"));
}

TEST_F(MeshImportErrors, SayHowToConvertFilesOfOtherKinds) {
  const auto refusal_of = [&](const char* name, const std::string& content = "ISO-10303-21;") {
    return import_error(directory_.write(name, content));
  };
  for (const char* name : {"hull.step", "hull.STP", "hull.igs", "hull.iges"}) {
    EXPECT_TRUE(contains(refusal_of(name), "tessellate it, in FreeCAD")) << name;
  }
  EXPECT_TRUE(contains(refusal_of("hull.fbm"), "model of FREE!ship or DELFTship: tessellate it there"));
  EXPECT_TRUE(contains(refusal_of("hull.3mf", "PK\x03\x04"), "3MF cannot be trusted: open it in the slicer"));
  EXPECT_TRUE(contains(refusal_of("hull.zae", "PK\x03\x04"), "unzip it and give that file"));
}

TEST_F(MeshImportErrors, AdviseToFetchGitLfsPointers) {
  const std::string pointer =
      "version https://git-lfs.github.com/spec/v1\noid sha256:" + std::string(64, '0') + "\nsize 123456\n";
  for (const std::string extension :
       {".obj", ".stl", ".ply", ".off", ".dae", ".gltf", ".glb", ".fbx", ".3ds", ".gdf", ".dat"}) {
    const std::string message = import_error(directory_.write("hull" + extension, pointer));
    EXPECT_TRUE(contains(message, "the content is a Git LFS pointer, not the file itself"));
    EXPECT_TRUE(contains(message, "Run git lfs pull"));
    EXPECT_FALSE(contains(message, "xport"));
  }
}

TEST_F(MeshImportErrors, QuoteTheImporter) {
  EXPECT_TRUE(contains(import_error(directory_.write("cut.gltf", "{\"asset\":")),
                       "not readable as glTF (No suitable reader"));
  EXPECT_TRUE(contains(import_error(directory_.write("odd.dae", "<?xml version=\"1.0\"?><a></b>")),
                       "not readable as Collada ("));
}

// Each format is stored under the extension of each other format.
TEST_F(MeshImportErrors, NameContentThatDoesNotMatchExtension) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  for (const auto& [name, content] : tetrahedron_files()) {
    const std::string own = fs::path(name).extension();
    for (const std::string other :
         {".obj", ".stl", ".ply", ".off", ".dae", ".gltf", ".glb", ".fbx", ".3ds", ".gdf", ".dat"}) {
      if (other == own) continue;
      SCOPED_TRACE(std::string(name).append(" as ").append(other));
      const fs::path disguised = directory_.write("disguised" + other, content);
      if (own.starts_with(".gl") &&
          other.starts_with(".gl")) {  // assimp 5.4 reads glTF under both extensions
        expect_mesh_or_complete_error(disguised, {});
        continue;
      }
      const std::string message = import_error(disguised);
      if (name == "binary.stl" || own == ".gdf" || own == ".dat") continue;  // no first bytes of their own
      EXPECT_TRUE(contains(message, "the content looks like"));
      EXPECT_TRUE(contains(message, "give it the extension " + own));
    }
  }
}

TEST_F(MeshImportErrors, DoNotSelectImporterByContent) {
  const std::string x = "xof 0303txt 0032\nMesh { 3; 0;0;0;, 1;0;0;, 0;1;0;; 1; 3;0,1,2;; }\n";
  for (const char* name :
       {"x.obj", "x.stl", "x.ply", "x.off", "x.dae", "x.gltf", "x.glb", "x.fbx", "x.3ds", "x.gdf", "x.dat"}) {
    EXPECT_TRUE(contains(import_error(directory_.write(name, x)), "the content looks like DirectX X"))
        << name;
  }
}

TEST_F(MeshImportErrors, RejectFilesWithoutTriangles) {
  const std::string no_faces =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 0\nproperty list uchar int vertex_indices\n"
      "end_header\n0 0 0\n";
  EXPECT_TRUE(contains(import_error(directory_.write("none.ply", no_faces)), "no triangles"));
  EXPECT_TRUE(
      contains(import_error(directory_.write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")), "triangles"));
  EXPECT_TRUE(contains(import_error(directory_.write("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n")),
                       "no triangles, but 2 points and lines"));
  import_error(directory_.write("none.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n"));
  import_error(directory_.write("none.stl", "solid\nendsolid\n"));
}

TEST_F(MeshImportErrors, NameFirstNonFiniteVertex) {
  std::string stl = tetrahedron::binary_stl();
  const float not_a_number = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(stl.data() + 84 + 12 + 12, &not_a_number,
              sizeof(not_a_number));  // first facet, second corner, x
  EXPECT_TRUE(contains(import_error(directory_.write("nan.stl", stl)), "vertex 1 of 12 is (nan, "));
  EXPECT_TRUE(
      contains(import_error(directory_.write("large.obj", "v 1e39 0 0\n" + tetrahedron::obj())), "finite"));
}

TEST_F(MeshImportErrors, EnforceVertexAndFaceLimits) {
  ImportLimits limits;
  limits.faces = 3;
  const fs::path file = directory_.write("t.off", tetrahedron::off());
  EXPECT_TRUE(contains(import_error(file, limits), "4 triangles; expected at most 3 (limit 'faces')"));
  limits.faces = 4;
  limits.vertices = 3;
  EXPECT_TRUE(contains(import_error(file, limits), "4 vertices; expected at most 3 (limit 'vertices')"));
  limits.vertices = 4;
  EXPECT_TRUE(import_mesh(file, limits));
}

TEST_F(MeshImportErrors, CountTrianglesOfPolygonsAgainstLimits) {
  const auto quad = [&](const char* height) {
    return directory_.write("quad.obj", std::string("v 0 0 0\nv 1 0 0\nv 1 1 ") + height +
                                            "\nv 0 1 0\nv 0 0 1\nf 1 2 3 4\nf 1 4 5\n");
  };
  ImportLimits limits;
  limits.faces = 2;
  EXPECT_TRUE(contains(import_error(quad("0"), limits), "3 triangles; expected at most 2 (limit 'faces')"));
  limits.faces = 3;
  EXPECT_TRUE(import_mesh(quad("0"), limits));
  EXPECT_TRUE(contains(import_error(quad("0.5"), limits), "5 triangles after splitting polygons"));
}

TEST_F(MeshImportErrors, CountInstancesAgainstLimits) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  const fs::path file =
      directory_.write("two.gltf", tetrahedron::gltf(R"([{"mesh":0,"children":[1]},{"mesh":0}])"));
  ImportLimits limits;
  limits.faces = 7;
  EXPECT_TRUE(contains(import_error(file, limits), "8 triangles"));
}

TEST_F(MeshImportErrors, RejectOffFilesThatTheImporterRepairs) {
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  EXPECT_TRUE(contains(import_error(directory_.write("index.off", "OFF\n4 1 0\n" + corners + "3 0 1 9\n")),
                       "Vertex index is out of range"));
  import_error(
      directory_.write("short.off", "OFF\n9 4 0\n" + corners + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n"));
}

TEST_F(MeshImportErrors, RejectReferencesToNonRegularFiles) {
  const fs::path pipe = directory_.path() / "pipe.bin";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const char* buffer : {R"("uri":"pipe.bin",)", R"("uri":"/dev/zero",)", R"("uri":"missing.bin",)"}) {
    import_error(directory_.write("linked.gltf", tetrahedron::gltf(R"([{"mesh":0}])", buffer)));
  }
  const Expected<ImportedMesh> endless_material =
      import_mesh(directory_.write("linked.obj", "mtllib /dev/zero\n" + tetrahedron::obj()));
  EXPECT_TRUE(endless_material);
}

TEST_F(MeshImportErrors, DetectPlyHeaderWithoutEnd) {
  std::string content = tetrahedron::ascii_ply();
  content.replace(content.find("end_header"), 10, "end_heaber");
  EXPECT_TRUE(
      contains(import_error(directory_.write("endless.ply", content)), "without its 'end_header' line"));
}

TEST_F(MeshImportErrors, NameTriangleStripsInPlyFiles) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string data = "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n6 0 1 2 3 0 1\n";
  const std::string message = import_error(directory_.write("strips.ply", header + strips + data));
  EXPECT_TRUE(contains(message, "a PLY file of triangle strips (element tristrips 1); expected polygons"));
  EXPECT_TRUE(contains(message, "Open it in MeshLab and export it as PLY or STL"));
  const std::string both =
      header + "element face 0\nproperty list uchar int vertex_indices\n" + strips + data;
  EXPECT_TRUE(contains(import_error(directory_.write("both.ply", both)), "triangle strips"));
  std::string windows;
  for (const char c : header + strips + data) windows += c == '\n' ? "\r\n" : std::string(1, c);
  EXPECT_TRUE(contains(import_error(directory_.write("windows.ply", windows)), "(element tristrips 1)"));
}

TEST_F(MeshImportErrors, DistinguishBlankFromDamagedFiles) {
  for (const std::string extension :
       {".obj", ".stl", ".ply", ".off", ".dae", ".gltf", ".glb", ".fbx", ".3ds", ".gdf", ".dat"}) {
    SCOPED_TRACE(extension);
    const auto refusal_of = [&](const std::string& content) {
      const std::string message = import_error(directory_.write("empty" + extension, content));
      EXPECT_FALSE(contains(message, "damaged"));
      return message;
    };
    EXPECT_TRUE(contains(refusal_of(""), "the file is empty (0 bytes)"));
    EXPECT_TRUE(contains(refusal_of(" \r\n\t\n"), "nothing but white space (5 bytes)"));
    EXPECT_TRUE(contains(refusal_of(std::string(100'000, '\0')), "nothing but zero bytes (100000 bytes)"));
  }
}

TEST_F(MeshImportErrors, NameFilesWithOnlyAHeader) {
  const std::string ply = tetrahedron::ply_header("ascii") + "end_header\n";
  EXPECT_TRUE(contains(import_error(directory_.write("header.ply", ply)),
                       "only a PLY header (element vertex 4, element face 4) and nothing after it"));
  const std::string nothing = tetrahedron::ply_header("ascii", "0", "0") + "end_header\n";
  EXPECT_TRUE(
      contains(import_error(directory_.write("nothing.ply", nothing)),
               "no triangles: a PLY header that declares no faces (element vertex 0, element face 0)"));
  for (const auto& [name, content] : std::vector<NamedContent>{
           {"ascii.stl", "solid nothing\nendsolid nothing\n"},
           {"binary.stl", std::string(80, ' ') + std::string(4, '\0')},
           {"header.off", "OFF\n"},
           {"counts.off", "OFF\n0 0 0\n"},
           {"header.obj", "# an empty export\n"},
           {"header.dae", R"(<?xml version="1.0"?><COLLADA version="1.4.1"></COLLADA>)"},
           {"header.gltf", R"({"asset":{"version":"2.0"}})"}}) {
    const std::string message = import_error(directory_.write(name, content));
    EXPECT_TRUE(contains(message, "no mesh in it (")) << name;
    EXPECT_FALSE(contains(message, "damaged")) << name;
  }
}

TEST_F(MeshImportErrors, AreCompleteForTruncatedFiles) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  std::vector<NamedContent> files = tetrahedron_files();
  const fs::path models = "/usr/share/assimp/models";  // Debian's assimp-testmodels; optional
  for (const char* name : {"OBJ/spider.obj", "STL/Spider_ascii.stl", "STL/Spider_binary.stl", "PLY/Wuson.ply",
                           "PLY/cube_binary.ply", "OFF/Wuson.off", "Collada/duck.dae",
                           "glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf",
                           "glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb", "FBX/spider.fbx",
                           "FBX/box.fbx", "3DS/fels.3ds"}) {
    if (fs::exists(models / name)) {
      files.push_back({"model" + fs::path(name).extension().string(), read_file(models / name)});
    }
  }
  ImportLimits limits;
  limits.import_seconds = 2.0;
  for (const auto& [name, content] : files) {
    for (std::size_t tenth = 0; tenth < 10; ++tenth) {
      SCOPED_TRACE(name + " cut at " + std::to_string(tenth) + "0 %");
      expect_mesh_or_complete_error(directory_.write(name, content.substr(0, content.size() * tenth / 10)),
                                    limits);
    }
  }
}

TEST_F(MeshImportErrors, AreCompleteForCorruptedFiles) {
  directory_.write("tetrahedron.bin", tetrahedron::gltf_buffer());
  ImportLimits limits;
  limits.import_seconds = 0.2;
  std::uint32_t state = 1;
  const auto random = [&state] { return (state = state * 1664525U + 1013904223U) >> 8; };
  for (const auto& [name, content] : tetrahedron_files()) {
    for (int round = 0; round < 20; ++round) {
      std::string wrong = content;
      for (int i = 0; i < 1 + round % 4; ++i) wrong[random() % wrong.size()] = static_cast<char>(random());
      SCOPED_TRACE(name + " round " + std::to_string(round));
      expect_mesh_or_complete_error(directory_.write(name, wrong), limits);
    }
  }
}

TEST_F(MeshImportErrors, RejectSharedMalformedFiles) {
  const fs::path malformed = shared_mesh_file("malformed");
  if (!fs::exists(malformed)) GTEST_SKIP() << missing_shared_mesh(malformed);
  for (const fs::directory_entry& entry : fs::directory_iterator(malformed)) import_error(entry.path());
}

}  // namespace
}  // namespace buoyancy
