// Runs client/examples with buoyancyd over UDP: in third-party engines the crate of scenes/box.toml comes to
// rest level and at its equilibrium height, and the Python client receives the force of a closed form.
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/e2e/closed_loop.h"
#include "tests/support/running_program.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

const std::string kSources = BUOYANCY_SOURCE_DIR;
// Time step [s]: the 20 s of the crate's motion take 4,000 round trips.
constexpr const char* kStep = "0.005";

ChildCommand box_service() {
  return service_command(kSources + "/scenes/box.toml", {});
}

// The engines and Python are optional for a build. scripts/test installs them, so that it skips none of these
// tests; a build without one of them names it and runs the other tests.
constexpr const char* kNoBullet =
    "CMake did not find double-precision Bullet; install libbullet-dev and configure again";
constexpr const char* kNoOde = "CMake did not find ODE; install libode-dev and configure again";
constexpr const char* kNoPython = "CMake did not find Python; install python3 and configure again";

void expect_crate_settles_level(const std::string& program) {
  const RunningProgram service(box_service());
  const FinishedProcess run = run_to_end(command_of({program, "", kStep}), kRunTimeout);
  ASSERT_EQ(run.exit_code, 0) << run.standard_error;
  double height = NAN;
  double tilt = NAN;
  ASSERT_EQ(std::sscanf(run.standard_output.c_str(), "height %lf m, tilt %lf rad", &height, &tilt), 2)
      << run.standard_output;
  EXPECT_NEAR(height, 0.0, 1e-6);
  EXPECT_NEAR(tilt, 0.0, 1e-3);
}

TEST(Examples, BulletCrateSettlesLevel) {
  if (*BULLET_CRATE == '\0') GTEST_SKIP() << kNoBullet;
  expect_crate_settles_level(BULLET_CRATE);
}

TEST(Examples, OdeCrateSettlesLevel) {
  if (*ODE_CRATE == '\0') GTEST_SKIP() << kNoOde;
  expect_crate_settles_level(ODE_CRATE);
}

TEST(Examples, ReportMissingService) {
  if (*BULLET_CRATE == '\0') GTEST_SKIP() << kNoBullet;
  const FinishedProcess run = run_to_end(command_of({BULLET_CRATE, "memq://", kStep, "3"}), kRunTimeout);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.standard_error.find("no buoyancyd is running"), std::string::npos) << run.standard_error;
}

TEST(Examples, PythonReceivesForceOnBox) {
  if (*PYTHON == '\0') GTEST_SKIP() << kNoPython;
  const TempDir directory;
  std::vector<std::string> generate{LCM_GEN, "-p", "--ppath", directory.path("")};
  for (const auto& entry : std::filesystem::directory_iterator(kSources + "/lcmtypes")) {
    if (entry.path().extension() == ".lcm") generate.push_back(entry.path());
  }
  const FinishedProcess generated = run_to_end(command_of(generate), kRunTimeout);
  ASSERT_EQ(generated.exit_code, 0) << generated.standard_error;

  const RunningProgram service(box_service());
  for (const double height : {0.0, 0.1, 1.0}) {
    ChildCommand command =
        command_of({PYTHON, kSources + "/client/examples/round_trip.py", "--height", std::to_string(height)});
    command.environment = {"PYTHONPATH=" + directory.path(""), "PYTHONDONTWRITEBYTECODE=1"};
    const FinishedProcess finished = run_to_end(command, kRunTimeout);
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
    int status = -1;
    std::array<double, 3> force{};
    double volume = NAN;
    ASSERT_EQ(std::sscanf(finished.standard_output.c_str(),
                          "status %d, force %lf %lf %lf N, submerged volume %lf m^3", &status, &force[0],
                          &force[1], &force[2], &volume),
              5)
        << finished.standard_output;
    const double expected_volume = std::fmax(0.25 - height, 0.0);  // box of 1 x 1 x 0.5 m about its origin
    EXPECT_EQ(status, 0);
    EXPECT_NEAR(volume, expected_volume, 1e-9);
    EXPECT_NEAR(force[2], 1025.0 * 9.80665 * expected_volume, 1e-5);
  }
}

}  // namespace
}  // namespace buoyancy
