// The stiffness against derivatives of force and torque by dual numbers; near bodies are in the stress
// catalogue, "Invariants".
#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/hydrostatics.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/stiffness_autodiff.h"

namespace buoyancy {
namespace {

TEST(Stiffness, HoldsAboutDistantReferencePoint) {
  const TriangleMesh rock = moved_and_scaled(make_shape(RockShape{.frequency = 8}), {6e5, -8e5, 1e5});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  RandomPoses random(32);
  int crossing = 0;

  for (int i = 0; i < 50; ++i) {
    const Pose pose = random.crossing(bounding_box(rock), {});
    const auto found = hydrostatics(mesh, pose, {}, Vec3::Zero(), std::nullopt);
    ASSERT_TRUE(found);
    const Mat6 expected = stiffness_autodiff(mesh, pose, {}, Vec3::Zero());
    const double area = found->waterplane_area;
    // Without a waterplane, the rounding error of its area in the reference counts with the distance squared.
    if (!(area > 0.0)) continue;
    EXPECT_LE(max_difference(found->stiffness, expected, true), stiffness_tolerance(mesh, area)) << i;
    crossing += static_cast<int>(stiffness_tolerance(mesh, area) == 1e-9);
  }
  EXPECT_GT(crossing, 15);
}

}  // namespace
}  // namespace buoyancy
