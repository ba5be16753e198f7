// FMUs of both versions, as a host uses them: results, the state machine, states, derivatives, threads, and
// calls that the standard forbids.
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <thread>

#include <gmock/gmock.h>

#include "query/pose_evaluation.h"
#include "tests/fmu/importer.h"
#include "tests/query/pose_table.h"
#include "tests/support/build_paths.h"
#include "tests/support/child_process.h"
#include "tests/support/csv.h"
#include "tests/support/scene_of.h"

namespace buoyancy::fmu {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string kWaves =
    "[water]\nlevel = 0.25\n[[water.waves]]\ntype = \"jonswap\"\nsignificant_wave_height = 0.4\n"
    "peak_period = 3\ndirection = 30\nspreading = 10\n[water.current]\nvelocity = [0.3, 0.1, 0]\n";
const std::string kSwell =
    "[water]\nwaves = { type = \"regular\", height = 0.3, period = 2.5, direction = 30 }\n";
const std::string kRock =
    "[[body]]\nid = 3\nname = \"rock\"\nshape = { type = \"rock\", frequency = 6, radius = 1.0, seed = 5 }\n"
    "reference_point = [0.1, 0.2, 0.3]\n";
const std::string kLoads =
    "[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\nquadratic = [30, 50, 50, 2, 3, 4]\n"
    "[body.added_mass]\nmatrix = [5, 126, 126, 1, 33, 33]\n";
const std::string kOutputs = "outputs = [\"wrench\", \"hydrostatics\"]\n";
const std::string kFerry =
    "[[body]]\nid = 7\nname = \"8 m ferry, \\\"A&B\\\"\"\nshape = { type = \"box\", size = [8, 3, 2] }\n" +
    kOutputs +
    "[[body.compartment]]\nshape = { type = \"box\", size = [2, 2, 1] }\nposition = [2, 0, -0.4]\nflooded = "
    "0.5\n"
    "[[body.tank]]\nshape = { type = \"box\", size = [2, 2, 1] }\nposition = [-2, 0, -0.4]\nfill = 0.25\n";

constexpr std::array kVersions{FmiVersion::k2, FmiVersion::k3};

std::vector<double> row(const std::vector<double>& all, std::size_t i, std::size_t columns) {
  const auto first = all.begin() + static_cast<std::ptrdiff_t>(i * columns);
  return {first, first + static_cast<std::ptrdiff_t>(columns)};
}

void set_pose(const Importer& host, const std::string& body, const PoseTable& poses, std::size_t i) {
  ASSERT_EQ(host.set(body + ".position", row(poses.positions, i, 3)), kFmiOk);
  ASSERT_EQ(host.set(body + ".quaternion", row(poses.quaternions, i, 4)), kFmiOk);
  ASSERT_EQ(host.set(body + ".linear_velocity", row(poses.linear_velocities, i, 3)), kFmiOk);
  ASSERT_EQ(host.set(body + ".angular_velocity", row(poses.angular_velocities, i, 3)), kFmiOk);
}

// Appends the wrench of a body as it is now.
void get_wrench(const Importer& host, const std::string& body, std::size_t i, WrenchTable& table) {
  table.statuses[i] = host.status_of(body);
  const auto store = [&](const char* name, std::vector<double>& out) {
    const std::vector<double> values = host.get(body + name);
    std::copy(values.begin(), values.end(), out.begin() + static_cast<std::ptrdiff_t>(i * values.size()));
  };
  store(".force", table.forces);
  store(".torque", table.torques);
  store(".submerged_volume", table.volumes);
  store(".center_of_buoyancy", table.centers);
  store(".force_error_bound", table.force_bounds);
  store(".torque_error_bound", table.torque_bounds);
}

// Makes the poses of a body one after the other, each at its time, and returns the wrenches.
WrenchTable wrenches_of(const Importer& host, const std::string& body, const PoseTable& poses) {
  WrenchTable table(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    set_pose(host, body, poses, i);
    const double time = static_cast<double>(poses.utimes[i]) * 1e-6;
    EXPECT_EQ(host.step(time - 0.125, 0.125), kFmiOk);
    get_wrench(host, body, i, table);
  }
  return table;
}

// Poses with times that go back now and then.
PoseTable timed_poses(std::size_t count) {
  PoseTable poses = random_poses(count, 1.0, 21);
  for (std::size_t i = 0; i < count; ++i) {
    poses.utimes.push_back(static_cast<std::int64_t>(i / 3) * 250'000 -
                           static_cast<std::int64_t>(i % 3) * 125'000);
  }
  return poses;
}

TEST(Fmu, EqualsQueriesBitForBit) {
  const std::string mesh = "[[body]]\nid = 1\nname = \"ship\"\nmesh = \"" +
                           (source_dir() / "scenes/meshes/catamaran.obj").string() + "\" # Größe\n" + kLoads;
  for (const std::string& text : {kRock, kRock + kLoads, kWaves + kRock + kLoads, kFerry, mesh}) {
    const UnpackedFmu fmu(text);
    const Scene scene = scene_of(text);
    const Body& body = scene.bodies().front();
    const std::string name = to_identifier(body.name);
    const PoseTable poses = timed_poses(1000);
    WrenchTable expected(poses.size());
    evaluate_poses(body, water_of(scene), poses.arrays(), expected.arrays());
    for (const FmiVersion version : kVersions) {
      const Importer host(fmu, version);
      ASSERT_EQ(host.initialize(), kFmiOk) << testing::PrintToString(host.log);
      EXPECT_TRUE(wrenches_of(host, name, poses) == expected) << text;
      EXPECT_TRUE(host.log.empty()) << host.log.front();
    }
  }
}

TEST(Fmu, HasMatricesOfLoadsAndHydrostatics) {
  const UnpackedFmu fmu(kRock + kOutputs + kLoads);
  const Scene scene = scene_of(kRock + kOutputs + kLoads);
  const PoseTable poses = timed_poses(20);
  WrenchTable wrenches(poses.size());
  std::vector<BodyLoads> loads(poses.size());
  std::vector<BodyHydrostatics> hydrostatics(poses.size());
  evaluate_poses(scene.bodies().front(), water_of(scene), poses.arrays(), wrenches.arrays(), loads);
  evaluate_hydrostatics(scene.bodies().front(), scene.water(), poses.arrays(), hydrostatics);
  const auto flat = [](const auto& matrix) {
    std::vector<double> values;
    for (const auto& of_row : matrix) values.insert(values.end(), of_row.begin(), of_row.end());
    return values;
  };
  for (const FmiVersion version : kVersions) {
    const Importer host(fmu, version);
    ASSERT_EQ(host.initialize(), kFmiOk);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      set_pose(host, "rock", poses, i);
      EXPECT_EQ(host.get("rock.stiffness"), flat(hydrostatics[i].stiffness));
      EXPECT_EQ(host.get("rock.added_mass"), flat(loads[i].added_mass));
      EXPECT_EQ(host.get("rock.damping"), flat(loads[i].damping));
    }
  }
}

TEST(Fmu, TakesWaterFromParameters) {
  const std::string changed_water =
      "[world]\ngravity = 3.7\n[water]\nlevel = -0.5\ndensity = 800\n[water.current]\nvelocity = [1, 2, 0]\n";
  for (const bool in_waves : {false, true}) {
    const std::string waves = in_waves ? kWaves : "[water]\n";
    std::string changed = waves;
    if (in_waves) {
      changed.replace(changed.find("0.25"), 4, "-0.5\ndensity = 800");
      changed.replace(changed.find("0.3, 0.1, 0"), 11, "1, 2, 0");
      changed.insert(0, "[world]\ngravity = 3.7\n");
    } else {
      changed = changed_water;
    }
    const UnpackedFmu fmu(waves + kRock + kLoads);
    const Scene scene = scene_of(changed + kRock + kLoads);
    const PoseTable poses = timed_poses(30);
    WrenchTable expected(poses.size());
    evaluate_poses(scene.bodies().front(), water_of(scene), poses.arrays(), expected.arrays());
    for (const FmiVersion version : kVersions) {
      const Importer host(fmu, version);
      ASSERT_EQ(host.set("water.level", {-0.5}), kFmiOk);
      ASSERT_EQ(host.set("water.density", {800.0}), kFmiOk);
      EXPECT_EQ(host.set("water.density", {-1.0}), kFmiError);
      ASSERT_EQ(host.enter_initialization(), kFmiOk);
      ASSERT_EQ(host.set("water.gravity", {3.7}), kFmiOk);
      ASSERT_EQ(host.set("water.current", {1.0, 2.0, 0.0}), kFmiOk);
      ASSERT_EQ(host.call("ExitInitializationMode"), kFmiOk);
      EXPECT_TRUE(wrenches_of(host, "rock", poses) == expected) << changed;
      EXPECT_EQ(host.set("water.level", {0.0}), kFmiError);
    }
  }
}

TEST(Fmu, TakesConditionOfCompartmentsAndTanks) {
  const UnpackedFmu fmu(kFerry);
  std::string changed = kFerry;
  changed.replace(changed.find("0.5\n"), 3, "1.0");
  changed.replace(changed.find("fill = 0.25"), 11, "liquid_volume = 3.5");
  const Scene scene = scene_of(changed);
  const PoseTable poses = timed_poses(30);
  WrenchTable expected(poses.size());
  evaluate_poses(scene.bodies().front(), water_of(scene), poses.arrays(), expected.arrays());
  const std::string ferry = "_8_m_ferry___A_B_";
  for (const FmiVersion version : kVersions) {
    const Importer host(fmu, version);
    ASSERT_EQ(host.initialize(), kFmiOk);
    EXPECT_THAT(host.get(ferry + ".compartment[1].flooded"), ElementsAre(0.5));
    EXPECT_THAT(host.get(ferry + ".tank[1].liquid_volume"), ElementsAre(1.0));
    ASSERT_EQ(host.set(ferry + ".compartment[1].flooded", {1.0}), kFmiOk);
    ASSERT_EQ(host.set(ferry + ".tank[1].liquid_volume", {3.5}), kFmiOk);
    EXPECT_TRUE(wrenches_of(host, ferry, poses) == expected);
    ASSERT_EQ(host.set(ferry + ".tank[1].liquid_volume", {4.5}), kFmiOk);  // it holds 4 m^3
    EXPECT_EQ(host.status_of(ferry), static_cast<int>(BodyStatus::kBadCondition));
  }
}

TEST(Fmu, HasBodiesThatAreChosen) {
  const std::string other =
      "[[body]]\nid = 4\nname = \"rock\"\nshape = { type = \"box\", size = [1, 1, 1] }\n";
  EXPECT_EQ(UnpackedFmu(kRock + other).table().variables().back().name, "rock_4.torque_error_bound");
  const UnpackedFmu fmu(kRock + other, {"4"});
  const Importer host(fmu, FmiVersion::k3);
  ASSERT_EQ(host.initialize(), kFmiOk);
  ASSERT_EQ(host.set("rock.position", {0.0, 0.0, -5.0}), kFmiOk);
  EXPECT_THAT(host.get("rock.submerged_volume"), ElementsAre(1.0));
}

TEST(Fmu, ReportsInvalidInputOnce) {
  const UnpackedFmu fmu(kRock);
  for (const FmiVersion version : kVersions) {
    Importer host(fmu, version);
    ASSERT_EQ(host.initialize(), kFmiOk);
    ASSERT_EQ(host.set("rock.position", {0.0, std::nan(""), 0.0}), kFmiOk);
    std::vector<double> force;
    EXPECT_EQ(host.get("rock.force", force), kFmiWarning);
    EXPECT_THAT(force, ElementsAre(0.0, 0.0, 0.0));
    EXPECT_EQ(host.get("rock.force", force), kFmiOk);
    EXPECT_EQ(host.status_of("rock"), static_cast<int>(BodyStatus::kNonFinitePose));
    ASSERT_EQ(host.set("rock.position", {0.0, std::nan(""), 1.0}), kFmiOk);
    EXPECT_EQ(host.get("rock.force", force), kFmiOk);
    EXPECT_THAT(host.log,
                ElementsAre(HasSubstr("logStatusWarning: body 3 (rock) has the status NON_FINITE_POSE")));
    ASSERT_EQ(host.set("rock.position", {0.0, 0.0, 0.0}), kFmiOk);
    ASSERT_EQ(host.set("rock.quaternion", {0.0, 0.0, 0.0, 0.0}), kFmiOk);
    EXPECT_EQ(host.get("rock.force", force), kFmiWarning);
    EXPECT_THAT(host.log.back(), HasSubstr("BAD_QUATERNION"));
  }
}

TEST(Fmu, RefusesWrongToken) {
  const UnpackedFmu fmu(kRock);
  for (const FmiVersion version : kVersions) {
    Importer host(fmu, version);
    host.free();
    host.instantiate("another");
    EXPECT_EQ(host.instance(), nullptr);
    EXPECT_THAT(host.log.back(), HasSubstr("'another'"));
  }
}

TEST(Fmu, FollowsStateMachine) {
  const UnpackedFmu fmu(kRock);
  for (const FmiVersion version : kVersions) {
    const Importer host(fmu, version);
    std::vector<double> force;
    const auto is_refused = [&](const std::vector<std::function<int()>>& calls) {
      for (std::size_t i = 0; i < calls.size(); ++i) EXPECT_EQ(calls[i](), kFmiError) << "call " << i;
    };
    const auto get = [&] { return host.get("rock.force", force); };
    const auto step = [&] { return host.step(0.0, 1.0); };
    const auto enter = [&] { return host.enter_initialization(); };
    const auto exit = [&] { return host.call("ExitInitializationMode"); };
    const auto terminate = [&] { return host.call("Terminate"); };
    const auto set = [&] { return host.set("rock.position", {0.0, 0.0, 0.5}); };
    const auto set_output = [&] { return host.set("rock.force", {0.0, 0.0, 0.5}); };
    is_refused({get, step, exit, terminate, set_output});
    EXPECT_EQ(set(), kFmiOk);
    EXPECT_EQ(enter(), kFmiOk);
    is_refused({step, enter, terminate, set_output});
    EXPECT_EQ(get(), kFmiOk);
    EXPECT_EQ(set(), kFmiOk);
    EXPECT_EQ(exit(), kFmiOk);
    is_refused({enter, exit, set_output});
    EXPECT_EQ(step(), kFmiOk);
    EXPECT_EQ(host.step(1.0, std::nan("")), kFmiError);
    EXPECT_THAT(host.get("time"), ElementsAre(1.0));
    EXPECT_EQ(set(), kFmiOk);
    EXPECT_EQ(terminate(), kFmiOk);
    is_refused({enter, exit, set, step, terminate});
    EXPECT_EQ(get(), kFmiOk);
    EXPECT_EQ(host.call("Reset"), kFmiOk);
    EXPECT_EQ(host.initialize(2.5), kFmiOk);
    EXPECT_THAT(host.get("time"), ElementsAre(2.5));
    EXPECT_THAT(host.get("rock.position"), ElementsAre(0.0, 0.0, 0.0));
  }
}

TEST(Fmu, MovesOutputsByInputsAndTimeAlone) {
  const UnpackedFmu fmu(kWaves + kRock);
  for (const FmiVersion version : kVersions) {
    const Importer host(fmu, version);
    ASSERT_EQ(host.initialize(20.0), kFmiOk);
    const std::vector<double> at_20 = host.get("rock.force");
    ASSERT_EQ(host.step(20.0, 0.5), kFmiOk);
    EXPECT_NE(host.get("rock.force"), at_20);
    ASSERT_EQ(host.step(20.5, -0.5), kFmiOk);
    EXPECT_EQ(host.get("rock.force"), at_20);
    ASSERT_EQ(host.set("rock.position", {0.0, 0.0, 0.1}), kFmiOk);
    EXPECT_NE(host.get("rock.force"), at_20);
  }
}

TEST(Fmu, SavesAndRestoresStates) {
  const UnpackedFmu fmu(kWaves + kRock);
  const PoseTable poses = timed_poses(3);
  for (const FmiVersion version : kVersions) {
    const Importer host(fmu, version);
    const std::string state_name = version == FmiVersion::k2 ? "FMUstate" : "FMUState";
    ASSERT_EQ(host.initialize(), kFmiOk);
    set_pose(host, "rock", poses, 1);
    ASSERT_EQ(host.step(0.0, 20.0), kFmiOk);
    const std::vector<double> force = host.get("rock.force");
    void* state = nullptr;
    ASSERT_EQ(host.call("Get" + state_name, &state), kFmiOk);
    const auto disturb = [&] {
      set_pose(host, "rock", poses, 2);
      ASSERT_EQ(host.step(20.0, 3.0), kFmiOk);
      ASSERT_NE(host.get("rock.force"), force);
    };
    disturb();
    ASSERT_EQ(host.call("Set" + state_name, state), kFmiOk);
    EXPECT_EQ(host.get("rock.force"), force);
    EXPECT_THAT(host.get("time"), ElementsAre(20.0));

    std::size_t size = 0;
    ASSERT_EQ(host.call("Serialized" + state_name + "Size", state, &size), kFmiOk);
    std::vector<std::uint8_t> bytes(size);
    ASSERT_EQ(host.call("Serialize" + state_name, state, bytes.data(), bytes.size()), kFmiOk);
    ASSERT_EQ(host.call("Free" + state_name, &state), kFmiOk);
    EXPECT_EQ(state, nullptr);
    const std::string deserialize = (version == FmiVersion::k2 ? "DeSerialize" : "Deserialize") + state_name;
    const Importer other(fmu, version);
    const std::uint8_t* const data = bytes.data();
    ASSERT_EQ(other.call(deserialize, data, bytes.size(), &state), kFmiOk);
    ASSERT_EQ(other.call("Set" + state_name, state), kFmiOk);
    EXPECT_EQ(other.get("rock.force"), force);
    EXPECT_EQ(host.call("Set" + state_name, state), kFmiError);  // a state of the other instance
    EXPECT_EQ(other.call(deserialize, data, bytes.size() - 1, &state), kFmiError);
    bytes.front() ^= 1U;
    EXPECT_EQ(other.call(deserialize, data, bytes.size(), &state), kFmiError);
  }
}

// The same heave: by a loop around the FMU, and by buoyancy-client.
TEST(Fmu, HeavesAsClientDoes) {
  const std::string text =
      "[[body]]\nid = 1\nname = \"box\"\nshape = { type = \"box\", size = [1, 1, 0.5] }\n"
      "[body.client]\nmass = 256.25\nposition = [0, 0, 0.2]\n";
  const TempDir dir;
  ChildProcess client(
      command_of({built_program("buoyancy-client"), "--embedded", "--scene", dir.write("scene.toml", text),
                  "--duration", "5", "--step", "0.01", "--csv", dir.path("run.csv")}));
  ASSERT_EQ(client.wait(kRunTimeout), 0) << client.standard_error();
  const std::vector<double> heights = csv_column(read_file(dir.path("run.csv")), "pz");
  ASSERT_GT(heights.size(), 400U);

  const UnpackedFmu fmu(text);
  const Importer host(fmu, FmiVersion::k3);
  ASSERT_EQ(host.initialize(), kFmiOk);
  constexpr double kStep = 0.01;
  double z = 0.2, velocity = 0.0;
  const auto kick = [&] {
    ASSERT_EQ(host.set("box.position", {0.0, 0.0, z}), kFmiOk);
    velocity += 0.5 * kStep * (host.get("box.force")[2] / 256.25 - 9.80665);
  };
  for (std::size_t i = 0; i < heights.size(); ++i) {
    EXPECT_NEAR(z, heights[i], 1e-12) << "step " << i;
    kick();
    z += kStep * velocity;
    ASSERT_EQ(host.step(static_cast<double>(i) * kStep, kStep), kFmiOk);
    kick();
  }
}

// The largest difference of two vectors over the largest value of the second.
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0, scale = 1e-3;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, std::abs(a[i] - b[i]));
    scale = std::max(scale, std::abs(b[i]));
  }
  return largest / scale;
}

