#include "geometry/face_winding.h"

#include <cmath>
#include <utility>

#include <gtest/gtest.h>

#include "geometry/mesh_validation.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/geometry/validated.h"

namespace buoyancy {
namespace {

TriangleMesh with_turned_faces(TriangleMesh mesh, std::size_t stride) {
  for (std::size_t f = 0; f < mesh.triangles.size(); f += stride)
    std::swap(mesh.triangles[f][0], mesh.triangles[f][1]);
  return mesh;
}

TEST(FaceWinding, TurnsTheSmallerPart) {
  const TriangleMesh rock = rock_mesh();
  const MeshValidation validation = validate(with_turned_faces(rock, 3));
  ASSERT_TRUE(validation.mesh);
  ASSERT_EQ(validation.report.repair.steps.size(), 1U);
  const RepairStep& step = validation.report.repair.steps[0];
  EXPECT_EQ(step.kind, RepairKind::kTurnFaces);
  EXPECT_EQ(step.count, static_cast<std::int64_t>((rock.triangles.size() + 2) / 3));
  EXPECT_LT(step.area, 0.5 * validation.report.area);
  EXPECT_FALSE(validation.report.flipped);
  EXPECT_EQ(validation.report.volume, validate(rock).report.volume);
}

TEST(FaceWinding, LeavesTheRestToOrientationIfMostFacesAreTurned) {
  const MeshValidation validation = validate(inside_out(with_turned_faces(rock_mesh(), 3)));
  ASSERT_TRUE(validation.mesh);
  EXPECT_TRUE(validation.report.flipped);
  EXPECT_NEAR(validation.report.volume, validate(rock_mesh()).report.volume, 1e-12);
}

TEST(FaceWinding, TurnsFacesOfCavitiesByTheirMajority) {
  const TriangleMesh shell = joined(cube_mesh(3), inside_out(cube_mesh(1)));
  const MeshValidation validation = validate(with_turned_faces(shell, 5));
  ASSERT_TRUE(validation.mesh);
  EXPECT_DOUBLE_EQ(validation.report.volume, 26.0);
}

// Returns a strip around a circle with half a turn per revolution and `turns` of these.
TriangleMesh strip(int turns) {
  TriangleMesh mesh;
  constexpr int kSegments = 40;
  for (int i = 0; i < kSegments; ++i) {
    const double angle = 6.283185307179586 * i / kSegments;
    const double tilt = 0.5 * turns * angle;
    for (const double side : {-0.2, 0.2}) {
      const double r = 1.0 + side * std::cos(tilt);
      mesh.add_vertex({r * std::cos(angle), r * std::sin(angle), side * std::sin(tilt)});
    }
  }
  for (std::int32_t i = 0; i < kSegments; ++i) {
    const std::int32_t next = 2 * ((i + 1) % kSegments);
    const bool seam = i + 1 == kSegments && turns % 2 == 1;
    const std::int32_t c = next + (seam ? 1 : 0);
    const std::int32_t d = next + (seam ? 0 : 1);
    mesh.triangles.push_back({2 * i, c, 2 * i + 1});
    mesh.triangles.push_back({2 * i + 1, c, d});
  }
  return mesh;
}

TEST(FaceWinding, RefusesMoebiusStrips) {
  const MeshValidation validation = validate(strip(1));
  EXPECT_FALSE(validation.mesh);
  ASSERT_FALSE(validation.report.repair.skipped.empty());
  EXPECT_EQ(validation.report.repair.skipped[0],
            (SkippedRepair{RepairKind::kTurnFaces, RepairObstacle::kNotOrientable, 80}));
  EXPECT_TRUE(validate(strip(2)).report.repair.skipped.empty());
}

// A torus of n by n vertices whose last column is glued to the first upside down.
TEST(FaceWinding, RefusesKleinBottles) {
  TriangleMesh bottle;
  constexpr std::int32_t kSegments = 12;
  for (int i = 0; i < kSegments; ++i) {
    for (int j = 0; j < kSegments; ++j) {
      const double u = 6.283185307179586 * i / kSegments;
      const double v = 6.283185307179586 * j / kSegments;
      const double r = 2.0 + std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
      bottle.add_vertex({r * std::cos(u), r * std::sin(u),
                         std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v)});
    }
  }
  const auto at = [](std::int32_t i, std::int32_t j) {
    if (i == kSegments) j = 2 * kSegments - j;
    return (i % kSegments) * kSegments + j % kSegments;
  };
  for (std::int32_t i = 0; i < kSegments; ++i) {
    for (std::int32_t j = 0; j < kSegments; ++j) {
      bottle.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      bottle.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  const MeshValidation validation = validate(bottle);
  EXPECT_EQ(validation.report.boundary_edges, 0);
  EXPECT_GT(validation.report.misoriented_edges, 0);
  EXPECT_FALSE(validation.mesh);
}

// Most faces of the second box are turned: its majority is inside out. Together they would count as a
// difference of volumes, because both belong to one component.
TEST(FaceWinding, DoesNotSubtractATurnedSolidThatTouchesAnother) {
  TriangleMesh second = box_mesh(Vec3(1, 1, 0), Vec3(2, 2, 1));
  for (std::size_t f = 0; f < 9; ++f) std::swap(second.triangles[f][0], second.triangles[f][1]);
  const MeshValidation validation = validate(joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1.5)), second));
  if (validation.mesh) {
    EXPECT_DOUBLE_EQ(validation.report.volume, 2.5);
  }
  const MeshValidation equal = validate(joined(box_mesh(Vec3(0, 0, 0), Vec3(1, 1, 1)), second));
  if (equal.mesh) {
    EXPECT_DOUBLE_EQ(equal.report.volume, 2.0);
  }
}

}  // namespace
}  // namespace buoyancy
