#include "geometry/meshlets.h"

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/sample_meshes.h"

namespace buoyancy {
namespace {

using Corners = std::array<std::array<double, 3>, 3>;

Corners corners_of(const TriangleMesh& mesh, const Triangle& triangle) {
  Corners corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 vertex = mesh.vertex(triangle[i]);
    corners[i] = {vertex.x(), vertex.y(), vertex.z()};
  }
  return corners;
}

// The triangles with three different corners.
std::vector<Corners> triangles_of(const Meshlets& meshlets) {
  std::vector<Corners> triangles;
  for (const Meshlet& meshlet : meshlets.meshlets) {
    const auto point = [&](std::uint8_t corner) -> std::array<double, 3> {
      EXPECT_EQ(corner % 4, 0);
      EXPECT_LT(corner / 4U, meshlet.vertices);
      const std::size_t i = meshlet.first_vertex + corner / 4U;
      return {meshlets.x[i], meshlets.y[i], meshlets.z[i]};
    };
    for (std::size_t group = 0; group < meshlet.groups; ++group) {
      const CornerGroup& corners = meshlets.groups[meshlet.first_group + group];
      std::uint64_t vertices = 0;
      for (const auto& corner : {corners.a, corners.b, corners.c}) {
        for (const std::uint8_t at : corner) vertices |= std::uint64_t{1} << (at / 4U);
      }
      EXPECT_EQ(corners.vertices, vertices);
      for (std::size_t i = 0; i < kGroupTriangles; ++i) {
        if (corners.a[i] == corners.b[i] && corners.b[i] == corners.c[i]) continue;
        triangles.push_back({point(corners.a[i]), point(corners.b[i]), point(corners.c[i])});
      }
    }
  }
  return triangles;
}

TriangleMesh shuffled(TriangleMesh mesh) {
  std::mt19937_64 generator(3);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), generator);
  return mesh;
}

TEST(Meshlets, ContainEveryTriangleOnceWithinLimits) {
  for (const TriangleMesh& mesh :
       {tetrahedron_mesh(), cube_mesh(), rock_mesh(16), sphere_mesh(40), shuffled(rock_mesh(12)),
        unwelded(rock_mesh(8)), make_shape(BoxShape{.size = {8192, 1, 1}, .segments = {40, 1, 1}})}) {
    const Meshlets meshlets = build_meshlets(mesh);
    std::vector<Corners> expected;
    expected.reserve(mesh.triangles.size());
    for (const Triangle& triangle : mesh.triangles) expected.push_back(corners_of(mesh, triangle));
    std::vector<Corners> found = triangles_of(meshlets);
    std::sort(expected.begin(), expected.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, expected) << mesh.triangles.size();

    std::size_t vertices = 0;
    std::size_t groups = 0;
    for (const Meshlet& meshlet : meshlets.meshlets) {
      EXPECT_EQ(meshlet.first_vertex, vertices);
      EXPECT_EQ(meshlet.first_group, groups);
      EXPECT_EQ(meshlet.vertices % 4, 0U);
      EXPECT_LE(meshlet.vertices, Meshlets::kMaxVertices);
      EXPECT_LE(meshlet.groups, Meshlets::kMaxGroups);
      vertices += meshlet.vertices;
      groups += meshlet.groups;
    }
    EXPECT_EQ(meshlets.x.size(), vertices);
    EXPECT_EQ(meshlets.groups.size(), groups);
  }
}

TEST(Meshlets, GroupNeighboursWhateverTheOrderOfTriangles) {
  const TriangleMesh mesh = rock_mesh(30);
  const Meshlets in_order = build_meshlets(mesh);
  const Meshlets from_shuffled = build_meshlets(shuffled(mesh));
  EXPECT_EQ(from_shuffled.x, in_order.x);
  EXPECT_EQ(from_shuffled.y, in_order.y);
  EXPECT_EQ(from_shuffled.z, in_order.z);
  // A mesh has half as many vertices as triangles; those between meshlets are stored more than once.
  EXPECT_LT(static_cast<double>(in_order.x.size()), 0.85 * static_cast<double>(mesh.triangles.size()));
  EXPECT_LT(static_cast<double>(in_order.bytes()), 27.0 * static_cast<double>(mesh.triangles.size()));
}

TEST(Meshlets, AcceptMeshesWithoutTrianglesExtentOrFiniteSize) {
  EXPECT_TRUE(build_meshlets({}).meshlets.empty());
  TriangleMesh point = tetrahedron_mesh();
  for (std::vector<double>* coordinate : {&point.x, &point.y, &point.z})
    std::fill(coordinate->begin(), coordinate->end(), 3.0);
  EXPECT_EQ(triangles_of(build_meshlets(point)).size(), 4U);
  TriangleMesh huge = tetrahedron_mesh();
  for (double& x : huge.x) x = (x - 0.5) * std::numeric_limits<double>::max() * 2.0;
  EXPECT_EQ(triangles_of(build_meshlets(huge)).size(), 4U);
}

}  // namespace
}  // namespace buoyancy
