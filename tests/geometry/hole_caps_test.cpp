#include "geometry/hole_caps.h"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "geometry/mesh_repair.h"
#include "geometry/mesh_validation.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/geometry/validated.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

// Leaves a triangle with legs of this length open in a face with a right angle at its first corner.
TriangleMesh with_pinhole(TriangleMesh mesh, std::size_t face, double leg) {
  const auto [a, b, c] = mesh.triangles[face];
  const Vec3 ab = mesh.vertex(b) - mesh.vertex(a);
  const Vec3 ac = mesh.vertex(c) - mesh.vertex(a);
  const std::int32_t d = mesh.add_vertex(mesh.vertex(a) + 0.3 * ab + 0.3 * ac);
  const std::int32_t e = mesh.add_vertex(mesh.vertex(d) + leg * ab.normalized());
  const std::int32_t f = mesh.add_vertex(mesh.vertex(d) + leg * ac.normalized());
  mesh.triangles[face] = {a, b, d};
  for (const Triangle& piece : {Triangle{b, e, d}, {b, c, e}, {c, f, e}, {c, d, f}, {c, a, d}})
    mesh.triangles.push_back(piece);
  return mesh;
}

TEST(HoleCaps, ClosesNegligibleHoles) {
  const TriangleMesh cube = with_pinhole(with_pinhole(cube_mesh(), 0, 1e-3), 8, 2e-3);
  const MeshValidation validation = validate(cube);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  ASSERT_EQ(validation.report.repair.steps.size(), 1U);
  const RepairStep& step = validation.report.repair.steps[0];
  EXPECT_EQ(step.kind, RepairKind::kCapHoles);
  EXPECT_EQ(step.count, 2);
  EXPECT_NEAR(step.area, 0.5e-6 + 2e-6, 1e-18);
  EXPECT_NEAR(validation.report.repair.cap_bulge, 0.376 * (std::pow(0.5e-6, 1.5) + std::pow(2e-6, 1.5)),
              1e-16);
  EXPECT_FALSE(step.before);
  EXPECT_NEAR(step.after.value().volume, 1.0, 1e-15);
  EXPECT_TRUE(validation.report.holes.empty());
  EXPECT_EQ(validation.report.repair.volume_bound, 0.0);
}

TEST(HoleCaps, LeavesHolesAboveTheLimit) {
  // The limit of a volume of 1 m^3 is an area of (1e-5 / 0.376)^(2/3) = 8.9e-4 m^2.
  EXPECT_TRUE(validate(with_pinhole(cube_mesh(), 2, 0.042)).mesh);
  const MeshValidation larger = validate(with_pinhole(cube_mesh(), 2, 0.0425));
  EXPECT_FALSE(larger.mesh);
  ASSERT_EQ(larger.report.holes.size(), 1U);
  EXPECT_NEAR(larger.report.holes[0].area, 0.5 * 0.0425 * 0.0425, 1e-15);
  EXPECT_NEAR(larger.report.holes[0].perimeter, 0.0425 * (2 + std::sqrt(2.0)), 1e-15);
  EXPECT_NEAR(larger.report.holes[0].bulge, 0.376 * std::pow(larger.report.holes[0].area, 1.5), 1e-15);
  EXPECT_FALSE(larger.report.holes[0].slit);
  EXPECT_TRUE(larger.report.repair.empty());
}

TEST(HoleCaps, CountsHolesTogether) {
  TriangleMesh many = make_shape(BoxShape{.size = {1, 1, 1}, .segments = {4, 4, 4}});
  for (std::size_t face = 0; face < 40; ++face) many = with_pinhole(many, face, 0.02);
  EXPECT_FALSE(validate(many).mesh);
}

TEST(HoleCaps, LeavesSmallHolesOfAMeshWithALargeOne) {
  TriangleMesh cup = with_pinhole(without_face(cube_mesh(), 2), 5, 1e-3);
  const MeshValidation validation = validate(cup, OpenPolicy::kDryBoundary);
  ASSERT_TRUE(validation.mesh);
  EXPECT_TRUE(validation.report.repair.empty());
  EXPECT_EQ(validation.report.holes.size(), 2U);
}

