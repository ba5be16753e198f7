#include "view/page/mesh_drawing.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "geometry/shapes.h"

namespace buoyancy::view {
namespace {

// [m^3], by the divergence theorem.
double volume_of(const MeshDrawing& drawing) {
  const auto vertex = [&drawing](std::uint32_t i) {
    const float* const p = drawing.positions.data() + 3 * std::size_t{i};
    return Vec3(p[0], p[1], p[2]);
  };
  double volume = 0.0;
  for (std::size_t i = 0; i < drawing.indices.size(); i += 3) {
    volume +=
        vertex(drawing.indices[i]).dot(vertex(drawing.indices[i + 1]).cross(vertex(drawing.indices[i + 2]))) /
        6.0;
  }
  return volume;
}

TEST(MeshDrawing, AppendsPlacedMeshes) {
  MeshDrawing drawing;
  append(drawing, make_shape(BoxShape{{2, 4, 6}, {1, 1, 1}}));
  Mat3 rotation;  // a quarter turn about z
  rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  append(drawing, make_shape(BoxShape{{2, 4, 6}, {1, 1, 1}}), rotation, Vec3(10, 0, 0));
  EXPECT_EQ(drawing.triangle_count(), 24U);
  ASSERT_EQ(drawing.positions.size(), 48U);
  EXPECT_NEAR(volume_of(drawing), 96.0, 1e-4);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(std::abs(drawing.positions[3 * i]), 1.0F);
    EXPECT_NEAR(std::abs(drawing.positions[24 + 3 * i] - 10.0F), 2.0F, 1e-6F) << "its y extent";
    EXPECT_NEAR(std::abs(drawing.positions[24 + 3 * i + 1]), 1.0F, 1e-6F);
  }
}

TEST(MeshDrawing, ReducesOnlyWhatHasTooManyTriangles) {
  MeshDrawing drawing;
  append(drawing, make_shape(RockShape{.frequency = 30}));
  const std::size_t triangles = drawing.triangle_count();
  const double volume = volume_of(drawing);
  reduce(drawing, triangles);
  EXPECT_EQ(drawing.triangle_count(), triangles);
  reduce(drawing, 2'000);
  EXPECT_LE(drawing.triangle_count(), 2'000U);
  EXPECT_GT(drawing.triangle_count(), 500U);
  EXPECT_LT(drawing.positions.size(), 3 * 2'000U);
  EXPECT_NEAR(volume_of(drawing), volume, 0.02 * volume);
}

}  // namespace
}  // namespace buoyancy::view
