#include "hydrostatics/lowest_vertex.h"

#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

TEST(LowestVertex, IsThatOfASearchOfAllVertices) {
  for (const NamedMesh& sample : closed_test_meshes()) {
    SCOPED_TRACE(sample.name);
    const HydrostaticMesh mesh = make_hydrostatic_mesh({sample.mesh, {}});
    RandomPoses random(11);
    for (int i = 0; i < 30; ++i) {
      const Vec3 up_B = i == 0 ? Vec3(-Vec3::UnitZ()) : random.direction();
      double expected = std::numeric_limits<double>::infinity();
      for (const Triangle& triangle : mesh.surface.triangles) {
        for (const std::int32_t corner : triangle) {
          expected = std::min(expected, up_B.dot(mesh.vertex(corner)));
        }
      }
      EXPECT_NEAR(lowest_vertex(*mesh.tree, up_B), expected, 1e-15 * mesh.diagonal);
    }
  }
}

TEST(LowestVertex, IsInMetresForAScaledMesh) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 6, .roughness = 0.4, .seed = 7});
  const HydrostaticMesh mesh =
      make_hydrostatic_mesh({moved_and_scaled(rock, Vec3::Zero(), 0.01), {}}, WithTree::kYes, 0.01);
  ASSERT_EQ(mesh.tree->scale, 0.01);
  const Vec3 up_B = Vec3(1, 2, 2) / 3.0;
  double expected = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < rock.vertex_count(); ++i) {
    expected = std::min(expected, 0.01 * up_B.dot(rock.vertex(static_cast<std::int32_t>(i))));
  }
  EXPECT_NEAR(lowest_vertex(*mesh.tree, up_B) + up_B.dot(mesh.center_B), expected, 1e-16);
}

}  // namespace
}  // namespace buoyancy
