// Tests of the oracle itself: closed forms hold in it without any error, and balls enclose its results.
#include "tests/truth/exact_oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/ball.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

using RationalVec = Vec3T<Rational>;

const Water kWater{.up_W = Vec3(0.36, 0.48, 0.8), .level = 0.25, .density = 1.0, .gravity = 1.0};
const Water kUpright{.up_W = Vec3::UnitZ(), .level = 0.0, .density = 1.0, .gravity = 1.0};

Pose turned(double w, double x, double y, double z, const Vec3& p_WB = Vec3::Zero()) {
  return {.p_WB = p_WB, .q_WB = {w, x, y, z}};
}

ExactDisplacement<Rational> exactly(const TriangleMesh& mesh, const Pose& pose, const Water& water) {
  return exact_displacement<Rational>(mesh, pose, water);
}

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  for (const Vec3& vertex : {Vec3(0, 0, 0), Vec3(3, 0, 0.5), Vec3(0.25, 2, 0), Vec3(0.5, 0.75, 4)})
    mesh.add_vertex(vertex);
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

TEST(ExactOracle, RotatesVectorsExactly) {
  const Pose pose = turned(1, 2, -3, 0.5);
  const RationalVec v = Vec3(0.1, -7, 1e-3).cast<Rational>();
  const RationalVec turned_v = exactly_in_world<Rational>(pose, v);
  EXPECT_EQ(turned_v.dot(turned_v), v.dot(v));
  const RationalVec back = exact_plane<Rational>(pose, Water{.up_W = Vec3(0.1, -7, 1e-3), .level = 0.0}).up_B;
  EXPECT_EQ(exactly_in_world<Rational>(pose, back), v);
}

TEST(ExactOracle, MatchesClosedFormForUprightBoxExactly) {
  const TriangleMesh box = make_shape(BoxShape{.size = {1, 2, 4}, .segments = {2, 3, 1}});
  const auto found = exactly(box, turned(1, 0, 0, 0, {5, -6, 1.25}), kUpright);
  const Rational draft(0.75);
  EXPECT_EQ(found.volume, Rational(2) * draft);
  const Rational center = Rational(-2) + draft / Rational(2);
  EXPECT_EQ(found.moment, RationalVec(0, 0, found.volume * center));
  const RationalVec torque = found.torque(Vec3(0.5, -1, 0));
  EXPECT_EQ(torque, RationalVec(found.volume, found.volume / Rational(2), 0));
}

TEST(ExactOracle, MatchesClosedFormForTetrahedronTip) {
  const TriangleMesh mesh = tetrahedron();
  const Pose pose = turned(3, -1, 2, 0.7, {0.1, 0.2, 0.3});
  const ExactPlane<Rational> dry = exact_plane<Rational>(pose, kUpright);
  std::array<Rational, 4> height;
  for (std::size_t i = 0; i < 4; ++i)
    height[i] = dry.up_B.dot(mesh.vertex(static_cast<std::int32_t>(i)).cast<Rational>()) - dry.h;
  const auto lowest =
      static_cast<std::size_t>(std::min_element(height.begin(), height.end()) - height.begin());
  std::array<Rational, 4> sorted = height;
  std::sort(sorted.begin(), sorted.end());
  Water water = kUpright;  // its level lies between the lowest vertex and the next
  water.level = Rational((sorted[0] + sorted[1]) / Rational(2)).convert_to<double>();
  Rational share(1);
  RationalVec centre = RationalVec::Constant(Rational(0));
  const RationalVec tip = mesh.vertex(static_cast<std::int32_t>(lowest)).cast<Rational>();
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == lowest) continue;
    const Rational part = (height[lowest] - Rational(water.level)) / (height[lowest] - height[i]);
    share *= part;
    const RationalVec edge = mesh.vertex(static_cast<std::int32_t>(i)).cast<Rational>() - tip;
    centre += edge * Rational(part / Rational(4));
  }
  Water above = kUpright;
  above.level = 100.0;
  const Rational whole = exactly(mesh, pose, above).volume;
  const Vec3 a = mesh.vertex(1);
  EXPECT_EQ(whole, Rational(a.dot(mesh.vertex(2).cross(mesh.vertex(3)))) / Rational(6))
      << "the coordinates are short binary numbers";
  const auto found = exactly(mesh, pose, water);
  EXPECT_EQ(found.volume, whole * share);
  EXPECT_EQ(found.moment, RationalVec((tip + centre) * found.volume));
}

TEST(Ball, ContainsRationalResult) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    RandomPoses random(5);
    for (int i = 0; i < 6; ++i) {
      const Pose pose = i % 2 == 0 ? random.crossing(bounding_box(named.mesh), kWater)
                                   : random.adversarial(named.mesh, kWater);
      const auto exact = exactly(named.mesh, pose, kWater);
      const auto balls = exact_displacement<Ball>(named.mesh, pose, kWater);
      EXPECT_TRUE(balls.volume.contains(exact.volume)) << named.name;
      const RationalVec torque_W = exactly_in_world<Rational>(pose, exact.torque(Vec3(1, 2, 3)));
      const Vec3T<Ball> torque_W_balls = exactly_in_world<Ball>(pose, balls.torque(Vec3(1, 2, 3)));
      for (int j = 0; j < 3; ++j) {
        EXPECT_TRUE(balls.moment[j].contains(exact.moment[j])) << named.name;
        EXPECT_TRUE(torque_W_balls[j].contains(torque_W[j])) << named.name;
      }
      EXPECT_LT(balls.volume.rad, 0.05L * mesh.volume_tolerance())
          << named.name << ": too wide for a comparison";
    }
  }
}

TEST(Ball, ExcludesNeighbouringNumbers) {
  const Ball third = Ball(1) / Ball(3);
  EXPECT_TRUE(third.contains(Rational(1) / Rational(3)));
  EXPECT_FALSE(third.contains(Rational(1) / Rational(3) + Rational(0x1p-60)));
  EXPECT_FALSE(Ball(2.0).contains(Rational(std::nextafter(2.0, 3.0))));
}

}  // namespace
}  // namespace buoyancy
