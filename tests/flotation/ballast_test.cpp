#include "flotation/ballast.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "flotation/submerged.h"
#include "tests/flotation/bodies.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

using ::testing::Test;

constexpr double kDegree = std::numbers::pi / 180.0;
const Water kWater;

FloatingBody loaded(const FloatingBody& body, double mass, const Vec3& center_of_mass_B) {
  std::vector<PlacedMesh> meshes;
  for (const FloatingBody::SignedVolume& volume : body.volumes()) meshes.push_back(volume.placed);
  return FloatingBody::make(meshes, mass, center_of_mass_B, body.tanks()).value();
}

// The box ship has 9.84e6 kg; a tenth more takes it from a draught of 6 to 6.6 m.
class BallastOfBoxShip : public Test {
 protected:
  static constexpr double kMass = 0.984e6;
  Expected<Ballast> find(const BallastTask& task) const { return find_ballast(ship_.body, kWater, task); }
  BoxShip ship_;
};

TEST_F(BallastOfBoxShip, PutsFreeBallastOnTheKeelAndReportsTheHighestStablePoint) {
  const Ballast found = find({.mass = kMass}).value();
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_LT((found.places[0].position_B - Vec3(0, 0, -6)).norm(), 1e-12);
  EXPECT_NEAR(found.draft, 6.6, 1e-12);
  const double km = 0.5 * 6.6 + 400.0 / (12.0 * 6.6);
  EXPECT_NEAR(found.metacentric_heights[0], km - 10.0 * 8.0 / 11.0, 1e-9);
  EXPECT_NEAR(found.stability_limit_B.value().z(), 11.0 * km - 10.0 * 8.0 - 6.0, 1e-8);
  EXPECT_NEAR(std::abs(found.turning_axes_B[0].x()), 1.0, 1e-9);
  EXPECT_NEAR(found.center_of_mass_B.z(), 10.0 * 2.0 / 11.0 - 6.0 / 11.0, 1e-12);
  EXPECT_TRUE(found.is_in_box);
  EXPECT_TRUE(found.is_stable());
}

// B of a heeled wall-sided box moves by (I/V) tan to the low side and (I/V) tan^2 / 2 up.
TEST_F(BallastOfBoxShip, HeelsByTheWallSidedFormula) {
  const double heel = 5.0 * kDegree;
  const Ballast found = find({.target = {heel, 0.0}, .mass = kMass}).value();
  const double bm = 400.0 / (12.0 * 6.6);
  const double tangent = std::tan(heel);
  const Vec3 buoyancy(0.0, -bm * tangent, 3.3 - 6.0 + 0.5 * bm * tangent * tangent);
  const Vec3 up(0.0, std::sin(heel), std::cos(heel));
  EXPECT_LT((found.center_of_mass_B - buoyancy).cross(up).norm(), 1e-9);
}

TEST_F(BallastOfBoxShip, TakesTheMassFromTheDraft) {
  const Ballast found = find({.draft = 6.6, .places_B = {{0, 0, -5}}}).value();
  EXPECT_NEAR(found.mass, kMass, 1e-3);
  const auto wrong = find({.draft = 6.6, .mass = 1e6, .places_B = {{0, 0, -5}}});
  ASSERT_FALSE(wrong);
  EXPECT_TRUE(contains(wrong.error().actual, "takes 984000 kg, not 1e+06 kg")) << wrong.error().actual;
}

TEST_F(BallastOfBoxShip, SplitsBetweenTwoPlacesByTheLever) {
  const Ballast found = find({.mass = kMass, .places_B = {{-10, 0, -5}, {30, 0, -5}}}).value();
  ASSERT_EQ(found.places.size(), 2U);
  EXPECT_NEAR(found.places[0].mass, 0.75 * kMass, 1e-3);
  EXPECT_NEAR(found.places[1].mass, 0.25 * kMass, 1e-3);
}

TEST_F(BallastOfBoxShip, FindsThePositionOnALine) {
  const BallastTask task{.mass = kMass, .places_B = {{17, 0, -5}}, .along_B = Vec3::UnitX()};
  EXPECT_LT((find(task).value().places[0].position_B - Vec3(0, 0, -5)).norm(), 1e-9);
}

TEST_F(BallastOfBoxShip, SubmergesWithTheCentreOfMassUnderTheMiddle) {
  const Ballast found = find({.target = {0.1, 0.2}, .mass = 11e6}).value();
  EXPECT_EQ(found.outcome, FlotationOutcome::kSinks);
  EXPECT_GT(found.total_mass, found.displaced_mass);
  const Vec3 up = up_at({}, {0.1, 0.2});
  EXPECT_LT(found.center_of_mass_B.cross(up).norm(), 1e-12);
  EXPECT_NEAR(found.metacentric_heights[0], -found.center_of_mass_B.dot(up), 1e-12);
}