TEST(Fmu, HasDirectionalDerivatives) {
  const struct {
    std::string text;
    std::vector<std::string> inputs;
  } cases[] = {{kRock, {"position", "quaternion", "linear_velocity"}},
               {kRock + kLoads, {"linear_velocity", "angular_velocity"}}};
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (const auto& [text, inputs] : cases) {
    const UnpackedFmu fmu(text);
    EXPECT_TRUE(fmu.model().has_derivatives);
    PoseTable poses = timed_poses(8);
    for (std::size_t i = 0; i < poses.size(); ++i) poses.positions[3 * i + 2] *= 0.3;  // at the surface
    for (const FmiVersion version : kVersions) {
      const Importer host(fmu, version);
      ASSERT_EQ(host.initialize(), kFmiOk);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        for (const std::string& input : inputs) {
          set_pose(host, "rock", poses, i);
          const std::string known = "rock." + input;
          const std::vector<double> at = host.get(known);
          std::vector<double> seed;
          for (std::size_t k = 0; k < at.size(); ++k) seed.push_back(unit(random));
          if (input == "quaternion") {  // along the sphere
            double along = 0.0;
            for (std::size_t k = 0; k < 4; ++k) along += seed[k] * at[k];
            for (std::size_t k = 0; k < 4; ++k) seed[k] -= along * at[k];
          }
          for (const char* const unknown : {"rock.force", "rock.torque"}) {
            std::vector<double> exact, numeric(3);
            ASSERT_EQ(host.derivative(unknown, known, seed, exact), kFmiOk)
                << testing::PrintToString(host.log);
            constexpr double kStep = 1e-5;
            for (const double sign : {1.0, -1.0}) {
              std::vector<double> moved = at;
              for (std::size_t k = 0; k < at.size(); ++k) moved[k] += sign * kStep * seed[k];
              ASSERT_EQ(host.set(known, moved), kFmiOk);
              const std::vector<double> value = host.get(unknown);
              for (std::size_t k = 0; k < 3; ++k) numeric[k] += sign * value[k] / (2.0 * kStep);
            }
            ASSERT_EQ(host.set(known, at), kFmiOk);
            EXPECT_LT(difference(exact, numeric), 1e-5) << unknown << " by " << known << ", pose " << i;
          }
        }
      }
    }
  }
}

