// Runs client/examples with buoyancyd over UDP: in third-party engines the crate of scenes/box.toml, and that
// of scenes/crate.toml with drag and added mass, comes to rest level and at its equilibrium height and heaves
// with the period of a closed form; bodies in MuJoCo sink, heave, drift and ride waves as closed forms and
// buoyancy-client say; and the Python client receives the forces of closed forms.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "scene/scene.h"
#include "tests/e2e/closed_loop.h"
#include "tests/support/build_paths.h"
#include "tests/support/contains.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

const std::string kSources = source_dir().string();
constexpr double kDensity = 1025.0;   // [kg/m^3], of the water
constexpr double kGravity = 9.80665;  // [m/s^2]
// Time step [s]: the 20 s of the crate's motion take 4,000 round trips.
constexpr const char* kStep = "0.005";

ChildCommand box_service() {
  return service_command(kSources + "/scenes/box.toml", {});
}

ChildCommand crate_service() {
  return service_command(kSources + "/scenes/crate.toml", {});
}

// The engines and Python are optional for a build. scripts/test installs them, so that it skips none of these
// tests; a build without one of them names it and runs the other tests.
constexpr const char* kNoBullet =
    "CMake did not find double-precision Bullet; install libbullet-dev and configure again";
constexpr const char* kNoOde = "CMake did not find ODE; install libode-dev and configure again";
constexpr const char* kNoMujoco = "CMake did not find MuJoCo; install libmujoco-dev and configure again";
constexpr const char* kNoPython = "CMake did not find Python; install python3 and configure again";

// [s], of small heave motions of a floating body that displaces no other water than by its draft.
double heave_period(double mass, double added_mass, double waterplane_area) {
  return 2.0 * std::numbers::pi * std::sqrt((mass + added_mass) / (kDensity * kGravity * waterplane_area));
}

// Of the line "heave period ... s", or of the end of a line about a body.
double printed_heave_period(const FinishedProcess& run) {
  const std::size_t at = run.standard_output.find("heave period ");
  double period = NAN;
  if (at != std::string::npos) {
    std::sscanf(run.standard_output.c_str() + at, "heave period %lf s", &period);
  }
  return period;
}

// That the service sees no contradiction between velocities and motion.
void expect_consistent_motion(const RunningProgram& service) {
  EXPECT_FALSE(contains(service.standard_error(), "contradict"));
}

void expect_crate_settles_level(const ChildCommand& service_of_scene, Options program) {
  const RunningProgram service(service_of_scene);
  program.insert(program.end(), {"", kStep});
  const FinishedProcess run = run_to_end(command_of(program), kRunTimeout);
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  double height = NAN;
  double tilt = NAN;
  ASSERT_EQ(std::sscanf(run.standard_output.c_str(), "height %lf m, tilt %lf rad", &height, &tilt), 2)
      << run.standard_output;
  EXPECT_NEAR(height, 0.0, 1e-6);
  EXPECT_NEAR(tilt, 0.0, 1e-3);
  expect_consistent_motion(service);
}

// As an explicit force, an added mass of 20 times the mass would diverge within a few steps.
void expect_crate_heaves_with_20_times_its_mass(const std::string& program) {
  constexpr double kMass = 256.25;  // [kg], as in crate.h
  const TempDir directory;
  const std::string scene = directory.write("heave.toml", R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.5] }
outputs = ["wrench", "loads"]
[body.added_mass]
matrix = [0, 0, 5125, 0, 0, 0]
immersion = "none"
)");
  const RunningProgram service(service_command(scene, {}));
  const FinishedProcess run =
      run_to_end(command_of({program, "--loads", "", kStep, "600", "0.01"}), kRunTimeout);
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  const double expected = heave_period(kMass, 20.0 * kMass, 1.0);
  EXPECT_NEAR(printed_heave_period(run), expected, 1e-3 * expected) << run.standard_output;
  expect_consistent_motion(service);
}