// The program equilibrium says sinks or neutrally buoyant of the same bodies.
TEST_F(BallastOfBoxShip, DecidesLikeAnEquilibriumWhetherTheBodyFloats) {
  const double neutral = kWater.density * ship_.mesh.volume - ship_.body.mass();
  for (const double excess : {-1e-6, -1e-10, 0.0, 1e-10, 1e-6}) {
    const double mass = neutral + excess * kWater.density * ship_.mesh.volume;
    const Ballast found = find({.mass = mass}).value();
    const FloatingBody result = loaded(ship_.body, found.mass_with_body, found.center_of_mass_B);
    EXPECT_EQ(found.outcome, find_equilibria(result, kWater).outcome) << excess;
  }
}

TEST_F(BallastOfBoxShip, RefusesWithWhatIsWrong) {
  struct Case {
    BallastTask task;
    const char* says;
  };
  const std::vector<Case> cases{
      {{}, "neither a mass nor a draft"},
      {{.mass = -1.0}, "-1 kg"},
      {{.mass = 1.0, .places_B = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}, "3 places"},
      {{.draft = 5.0}, "takes -1.64e+06 kg"},
      {{.draft = 12.5}, "12.5 m"},
      {{.mass = kMass, .places_B = {{1, 0, 0}}}, "-984000 kg m forward, 0 to port"},
      {{.mass = kMass, .places_B = {{0, 2, 0}}, .along_B = Vec3::UnitX()}, "-1.968e+06 to port"},
      {{.mass = kMass, .places_B = {{10, 0, 0}, {30, 0, 0}}}, "it would take -492000 kg at 30,0,0"},
      {{.mass = kMass, .places_B = {{NAN, 0, 0}}}, "nan"},
  };
  for (const Case& each : cases) {
    const auto found = find(each.task);
    ASSERT_FALSE(found) << each.says;
    EXPECT_TRUE(contains(found.error().actual, each.says)) << found.error().actual;
  }
}

TEST_F(BallastOfBoxShip, ReportsATargetThatIsNotStableAndAPlaceOutside) {
  const Ballast found = find({.mass = kMass, .places_B = {{0, 0, 30}}}).value();
  EXPECT_FALSE(found.is_stable());
  EXPECT_FALSE(found.is_in_box);
}

// A half full tank's liquid lies to the low side at the target, and its free surface takes from GM.
TEST_F(BallastOfBoxShip, CountsTheLiquidWhereItLiesAtTheTarget) {
  const HydrostaticMesh tank = mesh_of(BoxShape{{20, 10, 4}, {1, 1, 1}});
  const Tank half{.mesh = &tank, .liquid_volume = 400.0, .density = 1000.0};
  const PlacedMesh hull{.mesh = &ship_.mesh};
  const FloatingBody body =
      FloatingBody::make({&hull, 1}, ship_.body.mass(), Vec3(0, 0, 2), {&half, 1}).value();
  const HeelTrim target{3.0 * kDegree, 0.0};
  const Ballast found = find_ballast(body, kWater, {.target = target, .mass = kMass}).value();
  const FloatingBody result = loaded(body, found.mass_with_body, found.center_of_mass_B);
  const auto at = find_equilibrium_from(result, kWater, attitude_at({}, target, kWater.up_W));
  ASSERT_TRUE(at);
  EXPECT_NEAR(at->angles.heel, target.heel, 1e-9);
  const double gm = at->state.hydrostatics.metacentric_heights[0];
  EXPECT_NEAR(found.metacentric_heights[0], gm, 1e-9 * std::abs(gm));

  // Heavier than the water, it hangs at the same heel, and GM is what is left of BG.
  const Ballast hung = find_ballast(body, kWater, {.target = target, .mass = 11e6}).value();
  const FloatingBody heavy = loaded(body, hung.mass_with_body, hung.center_of_mass_B);
  const SubmergedRest rest = submerged_rest(heavy, kWater).value();
  EXPECT_NEAR(rest.angles.heel, target.heel, 1e-9);
  EXPECT_NEAR(rest.angles.trim, 0.0, 1e-9);
  const double buoyancy = hung.displaced_mass * kWater.gravity;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(rest.moments_per_degree[i], buoyancy * hung.metacentric_heights[i] * std::sin(kDegree),
                1e-9 * rest.moments_per_degree[1]);
  }
}

// Hulls of every kind at any attitude, whose ballast is free, at a place, on a line or split.
class RandomBallast : public Test {
 protected:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 vector(double length) { return length * Vec3{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)}; }

  HydrostaticMesh hull(int n) {
    const double size = std::pow(10.0, uniform(-1.0, 2.0));
    switch (n % 5) {
      case 0:
        return mesh_of(BoxShape{{size, size * uniform(0.2, 1), size * uniform(0.2, 1)}, {1, 1, 1}});
      case 1:
        return mesh_of(RockShape{size, 4, uniform(0.0, 0.6), static_cast<std::uint64_t>(n)});
      case 2:
        return mesh_of(WigleyShape{size, size * uniform(0.1, 0.5), 0.1 * size, 0.05 * size, 8, 4});
      case 3:
        return mesh_of(ConeShape{size * uniform(0.2, 1), size, 12, 1});
      default:
        return mesh_of(TorusKnotShape{size, 0.2 * size, 3, 2, 40, 6});
    }
  }

  std::mt19937 random_{7};
};