TEST(HoleCaps, ClosesHolesThatTouchInAVertex) {
  // A fan of 8 faces around a vertex in the middle of the top, every other one of which is missing.
  TriangleMesh fan = make_shape(CylinderShape{.radius = 1e-2, .height = 10, .segments = 8});
  std::size_t removed = 0;
  for (std::size_t f = 0; f < fan.triangles.size() && removed < 3; f += 2) {
    bool on_top = true;
    for (const std::int32_t v : fan.triangles[f])
      on_top = on_top && fan.z[static_cast<std::size_t>(v)] > 4.99;
    if (!on_top) continue;
    fan.triangles.erase(fan.triangles.begin() + static_cast<std::ptrdiff_t>(f));
    ++removed;
  }
  ASSERT_EQ(removed, 3U);
  const MeshValidation open = validate_mesh({fan, {}}, "fan", {.repair = RepairPolicy::kNone});
  EXPECT_EQ(open.report.holes.size(), 1U);
  const MeshValidation validation = validate(joined(fan, cube_mesh(3, Vec3(5, 0, 0))));
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_EQ(validation.report.repair.steps[0].count, 3);
}

TEST(HoleCaps, ReportsSlits) {
  // A triangle that reaches across a face's plane is missing: its two long sides are 1e-7 apart.
  TriangleMesh cube = cube_mesh();
  const auto [a, b, c] = cube.triangles[0];
  const Vec3 middle = 0.5 * (cube.vertex(a) + cube.vertex(b));
  const Vec3 inward = (cube.vertex(c) - middle).normalized();
  const std::int32_t m = cube.add_vertex(middle + 2e-6 * inward);
  cube.triangles[0] = {a, m, c};
  cube.triangles.push_back({m, b, c});
  const MeshValidation open = validate_mesh({cube, {}}, "cube", {.repair = RepairPolicy::kNone});
  ASSERT_EQ(open.report.holes.size(), 1U);
  EXPECT_TRUE(open.report.holes[0].slit);
  EXPECT_TRUE(contains(to_text(open.report), "; a slit"));
  EXPECT_TRUE(validate(cube).mesh);
}

TEST(HoleCaps, MeasuresAHoleOfManyEdges) {
  constexpr std::int32_t kEdges = 100'000;
  TriangleMesh cone;
  const std::int32_t apex = cone.add_vertex({0, 0, 1});
  for (std::int32_t i = 0; i < kEdges; ++i) {
    const double angle = 6.283185307179586 * i / kEdges;
    cone.add_vertex({std::cos(angle), std::sin(angle), 0});
  }
  for (std::int32_t i = 0; i < kEdges; ++i) cone.triangles.push_back({apex, 1 + i, 1 + (i + 1) % kEdges});
  const MeshValidation validation = validate(cone);
  EXPECT_FALSE(validation.mesh);
  ASSERT_EQ(validation.report.holes.size(), 1U);
  EXPECT_NEAR(validation.report.holes[0].area, 3.14159, 1e-3);
}

TEST(HoleCaps, ClosesLongCracksAlongTheirWidth) {
  // A sphere's faces north of its equator are turned by 1e-5: a crack of 2 * 500 edges, and 1e-5 m wide.
  TriangleMesh sphere;
  constexpr std::int32_t kEdges = 500;
  for (const double z : {1e-5, -1e-5}) {
    for (std::int32_t i = 0; i < kEdges; ++i) {
      const double angle = 6.283185307179586 * i / kEdges;
      sphere.add_vertex({std::cos(angle), std::sin(angle), z});
    }
  }
  const std::int32_t north = sphere.add_vertex({0, 0, 1});
  const std::int32_t south = sphere.add_vertex({0, 0, -1});
  for (std::int32_t i = 0; i < kEdges; ++i) {
    const std::int32_t next = (i + 1) % kEdges;
    sphere.triangles.push_back({north, i, next});
    sphere.triangles.push_back({south, kEdges + next, kEdges + i});
    if (i == 0) {  // a bridge makes one loop of the two
      sphere.triangles.push_back({i, kEdges + i, next});
      sphere.triangles.push_back({next, kEdges + i, kEdges + next});
    }
  }
  const MeshValidation validation = validate(sphere);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_EQ(validation.report.repair.steps[0].kind, RepairKind::kCapHoles);
  EXPECT_NEAR(validation.report.repair.steps[0].area, 2e-5 * 6.28, 1e-6);
}

}  // namespace
}  // namespace buoyancy
