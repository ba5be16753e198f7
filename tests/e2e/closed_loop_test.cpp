// Floating bodies reach the rest positions and oscillate with the periods that hydrostatics predicts, with
// buoyancyd and buoyancy-client as two processes in lock-step over UDP multicast, each test in its own
// network namespace. A run over the network has just enough steps to show that the loop is closed; properties
// of many steps are tested with --embedded, which gives the same bytes (lockstep_test.cpp) and does not
// depend on the scheduler.
#include "tests/e2e/closed_loop.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "scene/scene.h"
#include "tests/support/json.h"
#include "tests/support/running_program.h"

namespace buoyancy {
namespace {

constexpr double kGravity = kStandardGravity;
constexpr double kDegrees = 180.0 / std::numbers::pi;

nlohmann::json simulate_with_service(const std::string& scene, Options options) {
  const RunningProgram service(service_command(scene, {"-l", kServiceUrl}));
  options.insert(options.end(), {"-l", kServiceUrl, "--retries", "10000"});
  return simulate(scene, options);
}

TEST(ClosedLoop, WarnsIfResponsesMayNotFitReceiveBuffer) {
  const TempDir directory;
  std::string scene;
  for (int id = 1; id <= 30; ++id) {
    scene += "[[body]]\nid = " + std::to_string(id) +
             "\nshape = { type = \"box\", size = [1, 1, 1] }\n[body.client]\ndensity = 500\n";
  }
  const std::string path = directory.write("boxes.toml", scene);
  const RunningProgram service(service_command(path, {"-l", kServiceUrl}));
  const nlohmann::json summary = simulate_with_warnings(
      path,
      {"-l", kServiceUrl + std::string("&recv_buf_size=3000"), "--retries", "10000", "--duration", "0.01"});
  const std::string warning = summary["warnings"].at(0);
  EXPECT_TRUE(warning.starts_with("response for 30 bodies: a message of 3156 bytes in 1 packet")) << warning;
}

TEST(ClosedLoop, SettlesAtExpectedDrafts) {
  const TempDir directory;
  const std::string path = directory.write("drafts.toml", R"(
[water]
level = 0.7
density = 1000
[[body]]
id = 1
name = "box"
shape = { type = "box", size = [1, 0.8, 0.5], segments = [2, 2, 2] }
[body.client]
density = 600
position = [0, 0, 1.3]
orientation = [0.98, 0.15, 0.1, 0]
linear_damping = 2000
angular_damping = 100
[[body]]
id = 2
name = "cylinder"
shape = { type = "cylinder", radius = 0.5, height = 0.5, segments = 32 }
[body.client]
density = 500
position = [3, 0, 0.4]
orientation = [0.98, 0, 0.1, 0]
linear_damping = 2000
angular_damping = 100
[[body]]
id = 3
name = "sphere, low centre of mass"
shape = { type = "sphere", radius = 0.5, segments = 24 }
[body.client]
density = 400
center_of_mass = [0, 0, -0.2]
position = [6, 0, 1]
orientation = [0.98, 0.1, 0.1, 0]
linear_damping = 1500
linear_damping_quadratic = 200
angular_damping = 100
angular_damping_quadratic = 20
)");
  const nlohmann::json summary = simulate_with_service(path, {"--duration", "15", "--step", "0.01"});

  EXPECT_NEAR(body(summary, 1)["draft"], 0.6 * 0.5, 1e-6 * std::sqrt(1 + 0.64 + 0.25));
  EXPECT_NEAR(body(summary, 1)["roll_deg"], 0.0, 1e-4);
  EXPECT_NEAR(body(summary, 1)["heave"], 0.25 - 0.3, 1e-6);
  EXPECT_NEAR(body(summary, 2)["draft"], 0.5 * 0.5, 1e-6 * std::sqrt(1 + 1 + 0.25));

  const Expected<Scene> scene = Scene::load(path);
  ASSERT_TRUE(scene) << scene.error().message();
  const Body& sphere = *scene->find(3);
  const double displaced = 400.0 / 1000.0 * sphere.prepared_mesh->mass_properties.volume;
  double low = -0.5;
  double high = 0.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    const Pose pose{{0, 0, scene->water().level + middle}, Eigen::Quaterniond::Identity()};
    const BuoyancyResult result = buoyancy(sphere.solver, pose, scene->water(), Vec3::Zero());
    (result.volume > displaced ? low : high) = middle;
  }
  EXPECT_NEAR(body(summary, 3)["draft"], 0.5 - low, 1e-6 * std::sqrt(3.0));
  EXPECT_NEAR(body(summary, 3)["pitch_deg"], 0.0, 1e-4);
}

// A bar of square section 1 x 1 m along x that starts with a roll of 0.3 rad.
std::string bar(int id, double relative_density) {
  return "[[body]]\nid = " + std::to_string(id) +
         "\nshape = { type = \"box\", size = [3, 1, 1] }\n[body.client]\ndensity = " +
         std::to_string(1000.0 * relative_density) + "\nposition = [0, " + std::to_string(5 * id) +
         ", 0.3]\norientation = [0.98877107793604, 0.14943813247360, 0, 0]\n"
         "linear_damping = 5000\nangular_damping = 250\n";
}

TEST(ClosedLoop, SquareBarsSettleAtTheirAngleOfLoll) {
  const TempDir directory;
  const std::string path = directory.write("bars.toml", "[water]\ndensity = 1000\n" + bar(19, 0.19) +
                                                            bar(22, 0.22) + bar(23, 0.23) + bar(24, 0.24));
  const nlohmann::json summary = simulate(path, {"--embedded", "--duration", "40", "--step", "0.01"});
  for (const int percent : {22, 23, 24}) {
    const double s = 0.01 * percent;
    const double angle = std::atan(std::sqrt(12.0 * s * (1.0 - s) - 2.0));
    EXPECT_NEAR(double{body(summary, percent)["roll_deg"]} / kDegrees, angle, 1e-4) << percent;
  }
  EXPECT_NEAR(double{body(summary, 19)["roll_deg"]} / kDegrees, 0.0, 1e-4);
}

constexpr const char* kHeavingBox = R"(
[water]
density = 1000
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.4] }
[body.client]
density = 500
position = [0, 0, 0.05]
)";