// [N m] over [N], the least torque of a body loaded with `mass` on the line, at a pose: torques are affine in
// the position. Independent of the search for the position.
double least_lever(const FloatingBody& body, double mass, const Vec3& from, const Vec3& to, double low,
                   double high, const Pose& pose) {
  const auto torque = [&](const Vec3& at) {
    const double total = body.mass() + mass;
    const Vec3 center = (body.mass() * body.center_of_mass_B() + mass * at) / total;
    const FloatingState state = floating_state(loaded(body, total, center), pose, kWater).value();
    return Vec3(state.torque_W / (total * kWater.gravity));
  };
  const Vec3 start = torque(from);
  const Vec3 change = torque(to) - start;
  const double square = change.squaredNorm();
  const double best = square > 0.0 ? std::clamp(-start.dot(change) / square, low, high) : low;
  return (start + best * change).norm();
}

TEST_F(RandomBallast, GivesTheTargetOrARightRefusal) {
  int solved = 0;
  int refused = 0;
  int compared = 0;
  int hung = 0;
  for (int n = 0; n < 1000; ++n) {
    SCOPED_TRACE(n);
    const HydrostaticMesh mesh = hull(n);
    const double length = mesh.diagonal;
    const Vec3 center_of_mass_B = mesh.center_B + vector(0.1 * length);
    const FloatingBody body = body_of(mesh, uniform(0.05, 0.5), center_of_mass_B);
    BallastTask task{.target = {uniform(-1.0, 1.0), uniform(-1.0, 1.0)},
                     .mass = uniform(0.02, 0.75) * kWater.density * mesh.volume};
    const Vec3 up = up_at(task.axes, task.target);
    const Ballast free = find_ballast(body, kWater, task).value();
    const Vec3 right = free.places[0].position_B - uniform(0.0, 0.5) * length * up;
    const Vec3 off = vector(0.2 * length);
    const bool is_wrong = uniform(0.0, 1.0) < 0.4;
    Vec3 from = right;
    Vec3 to = right + up;
    double low = 0.0;
    double high = 0.0;
    switch (n / 5 % 4) {
      case 0:
        break;
      case 1:
        if (is_wrong) from += off;
        to = from + off;
        task.places_B = {from};
        break;
      case 2:
        task.along_B = Vec3::UnitX();
        from = right + (is_wrong ? off : Vec3(Vec3::Zero())) + length * Vec3::UnitX();
        to = from + *task.along_B;
        low = -1e6 * length;
        high = 1e6 * length;
        task.places_B = {from};
        break;
      default: {
        const double share = is_wrong ? uniform(1.1, 2.0) : uniform(0.0, 1.0);
        from = right - share * off;
        to = from + off;
        high = 1.0;
        task.places_B = {from, to};
      }
    }
    const auto found = find_ballast(body, kWater, task);
    const Eigen::Quaterniond attitude = attitude_at(task.axes, task.target, kWater.up_W);
    const double lowest = lowest_along(body, up) + up.dot(body.center_B());
    const double draft = free.is_submerged() ? 3.0 * length : free.draft;
    const Pose pose{.p_WB = (kWater.level - draft - lowest) * kWater.up_W, .q_WB = attitude};
    if (!found) {
      ++refused;
      EXPECT_TRUE(is_wrong && n / 5 % 4 != 0) << found.error().actual;
      EXPECT_GT(least_lever(body, *task.mass, from, to, low, high, pose), 1e-9 * length);
      continue;
    }
    ++solved;
    const FloatingBody result = loaded(body, found->mass_with_body, found->center_of_mass_B);
    const FloatingState state = floating_state(result, pose, kWater).value();
    EXPECT_LE(state.torque_W.norm(), 1e-7 * result.total_mass() * kWater.gravity * length);
    if (!found->is_submerged()) {
      EXPECT_LE(state.force_W.norm(), 1e-9 * result.total_mass() * kWater.gravity);
    }
    if (found->metacentric_heights[0] < 1e-3 * length) continue;
    if (found->is_submerged()) {
      ++hung;
      const SubmergedRest rest = submerged_rest(result, kWater, task.axes).value();
      EXPECT_LE((up_at(task.axes, rest.angles) - up).norm(), 1e-6);
      continue;
    }
    ++compared;
    const Vec3 tilt = 1e-4 * vector(1.0);
    const Eigen::Quaterniond start(Eigen::Quaterniond(1.0, tilt.x(), tilt.y(), tilt.z()).normalized() *
                                   attitude);
    const auto at = find_equilibrium_from(result, kWater, start, task.axes);
    ASSERT_TRUE(at);
    EXPECT_LE((up_at(task.axes, at->angles) - up).norm(), 1e-6);
    EXPECT_NEAR(at->draft, found->draft, 1e-6 * length);
  }
  EXPECT_GT(solved, 500);
  EXPECT_GT(refused, 200);
  EXPECT_GT(compared, 300);
  EXPECT_GT(hung, 30);
}

}  // namespace
}  // namespace buoyancy
