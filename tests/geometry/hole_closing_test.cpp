#include "geometry/hole_closing.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/mesh_validation.h"
#include "geometry/mirroring.h"
#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

MeshValidation closed(const TriangleMesh& mesh, const ClosingOptions& closing,
                      RepairPolicy repair = RepairPolicy::kAutomatic) {
  return validate_mesh({mesh, {}}, "hull.stl", {OpenPolicy::kRefuse, false, repair, closing, true});
}

ClosingOptions closing_up_to(double share) {
  ClosingOptions closing;
  closing.holes = true;
  closing.max_change = share;
  return closing;
}

ClosingOptions all_rims(double max_change = kDefaultMaxChange) {
  ClosingOptions closing;
  closing.all_rims = true;
  closing.max_change = max_change;
  return closing;
}

// Leaves out the faces whose corners all satisfy a condition.
template <typename Condition>
TriangleMesh without_faces(TriangleMesh mesh, const Condition& condition) {
  std::erase_if(mesh.triangles, [&](const Triangle& face) {
    return condition(mesh.vertex(face[0])) && condition(mesh.vertex(face[1])) &&
           condition(mesh.vertex(face[2]));
  });
  return mesh;
}

TriangleMesh box_without_top(const Vec3& size) {
  const double top = size.z();
  return without_faces(box_mesh(Vec3::Zero(), size), [top](const Vec3& v) { return v.z() == top; });
}

// A quarter of a cylinder of radius 1 along x: y from 0, z up to 0, with its ends.
TriangleMesh quarter_cylinder(int segments) {
  TriangleMesh mesh;
  const double length = 4.0;
  for (int end = 0; end < 2; ++end) {
    mesh.add_vertex({end * length, 0.0, 0.0});
    for (int i = 0; i <= segments; ++i) {
      const double angle = 0.5 * std::numbers::pi * i / segments;
      mesh.add_vertex({end * length, i == 0 ? 0.0 : std::sin(angle), i == segments ? 0.0 : -std::cos(angle)});
    }
  }
  const int other = segments + 2;
  for (int i = 1; i <= segments; ++i) {
    mesh.triangles.push_back({0, i, i + 1});
    mesh.triangles.push_back({other, other + i + 1, other + i});
    mesh.triangles.push_back({i, other + i, other + i + 1});
    mesh.triangles.push_back({i, other + i + 1, i + 1});
  }
  return inside_out(mesh);
}

TEST(HoleClosing, GivesABoxItsLid) {
  const TriangleMesh box = box_without_top({2.0, 1.0, 0.5});
  const MeshValidation refused = closed(box, closing_up_to(0.5));
  EXPECT_FALSE(refused.mesh);
  ASSERT_EQ(refused.report.repair.skipped.size(), 1U);
  EXPECT_EQ(refused.report.repair.skipped[0].obstacle, RepairObstacle::kBulge);
  EXPECT_NEAR(refused.report.repair.skipped[0].share, 0.376 * std::pow(2.0, 1.5), 1e-12);

  for (const ClosingOptions& closing : {closing_up_to(1.1), all_rims()}) {
    const MeshValidation validation = closed(box, closing);
    ASSERT_TRUE(validation.mesh) << validation.refusal->message();
    EXPECT_NEAR(validation.report.volume, 1.0, 1e-15);
    EXPECT_EQ(validation.report.repair.cap_disagreement, 0.0);
    EXPECT_NEAR(validation.report.repair.cap_bulge, 0.376 * std::pow(2.0, 1.5), 1e-12);
    ASSERT_EQ(validation.report.repair.steps.size(), 1U);
    EXPECT_EQ(validation.report.repair.steps[0].kind, RepairKind::kCloseHoles);
    EXPECT_NEAR(validation.report.repair.steps[0].area, 2.0, 1e-15);
  }
}

TEST(HoleClosing, SaysWhatAnOpenMeshNeeds) {
  const MeshValidation refused = closed(box_without_top({2.0, 1.0, 0.5}), {});
  ASSERT_FALSE(refused.mesh);
  ASSERT_TRUE(refused.report.closing);
  EXPECT_NEAR(refused.report.closing->volume, 1.0, 1e-15);
  const std::string message = refused.refusal->message();
  EXPECT_TRUE(contains(message, "buoyancy-mesh repair hull.stl OUTPUT.ply --rims, or close_holes = 1.1"));
  EXPECT_TRUE(contains(message, "dry_boundary"));
}

TEST(HoleClosing, WorksWithoutTheAutomaticRepair) {
  const MeshValidation validation = closed(box_without_top({2.0, 1.0, 0.5}), all_rims(), RepairPolicy::kNone);
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_NEAR(validation.report.volume, 1.0, 1e-15);
}

