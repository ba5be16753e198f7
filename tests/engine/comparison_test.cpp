// The tolerances of two replays' results (docs/replay.md): each field off by nearly its tolerance, and by
// more.
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/loads_comparison.h"
#include "engine/result_comparison.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kE = 128.0 * std::numeric_limits<double>::epsilon();  // of docs/replay.md

TEST(WrenchComparison, DividesDifferencesByTheSumOfBothBounds) {
  BodyWrench now{.force = {30, 40, 0},
                 .torque = {1, 2, 3},
                 .submerged_volume = 7.0,
                 .center_of_buoyancy = {4, 5, 6},
                 .force_error_bound = 0.5,
                 .torque_error_bound = 2.0};
  BodyWrench baseline = now;
  baseline.force_error_bound = 1.5;
  baseline.torque_error_bound = 1.0;
  EXPECT_EQ(compare_wrenches(now, baseline).in_bounds(), 0.0);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    BodyWrench other = baseline;
    other.force[axis] += 1.0;
    other.torque[axis] -= 6.0;
    other.center_of_buoyancy[axis] += 0.03;
    other.submerged_volume = 6.0;
    const WrenchDifferences found = compare_wrenches(now, other);
    EXPECT_DOUBLE_EQ(found.force, 1.0);
    EXPECT_DOUBLE_EQ(found.torque, 6.0);
    EXPECT_DOUBLE_EQ(found.volume, 1.0);
    EXPECT_NEAR(found.center, 0.03, 1e-15);
    EXPECT_DOUBLE_EQ(found.force_in_bounds, 1.0 / 2.0);
    EXPECT_DOUBLE_EQ(found.torque_in_bounds, 6.0 / 3.0);
    const auto force = [](const BodyWrench& w) { return std::hypot(w.force[0], w.force[1], w.force[2]); };
    const double of_center = 2.0 * 2.0 / force(now) + 2.0 * 1.0 / force(other);
    EXPECT_NEAR(found.center_in_bounds, 0.03 / of_center, 1e-12);
    EXPECT_EQ(found.in_bounds(), 2.0);
  }
}

TEST(WrenchComparison, HasNoBoundOfItsOwn) {
  BodyWrench exact;
  EXPECT_EQ(compare_wrenches(exact, exact).in_bounds(), 0.0) << "0 / 0";
  BodyWrench off;
  off.torque[2] = 1e-300;
  EXPECT_EQ(compare_wrenches(exact, off).torque_in_bounds, kInfinity);
  for (const double bad : {kNaN, kInfinity}) {
    BodyWrench wrong;
    wrong.force[1] = bad;
    EXPECT_EQ(compare_wrenches(wrong, wrong).force_in_bounds, kInfinity) << "NaN and infinity equal nothing";
    BodyWrench unbounded;
    unbounded.force_error_bound = bad;
    EXPECT_EQ(compare_wrenches(unbounded, exact).force_in_bounds, kInfinity);
  }
  // A force within its own bound says nothing of the centre.
  BodyWrench weak{.force = {0, 0, 1}, .center_of_buoyancy = {5, 5, 5}, .force_error_bound = 1.0};
  EXPECT_LT(compare_wrenches(weak, {.force = {0, 0, 1}, .force_error_bound = 1.0}).center_in_bounds, 1e-290);
}

TEST(WrenchComparison, KeepsTheLargestOfEachNumber) {
  WrenchDifferences all{1, 2, 3, 4, 0.1, 0.2, 0.3};
  all.update({4, 3, 2, 1, 0.4, 0.1, 0.2});
  all.update({0, 0, 9, 0, 0, 0.7, 0});
  const WrenchDifferences expected{4, 3, 9, 4, 0.4, 0.7, 0.3};
  for (const auto field : {&WrenchDifferences::force, &WrenchDifferences::torque, &WrenchDifferences::volume,
                           &WrenchDifferences::center, &WrenchDifferences::force_in_bounds,
                           &WrenchDifferences::torque_in_bounds, &WrenchDifferences::center_in_bounds}) {
    EXPECT_EQ(all.*field, expected.*field);
  }
  EXPECT_EQ(all.in_bounds(), 0.7);
  EXPECT_EQ((WrenchDifferences{.center_in_bounds = 3.0}).in_bounds(), 3.0);
}

