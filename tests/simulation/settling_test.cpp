// Damped bodies come to rest at the drafts and at the angle of loll that closed forms predict. The tests fill
// rows of the stress catalogue (docs/stability.md, "In time").
#include <cmath>
#include <cstdio>
#include <numbers>

#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "simulation/run_summary.h"
#include "tests/simulation/in_process_run.h"
#include "tests/stress/stress_case.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// Summary of the only body after `time` [s].
BodySummary settled(const Scene& scene, double time, double step) {
  const Simulation simulation = simulation_after(scene, {.step = step}, std::llround(time / step));
  return summarize(simulation.bodies().front(), scene.water());
}

// Roll at rest [rad] of a bar of square section 1 x 1 m along x that starts with a roll of 0.3 rad.
double roll_of_bar(double relative_density) {
  std::array<char, 32> density{};
  std::snprintf(density.data(), density.size(), "%.17g", 1000.0 * relative_density);
  const Scene scene = scene_of(std::string("[water]\ndensity = 1000\n[[body]]\nid = 1\n"
                                           "shape = { type = \"box\", size = [3, 1, 1] }\n"
                                           "[body.client]\nposition = [0, 0, 0.3]\n"
                                           "orientation = [0.98877107793604, 0.14943813247360, 0, 0]\n"
                                           "linear_damping = 5000\nangular_damping = 250\ndensity = ") +
                               density.data() + "\n");
  return settled(scene, 60.0, 0.01).roll;
}

TEST(LongSquareBar, SettlesAtAngleOfLollUpToQuarterDensity) {
  StressCase stress("long square bar of relative density 0.215 to 0.25", "tan^2 theta = 12 s (1 - s) - 2",
                    "1e-4 rad");
  for (const double s : {0.215, 0.22, 0.235, 0.245, 0.249, 0.2499, 0.25}) {
    stress.check(std::abs(roll_of_bar(s) - std::atan(std::sqrt(12.0 * s * (1.0 - s) - 2.0))), 1e-4,
                 "s = " + std::to_string(s));
  }
  EXPECT_NEAR(roll_of_bar(0.25) * kDegrees, 26.565, 0.001);
}

TEST(LongSquareBar, FloatsFlatBelowCriticalDensity) {
  const double critical = (3.0 - std::sqrt(3.0)) / 6.0;
  StressCase stress("long square bar below relative density (3 - sqrt 3) / 6", "flat", "1e-4 rad");
  for (const double s : {0.1, 0.15, 0.2, critical - 0.005}) {
    stress.check(std::abs(roll_of_bar(s)), 1e-4, "s = " + std::to_string(s));
  }
}

struct FloatingBody {
  std::string shape;
  double length;                   // [m], diagonal L of its bounding box
  double density;                  // [kg/m^3]
  double center;                   // [m], height of the centre of mass in B, low enough to float upright
  double angular_damping = 800.0;  // [N m/(rad/s)]
  bool upside_down = false;
};

Scene scene_with(const FloatingBody& floating) {
  std::array<char, 512> client{};
  std::snprintf(client.data(), client.size(),
                "[body.client]\ndensity = %.17g\ncenter_of_mass = [0, 0, %.17g]\nposition = [0, 0, 0.1]\n"
                "orientation = %s\nlinear_damping = 3000\nangular_damping = %.17g\n",
                floating.density, floating.center,
                floating.upside_down ? "[0.05, 0.998749, 0, 0]" : "[0.998749, 0.04, 0.03, 0]",
                floating.angular_damping);
  return scene_of("[water]\ndensity = 1000\n[[body]]\nid = 1\nshape = " + floating.shape + "\n" +
                  client.data());
}

double draft_of(const FloatingBody& floating) {
  const BodySummary body = settled(scene_with(floating), 40.0, 0.005);
  EXPECT_NEAR(std::abs(std::sin(body.roll)), 0.0, 1e-6) << floating.shape;
  EXPECT_NEAR(body.pitch, 0.0, 1e-6) << floating.shape;
  return body.draft;
}

constexpr const char* kDraftTolerance = "1e-6 L";

TEST(EquilibriumDraft, IsProportionalToDensityForBoxAndCylinder) {
  StressCase stress("draft of a box, a cylinder", "height times relative density", kDraftTolerance);
  for (const double density : {150.0, 500.0, 850.0}) {
    const FloatingBody box{R"({ type = "box", size = [1.2, 1, 0.5], segments = [3, 2, 2] })", 1.64, density,
                           -0.1};
    stress.check(std::abs(draft_of(box) - 0.5 * density / 1000.0), 1e-6 * box.length, "box");
    const FloatingBody cylinder{R"({ type = "cylinder", radius = 0.5, height = 0.6, segments = 48 })", 1.54,
                                density, -0.15};
    stress.check(std::abs(draft_of(cylinder) - 0.6 * density / 1000.0), 1e-6 * cylinder.length, "cylinder");
  }
}

TEST(EquilibriumDraft, FollowsCubeRootOfDensityForCone) {
  StressCase stress("draft of a cone, either way up", "cube roots of the relative density", kDraftTolerance);
  // The part cut off a cone, or off the pyramid of its mesh, is similar to the whole.
  for (const double s : {0.2, 0.5, 0.8}) {
    FloatingBody cone{R"({ type = "cone", radius = 0.5, height = 0.8, segments = 32 })", 1.63, 1000.0 * s,
                      0.1, 100.0};
    stress.check(std::abs(draft_of(cone) - 0.8 * (1.0 - std::cbrt(1.0 - s))), 1e-6 * cone.length, "upright");
    cone.upside_down = true;
    cone.center = 0.7;
    stress.check(std::abs(draft_of(cone) - 0.8 * std::cbrt(s)), 1e-6 * cone.length, "upside down");
  }
}

TEST(EquilibriumDraft, DisplacesMassOfWigleyHull) {
  StressCase stress("draft of a Wigley hull", "bisection on the same mesh", kDraftTolerance);
  for (const double density : {300.0, 450.0, 600.0}) {
    const FloatingBody hull{R"({ type = "wigley", length = 4, beam = 1, draft = 0.5, freeboard = 0.3 })", 4.2,
                            density, -0.35};
    const Scene scene = scene_with(hull);
    const Body& body = scene.bodies().front();
    const double displaced = density / 1000.0 * body.prepared_mesh->mass_properties.volume;
    double low = -0.3;
    double high = 0.5;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      const Pose pose{{0, 0, middle}, Eigen::Quaterniond::Identity()};
      (buoyancy(body.solver, pose, scene.water(), Vec3::Zero()).volume > displaced ? low : high) = middle;
    }
    stress.check(std::abs(draft_of(hull) - (0.5 - low)), 1e-6 * hull.length, "Wigley hull");
  }
}

}  // namespace
}  // namespace buoyancy
