#include "tests/truth/reference_load.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "tests/waves/seas.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SeaDescription three_waves(WavePressure pressure, double depth) {
  return sea_of({WaveComponents{{0.2, 2.0, 30.0, 40.0}, {0.1, 3.0, -60.0, 140.0}, {0.02, 5.0, 170.0, 300.0}}},
                pressure, depth);
}

TEST(ReferenceLoad, SaysThatItsWorkDidNotSuffice) {
  const TriangleMesh mesh = make_shape(BoxShape{{30.0, 20.0, 2.0}, {1, 1, 1}});
  const HydrostaticMesh body = make_hydrostatic_mesh(ValidatedMesh{mesh, {}}, WithTree::kNo);
  const Sea sea = Sea::make(three_waves(WavePressure::kWheeler, kInfinity), Water{}).value();
  const ReferenceSea reference(sea, 0, 0.0, Pose{}, body.center_B);
  const ReferenceLoad load =
      reference_load(mesh, body.center_B, reference, Vec3::Zero(),
                     {.force_error = 1e-6, .torque_error = 1e-6, .volume_error = 1e-6, .max_work = 20'000});
  EXPECT_FALSE(load.resolved);
  EXPECT_GT(load.force_error, 1e-6);
}

}  // namespace
}  // namespace buoyancy