// A box of 4 x 2 x 1.5 m with a distant reference point, in water of 900 kg/m^3 times 5 m/s^2.
Scene box_in(const std::string& water = "", const std::string& tables = "") {
  return scene_of(
      "[world]\ngravity = 5\n[water]\ndensity = 900\n" + water +
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [4, 2, 1.5] }\nreference_point = [0, 3, 0]\n" +
      tables);
}
constexpr double kWeight = 900.0 * 5.0;                              // [N/m^3]
constexpr double kArea = 2.0 * (4.0 * 2.0 + 4.0 * 1.5 + 2.0 * 1.5);  // [m^2]
const double kDiagonal = std::sqrt(16.0 + 4.0 + 2.25);               // [m]

struct ToleranceRow {
  std::string field;
  double tolerance;
  std::function<double&(BodyHydrostatics&)> number;
};

TEST(HydrostaticsComparison, HasTheTolerancesOfItsTable) {
  const Scene scene = box_in();
  const Body& body = scene.bodies()[0];
  const double volume = 2.0 * body.solver.mesh().volume_tolerance() + kE * kArea * kDiagonal;
  const double second_moment = 4.0 * kE * kArea * kDiagonal * kDiagonal;
  // Numbers so small that e times them does not count, except those that the tolerances are divided by.
  BodyHydrostatics baseline;
  baseline.submerged_volume = 1e-3;
  baseline.waterplane_area = 2e-3;
  baseline.waterplane_second_moments = {1e-6, 4e-6};
  baseline.waterplane_axes = {{{1, 0, 0}, {0, 1, 0}}};
  baseline.metacentric_radii = {2e-3, 3e-3};
  const double arm = body.solver.mesh().max_lever_arm(body.reference_B) + kDiagonal;
  const double point = kE * body.solver.mesh().max_lever_arm(Vec3::Zero());
  const double center = 2.0 * volume * kDiagonal / 1e-3 + point;
  const auto radius = [&](std::size_t i) {
    return (second_moment + baseline.metacentric_radii[i] * volume) / 1e-3;
  };
  std::vector<ToleranceRow> rows{
      {"submerged_volume", volume, [](auto& b) -> double& { return b.submerged_volume; }},
      {"wetted_area", kE * kArea, [](auto& b) -> double& { return b.wetted_area; }},
      {"waterplane_area", kE * kArea, [](auto& b) -> double& { return b.waterplane_area; }}};
  for (std::size_t k = 0; k < 3; ++k) {
    rows.push_back(
        {"center_of_buoyancy", center, [k](auto& b) -> double& { return b.center_of_buoyancy[k]; }});
    rows.push_back({"waterplane_centroid", 2.0 * kE * kArea * kDiagonal / 2e-3 + point,
                    [k](auto& b) -> double& { return b.waterplane_centroid[k]; }});
  }
  for (std::size_t i = 0; i < 2; ++i) {
    rows.push_back({"waterplane_second_moments", second_moment,
                    [i](auto& b) -> double& { return b.waterplane_second_moments[i]; }});
    rows.push_back({"waterplane_axes", 2.0 * second_moment / 3e-6 + kE,
                    [i](auto& b) -> double& { return b.waterplane_axes[i][2]; }});
    rows.push_back(
        {"metacentric_radii", radius(i), [i](auto& b) -> double& { return b.metacentric_radii[i]; }});
    for (std::size_t k = 0; k < 3; ++k) {
      rows.push_back(
          {"metacenters", center + radius(i), [i, k](auto& b) -> double& { return b.metacenters[i][k]; }});
    }
    rows.push_back({"metacentric_heights", center + radius(i),
                    [i](auto& b) -> double& { return b.metacentric_heights[i]; }});
  }
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      const double of_force = kWeight * kE * kArea;
      const double tolerance = row < 3 && column < 3 ? of_force
                               : row < 3 || column < 3
                                   ? 2.0 * arm * of_force
                                   : kWeight * (4.0 * kE * kArea * arm + 2.0 * volume) * arm;
      rows.push_back(
          {"stiffness", tolerance, [row, column](auto& b) -> double& { return b.stiffness[row][column]; }});
    }
  }
  for (const auto& [field, tolerance, number] : rows) {
    for (const double share : {0.5, 0.99, 1.01, 3.0}) {
      BodyHydrostatics now = baseline;
      number(now) += share * tolerance;
      MessageDifferences differences;
      compare_hydrostatics(now, baseline, body, scene.water(), differences);
      EXPECT_NEAR(differences.in_bounds, share, 5e-3 * share) << field;
      EXPECT_EQ(differences.worst_field, field);
      EXPECT_EQ(differences.compared, 1);
    }
    // Undefined on one side only.
    BodyHydrostatics undefined = baseline;
    number(undefined) = kNaN;
    MessageDifferences differences;
    compare_hydrostatics(undefined, baseline, body, scene.water(), differences);
    EXPECT_EQ(differences.in_bounds, kInfinity) << field;
  }
}

