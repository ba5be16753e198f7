#include "geometry/mesh_topology.h"

#include <gtest/gtest.h>

#include "geometry/welding.h"
#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

TEST(MeshTopology, ClassifiesEdgesOfClosedMeshAsManifold) {
  const MeshTopology topology = mesh_topology(cube_mesh());
  EXPECT_EQ(topology.counts.manifold, 18);
  EXPECT_TRUE(topology.counts.all_matched());
  EXPECT_EQ(topology.counts.balanced, 0);
  EXPECT_EQ(topology.components, 1);
  EXPECT_EQ(topology.duplicate_faces, 0);
}

TEST(MeshTopology, ReportsBoundaryInDirectionOfItsFaces) {
  const TriangleMesh open = without_face(cube_mesh(), 0);  // 0 2 1
  const MeshTopology topology = mesh_topology(open);
  EXPECT_EQ(topology.counts.boundary, 3);
  EXPECT_EQ(topology.boundary, (std::vector<Edge>{{0, 1}, {2, 0}, {1, 2}}));
  for (std::size_t i = 0; i < topology.boundary.size(); ++i) {
    const Triangle& face = open.triangles[static_cast<std::size_t>(topology.boundary_faces[i])];
    const auto [from, to] = topology.boundary[i];
    EXPECT_TRUE((face[0] == from && face[1] == to) || (face[1] == from && face[2] == to) ||
                (face[2] == from && face[0] == to));
  }
}

TEST(MeshTopology, DetectsMisorientedEdges) {
  TriangleMesh cube = cube_mesh();
  std::swap(cube.triangles[5][0], cube.triangles[5][1]);
  const MeshTopology topology = mesh_topology(cube);
  EXPECT_EQ(topology.counts.misoriented, 3);
  EXPECT_EQ(topology.counts.boundary, 0);
  EXPECT_FALSE(topology.counts.all_matched());
}

// Two cubes that share an edge.
TriangleMesh edge_sharing_cubes() {
  return weld(joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)), box_mesh(Vec3(1, 1, 0), Vec3(2, 2, 1)))).mesh;
}

TEST(MeshTopology, DetectsBalancedEdges) {
  const MeshTopology topology = mesh_topology(edge_sharing_cubes());
  EXPECT_EQ(topology.counts.balanced, 1);
  EXPECT_EQ(topology.counts.non_manifold, 0);
  EXPECT_TRUE(topology.counts.all_matched());
}

TEST(MeshTopology, DetectsNonManifoldEdges) {
  TriangleMesh cube = cube_mesh();
  const std::int32_t fin = cube.add_vertex({5, 5, 5});
  cube.triangles.push_back({0, 1, fin});
  const MeshTopology topology = mesh_topology(cube);
  EXPECT_EQ(topology.counts.non_manifold, 1);
  EXPECT_EQ(topology.non_manifold, (std::vector<Edge>{{0, 1}}));
  EXPECT_EQ(topology.counts.boundary, 2);
}

TEST(MeshTopology, CountsDuplicateFacesOfEitherWinding) {
  TriangleMesh cube = cube_mesh();
  const Triangle face = cube.triangles[4];
  cube.triangles.push_back({face[1], face[2], face[0]});
  cube.triangles.push_back({face[1], face[0], face[2]});
  EXPECT_EQ(mesh_topology(cube).duplicate_faces, 2);
}

TEST(MeshTopology, NumbersComponentsByFirstFace) {
  const MeshTopology topology = mesh_topology(joined(tetrahedron_mesh(), cube_mesh(1, Vec3(9, 9, 9))));
  EXPECT_EQ(topology.components, 2);
  EXPECT_EQ(topology.component_of_face.front(), 0);
  EXPECT_EQ(topology.component_of_face.back(), 1);
}

TEST(MeshTopology, SeparatesFacesThatShareOnlyAVertex) {
  const TriangleMesh touching =
      weld(joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)), box_mesh(Vec3(1, 1, 1), Vec3(2, 2, 2)))).mesh;
  EXPECT_EQ(touching.vertex_count(), 15U);
  EXPECT_EQ(mesh_topology(touching).components, 2);
}

TEST(MeshTopology, GroupsBoundaryIntoHolesLargestFirst) {
  TriangleMesh cube = cube_mesh();
  cube.triangles.erase(cube.triangles.begin() + 2, cube.triangles.begin() + 4);  // the top
  cube = without_face(cube, 0);                                                  // half the bottom
  const std::vector<Hole> holes = find_holes(cube, mesh_topology(cube).boundary);
  ASSERT_EQ(holes.size(), 2U);
  EXPECT_EQ(holes[0].edges.size(), 4U);
  EXPECT_EQ(holes[0].box.min_B, Vec3(-0.5, -0.5, 0.5));
  EXPECT_EQ(holes[0].box.max_B, Vec3(0.5, 0.5, 0.5));
  EXPECT_EQ(holes[1].edges.size(), 3U);
}

}  // namespace
}  // namespace buoyancy
