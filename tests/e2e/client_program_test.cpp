// Tests buoyancy-client --embedded as a process: arguments, exit codes, files, summary. They need no network.
#include <numbers>

#include <gtest/gtest.h>

#include "tests/e2e/closed_loop.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"
#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

std::string crate(const std::string& world = "", const std::string& client = "density = 500\n") {
  return world +
         "[[body]]\nid = 1\nname = \"crate\"\nshape = { type = \"box\", size = [1, 1, 0.5] "
         "}\n[body.client]\n" +
         client;
}

class BuoyancyClient : public testing::Test {
 protected:
  FinishedProcess run(const Options& options) const {
    return run_to_end(client_command(scene_, options), kRunTimeout);
  }

  TempDir directory_;
  std::string scene_ = directory_.write("crate.toml", crate());
};

TEST_F(BuoyancyClient, PrintsSummaryTable) {
  const FinishedProcess finished = run({"--embedded", "--duration", "0.1"});
  EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
  EXPECT_EQ(finished.standard_error, "") << "a progress bar is shown on terminals only";
  for (const char* text : {"crate", "draft", "heave", "roll", "pitch", "energy drift", "100 of 100", "p50",
                           "p99", "p99.9", "max", "retries 0", "unanswered 0", "late 0"}) {
    EXPECT_TRUE(contains(finished.standard_output, text));
  }
}

TEST_F(BuoyancyClient, WritesCsvRowPerBodyAndStepThatReadsBackExactly) {
  const std::string csv = directory_.path("run.csv");
  const nlohmann::json summary =
      simulate(scene_, {"--embedded", "--duration", "0.01", "--step", "0.001", "--csv", csv});
  const std::string text = read_file(csv);
  EXPECT_EQ(text.substr(0, text.find('\n')),
            "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,status,fx,fy,fz,tx,ty,tz,volume,bx,by,bz,"
            "energy");
  const std::vector<double> utime = csv_column(text, "utime");
  ASSERT_EQ(utime.size(), 11U);
  EXPECT_EQ(utime.front(), 0.0);
  EXPECT_EQ(utime.back(), 10000.0);
  EXPECT_EQ(csv_column(text, "pz").back(), double{body(summary, 1)["heave"]});
}

TEST_F(BuoyancyClient, WritesOnlyEveryNthStepToCsv) {
  const std::string csv = directory_.path("run.csv");
  simulate(scene_, {"--embedded", "--duration", "0.1", "--step", "0.001", "--csv", csv, "--csv-every", "25"});
  EXPECT_EQ(csv_column(read_file(csv), "utime"), (std::vector<double>{0, 25000, 50000, 75000, 100000}));
}

TEST_F(BuoyancyClient, FloatsIndependentlyOfUpDirection) {
  const std::string damped = "density = 300\nlinear_damping = 900\nangular_damping = 60\n";
  const std::string up_x = directory_.write(
      "up_x.toml", crate("[world]\nup = [1, 0, 0]\ngravity = 3.7\n[water]\nlevel = -4\n",
                         damped + "position = [-4, 0, 0]\norientation = [0.7071067811865476, 0, "
                                  "0.7071067811865475, 0]\n"));
  const nlohmann::json summary = simulate(up_x, {"--embedded", "--duration", "20", "--step", "0.005"});
  EXPECT_NEAR(body(summary, 1)["draft"], 0.5 * 300.0 / 1025.0, 1e-9);
  EXPECT_NEAR(body(summary, 1)["roll_deg"], 0.0, 1e-6);
  EXPECT_NEAR(body(summary, 1)["pitch_deg"], 0.0, 1e-6);
}

