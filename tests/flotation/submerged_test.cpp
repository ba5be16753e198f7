#include "flotation/submerged.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/angles.h"
#include "hydrostatics/buoyancy.h"
#include "tests/flotation/bodies.h"
#include "tests/hydrostatics/random_poses.h"

namespace buoyancy {
namespace {

using ::testing::Test;

constexpr double kPi = std::numbers::pi;
const Water kWater;
const double kSineOfDegree = std::sin(kRadiansPerDegree);

double buoyancy_of(const FloatingBody& body) {
  return kWater.density * kWater.gravity * body.volume();
}

TEST(SubmergedRest, PutsTheCentreOfMassUnderThatOfBuoyancy) {
  const HydrostaticMesh box = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const HydrostaticMesh sphere = mesh_of(SphereShape{0.5, 20});
  const ShipAxes down = axes_with_up(-Vec3::UnitZ());
  const double s = std::sin(0.2);
  const double c = std::cos(0.2);
  struct Case {
    const char* name;
    const HydrostaticMesh* mesh;
    double relative_density;
    Vec3 center_of_mass_B;
    ShipAxes axes;
    Vec3 up_W;
    HeelTrim angles;
    VerticalMotion motion;
  };
  using enum VerticalMotion;
  const std::vector<Case> cases{
      // The bow goes down towards the mass, and so does the port side: k is (-3, -4, 12) / 13.
      {"box",
       &box,
       1.2,
       {0.03, 0.04, -0.12},
       {},
       Vec3::UnitZ(),
       {std::atan2(-4.0, 12.0), std::asin(-3.0 / 13.0)},
       kSinks},
      // 0.8 of the displacement in the centre and 0.3 at half of the radius below it; then 0.7 and 0.3.
      {"heavy sphere", &sphere, 1.1, {0, 0, -0.25 * 0.3 / 1.1}, {}, Vec3::UnitZ(), {}, kSinks},
      {"neutral sphere", &sphere, 1.0, {0, 0, -0.25 * 0.3}, {}, Vec3::UnitZ(), {}, kHovers},
      {"light box on its head", &box, 0.9, {0, 0, 0.1}, {}, Vec3::UnitZ(), {kPi, 0.0}, kRises},
      // Axes forward, starboard and down: the mass lies to starboard, then forward.
      {"NED upright", &box, 1.2, {0, 0, 0.1}, down, -Vec3::UnitZ(), {}, kSinks},
      {"NED heeled", &box, 1.2, {0, 0.1 * s, 0.1 * c}, down, -Vec3::UnitZ(), {0.2, 0.0}, kSinks},
      {"NED trimmed", &box, 1.2, {0.1 * s, 0, 0.1 * c}, down, -Vec3::UnitZ(), {0.0, -0.2}, kSinks},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.name);
    Water water;
    water.up_W = each.up_W;
    const FloatingBody body = body_of(*each.mesh, each.relative_density, each.center_of_mass_B);
    const SubmergedRest rest = submerged_rest(body, water, each.axes).value();
    // Heels of 180 degrees to either side are the same.
    EXPECT_NEAR(std::remainder(rest.angles.heel - each.angles.heel, 2.0 * kPi), 0.0, 1e-12);
    EXPECT_NEAR(rest.angles.trim, each.angles.trim, 1e-12);
    const Vec3 lever_W = rest.q_WB * each.center_of_mass_B;
    const double bg = each.center_of_mass_B.norm();
    EXPECT_LT((lever_W + bg * water.up_W).norm(), 1e-12);
    EXPECT_EQ(rest.family, AttitudeFamily::kNone);
    EXPECT_NEAR(rest.bg, bg, 1e-12);
    for (const double moment : rest.moments_per_degree) {
      EXPECT_NEAR(moment, buoyancy_of(body) * bg * kSineOfDegree, 1e-9 * buoyancy_of(body) * bg);
    }
    EXPECT_NEAR(rest.net_weight, (each.relative_density - 1.0) * buoyancy_of(body),
                1e-12 * buoyancy_of(body));
    EXPECT_EQ(rest.motion, each.motion);
  }
}

// A box of 4 x 2 x 2 m with a mass below its middle, and a half full tank of 1 x 0.8 x 0.6 m in its middle.
TEST(SubmergedRest, LosesTheRightingMomentThatFreeSurfacesTake) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{4, 2, 2}});
  const HydrostaticMesh tank = mesh_of(BoxShape{{1.0, 0.8, 0.6}});
  const PlacedMesh placed{.mesh = &hull};
  const Tank half{.mesh = &tank, .liquid_volume = 0.24, .density = 900.0};
  for (const double relative_density : {0.8, 1.0, 1.3}) {
    SCOPED_TRACE(relative_density);
    const double total = relative_density * kWater.density * 16.0;
    const double liquid = 900.0 * 0.24;
    const FloatingBody body =
        FloatingBody::make({&placed, 1}, total - liquid, Vec3(0, 0, -0.2), {&half, 1}).value();
    const SubmergedRest rest = submerged_rest(body, kWater).value();
    const double bg = (0.2 * (total - liquid) + 0.15 * liquid) / total;
    EXPECT_NEAR(rest.bg, bg, 1e-12);
    // Over rho g V sin 1 degree: BG less rho_l i / m; of a neutral body, rho g V BG - rho_l g i.
    const double trim = bg - 900.0 * (0.8 / 12.0) / total;
    const double heel = bg - 900.0 * (0.512 / 12.0) / total;
    EXPECT_NEAR(rest.moments_per_degree[0], buoyancy_of(body) * trim * kSineOfDegree, 1e-7);
    EXPECT_NEAR(rest.moments_per_degree[1], buoyancy_of(body) * heel * kSineOfDegree, 1e-7);
    // The torque about the centre of all mass of a body that is heeled a little, with the liquid moved.
    const double angle = 1e-4;
    const Vec3 up_B = up_at({}, {angle, 0.0});
    const Vec3 liquid_B = tank_liquid(half, up_B).centroid;
    const Vec3 center_B = ((total - liquid) * Vec3(0, 0, -0.2) + liquid * liquid_B) / total;
    const double torque = buoyancy_of(body) * center_B.cross(up_B).norm();
    EXPECT_NEAR(torque / std::sin(angle) * kSineOfDegree, rest.moments_per_degree[1], 1e-6 * torque / angle);
  }
}