TEST(Examples, BulletCrateSettlesLevel) {
  if (*BULLET_CRATE == '\0') GTEST_SKIP() << kNoBullet;  // the engine is optional for a build
  expect_crate_settles_level(box_service(), {BULLET_CRATE});
}

TEST(Examples, BulletCrateWithLoadsSettlesLevel) {
  if (*BULLET_CRATE == '\0') GTEST_SKIP() << kNoBullet;  // the engine is optional for a build
  expect_crate_settles_level(crate_service(), {BULLET_CRATE, "--loads"});
}

TEST(Examples, OdeCrateSettlesLevel) {
  if (*ODE_CRATE == '\0') GTEST_SKIP() << kNoOde;  // the engine is optional for a build
  expect_crate_settles_level(box_service(), {ODE_CRATE});
}

TEST(Examples, OdeCrateWithLoadsSettlesLevel) {
  if (*ODE_CRATE == '\0') GTEST_SKIP() << kNoOde;  // the engine is optional for a build
  expect_crate_settles_level(crate_service(), {ODE_CRATE, "--loads"});
}

TEST(Examples, BulletCrateHeavesWith20TimesItsMass) {
  if (*BULLET_CRATE == '\0') GTEST_SKIP() << kNoBullet;  // the engine is optional for a build
  expect_crate_heaves_with_20_times_its_mass(BULLET_CRATE);
}

TEST(Examples, OdeCrateHeavesWith20TimesItsMass) {
  if (*ODE_CRATE == '\0') GTEST_SKIP() << kNoOde;  // the engine is optional for a build
  expect_crate_heaves_with_20_times_its_mass(ODE_CRATE);
}

// A model for mujoco_bodies with one body, of the given mass.
std::string mujoco_model(const std::string& position, double mass) {
  return "<mujoco><option timestep=\"0.005\" gravity=\"0 0 -9.80665\"/><size nuser_body=\"1\"/><worldbody>"
         "<body name=\"body\" user=\"1\" pos=\"" +
         position + "\"><freejoint/><inertial pos=\"0 0 0\" mass=\"" + std::to_string(mass) +
         "\" diaginertia=\"30 30 40\"/></body></worldbody></mujoco>";
}

// What mujoco_bodies prints about a body.
struct MujocoMotion {
  std::array<double, 3> position{}, velocity{};
};

FinishedProcess run_mujoco(const std::string& scene, const std::string& model, const std::string& duration,
                           MujocoMotion& motion) {
  const RunningProgram service(service_command(scene, {}));
  FinishedProcess run = run_to_end(command_of({MUJOCO_BODIES, model, "", duration}), kRunTimeout);
  EXPECT_EQ(run.exit_code, 0) << run.standard_error;
  const std::size_t at = run.standard_output.find(": position ");
  auto& [p, v] = motion;
  EXPECT_NE(at, std::string::npos) << run.standard_output;
  if (at != std::string::npos) {
    EXPECT_EQ(
        std::sscanf(run.standard_output.c_str() + at, ": position %lf %lf %lf m, velocity %lf %lf %lf m/s",
                    &p[0], &p[1], &p[2], &v[0], &v[1], &v[2]),
        6)
        << run.standard_output;
  }
  expect_consistent_motion(service);
  return run;
}

// Compares mujoco_bodies with buoyancy-client, which solves the same equations by other means.
void expect_motion_of_client(const std::string& scene, const std::string& model, const std::string& duration,
                             const std::string& step) {
  MujocoMotion motion;
  run_mujoco(scene, model, duration, motion);
  const TempDir directory;
  const std::string csv = directory.path("run.csv");
  const FinishedProcess reference =
      run_to_end(client_command(scene, {"--embedded", "--duration", duration, "--step", step, "--csv", csv}),
                 kRunTimeout);
  ASSERT_EQ(reference.exit_code, 0) << reference.standard_error;
  const std::string run = read_file(csv);
  // Both are off by a step's fraction of the motion.
  constexpr std::array kPosition{"px", "py", "pz"};
  constexpr std::array kVelocity{"vx", "vy", "vz"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(motion.position[i], csv_column(run, kPosition[i]).back(), 0.004) << kPosition[i];
    EXPECT_NEAR(motion.velocity[i], csv_column(run, kVelocity[i]).back(), 0.004) << kVelocity[i];
  }
}

