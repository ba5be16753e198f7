#include "scene/floating_pose.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "geometry/mesh_validation.h"
#include "geometry/shapes.h"

namespace buoyancy {
namespace {

// A body of the weight of this volume of water.
FloatingBody body_of(const HydrostaticMesh& mesh, double volume, const Water& water) {
  const std::array<PlacedMesh, 1> meshes{{{.mesh = &mesh}}};
  return FloatingBody::make(meshes, volume * water.density, Vec3::Zero()).value();
}

TEST(FloatingPose, DisplacesTheRequestedVolume) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const std::array<Shape, 4> shapes{BoxShape{{3, 1, 0.2}, {3, 2, 1}}, TorusKnotShape{}, RockShape{},
                                    ConeShape{0.5, 2.0, 16, 2}};
  for (const Shape& shape : shapes) {
    const HydrostaticMesh mesh =
        make_hydrostatic_mesh(validate_mesh({make_shape(shape), {}}, "shape", {}).mesh.value());
    for (int run = 0; run < 60; ++run) {
      const Eigen::Quaterniond q(
          Eigen::Vector4d{uniform(random), uniform(random), uniform(random), uniform(random)}.normalized());
      const double exponent = 4.0 * std::abs(uniform(random));
      const double fraction = run % 2 == 0 ? std::pow(10.0, -exponent) : 1.0 - std::pow(10.0, -exponent);
      const double volume = fraction * mesh.volume;
      const Water water{.up_W = Vec3(0.6, 0.0, 0.8), .level = 7.0};
      const auto floating = find_floating_pose(body_of(mesh, volume, water), q, water);
      ASSERT_TRUE(floating) << fraction;
      EXPECT_NEAR(floating->state.hydrostatics.volume, volume,
                  4.0 * mesh.volume_tolerance() + 1e-14 * mesh.area)
          << fraction;
      double lowest = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < mesh.surface.x.size(); ++i) {
        const Vec3 vertex_W =
            floating->pose.p_WB + q * Vec3(mesh.center_B + mesh.vertex(static_cast<std::int32_t>(i)));
        lowest = std::min(lowest, water.up_W.dot(vertex_W));
      }
      EXPECT_NEAR(floating->draft, water.level - lowest, 1e-12);
    }
    const Water water;
    const FloatingBody heavy = body_of(mesh, 1.01 * mesh.volume, water);
    EXPECT_FALSE(find_floating_pose(heavy, Eigen::Quaterniond::Identity(), water));
  }
}

}  // namespace
}  // namespace buoyancy