TEST_F(BuoyancyClient, ReportsRollAndPitchWithSigns) {
  // The body does not move: without gravity neither weight nor buoyancy acts.
  const auto still = [&](const std::string& orientation) {
    const std::string path = directory_.write(
        "still.toml", crate("[world]\ngravity = 0\n", "density = 100\norientation = " + orientation + "\n"));
    return body(simulate(path, {"--embedded", "--duration", "0.01"}), 1);
  };
  // A rotation of 0.2 rad about x, one about y, and both after a yaw of 1 rad: Rz(1) Ry(0.2) Rx(0.3).
  const double degrees = 180.0 / std::numbers::pi;
  EXPECT_NEAR(still("[0.9950041652780258, 0.09983341664682815, 0, 0]")["roll_deg"], 0.2 * degrees, 1e-9);
  EXPECT_NEAR(still("[0.9950041652780258, 0, 0.09983341664682815, 0]")["pitch_deg"], 0.2 * degrees, 1e-9);
  const nlohmann::json turned =
      still("[0.8705457396901702, 0.08316388076114686, 0.15791480976984434, 0.4585812871230074]");
  EXPECT_NEAR(turned["roll_deg"], 0.3 * degrees, 1e-9);
  EXPECT_NEAR(turned["pitch_deg"], 0.2 * degrees, 1e-9);
}

TEST_F(BuoyancyClient, MovesIndependentlyOfReferencePoint) {
  const std::string tilted =
      "density = 400\norientation = [0.9, 0.3, 0.2, 0.1]\ncenter_of_mass = [0.1, 0, 0.05]\n";
  const std::string original = crate("", tilted);
  const std::size_t end_of_body = original.find("[body.client]");
  const std::string shifted =
      original.substr(0, end_of_body) + "reference_point = [3, -2, 5]\n" + original.substr(end_of_body);
  const Options options = {"--embedded", "--duration", "1"};
  const nlohmann::json at_origin = simulate(directory_.write("a.toml", original), options);
  const nlohmann::json elsewhere = simulate(directory_.write("b.toml", shifted), options);
  for (const char* key : {"heave", "roll_deg", "pitch_deg"}) {
    EXPECT_NEAR(body(at_origin, 1)[key], body(elsewhere, 1)[key], 1e-9) << key;
  }
}

TEST_F(BuoyancyClient, ConservesEnergyOfTumblingBodyWithEitherIntegrator) {
  const std::string path =
      directory_.write("tumbling.toml",
                       "[[body]]\nid = 1\nshape = { type = \"rock\", frequency = 3 }\n[body.client]\n"
                       "density = 500\nposition = [0, 0, 0.3]\nangular_velocity = [0.3, 1, 0.5]\n");
  const auto range = [&](const std::string& integrator, const std::string& step) -> double {
    return body(
        simulate(path, {"--embedded", "--duration", "50", "--step", step, "--integrator", integrator}),
        1)["energy_range"];
  };
  const double verlet = range("velocity_verlet", "0.005");
  const double euler = range("semi_implicit_euler", "0.005");
  EXPECT_LT(verlet, 1e-3);
  EXPECT_LT(euler, 1e-1);
  // The energy error is of order 2 and 1 in the step.
  EXPECT_LT(range("velocity_verlet", "0.0025"), verlet / 3.0);
  EXPECT_LT(range("semi_implicit_euler", "0.0025"), euler / 1.5);
}

TEST_F(BuoyancyClient, EvaluatesWrenchAtLeadTime) {
  const std::string falling = directory_.write("falling.toml", crate("",
                                                                     "density = 500\nposition = [0, 0, 0.1]\n"
                                                                     "linear_velocity = [0, 0, -1]\n"));
  const std::string csv = directory_.path("run.csv");
  simulate(falling,
           {"--embedded", "--duration", "0.02", "--step", "0.001", "--lead-time", "0.05", "--csv", csv});
  const std::string text = read_file(csv);
  const std::vector<double> heights = csv_column(text, "pz");
  const std::vector<double> speeds = csv_column(text, "vz");
  const std::vector<double> volumes = csv_column(text, "volume");
  ASSERT_EQ(volumes.size(), 21U);
  EXPECT_NEAR(volumes[0], 0.25 - (0.1 - 0.05), 1e-15);
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    // The velocity of the half step would be off by 1e-4.
    EXPECT_NEAR(volumes[i], 0.25 - (heights[i] + 0.05 * speeds[i]), 1e-5);
  }
}