TEST(Examples, MujocoBodySinksAtItsTerminalVelocity) {
  if (*MUJOCO_BODIES == '\0') GTEST_SKIP() << kNoMujoco;  // the engine is optional for a build
  const TempDir directory;
  const std::string scene = directory.write("sinks.toml", R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.5] }
outputs = ["wrench", "loads"]
[body.drag]
quadratic = [300, 300, 560, 50, 50, 50]
center = [0, 0, 0]
[body.added_mass]
matrix = [150, 150, 440, 20, 20, 8]
center = [0, 0, 0]
)");
  MujocoMotion motion;
  run_mujoco(scene, directory.write("sinks.xml", mujoco_model("0 0 -20", 700.0)), "10", motion);
  const double terminal = std::sqrt((700.0 - kDensity * 0.5) * kGravity / 560.0);
  EXPECT_NEAR(motion.velocity[2], -terminal, 0.01 * terminal);
  EXPECT_NEAR(motion.velocity[0], 0.0, 1e-6);
}

TEST(Examples, MujocoBodyHeavesWithItsAddedMass) {
  if (*MUJOCO_BODIES == '\0') GTEST_SKIP() << kNoMujoco;  // the engine is optional for a build
  const TempDir directory;
  const std::string scene = directory.write("heaves.toml", R"(
[[body]]
id = 1
shape = { type = "box", size = [1, 1, 0.5] }
outputs = ["wrench", "loads"]
[body.added_mass]
matrix = [0, 0, 800, 0, 0, 0]
center = [0, 0, 0]
immersion = "none"
)");
  MujocoMotion motion;
  const FinishedProcess run =
      run_mujoco(scene, directory.write("heaves.xml", mujoco_model("0 0 0.02", 256.25)), "10", motion);
  const double expected = heave_period(256.25, 800.0, 1.0);
  EXPECT_NEAR(printed_heave_period(run), expected, 1e-3 * expected) << run.standard_output;
}

// A body without symmetries, tilted, falls and turns in a current: frames, centre of mass and the blocks of
// the matrices all matter.
TEST(Examples, MujocoBodyTumblesAsInBuoyancyClient) {
  if (*MUJOCO_BODIES == '\0') GTEST_SKIP() << kNoMujoco;  // the engine is optional for a build
  const TempDir directory;
  const std::string scene = directory.write("tumbles.toml", R"(
[water.current]
velocity = [0.4, -0.3, 0.1]
[[body]]
id = 1
shape = { type = "box", size = [1, 0.8, 0.5] }
outputs = ["wrench", "loads"]
[body.drag]
linear = [90, 20, 0, 0, 10, 0,   20, 150, 0, -10, 0, 0,  0, 0, 120, 0, 0, 0,
          0, -10, 0, 20, 0, 0,   10, 0, 0, 0, 30, 0,     0, 0, 0, 0, 0, 25]
quadratic = [100, 200, 300, 20, 30, 25]
center = [0.1, 0, 0.05]
[body.added_mass]
matrix = [200, 10, 0, 0, 30, 0,  10, 500, 0, -40, 0, 20,  0, 0, 900, 0, 0, 0,
          0, -40, 0, 60, 0, 0,   30, 0, 0, 0, 80, 0,      0, 20, 0, 0, 0, 70]
center = [-0.05, 0.02, 0]
[body.client]
mass = 500
center_of_mass = [0.1, 0.05, -0.05]
inertia = [40, 50, 65]
position = [0, 0, -20]
orientation = [0.8, 0.4, 0.2, 0.4]
)");
  const std::string model = directory.write("tumbles.xml", R"(
<mujoco><option timestep="0.001" gravity="0 0 -9.80665"/><size nuser_body="1"/><worldbody>
<body name="body" user="1" pos="0 0 -20" quat="0.8 0.4 0.2 0.4"><freejoint/>
<inertial pos="0.1 0.05 -0.05" mass="500" diaginertia="40 50 65"/></body></worldbody></mujoco>)");
  expect_motion_of_client(scene, model, "3", "0.001");
}