// Mean period from the first to the last upward crossing of the level.
double mean_period(const std::vector<double>& heights, double step) {
  double first = 0.0;
  double last = 0.0;
  int periods = -1;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    if (heights[i - 1] < 0.0 && heights[i] >= 0.0) {
      last = (static_cast<double>(i) - heights[i] / (heights[i] - heights[i - 1])) * step;
      if (++periods == 0) first = last;
    }
  }
  return (last - first) / periods;
}

// Checks period and energy of the heaving box over `steps` steps of 0.01 s. run(scene, options) simulates
// them.
template <typename Run>
void expect_period_and_energy(std::int64_t steps, int csv_every, const Run& run) {
  const TempDir directory;
  const std::string path = directory.write("box.toml", kHeavingBox);
  const std::string csv = directory.path("box.csv");
  const double step = 0.01;
  const nlohmann::json summary =
      run(path, {"--duration", std::to_string(static_cast<double>(steps) * step), "--step",
                 std::to_string(step), "--csv", csv, "--csv-every", std::to_string(csv_every)});
  EXPECT_EQ(summary["steps"], steps);

  // m = 200 kg, A_wp = 1 m^2. The period of velocity Verlet is shorter by (w h)^2 / 24 = 2e-4 of itself.
  const double w = std::sqrt(1000.0 * kGravity * 1.0 / 200.0);
  const double period = 2.0 * std::numbers::pi / w;
  EXPECT_NEAR(mean_period(csv_column(read_file(csv), "pz"), csv_every * step), period, 1e-3 * period);
  // The energy of velocity Verlet oscillates by (w h)^2 / 4 of itself.
  EXPECT_LT(double{body(summary, 1)["energy_range"]}, 2e-3);
  EXPECT_LT(std::abs(double{body(summary, 1)["energy_drift"]}), 2e-3);
}