TEST_F(BuoyancyClient, FailsOnFullDisk) {
  const FinishedProcess finished = run({"--embedded", "--csv", "/dev/full"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "/dev/full"));
  ChildCommand command = client_command(scene_, {"--embedded", "--duration", "0.01"});
  command.standard_output = "/dev/full";
  EXPECT_EQ(run_to_end(command, kRunTimeout).exit_code, 1);
}

TEST_F(BuoyancyClient, FailsBeforeRunIfCsvCannotBeCreated) {
  const std::string path = directory_.path("no_such_directory/run.csv");
  const FinishedProcess finished = run({"--embedded", "--csv", path});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, path));
}

TEST_F(BuoyancyClient, RefusesToOverwriteSceneWithCsv) {
  const std::string before = read_file(scene_);
  EXPECT_EQ(run({"--embedded", "--csv", scene_}).exit_code, 2);
  EXPECT_EQ(read_file(scene_), before);
}

TEST_F(BuoyancyClient, EndsRunAtFailedBodyAndWritesItsRow) {
  const std::string csv = directory_.path("run.csv");
  // An open tray that is so heavy that its edge gets wet.
  const std::string mesh = directory_.write(
      "tray.off",
      "OFF\n8 10 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 0.2\n1 0 0.2\n1 1 0.2\n0 1 0.2\n"
      "3 0 2 1\n3 0 3 2\n3 0 1 5\n3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n");
  const std::string path = directory_.write(
      "tray.toml",
      "[[body]]\nid = 1\nname = \"tray\"\nmesh = \"" + mesh +
          "\"\nopen = \"dry_boundary\"\n[body.client]\nmass = 300\ncenter_of_mass = [0.5, 0.5, 0]\n"
          "inertia = [50, 50, 50]\n");
  const FinishedProcess finished =
      run_to_end(client_command(path, {"--embedded", "--step", "0.01", "--csv", csv}), kRunTimeout);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(finished.standard_output, "");
  EXPECT_TRUE(contains(finished.standard_error, "body 1 (tray)"));
  EXPECT_TRUE(contains(finished.standard_error, "OPEN_EDGE_WET"));
  EXPECT_NE(csv_column(read_file(csv), "status").back(), 0.0);
}

TEST_F(BuoyancyClient, FailsOnDivergedMotionWithoutNonFiniteRows) {
  const struct {
    std::string client;
    Options options;
  } cases[] = {
      {"linear_velocity = [0, 0, 1e308]\n", {"--step", "10"}},
      {"linear_velocity = [1e200, 0, 0]\n", {}},
      {"angular_velocity = [1e200, 1e200, 0]\n", {}},
      {"position = [0, 0, -1e308]\ndensity = 1e-3\n", {"--step", "1e6", "--duration", "1e9"}},
      {"linear_velocity = [0, 0, 1e308]\n", {"--step", "10", "--delay-steps", "2"}},
  };
  for (const auto& test : cases) {
    const std::string csv = directory_.path("run.csv");
    const std::string path = directory_.write("far.toml", crate("", test.client));
    Options options = {"--embedded", "--csv", csv};
    options.insert(options.end(), test.options.begin(), test.options.end());
    const FinishedProcess finished = run_to_end(client_command(path, options), kRunTimeout);
    EXPECT_EQ(finished.exit_code, 1) << test.client << finished.standard_output;
    EXPECT_EQ(finished.standard_output, "");
    EXPECT_TRUE(contains(finished.standard_error, "body 1 (crate) at"));
    EXPECT_TRUE(contains(finished.standard_error, "smaller --step"));
    const std::string text = read_file(csv);
    EXPECT_FALSE(contains(text, "nan"));
    EXPECT_FALSE(contains(text, "inf"));
  }
}