TEST(Examples, MujocoCatamaranRidesWavesAsInBuoyancyClient) {
  if (*MUJOCO_BODIES == '\0') GTEST_SKIP() << kNoMujoco;  // the engine is optional for a build
  expect_motion_of_client(kSources + "/scenes/catamaran.toml", kSources + "/client/examples/catamaran.xml",
                          "8", "0.005");
}

TEST(Examples, MujocoBodyDriftsWithTheCurrent) {
  if (*MUJOCO_BODIES == '\0') GTEST_SKIP() << kNoMujoco;  // the engine is optional for a build
  MujocoMotion motion;
  run_mujoco(kSources + "/scenes/rov.toml", kSources + "/client/examples/rov.xml", "30", motion);
  // The current of the scene; the drag of the last centimetres a second is almost linear.
  EXPECT_NEAR(motion.velocity[0], 0.3, 0.003);
  EXPECT_NEAR(motion.velocity[1], 0.1, 0.003);
  // Rises under the weight of the water that it displaces above its own.
  const double lift = (kDensity * 0.4 * 0.3 * 0.095 - 11.5) * kGravity;
  const double terminal = (std::sqrt(5.2 * 5.2 + 4.0 * 37.0 * lift) - 5.2) / (2.0 * 37.0);
  EXPECT_NEAR(motion.velocity[2], terminal, 0.01 * terminal);
}

// A small neutrally buoyant sphere, whose added mass is half the mass of its water, moves as that water
// would.
TEST(Examples, MujocoSphereMovesAsTheWaterInWaves) {
  if (*MUJOCO_BODIES == '\0') GTEST_SKIP() << kNoMujoco;  // the engine is optional for a build
  constexpr double kAmplitude = 0.02;                     // [m]
  constexpr double kPeriod = 4.0;                         // [s]
  const TempDir directory;
  const std::string scene = directory.write("waves.toml", R"(
[water.waves]
type = "regular"
height = 0.04
period = 4.0
[[body]]
id = 1
shape = { type = "sphere", radius = 0.1, segments = 50 }
tolerance = 1e-4
outputs = ["wrench", "loads"]
[body.drag]
linear = [5, 5, 5, 0.1, 0.1, 0.1]
center = [0, 0, 0]
[body.added_mass]
matrix = [2.1467549, 2.1467549, 2.1467549, 0, 0, 0]
center = [0, 0, 0]
)");
  const Expected<Scene> prepared = Scene::load(scene);
  ASSERT_TRUE(prepared) << prepared.error().message();
  const double mass = kDensity * prepared->bodies()[0].prepared_mesh->mass_properties.volume;
  MujocoMotion motion;
  run_mujoco(scene, directory.write("waves.xml", mujoco_model("0 0 -1.5", mass)), "30", motion);
  const double w = 2.0 * std::numbers::pi / kPeriod;
  const double k = w * w / kGravity;
  const double phase = k * motion.position[0] - w * 30.0;
  const double speed = kAmplitude * w * std::exp(k * motion.position[2]);
  EXPECT_NEAR(motion.velocity[0], speed * std::cos(phase), 0.01 * speed);
  EXPECT_NEAR(motion.velocity[2], speed * std::sin(phase), 0.01 * speed);
}

