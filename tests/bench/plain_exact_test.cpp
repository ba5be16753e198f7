// Tests the plain method of the benchmarks against the product's exact one.
#include "bench/plain_exact.h"

#include <gtest/gtest.h>

#include "bench/benchmark_meshes.h"
#include "bench/unit_water.h"
#include "hydrostatics/buoyancy.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy::bench {
namespace {

TEST(PlainExact, AgreesWithExactMethodOfProduct) {
  const Water water{.up_W = Vec3::UnitZ(), .level = 0.3, .density = 1000.0, .gravity = 9.81};
  const Vec3 reference_B(0.4, -0.2, 0.1);
  for (const BenchmarkMesh& model : {rock(8), rock_uv(40, 21), torus_knot()}) {
    const Solver exact(model.mesh, Method::kExact);
    PlainExact plain(model.source);
    const double whole = water.density * water.gravity * model.mesh.volume;
    RandomPoses random(31);
    for (int i = 0; i < 50; ++i) {
      const Pose pose = random.crossing(bounding_box(model.source), water);
      const BuoyancyResult expected = buoyancy(exact, pose, water, reference_B);
      const PlainWrench found = plain(pose, water, reference_B);
      EXPECT_NEAR(found.volume, expected.volume, 1e-12 * model.mesh.volume) << model.name;
      EXPECT_LE((found.force_W - expected.force_W).norm(), 1e-12 * whole) << model.name;
      EXPECT_LE((found.torque_W - expected.torque_W).norm(), 1e-12 * whole * model.mesh.diagonal)
          << model.name;
    }
  }
}

}  // namespace
}  // namespace buoyancy::bench