TEST_F(BuoyancyClient, EndsRunThatExplodesInWavesWithACompleteCsv) {
  const std::string waves = "[[water.waves]]\ntype = \"regular\"\nheight = 0.1\nperiod = 2.0\n";
  const std::string path = directory_.write("waves.toml", crate(waves, "density = 50\n"));
  const std::string csv = directory_.path("run.csv");
  // Wrenches of half a second ago feed energy into the crate.
  const FinishedProcess finished = run_to_end(
      client_command(
          path, {"--embedded", "--step", "0.01", "--duration", "600", "--lead-time", "-0.5", "--csv", csv}),
      kRunTimeout);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(finished.standard_output, "");
  for (const char* text : {"body 1 (crate) at", "mechanical energy rose by", "at most", "smaller --step"}) {
    EXPECT_TRUE(contains(finished.standard_error, text));
  }
  const std::string text = read_file(csv);
  EXPECT_EQ(text.back(), '\n');
  const std::vector<double> utime = csv_column(text, "utime");
  ASSERT_GT(utime.size(), 10U);
  for (std::size_t i = 0; i < utime.size(); ++i) EXPECT_EQ(utime[i], 10'000.0 * static_cast<double>(i));
}

TEST_F(BuoyancyClient, WarnsOnceAboutBodyBelowTheSeaBed) {
  const std::string waves =
      "[water]\ndepth = 3\n[[water.waves]]\ntype = \"regular\"\nheight = 0.02\nperiod = 2.0\n";
  const std::string path = directory_.write("bed.toml", crate(waves, "density = 2000\n"));
  const nlohmann::json summary =
      simulate_with_warnings(path, {"--embedded", "--step", "0.01", "--duration", "2"});
  ASSERT_EQ(summary["warnings"].size(), 1U) << summary["warnings"];
  EXPECT_TRUE(contains(std::string(summary["warnings"][0]), "body 1 (crate): it is below the sea bed"));
}

TEST_F(BuoyancyClient, WarnsAboutLargeStepBeforeAndEnergyAfterRun) {
  // A plate of 2 kg: w = 70 rad/s.
  const std::string plate = directory_.write(
      "plate.toml",
      "[water]\ndensity = 1000\n[[body]]\nid = 1\nname = \"plate\"\nshape = { type = \"box\", size "
      "= [1, 1, 0.1] }\n[body.client]\ndensity = 20\nposition = [0, 0, 0.1]\n");
  const nlohmann::json summary =
      simulate_with_warnings(plate, {"--embedded", "--step", "0.05", "--duration", "20"});
  ASSERT_EQ(summary["warnings"].size(), 2U) << summary["warnings"];
  EXPECT_TRUE(contains(std::string(summary["warnings"][0]), "body 1 (plate): step x frequency"));
  EXPECT_TRUE(contains(std::string(summary["warnings"][0]), "Use --step 0.007"));
  EXPECT_TRUE(contains(std::string(summary["warnings"][1]), "mechanical energy rose"));

  const FinishedProcess table =
      run_to_end(client_command(plate, {"--embedded", "--step", "0.05", "--duration", "20"}), kRunTimeout);
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_TRUE(contains(table.standard_output, "warning     body 1 (plate): step"));
  EXPECT_TRUE(contains(table.standard_output, "warning     body 1 (plate): mechanical"));
  simulate(plate, {"--embedded", "--step", "0.007", "--duration", "20"});
}

TEST_F(BuoyancyClient, DelaysResponsesAndWarnsIfLeadTimeIsNotEnough) {
  const std::string box = directory_.write(
      "box.toml",
      "[water]\ndensity = 1000\n[[body]]\nid = 1\nname = \"box\"\nshape = { type = \"box\", size "
      "= [1, 1, 0.4] }\n[body.client]\ndensity = 500\nposition = [0, 0, 0.05]\n");
  // w = 7 rad/s: alpha = 0.007, then 0.14.
  const Options minute = {"--embedded", "--duration", "60", "--step", "0.001"};
  const auto with = [&](Options more) {
    more.insert(more.end(), minute.begin(), minute.end());
    return simulate_with_warnings(box, more);
  };
  const nlohmann::json with_lead = with({"--delay-steps", "1", "--lead-time", "0.001"});
  EXPECT_EQ(with_lead["delay_steps"], 1);
  EXPECT_EQ(with_lead["warnings"].size(), 0U) << with_lead["warnings"];
  EXPECT_LT(double{body(with_lead, 1)["energy_range"]}, 1e-3);
  const nlohmann::json without_lead = with({"--delay-steps", "1"});
  EXPECT_EQ(without_lead["delay_steps"], 1);
  ASSERT_EQ(without_lead["warnings"].size(), 1U) << without_lead["warnings"];
  EXPECT_TRUE(contains(std::string(without_lead["warnings"][0]), "energy rose"));
  const nlohmann::json too_late = with({"--delay-steps", "20", "--lead-time", "0.02"});
  ASSERT_FALSE(too_late["warnings"].empty());
  EXPECT_TRUE(contains(std::string(too_late["warnings"][0]), "response delay"));
}

TEST_F(BuoyancyClient, ExplainsInvalidArgumentsAndScenesAndExitsWith2) {
  const std::string unknown_key = directory_.write("unknown.toml", crate("", "densty = 500\n"));
  const std::string no_client =
      directory_.write("no_client.toml", "[[body]]\nid = 1\nshape = { type = \"box\" }\n");
  const struct {
    std::string scene;
    Options options;
    std::string message;
  } cases[] = {
      {scene_, {"--step", "0", "--embedded"}, "--step"},
      {scene_, {"--step", "nan", "--embedded"}, "--step"},
      {scene_, {"--duration", "-1", "--embedded"}, "--duration"},
      {scene_, {"--integrator", "euler", "--embedded"}, "--integrator"},
      {scene_, {"--rate", "100", "--embedded"}, "--embedded"},
      {scene_, {"--rate", "100", "--delay-steps", "1"}, "--delay-steps"},
      {scene_, {"--delay-steps", "-1", "--embedded"}, "--delay-steps"},
      {scene_, {"-l", "udpm://239.255.76.67:7667", "--embedded"}, "--embedded"},
      {scene_, {"--no-such-option"}, "--no-such-option"},
      {scene_, {"-l", "no url"}, "no url"},
      {scene_, {"--states-channel", ""}, "channel"},
      {scene_, {"--states-channel", "SAME", "--wrenches-channel", "SAME"}, "SAME"},
      {scene_, {"--step", "1e-6", "--duration", "1e13", "--embedded"}, "--duration"},
      {directory_.path("missing.toml"), {"--embedded"}, "missing.toml"},
      {unknown_key, {"--embedded"}, "densty"},
      {no_client, {"--embedded"}, "[body.client]"},
  };
  for (const auto& invalid : cases) {
    const FinishedProcess finished = run_to_end(client_command(invalid.scene, invalid.options), kRunTimeout);
    EXPECT_EQ(finished.exit_code, 2) << invalid.message;
    EXPECT_TRUE(contains(finished.standard_error, invalid.message)) << invalid.message << ": ";
  }
}

TEST_F(BuoyancyClient, PrintsVersionAndHelp) {
  ChildCommand command = client_command(scene_, {});
  command.arguments = {command.arguments.front(), "--version"};
  EXPECT_EQ(run_to_end(command, kWaitTimeout).exit_code, 0);
  command.arguments.back() = "--help";
  const FinishedProcess help = run_to_end(command, kWaitTimeout);
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_TRUE(contains(help.standard_output, "--lead-time"));
}

}  // namespace
}  // namespace buoyancy