TEST(Examples, MujocoModelWithoutWetBodiesIsRefused) {
  if (*MUJOCO_BODIES == '\0') GTEST_SKIP() << kNoMujoco;  // the engine is optional for a build
  const TempDir directory;
  const std::string model = directory.write("dry.xml", "<mujoco><worldbody><body/></worldbody></mujoco>");
  const FinishedProcess run = run_to_end(command_of({MUJOCO_BODIES, model, "memq://"}), kRunTimeout);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(contains(run.standard_error, "user attribute"));
}

TEST(Examples, ReportMissingService) {
  if (*BULLET_CRATE == '\0') GTEST_SKIP() << kNoBullet;  // the engine is optional for a build
  const FinishedProcess run = run_to_end(command_of({BULLET_CRATE, "memq://", kStep, "3"}), kRunTimeout);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(contains(run.standard_error, "no buoyancyd is running"));
}

// Runs round_trip.py with the types that lcm-gen generates.
std::string run_python(const TempDir& directory, const Options& options) {
  if (!std::filesystem::exists(directory.path("buoyancy"))) {
    std::vector<std::string> generate{LCM_GEN, "-p", "--ppath", directory.path("")};
    for (const auto& entry : std::filesystem::directory_iterator(kSources + "/lcmtypes")) {
      if (entry.path().extension() == ".lcm") generate.push_back(entry.path());
    }
    const FinishedProcess generated = run_to_end(command_of(generate), kRunTimeout);
    EXPECT_EQ(generated.exit_code, 0) << generated.standard_error;
  }
  std::vector<std::string> arguments{PYTHON, kSources + "/client/examples/round_trip.py"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  ChildCommand command = command_of(arguments);
  command.environment = {"PYTHONPATH=" + directory.path(""), "PYTHONDONTWRITEBYTECODE=1"};
  const FinishedProcess finished = run_to_end(command, kRunTimeout);
  EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
  return finished.standard_output;
}

TEST(Examples, PythonReceivesForceOnBox) {
  if (*PYTHON == '\0') GTEST_SKIP() << kNoPython;  // the engine is optional for a build
  const TempDir directory;
  const RunningProgram service(box_service());
  for (const double height : {0.0, 0.1, 1.0}) {
    const std::string output = run_python(directory, {"--height", std::to_string(height)});
    int status = -1;
    std::array<double, 3> force{};
    double volume = NAN;
    ASSERT_EQ(std::sscanf(output.c_str(), "status %d, force %lf %lf %lf N, submerged volume %lf m^3", &status,
                          &force[0], &force[1], &force[2], &volume),
              5)
        << output;
    const double expected_volume = std::fmax(0.25 - height, 0.0);  // box of 1 x 1 x 0.5 m about its origin
    EXPECT_EQ(status, 0);
    EXPECT_NEAR(volume, expected_volume, 1e-9);
    EXPECT_NEAR(force[2], kDensity * kGravity * expected_volume, 1e-5);
  }
}

TEST(Examples, PythonReceivesLoadsOfCrate) {
  if (*PYTHON == '\0') GTEST_SKIP() << kNoPython;  // the engine is optional for a build
  const TempDir directory;
  const RunningProgram service(crate_service());
  const std::string output = run_python(directory, {"--loads", "--velocity", "0", "0", "-0.5"});
  const std::size_t second_line = output.find("immersion");
  ASSERT_NE(second_line, std::string::npos) << output;
  double immersion = NAN;
  double drag = NAN;
  double added_mass = NAN;
  ASSERT_EQ(std::sscanf(output.c_str() + second_line,
                        "immersion %lf, drag in heave %lf N, added mass in heave %lf kg", &immersion, &drag,
                        &added_mass),
            3)
      << output;
  // The coefficients of the scene, of which one half is in the water.
  EXPECT_NEAR(immersion, 0.5, 1e-6);
  EXPECT_NEAR(drag, 0.5 * (2000.0 + 560.0 * 0.5) * 0.5, 1e-5);
  EXPECT_NEAR(added_mass, 0.5 * 440.0, 1e-5);
}

}  // namespace
}  // namespace buoyancy
