#include "geometry/mesh_report.h"

#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/mesh_validation.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

std::string text_of(const TriangleMesh& mesh, RepairPolicy repair = RepairPolicy::kAutomatic) {
  const MeshSource source{"STL", "not stated", "", 1, 2};
  return to_text(validate_mesh({mesh, source}, "hull.stl", {OpenPolicy::kRefuse, true, repair}).report);
}

void expect_line(const std::string& text, const std::string& line) {
  EXPECT_TRUE(contains(("\n" + text + "\n"), "\n" + line + "\n")) << text << "\nhas no line\n" << line;
}

TEST(MeshReport, FormatsAlignedLines) {
  EXPECT_EQ(text_of(cube_mesh(2)),
            "hull.stl\n"
            "  source        STL, up axis not stated, 2 points and lines left out\n"
            "  surface       closed\n"
            "  triangles     12\n"
            "  vertices      8 stored, 8 after welding\n"
            "  edges         each used once in each direction\n"
            "  box           from -1, -1, -1 to 1, 1, 1 m, diagonal 3.464102 m\n"
            "  area          24 m^2\n"
            "  volume        8 m^3\n"
            "                from x, y, z: 8, 8, 8 m^3\n"
            "                integral of n dA: 0, 0, 0 m^2\n"
            "  intersecting  0 pairs of faces");
}

TEST(MeshReport, ListsFaultsOfRefusedMesh) {
  TriangleMesh mesh = without_face(cube_mesh(), 0);
  mesh.triangles.push_back(mesh.triangles.back());
  mesh.triangles.push_back({1, 1, 2});
  const std::string text = text_of(mesh, RepairPolicy::kNone);
  expect_line(text, "  surface       open or inconsistent");
  expect_line(text, "  edges         3 boundary, 3 non-manifold");
  expect_line(text, "  faces         1 dropped for using a vertex twice, 1 duplicate of an earlier face");
  expect_line(text, "  holes         1");
  expect_line(
      text,
      "                1: 3 edges, from -0.5, -0.5, -0.5 to 0.5, 0.5, -0.5; 3.414 m around, 0.5 m^2, 0.133 "
      "m^3 in a hemisphere over it, 13.3 % of the closed volume");
  expect_line(text, "  intersecting  1 pair of faces");
  expect_line(text, "  overlap       not known before the mesh is closed");
}

TEST(MeshReport, SaysHowMuchVolumeCountsTwice) {
  // A box that stands on another, and one that reaches into it.
  const TriangleMesh deck = box_mesh(Vec3::Zero(), {4.0, 4.0, 1.0});
  expect_line(text_of(joined(deck, box_mesh({1.0, 1.0, 1.0}, {2.0, 2.0, 2.0}))),
              "  overlap       0 m^3 count more than once, 0 % of the volume (within some 0.1 %)");
  expect_line(text_of(joined(deck, box_mesh({1.0, 1.0, 0.5}, {3.0, 3.0, 1.5}))),
              "  overlap       2 m^3 count more than once, 10 % of the volume (within some 0.1 %)");
}

TEST(MeshReport, ListsTheShareOfEachHole) {
  // Of a cube of 8 m^3, one triangle of 2 m^2.
  const std::string text = text_of(without_face(cube_mesh(2.0), 0));
  EXPECT_TRUE(contains(text, "1.06 m^3 in a hemisphere over it, 13.3 % of the closed volume\n"));
}

TEST(MeshReport, RoundsCoordinatesToThoseOfFiles) {
  EXPECT_TRUE(contains(text_of(box_mesh(Vec3::Constant(-0.8F), Vec3::Constant(1.4F))),
                       "from -0.8, -0.8, -0.8 to 1.4, 1.4, 1.4 m"));
}

TEST(MeshReport, ListsRepairs) {
  TriangleMesh mesh = cube_mesh();
  mesh.triangles.push_back(mesh.triangles.back());
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  const std::string text = text_of(mesh);
  expect_line(text, "  repair        1 copy of a face removed, 0.5 m^2");
  expect_line(
      text,
      "                1 face turned to the winding of their neighbours, 0.5 m^2; volume not closed -> "
      "1 m^3");
}

TEST(MeshReport, ClassifiesEveryComponent) {
  const TriangleMesh shell = joined(cube_mesh(4), inside_out(cube_mesh(3)));
  const TriangleMesh filled = joined(shell, inside_out(cube_mesh(2)));
  const std::string text = text_of(joined(filled, cube_mesh(1)));
  expect_line(text, "  components    4, 1 cavity, 1 inside another, 1 flipped");
  expect_line(text, "                12 triangles, 64 m^3");
  expect_line(text, "                12 triangles, -27 m^3, a cavity");
  expect_line(text, "                12 triangles, 8 m^3, was inside out: its winding was reversed");
  expect_line(text, "                12 triangles, 1 m^3, inside another: its volume counts twice");
  EXPECT_FALSE(contains(text, "the winding of all faces"));
}

TEST(MeshReport, ReportsTurnedMesh) {
  expect_line(text_of(inside_out(cube_mesh())),
              "  flipped       was inside out: the winding of all faces was reversed");
}

TEST(MeshReport, TruncatesLongLists) {
  TriangleMesh many;
  for (int i = 0; i < 30; ++i)
    many = joined(std::move(many), without_face(cube_mesh(1, Vec3(2.0 * i, 0, 0)), 0));
  const std::string text = text_of(many);
  expect_line(text, "  components    30");
  expect_line(text, "  holes         30");
  expect_line(text, "                and 22 smaller ones");
}

TEST(MeshReport, OmitsFiguresOfUncheckedMesh) {
  TriangleMesh broken = cube_mesh();
  broken.x[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(text_of(broken),
            "hull.stl\n"
            "  source        STL, up axis not stated, 2 points and lines left out\n"
            "  surface       none\n"
            "  triangles     0\n"
            "  vertices      8 stored, 0 after welding");
}

}  // namespace
}  // namespace buoyancy