TEST(HoleClosing, FollowsADeckWithSheer) {
  // A hull whose deck edge rises towards both ends: stations of equal beam, so that the deck is ruled.
  TriangleMesh hull;
  const int stations = 20;
  for (int i = 0; i <= stations; ++i) {
    const double x = -1.0 + 2.0 * i / stations;
    const double deck = 1.0 + 0.3 * x * x;
    for (const Vec3& v : {Vec3(x, -0.5, 0.0), Vec3(x, 0.5, 0.0), Vec3(x, 0.5, deck), Vec3(x, -0.5, deck)})
      hull.add_vertex(v);
  }
  double volume = 0.0;
  for (int i = 0; i < stations; ++i) {
    const std::int32_t a = 4 * i;
    for (const std::array<std::int32_t, 2> side : {std::array{0, 1}, {1, 2}, {3, 0}}) {
      hull.triangles.push_back({a + side[0], a + side[1], a + 4 + side[1]});
      hull.triangles.push_back({a + side[0], a + 4 + side[1], a + 4 + side[0]});
    }
    const double x0 = -1.0 + 2.0 * i / stations;
    const double x1 = -1.0 + 2.0 * (i + 1) / stations;
    volume += (x1 - x0) * (1.0 + 0.15 * (x0 * x0 + x1 * x1));
  }
  const std::int32_t last = 4 * stations;
  for (const Triangle& face :
       {Triangle{0, 2, 1}, {0, 3, 2}, {last, last + 1, last + 2}, {last, last + 2, last + 3}})
    hull.triangles.push_back(face);
  const MeshValidation validation = closed(inside_out(hull), all_rims(0.1));
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_NEAR(validation.report.volume, volume, 1e-14);
  EXPECT_GT(validation.report.repair.cap_disagreement, 1e-3);
  EXPECT_FALSE(closed(inside_out(hull), all_rims(1e-4)).mesh);
}

TEST(HoleClosing, ClosesTheRimsThatAreNamed) {
  // A tube: its ends are two rims. One of them alone leaves it open.
  const TriangleMesh tube =
      without_faces(box_mesh(Vec3::Zero(), {1.0, 1.0, 3.0}), [](const Vec3& v) { return v.z() == 0.0; });
  const TriangleMesh open = without_faces(tube, [](const Vec3& v) { return v.z() == 3.0; });
  ClosingOptions one;
  one.rims = {1};
  const MeshValidation refused = closed(open, one);
  EXPECT_FALSE(refused.mesh);
  ASSERT_EQ(refused.report.repair.skipped.size(), 1U);
  EXPECT_EQ(refused.report.repair.skipped[0].obstacle, RepairObstacle::kStillOpen);
  EXPECT_EQ(refused.report.holes.size(), 2U);
  one.rims = {1, 2};
  const MeshValidation both = closed(open, one);
  ASSERT_TRUE(both.mesh) << both.refusal->message();
  EXPECT_NEAR(both.report.volume, 3.0, 1e-14);
}

TEST(HoleClosing, RaisesTheRimThatFacesUp) {
  ClosingOptions closing;
  closing.freeboard = 0.25;
  for (const bool reversed : {false, true}) {
    const TriangleMesh box = box_without_top({2.0, 1.0, 0.5});
    const MeshValidation validation = closed(reversed ? inside_out(box) : box, closing);
    ASSERT_TRUE(validation.mesh) << validation.refusal->message();
    EXPECT_NEAR(validation.report.volume, 1.5, 1e-14);
    EXPECT_EQ(validation.report.repair.steps[0].kind, RepairKind::kRaiseRims);
    EXPECT_NEAR(validation.report.repair.steps[0].area, 6.0 * 0.25, 1e-14);
  }
  closing.up_B = -Vec3::UnitZ();
  const MeshValidation down = closed(box_without_top({2.0, 1.0, 0.5}), closing);
  EXPECT_FALSE(down.mesh);
  ASSERT_EQ(down.report.repair.skipped.size(), 1U);
  EXPECT_EQ(down.report.repair.skipped[0].obstacle, RepairObstacle::kNoRim);
}

TEST(HoleClosing, RefusesHalfABodyUntilItIsMirrored) {
  const int segments = 24;
  TriangleMesh half = quarter_cylinder(segments);
  for (const double share : {kDefaultMaxChange, 10.0}) {
    const MeshValidation refused = closed(half, all_rims(share));
    EXPECT_FALSE(refused.mesh);
    ASSERT_EQ(refused.report.repair.skipped.size(), 1U);
    EXPECT_EQ(refused.report.repair.skipped[0].obstacle, RepairObstacle::kDisagreement);
    EXPECT_TRUE(contains(refused.refusal->message(), "--mirror y --rims"));
  }
  const Expected<RepairStep> mirrored = add_mirror_image(half, Axis::kY, "half");
  ASSERT_TRUE(mirrored);
  const MeshValidation validation = closed(half, all_rims());
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  const double quarter = 0.5 * segments * std::sin(0.5 * std::numbers::pi / segments);
  EXPECT_NEAR(validation.report.volume, 4.0 * 2.0 * quarter, 1e-12);
  EXPECT_EQ(validation.report.repair.cap_disagreement, 0.0);
}

