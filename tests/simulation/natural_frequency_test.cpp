#include "simulation/natural_frequency.h"

#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/geometry/mesh_files.h"
#include "tests/simulation/in_process_run.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr double kDensity = 1000.0;  // [kg/m^3], of the water

struct PreparedBody {
  Scene scene;
  RigidBody rigid;
  RigidBodyState state;

  const Body& body() const { return scene.bodies().front(); }
  HighestNaturalFrequency highest() const {
    return highest_natural_frequency(body(), rigid, state, scene.water());
  }
  double bound() const { return natural_frequency_bound(body(), rigid, scene.water()); }
};

// Prepares a scene of one body. keys: lines of [[body]]; client: lines of [body.client].
PreparedBody prepared(const std::string& keys, const std::string& client) {
  Scene scene = scene_of("[water]\ndensity = 1000\nlevel = 3\n[[body]]\nid = 1\n" + keys +
                         "\n[body.client]\n" + client);
  const Simulation simulation = simulation_of(scene, {});
  const SimulatedBody& body = simulation.bodies().front();
  const RigidBody rigid = body.rigid;
  const RigidBodyState state = body.state;
  return {std::move(scene), rigid, state};
}

// A plate of 1 x 1 x 0.2 m at its equilibrium draft, raised by `above_rest` [m].
std::string floating_plate(double relative_density, double above_rest = 0.0) {
  return "density = " + std::to_string(kDensity * relative_density) + "\nposition = [0, 0, " +
         std::to_string(3.0 + (0.5 - relative_density) * 0.2 + above_rest) + "]\n";
}
const std::string kPlate = R"(shape = { type = "box", size = [1, 1, 0.2] })";

TEST(HighestNaturalFrequency, EqualsHeaveFrequencyOfFlatPlateAtRest) {
  for (const double s : {0.05, 0.3, 0.8}) {
    const HighestNaturalFrequency highest = prepared(kPlate, floating_plate(s)).highest();
    EXPECT_NEAR(highest.frequency, std::sqrt(kStandardGravity / (0.2 * s)), 1e-9 * highest.frequency) << s;
    EXPECT_NEAR(highest.draft, 0.2 * s, 1e-9) << s;
  }
}

TEST(HighestNaturalFrequency, EqualsRollFrequencyOfBodyWithLowInertia) {
  // Roll: w^2 = rho g (J + V (z_b - z_c)) / I with J = 1/12 and z_b - z_c = -0.1 (1 - s).
  const double s = 0.5;
  const double inertia = 0.2;
  const PreparedBody plate = prepared(kPlate, floating_plate(s) + "inertia = [0.2, 0.2, 0.2]\n");
  const double stiffness = kDensity * kStandardGravity * (1.0 / 12.0 - 0.2 * s * 0.1 * (1.0 - s));
  EXPECT_NEAR(plate.highest().frequency, std::sqrt(stiffness / inertia), 1e-9 * plate.highest().frequency);
}

TEST(HighestNaturalFrequency, CountsAddedMassAtTheImmersionOfThePose) {
  const double s = 0.3;
  const std::string added = "\n[body.added_mass]\nmatrix = [0, 0, 2000, 0, 0, 0]\nimmersion = ";
  const double mass = kDensity * 0.2 * s;
  const auto heave_at = [&](double added_mass) {
    return std::sqrt(kDensity * kStandardGravity / (mass + added_mass));
  };
  // Without added mass of its rotations, roll and pitch are then faster than heave.
  const double roll = std::sqrt(kDensity * kStandardGravity * (1.0 / 12.0 - 0.2 * s * 0.1 * (1.0 - s)) /
                                (mass * (1.0 + 0.04) / 12.0));
  const HighestNaturalFrequency none = prepared(kPlate + added + "\"none\"", floating_plate(s)).highest();
  EXPECT_NEAR(none.frequency, roll, 1e-9 * roll);
  EXPECT_LT(heave_at(2000.0), roll);
  EXPECT_LT(roll, prepared(kPlate, floating_plate(s)).highest().frequency);

  // With rotations that are heavier still, heave is the highest, at the draft of the body at rest.
  const std::string all = "\n[body.added_mass]\nmatrix = [0, 0, 2000, 9e3, 9e3, 9e3]\n";
  const HighestNaturalFrequency volume = prepared(kPlate + all, floating_plate(s)).highest();
  EXPECT_NEAR(volume.frequency, heave_at(0.3 * 2000.0), 1e-9 * volume.frequency);
  EXPECT_NEAR(volume.draft, 0.2 * s, 1e-9);
}

TEST(HighestNaturalFrequency, CoversWaterBelowDryBody) {
  const PreparedBody plate = prepared(kPlate, floating_plate(0.1, 1.0));
  EXPECT_GE(plate.highest().frequency, std::sqrt(kStandardGravity / 0.02) * (1.0 - 1e-9));
}