TEST(HydrostaticsComparison, ComparesWhatIsDefined) {
  const Scene scene = box_in();
  const auto compared = [&](const BodyHydrostatics& a, const BodyHydrostatics& b) {
    MessageDifferences differences;
    compare_hydrostatics(a, b, scene.bodies()[0], scene.water(), differences);
    return differences.in_bounds;
  };
  BodyHydrostatics dry;
  dry.center_of_buoyancy = dry.waterplane_centroid = {kNaN, kNaN, kNaN};
  dry.metacentric_radii = dry.metacentric_heights = {kNaN, kNaN};
  dry.metacenters = dry.waterplane_axes = {dry.center_of_buoyancy, dry.center_of_buoyancy};
  EXPECT_EQ(compared(dry, dry), 0.0);
  // Axes have no sign, and none at all where the second moments are equal.
  BodyHydrostatics afloat;
  afloat.submerged_volume = afloat.waterplane_area = 1.0;
  afloat.waterplane_second_moments = {1.0, 2.0};
  afloat.waterplane_axes = {{{0.6, 0.8, 0}, {-0.8, 0.6, 0}}};
  BodyHydrostatics turned = afloat;
  turned.waterplane_axes[1] = {0.8, -0.6, 0};
  EXPECT_EQ(compared(turned, afloat), 0.0);
  turned.waterplane_axes[0] = {0.0, 1.0, 0};
  EXPECT_GT(compared(turned, afloat), 1e9);
  turned.waterplane_second_moments = afloat.waterplane_second_moments = {1.0, 1.0};
  EXPECT_EQ(compared(turned, afloat), 0.0);
}

// The numbers of the loads of a body whose drag and added mass are scaled in some way.
struct LoadsCase {
  std::string water, drag, added_mass;  // keys of [water], and the scalings
  double immersion, of_drag, of_mass;   // tolerances relative to 1 and to the matrices
};