TEST(ClosedLoop, UndampedBoxKeepsPeriodAndEnergy) {
  expect_period_and_energy(1000, 1, simulate_with_service);
}

TEST(ClosedLoop, UndampedBoxKeepsPeriodAndEnergyOver100000Steps) {
  expect_period_and_energy(100'000, 10, [](const std::string& scene, Options options) {
    options.emplace_back("--embedded");
    return simulate(scene, options);
  });
}

constexpr const char* kBargeWithTank = R"(
[water]
density = 1000
[[body]]
id = 1
shape = { type = "box", size = [4, 2, 1] }
[[body.tank]]
shape = { type = "box", size = [2, 1.6, 0.6] }
position = [0, 0, -0.1]
fill = 0.5
[body.client]
mass = 2400
center_of_mass = [0, 0, -0.2]
position = [0, 0, 0.1]
orientation = [0.9659258262890683, 0.25881904510252074, 0, 0]
)";

TEST(ClosedLoop, HalfFullTankKeepsEnergy) {
  const TempDir directory;
  const std::string path = directory.write("barge.toml", kBargeWithTank);
  const Options options = {"--duration", "10", "--step", "0.01"};
  const nlohmann::json over_udp = simulate_with_service(path, options);
  EXPECT_EQ(body(over_udp, 1)["mass"], 2400.0 + 960.0);
  EXPECT_LT(double{body(over_udp, 1)["energy_range"]}, 1e-3);
  // Some 500 periods of roll.
  const nlohmann::json longer = simulate(path, {"--embedded", "--duration", "1000", "--step", "0.01"});
  EXPECT_LT(double{body(longer, 1)["energy_range"]}, 1e-3);
  EXPECT_LT(std::abs(double{body(longer, 1)["energy_drift"]}), 1e-3);
}

TEST(ClosedLoop, AddedMassLengthensHeavePeriod) {
  // m = 200 kg and A33 = 20 m, at the step that the client uses by default.
  const TempDir directory;
  const std::string path = directory.write("box.toml", R"(
[water]
density = 1000
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.4] }
[body.added_mass]
matrix = [0, 0, 4000, 0, 0, 0]
immersion = "none"
[body.client]
density = 500
position = [0, 0, 0.002]
)");
  const std::string csv = directory.path("box.csv");
  const nlohmann::json summary = simulate_with_service(path, {"--duration", "10", "--csv", csv});
  EXPECT_EQ(summary["step"], 0.001);
  const double period = 2.0 * std::numbers::pi * std::sqrt((200.0 + 4000.0) / (1000.0 * kGravity));
  EXPECT_NEAR(mean_period(csv_column(read_file(csv), "pz"), 0.001), period, 1e-3 * period);
  EXPECT_LT(double{body(summary, 1)["energy_range"]}, 1e-3);
}

TEST(ClosedLoop, MunkMomentTurnsSlenderBody) {
  const TempDir directory;
  const std::string path = directory.write("slender.toml", R"(
[water]
density = 1000
[[body]]
id = 1
shape = { type = "box", size = [2, 0.3, 0.3] }
[body.added_mass]
matrix = [10, 170, 170, 0, 50, 50]
[body.client]
density = 1000
position = [0, 0, -50]
linear_velocity = [1, 0.2, 0]
)");
  const std::string csv = directory.path("slender.csv");
  simulate_with_service(path, {"--duration", "0.001", "--step", "0.0001", "--csv", csv});
  // N = -(A22 - A11) u v, on the inertia of the body and its added mass.
  const double moment = -(170.0 - 10.0) * 1.0 * 0.2;
  const double inertia = 1000.0 * 0.18 * (4.0 + 0.09) / 12.0 + 50.0;
  const std::string rows = read_file(csv);
  EXPECT_NEAR(csv_column(rows, "tz").at(0), moment, 1e-9 * std::abs(moment));
  EXPECT_NEAR(csv_column(rows, "wz").at(10), 0.001 * moment / inertia,
              1e-3 * std::abs(0.001 * moment / inertia));
}

}  // namespace
}  // namespace buoyancy