// All weight but that of the liquid acts at the centre of buoyancy: the tank stands on its smallest side.
TEST(SubmergedRest, TakesTheLowestOfSeveralAttitudes) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{4, 2, 2}});
  const PlacedMesh placed{.mesh = &hull};
  const auto rest_with = [&](const HydrostaticMesh& tank, const ShipAxes& axes) {
    const Tank half{.mesh = &tank, .liquid_volume = 0.5 * tank.volume, .density = 1000.0};
    const FloatingBody body = FloatingBody::make({&placed, 1}, 17000.0, Vec3::Zero(), {&half, 1}).value();
    return submerged_rest(body, kWater, axes).value();
  };
  const SubmergedRest tall = rest_with(mesh_of(BoxShape{{1.0, 1.1, 0.95}}), {});
  EXPECT_NEAR(std::abs(tall.angles.heel), 0.5 * kPi, 1e-9);
  EXPECT_NEAR(tall.bg, 0.25 * 1.1 * 522.5 / 17522.5, 1e-12);
  for (const Vec3& up_B : {Vec3(Vec3::UnitZ()), Vec3(-Vec3::UnitX())}) {
    const SubmergedRest cube = rest_with(mesh_of(BoxShape{}), axes_with_up(up_B));
    EXPECT_NEAR(cube.angles.heel, 0.0, 1e-9) << "six attitudes are as low";
    EXPECT_NEAR(cube.angles.trim, 0.0, 1e-9);
  }
}

TEST(SubmergedRest, SaysThatAnyAttitudeIsOneOfRest) {
  for (const double relative_density : {0.7, 1.0, 1.5}) {
    const HydrostaticMesh mesh = mesh_of(RockShape{.radius = 3.0, .frequency = 6, .roughness = 0.4});
    const FloatingBody body = body_of(mesh, relative_density, mesh.center_B + mesh.centroid);
    const SubmergedRest rest = submerged_rest(body, kWater).value();
    EXPECT_EQ(rest.family, AttitudeFamily::kSphere);
    EXPECT_TRUE(rest.q_WB.isApprox(Eigen::Quaterniond::Identity(), 1e-15));
    EXPECT_EQ(rest.angles.heel, 0.0);
    EXPECT_EQ(rest.bg, 0.0);
    EXPECT_EQ(rest.moments_per_degree, (std::array<double, 2>{}));
    EXPECT_NEAR(rest.net_weight, (relative_density - 1.0) * buoyancy_of(body), 1e-9 * buoyancy_of(body));
  }
}

TEST(SubmergedRest, HasNoneWhereNothingIsKnown) {
  const HydrostaticMesh hull = mesh_of(BoxShape{{4, 2, 1}, {2, 2, 2}});
  const PlacedMesh placed{.mesh = &hull};
  const std::vector<PlacedMesh> flooded{placed, {.mesh = &hull, .signed_permeability = -1.0}};
  EXPECT_FALSE(submerged_rest(FloatingBody::make(flooded, 100.0, Vec3(0, 0, -1)).value(), kWater));
  const double huge = 0.5 * std::numeric_limits<double>::max();
  EXPECT_FALSE(submerged_rest(FloatingBody::make({&placed, 1}, huge, Vec3(0, 0, -1)).value(), kWater));

  HydrostaticMesh open = hull;
  open.boundary_vertices = {0};
  ASSERT_TRUE(open.is_open());
  const PlacedMesh of_open{.mesh = &open};
  EXPECT_FALSE(submerged_rest(FloatingBody::make({&of_open, 1}, 100.0, Vec3(0, 0, -1)).value(), kWater));
}

// Hulls of every kind with a flooded compartment and two tanks, in worlds of any up axis, with any ship axes.
class RandomSubmerged : public Test {
 protected:
  Vec3 vector(double length) { return random_.vector(0.0, length); }