TEST(LoadsComparison, HasTheTolerancesOfItsTable) {
  const WrenchLimits limits{.force = 2e-6, .torque = 5e-6, .submerged_volume = 3.0};
  constexpr double kVolume = 12.0;
  const double i = limits.force / (kWeight * kVolume);
  const std::string waves = "waves = { type = \"regular\", height = 0.2, period = 3 }\n";
  for (const LoadsCase& test :
       {LoadsCase{"", "volume", "none", i, i * kVolume / 3.0, 0.0},
        {"", "none", "volume", i, 0.0, i * kVolume / 3.0},
        {"", "wetted_area", "none", i, kE * kVolume / 3.0, 0.0},
        {"", "none", "wetted_area", i, 0.0, kE * kVolume / 3.0},
        {"wave_pressure = \"hydrostatic\"\n" + waves, "volume", "none", i, i * kVolume / 3.0, 0.0},
        {waves, "none", "volume", 1.0, 0.0, kVolume / 3.0},
        {"waves = \"received\"\n", "volume", "none", 1.0, kVolume / 3.0, 0.0}}) {
    SCOPED_TRACE(test.water + test.drag + ", " + test.added_mass);
    const Scene scene = box_in(test.water + "current = { velocity = [0.3, 0, -0.4] }\n",
                               "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\nimmersion = \"" + test.drag +
                                   "\"\n[body.added_mass]\nmatrix = [1, 1, 1, 1, 1, 1]\nimmersion = \"" +
                                   test.added_mass + "\"\n");
    const Body& body = scene.bodies()[0];
    double speed = 0.5;  // [m/s], of the current and all waves
    if (scene.receives_sea()) speed += 10.0;
    if (scene.sea() != nullptr) speed += 0.1 * 2.0 * M_PI / 3.0;
    const double arm = body.solver.mesh().max_lever_arm(body.reference_B) + kDiagonal;
    BodyLoads baseline;
    struct Row {
      std::string field;
      double tolerance;
      std::function<double&(BodyLoads&)> number;
    };
    std::vector<Row> rows{{"immersion", test.immersion + kE, [](auto& b) -> double& { return b.immersion; }}};
    if (test.immersion == 1.0) rows[0].tolerance = 1.0;
    for (std::size_t k = 0; k < 3; ++k) {
      rows.push_back(
          {"buoyancy_force", limits.force, [k](auto& b) -> double& { return b.buoyancy_force[k]; }});
      rows.push_back(
          {"buoyancy_torque", limits.torque, [k](auto& b) -> double& { return b.buoyancy_torque[k]; }});
      rows.push_back({"drag_force", limits.force, [k](auto& b) -> double& { return b.drag_force[k]; }});
      rows.push_back({"drag_torque", limits.torque, [k](auto& b) -> double& { return b.drag_torque[k]; }});
      rows.push_back(
          {"added_mass_force", limits.force, [k](auto& b) -> double& { return b.added_mass_force[k]; }});
      rows.push_back(
          {"added_mass_torque", limits.torque, [k](auto& b) -> double& { return b.added_mass_torque[k]; }});
      rows.push_back({"water_velocity", kE * speed, [k](auto& b) -> double& { return b.water_velocity[k]; }});
    }
    // The largest entry of the block of forces and velocities is 1000; those of a torque or a rotation also
    // take what the lever brings in.
    baseline.added_mass[1][2] = baseline.damping[1][2] = 1000.0;
    const double relative_mass = test.of_mass + kE;
    const double relative_damping = std::max(test.of_drag, test.of_mass) + kE;
    for (std::size_t row = 0; row < 6; ++row) {
      for (std::size_t column = 0; column < 6; ++column) {
        if (row == 1 && column == 2) continue;
        const double size =
            1000.0 * (row < 3 ? 1.0 : arm) * (column < 3 ? 1.0 : arm) * (row < 3 || column < 3 ? 1.0 : 2.0);
        rows.push_back({"added_mass", relative_mass * size,
                        [row, column](auto& b) -> double& { return b.added_mass[row][column]; }});
        rows.push_back({"damping", relative_damping * size,
                        [row, column](auto& b) -> double& { return b.damping[row][column]; }});
      }
    }
    for (const auto& [field, tolerance, number] : rows) {
      for (const double share : {0.5, 0.99, 1.01, 3.0}) {
        BodyLoads now = baseline;
        number(now) += share * tolerance;
        MessageDifferences differences;
        compare_loads(now, baseline, limits, body, scene, differences);
        // The larger of both sides counts where the difference itself is large.
        if (tolerance < 1e-3) {
          EXPECT_NEAR(differences.in_bounds, share, 5e-3 * share) << field << tolerance;
        }
        EXPECT_EQ(differences.worst_field, field);
      }
    }
  }
}

TEST(LoadsComparison, LimitsAreThoseOfBothWrenches) {
  const WrenchLimits limits =
      limits_of({.submerged_volume = 3.0, .force_error_bound = 1.0, .torque_error_bound = 10.0},
                {.submerged_volume = 2.0, .force_error_bound = 0.5, .torque_error_bound = 20.0});
  EXPECT_EQ(limits.force, 1.5);
  EXPECT_EQ(limits.torque, 30.0);
  EXPECT_EQ(limits.submerged_volume, 3.0);
}

}  // namespace
}  // namespace buoyancy