TEST(HoleClosing, LeavesClosedMeshesAlone) {
  ClosingOptions everything = all_rims();
  everything.holes = true;
  const TriangleMesh rock = rock_mesh();
  const MeshValidation validation = closed(rock, everything);
  ASSERT_TRUE(validation.mesh);
  EXPECT_TRUE(validation.report.repair.empty());
  EXPECT_EQ(validation.mesh->mesh.triangles, rock.triangles);
}

TEST(HoleClosing, TellsInnerWallsFromTheSurface) {
  // A box with a bent deck inside, without its lid: the deck is no part of the surface once the lid is there.
  TriangleMesh box = make_shape(BoxShape{{2.0, 2.0, 2.0}, {2, 2, 2}});
  box = without_faces(box, [](const Vec3& v) { return v.z() == 1.0; });
  TriangleMesh deck = make_shape(BoxShape{{2.0, 2.0, 2.0}, {2, 2, 2}});
  deck = without_faces(deck, [](const Vec3& v) { return v.z() < 1.0; });
  deck = without_faces(deck, [](const Vec3& v) { return std::abs(v.x()) == 1.0 && v.z() < 0.5; });
  for (double& z : deck.z) z = 0.0;
  std::erase_if(deck.triangles, [&deck](const Triangle& t) {
    const Vec3 normal = (deck.vertex(t[1]) - deck.vertex(t[0])).cross(deck.vertex(t[2]) - deck.vertex(t[0]));
    return !(normal.z() > 0.0);
  });
  for (std::size_t i = 0; i < deck.vertex_count(); ++i) {
    if (deck.x[i] == 0.0 && deck.y[i] == 0.0) deck.z[i] = 0.4;
  }
  const MeshValidation validation = closed(joined(box, deck), all_rims(0.1));
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_NEAR(validation.report.volume, 8.0, 1e-13);
}

TEST(HoleClosing, RefusesAnInnerSkinThatCrossesTheOuterOne) {
  // A shell of two skins with a hole in the outer one; the inner skin pierces the outer one at a corner.
  TriangleMesh outer = box_mesh(Vec3::Zero(), Vec3::Constant(2.0));
  outer = without_faces(outer, [](const Vec3& v) { return v.z() == 2.0; });
  TriangleMesh inner = inside_out(box_mesh(Vec3::Constant(0.1), Vec3::Constant(1.9)));
  const MeshValidation shell = closed(joined(outer, inner), all_rims());
  ASSERT_TRUE(shell.mesh) << shell.refusal->message();
  EXPECT_NEAR(shell.report.volume, 8.0 - 5.832, 1e-12);
  inner.add_vertex({2.2, 2.2, 2.2});
  const auto tip = static_cast<std::int32_t>(inner.vertex_count() - 1);
  for (Triangle& face : inner.triangles) {
    for (std::int32_t& v : face) {
      if (v == 7) v = tip;
    }
  }
  const MeshValidation crossing = closed(joined(outer, inner), all_rims());
  EXPECT_FALSE(crossing.mesh);
  EXPECT_FALSE(crossing.report.closing);
}

TEST(HoleClosing, AdvisesToMirrorAFlatHalf) {
  TriangleMesh half = box_mesh({0.0, 0.0, -1.0}, {3.0, 1.0, 0.0});
  half = without_faces(half, [](const Vec3& v) { return v.y() == 0.0; });
  const MeshValidation refused = validate_mesh({half, {}}, "my half.obj", {});
  ASSERT_FALSE(refused.mesh);
  const std::string message = refused.refusal->message();
  EXPECT_TRUE(contains(message, "buoyancy-mesh repair 'my half.obj' OUTPUT.ply --mirror y --rims"));
  EXPECT_TRUE(contains(message, "Close them: "));
}

TEST(HoleClosing, MirrorsOnlyHalves) {
  TriangleMesh whole = cube_mesh();
  const Expected<RepairStep> both_sides = add_mirror_image(whole, Axis::kX, "cube.stl");
  ASSERT_FALSE(both_sides);
  EXPECT_TRUE(contains(both_sides.error().message(), "x from -0.5 to 0.5"));
  TriangleMesh far = cube_mesh(1.0, {5.0, 0.0, 0.0});
  EXPECT_FALSE(add_mirror_image(far, Axis::kX, "cube.stl"));
  // A wall in the plane of symmetry bounds nothing in the whole body.
  TriangleMesh half = cube_mesh(1.0, {0.5, 0.0, 0.0});
  ASSERT_TRUE(add_mirror_image(half, Axis::kX, "cube.stl"));
  const MeshValidation validation = closed(half, {});
  ASSERT_TRUE(validation.mesh) << validation.refusal->message();
  EXPECT_TRUE(validation.report.repair.empty());
  EXPECT_NEAR(validation.report.volume, 2.0, 1e-15);
  EXPECT_EQ(validation.report.triangles, 20);
}

}  // namespace
}  // namespace buoyancy