TEST(Fmu, RefusesDerivativesThatItDoesNotHave) {
  std::vector<double> out;
  const UnpackedFmu with_loads(kRock + kLoads);
  const Importer moving(with_loads, FmiVersion::k3);
  ASSERT_EQ(moving.initialize(), kFmiOk);
  EXPECT_EQ(moving.derivative("rock.force", "rock.position", {1.0, 0.0, 0.0}, out), kFmiError);
  EXPECT_EQ(moving.derivative("rock.submerged_volume", "rock.linear_velocity", {1.0, 0.0, 0.0}, out),
            kFmiError);
  const UnpackedFmu in_waves(kWaves + kRock);
  EXPECT_FALSE(in_waves.model().has_derivatives);
  const Importer host(in_waves, FmiVersion::k2);
  ASSERT_EQ(host.initialize(), kFmiOk);
  EXPECT_EQ(host.derivative("rock.force", "rock.position", {1.0, 0.0, 0.0}, out), kFmiError);
}

TEST(Fmu, RunsInstancesOnTwoThreads) {
  const UnpackedFmu fmu(kWaves + kRock + kLoads);
  const PoseTable poses = timed_poses(200);
  const Importer alone(fmu, FmiVersion::k3);
  ASSERT_EQ(alone.initialize(), kFmiOk);
  const WrenchTable expected = wrenches_of(alone, "rock", poses);
  std::array<bool, 2> equal{};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < equal.size(); ++i) {
    threads.emplace_back([&, i] {
      const Importer host(fmu, FmiVersion::k3);  // of the same library
      equal[i] = host.initialize() == kFmiOk && wrenches_of(host, "rock", poses) == expected;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(equal, ElementsAre(true, true));
}

// Makes one call with arguments that may be wrong, and returns its status.
int random_call(Importer& host, const VariableTable& table, std::mt19937_64& random,
                std::vector<void*>& states) {
  const auto pick = [&random](std::size_t count) { return random() % count; };
  const bool is_2 = host.version() == FmiVersion::k2;
  const std::size_t count = pick(6);
  std::size_t total = 0;  // number of values
  std::array<std::uint32_t, 5> references{};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t value = pick(33);  // the matrices follow
    const Variable& variable = *table.owner(value);
    references[i] = static_cast<std::uint32_t>(is_2 ? value : variable.first);
    total += is_2 ? 1 : variable.size;
    if (pick(50) == 0) references[i] = static_cast<std::uint32_t>(random());
  }
  std::array<double, 20> values;
  for (double& value : values) {
    constexpr std::array kSpecial{0.0, 1.0, std::numeric_limits<double>::infinity(), 1e300, -1e-310};
    value = pick(4) == 0 ? kSpecial[pick(kSpecial.size())] : static_cast<double>(pick(2001)) * 1e-3 - 1.0;
    if (pick(40) == 0) value = std::nan("");
  }
  std::array<std::int32_t, 20> integers{};
  std::array<std::uint8_t, 2000> bytes;
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  const std::string state_name = is_2 ? "FMUstate" : "FMUState";
  const std::size_t value_count = pick(10) == 0 ? pick(values.size()) : total;
  const std::uint32_t* const of = pick(30) == 0 ? nullptr : references.data();
  const double* const read = pick(30) == 0 ? nullptr : values.data();
  double* const written = pick(30) == 0 ? nullptr : values.data();
  void* state = states.empty() ? nullptr : states[pick(states.size())];
  if (pick(20) == 0) state = &values;
  std::size_t size = pick(bytes.size());
  switch (pick(16)) {
    case 0:
      return host.enter_initialization(values[0]);
    case 1:
      return host.call("ExitInitializationMode");
    case 2:
      return pick(8) == 0 ? host.call("Terminate") : kFmiOk;
    case 3:
      return host.call("Reset");
    case 4:
    case 5:
      return is_2 ? host.call("SetReal", of, count, read)
                  : host.call("SetFloat64", of, count, read, value_count);
    case 6:
    case 7:
      return is_2 ? host.call("GetReal", of, count, written)
                  : host.call("GetFloat64", of, count, written, value_count);
    case 8:
      return is_2 ? host.call("GetInteger", of, count, integers.data())
                  : host.call("GetInt32", of, count, integers.data(), value_count);
    case 9:
      return host.step(values[0], values[1]);
    case 10: {
      void* saved = nullptr;
      const int status = host.call("Get" + state_name, &saved);
      if (states.size() < 10) {
        states.push_back(saved);
      } else {
        host.call("Free" + state_name, &saved);
      }
      return status;
    }
    case 11:
      return host.call("Set" + state_name, state);
    case 12:
      return pick(2) == 0 ? host.call("Serialize" + state_name, state, bytes.data(), size)
                          : host.call("Serialized" + state_name + "Size", state, &size);
    case 13: {
      void* made = nullptr;
      const std::uint8_t* const data = bytes.data();
      return host.call((is_2 ? "DeSerialize" : "Deserialize") + state_name, data, size, &made);
    }
    case 14:
      return is_2 ? host.call("GetDirectionalDerivative", of, count, of, count, read, written)
                  : host.call("GetDirectionalDerivative", of, count, of, count, read, value_count, written,
                              value_count);
    default: {
      void* freed = state;
      return pick(5) == 0 ? host.call("Free" + state_name, &freed)
                          : host.call(is_2 ? "CancelStep" : "EnterEventMode");
    }
  }
}

TEST(Fmu, SurvivesRandomCalls) {
  for (const FmiVersion version : kVersions) {
    const UnpackedFmu fmu(kSwell + kRock + kLoads);
    Importer host(fmu, version);
    std::mt19937_64 random(64);
    std::vector<void*> states;
    std::array<int, 4> counts{};
    for (int i = 0; i < 100'000; ++i) {
      const int status = random_call(host, fmu.table(), random, states);
      ASSERT_TRUE(status >= kFmiOk && status <= kFmiError) << status;
      ++counts[static_cast<std::size_t>(status)];
      host.log.clear();
    }
    EXPECT_GT(counts[kFmiOk], 10'000);
    EXPECT_GT(counts[kFmiWarning], 100);
    EXPECT_GT(counts[kFmiError], 10'000);
    void* const freed = host.instance();
    host.free();
    EXPECT_EQ(host.function<int(void*)>("Reset")(freed), kFmiError);
    EXPECT_EQ(host.call("Reset"), kFmiError);  // nullptr
  }
}

}  // namespace
}  // namespace buoyancy::fmu