  HydrostaticMesh hull(std::uint64_t n) {
    const double size = random_.power_of_ten(-1.0, 2.0);
    switch (n % 4) {
      case 0:
        return mesh_of(BoxShape{{size, size * random_.uniform(0.2, 1), size * random_.uniform(0.2, 1)}});
      case 1:
        return mesh_of(RockShape{size, 4, random_.uniform(0.0, 0.6), n});
      case 2:
        return mesh_of(WigleyShape{size, size * random_.uniform(0.1, 0.5), 0.1 * size, 0.05 * size, 8, 4});
      default:
        return mesh_of(ConeShape{size * random_.uniform(0.2, 1), size, 12, 1});
    }
  }
  // A box about the hull's centre of volume, its size that of the hull times `share`.
  HydrostaticMesh room(const HydrostaticMesh& hull, double share) {
    const Vec3 size = share * (hull.box_max - hull.box_min);
    TriangleMesh mesh = make_shape(BoxShape{{size.x(), size.y(), size.z()}});
    return make_hydrostatic_mesh(
        {moved_and_scaled(std::move(mesh), hull.center_B + hull.centroid + vector(0.2 * hull.diagonal)), {}});
  }

  RandomPoses random_{17};
};

TEST_F(RandomSubmerged, LeavesNoTorqueAndComesBack) {
  int several = 0;
  for (std::uint64_t n = 0; n < 300; ++n) {
    SCOPED_TRACE(n);
    const HydrostaticMesh mesh = hull(n);
    const HydrostaticMesh compartment = room(mesh, 0.2);
    const std::vector<HydrostaticMesh> rooms{room(mesh, 0.3), room(mesh, 0.15)};
    std::vector<PlacedMesh> meshes{{.mesh = &mesh}};
    if (n % 3 == 1) meshes.push_back({.mesh = &compartment, .signed_permeability = -0.9});
    std::vector<Tank> tanks;
    if (n % 2 == 1) {
      for (const HydrostaticMesh& each : rooms) {
        tanks.push_back({.mesh = &each,
                         .liquid_volume = random_.uniform(0.0, 1.0) * each.volume,
                         .density = random_.uniform(500.0, 1500.0)});
      }
    }
    const Vec3 center_of_mass_B = mesh.center_B + mesh.centroid + vector(0.2 * mesh.diagonal);
    const double mass = random_.uniform(0.5, 1.5) * kWater.density * mesh.volume;
    const FloatingBody body = FloatingBody::make(meshes, mass, center_of_mass_B, tanks).value();
    Water water;
    water.up_W = random_.direction();
    const Vec3 forward_B = random_.direction();
    const ShipAxes axes = make_ship_axes(forward_B, forward_B.unitOrthogonal()).value();
    const SubmergedRest rest = submerged_rest(body, water, axes).value();
    const Vec3 up_B = rest.q_WB.conjugate() * water.up_W;
    EXPECT_LT((up_at(axes, rest.angles) - up_B).norm(), 1e-12);

    // [N m], W, about the centre of all mass with the liquids where they lie: weight has none there.
    const auto torque_at = [&](const Eigen::Quaterniond& q_WB) {
      Vec3 moment = mass * center_of_mass_B;
      double total = mass;
      for (const Tank& tank : tanks) {
        const TankLiquid liquid = tank_liquid(tank, q_WB.conjugate() * water.up_W);
        moment += tank.liquid_mass() * (tank.mesh->center_B + liquid.centroid);
        total += tank.liquid_mass();
      }
      const Pose pose{.p_WB = (water.level - 5.0 * mesh.diagonal) * water.up_W, .q_WB = q_WB};
      Vec3 torque = Vec3::Zero();
      for (const PlacedMesh& each : meshes) {
        const Solver solver(*each.mesh, Method::kExactSurface);
        torque += each.signed_permeability * buoyancy(solver, pose, water, moment / total).torque_W;
      }
      return torque;
    };
    const double scale = buoyancy_of(body) * mesh.diagonal;
    EXPECT_LE(torque_at(rest.q_WB).norm(), 1e-9 * scale);
    // A little turned about any horizontal axis, the torque turns the body back.
    const double angle = 1e-3;
    const double slack = (tanks.empty() ? 1e-5 : 0.05) * rest.moments_per_degree[1] + 1e-9 * scale;
    for (int i = 0; i < 4; ++i) {
      const Vec3 axis_W = water.up_W.cross(random_.direction()).normalized();
      const Vec3 torque = torque_at(Eigen::AngleAxisd(angle, axis_W) * rest.q_WB);
      const double per_degree = -torque.dot(axis_W) / std::sin(angle) * kSineOfDegree;
      EXPECT_GT(per_degree, rest.moments_per_degree[0] - slack);
      EXPECT_LT(per_degree, rest.moments_per_degree[1] + slack);
    }
    if (rest.moments_per_degree[1] > 1.01 * rest.moments_per_degree[0]) ++several;
  }
  EXPECT_GT(several, 30);
}

}  // namespace
}  // namespace buoyancy
