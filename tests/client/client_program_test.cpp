// buoyancy-client --embedded as a process: arguments, exit codes, files, table. Needs no network.
#include <numbers>

#include <gtest/gtest.h>

#include "tests/client/closed_loop.h"

namespace buoyancy {
namespace {

std::string crate(const std::string& world = "", const std::string& client = "density = 500\n") {
  return world +
         "[[body]]\nid = 1\nname = \"crate\"\nshape = { type = \"box\", size = [1, 1, 0.5] "
         "}\n[body.client]\n" +
         client;
}

class ClientProgram : public testing::Test {
 protected:
  FinishedProcess run(const Options& options) const {
    return run_to_end(client_command(scene_, options), 200.0);
  }

  TemporaryDirectory directory_;
  std::string scene_ = directory_.write("crate.toml", crate());
};

TEST_F(ClientProgram, PrintsATableWithEveryFigure) {
  const FinishedProcess finished = run({"--embedded", "--duration", "0.1"});
  EXPECT_EQ(finished.exit_code, 0) << finished.standard_error;
  EXPECT_EQ(finished.standard_error, "") << "a progress bar belongs on terminals only";
  for (const char* word : {"crate", "draft", "heave", "roll", "pitch", "energy drift", "100 of 100", "p50",
                           "p99", "p99.9", "max", "retries 0", "lost 0", "late 0"}) {
    EXPECT_NE(finished.standard_output.find(word), std::string::npos) << word << "\n"
                                                                      << finished.standard_output;
  }
}

TEST_F(ClientProgram, WritesARowPerBodyAndStepThatReadsBackExactly) {
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

TEST_F(ClientProgram, ThinsTheCsvOnRequest) {
  const std::string csv = directory_.path("run.csv");
  simulate(scene_, {"--embedded", "--duration", "0.1", "--step", "0.001", "--csv", csv, "--csv-every", "25"});
  EXPECT_EQ(csv_column(read_file(csv), "utime"), (std::vector<double>{0, 25000, 50000, 75000, 100000}));
}

TEST_F(ClientProgram, FloatsTheSameWhicheverWayIsUp) {
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

TEST_F(ClientProgram, TellsRollFromPitchAndTheirSigns) {
  // Nothing moves: no gravity, no water.
  const auto still = [&](const std::string& orientation) {
    const std::string path = directory_.write(
        "still.toml", crate("[world]\ngravity = 0\n", "density = 1\norientation = " + orientation + "\n"));
    return body(simulate(path, {"--embedded", "--duration", "0.01"}), 1);
  };
  // 0.2 rad about x, then about y; then both after a yaw of 1 rad: Rz(1) Ry(0.2) Rx(0.3).
  const double degrees = 180.0 / std::numbers::pi;
  EXPECT_NEAR(still("[0.9950041652780258, 0.09983341664682815, 0, 0]")["roll_deg"], 0.2 * degrees, 1e-9);
  EXPECT_NEAR(still("[0.9950041652780258, 0, 0.09983341664682815, 0]")["pitch_deg"], 0.2 * degrees, 1e-9);
  const nlohmann::json turned =
      still("[0.8705457396901702, 0.08316388076114686, 0.15791480976984434, 0.4585812871230074]");
  EXPECT_NEAR(turned["roll_deg"], 0.3 * degrees, 1e-9);
  EXPECT_NEAR(turned["pitch_deg"], 0.2 * degrees, 1e-9);
}

TEST_F(ClientProgram, MovesTheSameWhereverTorqueIsTakenAbout) {
  const std::string tilted =
      "density = 400\norientation = [0.9, 0.3, 0.2, 0.1]\ncenter_of_mass = [0.1, 0, 0.05]\n";
  const std::string other = crate("", tilted);
  const std::string moved = other.substr(0, other.find("[body.client]")) + "reference_point = [3, -2, 5]\n" +
                            other.substr(other.find("[body.client]"));
  const Options options = {"--embedded", "--duration", "1"};
  const nlohmann::json at_origin = simulate(directory_.write("a.toml", other), options);
  const nlohmann::json elsewhere = simulate(directory_.write("b.toml", moved), options);
  for (const char* key : {"heave", "roll_deg", "pitch_deg"}) {
    EXPECT_NEAR(body(at_origin, 1)[key], body(elsewhere, 1)[key], 1e-9) << key;
  }
}

TEST_F(ClientProgram, KeepsTheEnergyOfATumblingUndampedBodyWithEitherIntegrator) {
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
  // Orders 2 and 1 of the error in energy.
  EXPECT_LT(range("velocity_verlet", "0.0025"), verlet / 3.0);
  EXPECT_LT(range("semi_implicit_euler", "0.0025"), euler / 1.5);
}

TEST_F(ClientProgram, HasTheWrenchEvaluatedAheadByTheLeadTime) {
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
    // Not the velocity of the half step, which would be off by 1e-4.
    EXPECT_NEAR(volumes[i], 0.25 - (heights[i] + 0.05 * speeds[i]), 1e-5);
  }
}

TEST_F(ClientProgram, AFullDiskIsAnError) {
  const FinishedProcess finished = run({"--embedded", "--csv", "/dev/full"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.standard_error.find("/dev/full"), std::string::npos) << finished.standard_error;
  ChildCommand command = client_command(scene_, {"--embedded", "--duration", "0.01"});
  command.standard_output = "/dev/full";
  EXPECT_EQ(run_to_end(command, 200.0).exit_code, 1);
}

TEST_F(ClientProgram, ACsvThatCannotBeCreatedIsAnErrorBeforeTheRun) {
  const std::string path = directory_.path("no_such_directory/run.csv");
  const FinishedProcess finished = run({"--embedded", "--csv", path});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.standard_error.find(path), std::string::npos) << finished.standard_error;
}

TEST_F(ClientProgram, ABodyThatIsNotOkEndsTheRunAndIsTheLastRow) {
  const std::string csv = directory_.path("run.csv");
  const std::string path =
      directory_.write("far.toml", crate("", "density = 500\nlinear_velocity = [0, 0, 1e308]\n"));
  const FinishedProcess finished =
      run_to_end(client_command(path, {"--embedded", "--step", "10", "--csv", csv}), 200.0);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_NE(finished.standard_error.find("body 1 (crate)"), std::string::npos) << finished.standard_error;
  EXPECT_NE(csv_column(read_file(csv), "status").back(), 0.0);
}

TEST_F(ClientProgram, WrongArgumentsAndScenesExitWith2AndSayWhy) {
  const std::string unknown_key = directory_.write("unknown.toml", crate("", "densty = 500\n"));
  const std::string nobody =
      directory_.write("nobody.toml", "[[body]]\nid = 1\nshape = { type = \"box\" }\n");
  const struct {
    std::string scene;
    Options options;
    std::string said;
  } cases[] = {
      {scene_, {"--step", "0", "--embedded"}, "--step"},
      {scene_, {"--step", "nan", "--embedded"}, "--step"},
      {scene_, {"--duration", "-1", "--embedded"}, "--duration"},
      {scene_, {"--integrator", "euler", "--embedded"}, "--integrator"},
      {scene_, {"--rate", "100", "--embedded"}, "--embedded"},
      {scene_, {"-l", "udpm://239.255.76.67:7667", "--embedded"}, "--embedded"},
      {scene_, {"--no-such-option"}, "--no-such-option"},
      {scene_, {"-l", "no url"}, "no url"},
      {scene_, {"--states-channel", ""}, "channel"},
      {scene_, {"--states-channel", "SAME", "--wrenches-channel", "SAME"}, "SAME"},
      {scene_, {"--step", "1e-6", "--duration", "1e13", "--embedded"}, "--duration"},
      {directory_.path("missing.toml"), {"--embedded"}, "missing.toml"},
      {unknown_key, {"--embedded"}, "densty"},
      {nobody, {"--embedded"}, "[body.client]"},
  };
  for (const auto& wrong : cases) {
    const FinishedProcess finished = run_to_end(client_command(wrong.scene, wrong.options), 200.0);
    EXPECT_EQ(finished.exit_code, 2) << wrong.said;
    EXPECT_NE(finished.standard_error.find(wrong.said), std::string::npos)
        << wrong.said << ": " << finished.standard_error;
  }
}

TEST_F(ClientProgram, TellsItsVersionAndHelp) {
  ChildCommand command = client_command(scene_, {});
  command.arguments = {command.arguments.front(), "--version"};
  EXPECT_EQ(run_to_end(command, 60.0).exit_code, 0);
  command.arguments.back() = "--help";
  const FinishedProcess help = run_to_end(command, 60.0);
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.standard_output.find("--lead-time"), std::string::npos);
}

}  // namespace
}  // namespace buoyancy