TEST(HighestNaturalFrequency, CoversFlatSideOfBodyOnEdge) {
  // A light plate on its edge has a small waterplane; flat on the water it is stiff.
  const double heave = std::sqrt(kStandardGravity / 0.02);
  const PreparedBody on_edge = prepared(kPlate,
                                        "density = 100\nposition = [0, 0, 3.4]\norientation = "
                                        "[0.7071067811865476, 0.7071067811865475, 0, 0]\n");
  EXPECT_GE(on_edge.highest().frequency, heave * (1.0 - 1e-9));
}

TEST(HighestNaturalFrequency, IgnoresPosesBeyondAvailableEnergy) {
  // A cone with its apex down, at rest at half its height: the wider sections further up stay dry.
  const PreparedBody cone = prepared(
      R"(shape = { type = "cone", radius = 1, height = 1, segments = 64 })",
      "density = 125\ncenter_of_mass = [0, 0, 0.9]\nposition = [0, 0, 3.5]\norientation = [0, 1, 0, 0]\n");
  // Heave: w^2 = rho g A / m = 3 g / draft for a cone at its equilibrium draft.
  EXPECT_NEAR(cone.highest().frequency, std::sqrt(3.0 * kStandardGravity / 0.5), 0.01);
  EXPECT_NEAR(cone.highest().draft, 0.5, 1e-9);
}

TEST(HighestNaturalFrequency, DoesNotDependOnMethod) {
  const HighestNaturalFrequency expected = prepared(kPlate, floating_plate(0.3)).highest();
  for (const char* method : {R"(method = "exact")", R"(method = "fast_surface")"}) {
    std::string keys = kPlate + "\n";
    keys += method;
    const HighestNaturalFrequency actual = prepared(keys, floating_plate(0.3)).highest();
    EXPECT_EQ(actual.frequency, expected.frequency) << method;
    EXPECT_EQ(actual.draft, expected.draft) << method;
  }
}

TEST(HighestNaturalFrequency, IsZeroWithoutGravity) {
  PreparedBody plate = prepared(kPlate, floating_plate(0.3));
  Water weightless = plate.scene.water();
  weightless.gravity = 0.0;
  EXPECT_EQ(highest_natural_frequency(plate.body(), plate.rigid, plate.state, weightless).frequency, 0.0);
  EXPECT_EQ(natural_frequency_bound(plate.body(), plate.rigid, weightless), 0.0);
}

TEST(HighestNaturalFrequency, StaysBelowBound) {
  for (const char* shape : {R"(shape = { type = "box", size = [2, 1, 0.1] })",
                            R"(shape = { type = "sphere" })", R"(shape = { type = "torus_knot" })",
                            R"(shape = { type = "wigley" })", R"(shape = { type = "rock", frequency = 5 })",
                            R"(shape = { type = "box", size = [9, 0.01, 0.01] })"}) {
    for (const char* density : {"density = 5\n", "density = 300\n", "density = 950\n"}) {
      const PreparedBody body = prepared(
          shape, std::string("position = [0, 0, 4]\norientation = [0.9, 0.3, 0.2, 0.1]\n") + density);
      EXPECT_GT(body.highest().frequency, 0.0) << shape << density;
      EXPECT_GT(body.bound(), body.highest().frequency) << shape << density;
    }
  }
}

TEST(HighestNaturalFrequency, SupportsOpenHullWithDryBoundary) {
  // A tray of 1 x 1 x 0.2 m, without its lid.
  const TempDir directory;
  const std::filesystem::path path = directory.path() / "tray.off";
  std::ofstream(path)
      << "OFF\n8 10 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 0.2\n1 0 0.2\n1 1 0.2\n0 1 0.2\n"
         "3 0 2 1\n3 0 3 2\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
  const std::string source = "mesh = \"" + path.string() + "\"\nopen = \"dry_boundary\"";
  const std::string mass = "mass = 100\ncenter_of_mass = [0.5, 0.5, 0.05]\ninertia = [100, 100, 100]\n";
  const double heave = std::sqrt(kDensity * kStandardGravity / 100.0);
  // At its equilibrium draft, and one metre above it.
  for (const char* position : {"position = [0, 0, 2.9]\n", "position = [0, 0, 3.9]\n"}) {
    const PreparedBody tray = prepared(source, mass + position);
    EXPECT_NEAR(tray.highest().frequency, heave, 1e-3 * heave) << position;
    EXPECT_GT(tray.bound(), tray.highest().frequency);
  }
  // The boundary edge is wet at the start: there is no energy to compare with.
  EXPECT_EQ(prepared(source, mass + "position = [0, 0, 2]\n").highest().frequency, 0.0);
}

}  // namespace
}  // namespace buoyancy
