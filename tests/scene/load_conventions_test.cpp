// The examples of docs/importing.md, "From another simulator": at random motions, the coefficients of another
// simulator give the same wrench in its own convention as the converted ones in ours. Both are read from the
// page, so that no number of it can be wrong unnoticed.
#include <array>
#include <cmath>
#include <random>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "scene/scene.h"
#include "tests/support/build_paths.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

constexpr int kMotions = 200;

// The first block of code in this language after the heading.
std::string block_after(const std::string& heading, const std::string& language) {
  const std::string page = read_file(source_dir() / "docs/importing.md");
  const std::size_t section = page.find("\n### " + heading + "\n");
  const std::string fence = "```" + language + "\n";
  const std::size_t begin = page.find(fence, section);
  const std::size_t end = page.find("```", begin + fence.size());
  if (section == std::string::npos || begin == std::string::npos || end == std::string::npos) return "";
  return page.substr(begin + fence.size(), end - begin - fence.size());
}

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  static const std::regex number(R"([-+]?\d+(\.\d+)?)");
  for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at) {
    numbers.push_back(std::stod(at->str()));
  }
  return numbers;
}

// The numbers of an XML element, or none.
std::vector<double> element(const std::string& xml, const std::string& name) {
  const std::string tag = "<" + name + ">";
  const std::size_t begin = xml.find(tag);
  if (begin == std::string::npos) return {};
  const std::size_t end = xml.find("</" + name + ">", begin);
  return numbers_in(xml.substr(begin + tag.size(), end - begin - tag.size()));
}

double element_or(const std::string& xml, const std::string& name, double missing) {
  const std::vector<double> numbers = element(xml, name);
  return numbers.empty() ? missing : numbers.at(0);
}

Vec6 to_vec6(const std::vector<double>& numbers) {
  Vec6 vector = Vec6::Constant(NAN);
  EXPECT_EQ(numbers.size(), 6U);
  if (numbers.size() == 6) vector = Eigen::Map<const Vec6>(numbers.data());
  return vector;
}

// What another simulator applies to a body, in its own axes: from a twist relative to the water and, for the
// inertia of added mass, from an acceleration.
struct Reaction {
  Vec6 drag = Vec6::Zero();
  Vec6 coriolis = Vec6::Zero();
  Vec6 inertia = Vec6::Zero();
};

// -C_A nu of a full matrix, written out as Kirchhoff's equations have it.
Vec6 minus_coriolis(const Mat6& added_mass, const Vec6& nu) {
  const Vec6 momentum = added_mass * nu;
  const Vec3 p = momentum.head<3>();
  Vec6 load;
  load << p.cross(nu.tail<3>()), p.cross(nu.head<3>()) + momentum.tail<3>().cross(nu.tail<3>());
  return load;
}

// Keys of gz-sim and VRX: per axis a letter of the force, and one of the velocity.
constexpr std::array<const char*, 6> kForce{"x", "y", "z", "k", "m", "n"};
constexpr std::array<const char*, 6> kVelocity{"U", "V", "W", "P", "Q", "R"};

std::string sname(std::size_t axis, const std::string& middle, bool twice = false) {
  const std::string velocity = kVelocity[axis];
  return kForce[axis] + (twice ? velocity : "") + middle + velocity;
}

// gz-sim: the force along an axis is (xU + xUabsU |u|) u + xDotU du/dt. The Coriolis terms are those of its
// path by fluid_added_mass, since those of xDotU have the wrong sign.
Reaction gz_sim(const std::string& xml, const Vec6& nu, const Vec6& acceleration) {
  Reaction reaction;
  Mat6 fluid_added_mass = Mat6::Zero();
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double derivative = element_or(xml, sname(axis, "Dot"), 0.0);
    reaction.drag[i] = (element_or(xml, sname(axis, ""), 0.0) +
                        element_or(xml, sname(axis, "abs", true), 0.0) * std::abs(nu[i])) *
                       nu[i];
    reaction.inertia[i] = derivative * acceleration[i];
    fluid_added_mass(i, i) = -derivative;
  }
  reaction.coriolis = minus_coriolis(fluid_added_mass, nu);
  return reaction;
}

// VRX: the force along an axis is -(xU + xUU |u|) u - xDotU du/dt, with defaults that are not 0.
Reaction vrx(const std::string& xml, const Vec6& nu, const Vec6& acceleration) {
  constexpr std::array kAddedMassDefaults{5.0, 5.0, 0.1, 0.1, 0.1, 1.0};
  Reaction reaction;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const double linear = element_or(xml, sname(axis, ""), 20.0);
    const double quadratic = element_or(xml, sname(axis, "", true), 0.0);
    const double added_mass = element_or(xml, sname(axis, "Dot"), kAddedMassDefaults[axis]);
    reaction.drag[i] = -(linear + quadratic * std::abs(nu[i])) * nu[i];
    reaction.inertia[i] = -added_mass * acceleration[i];
  }
  return reaction;
}

// From forward, left, up to forward, right, down, and back.
Vec6 flipped(Vec6 vector) {
  for (const Eigen::Index i : {1, 2, 4, 5}) vector[i] = -vector[i];
  return vector;
}

// uuv_simulator: in axes forward, right, down; damping negative, added mass positive.
Reaction uuv_simulator(const std::string& xml, const Vec6& nu, const Vec6& acceleration) {
  const std::vector<double> numbers = element(xml, "added_mass");
  EXPECT_EQ(numbers.size(), 36U);
  if (numbers.size() != 36) return {};
  const Mat6 added_mass = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(numbers.data());
  const Vec6 linear = to_vec6(element(xml, "linear_damping"));
  const Vec6 quadratic = to_vec6(element(xml, "quadratic_damping"));
  const Vec6 nu_there = flipped(nu);
  Reaction reaction;
  reaction.drag = flipped((linear + quadratic.cwiseProduct(nu_there.cwiseAbs())).cwiseProduct(nu_there));
  reaction.coriolis = flipped(minus_coriolis(added_mass, nu_there));
  reaction.inertia = flipped(-(added_mass * flipped(acceleration)));
  return reaction;
}

Vec6 yaml_numbers(const std::string& yaml, const std::string& key) {
  const std::size_t begin = yaml.find(" " + key + ": [");
  EXPECT_NE(begin, std::string::npos) << key;
  if (begin == std::string::npos) return Vec6::Constant(NAN);
  return to_vec6(numbers_in(yaml.substr(begin, yaml.find(']', begin) - begin)));
}

// MarineGym: in axes forward, right, down; all positive.
Reaction marine_gym(const std::string& yaml, const Vec6& nu, const Vec6& acceleration) {
  const Vec6 linear = yaml_numbers(yaml, "linear_damping");
  const Vec6 quadratic = yaml_numbers(yaml, "quadratic_damping");
  const Mat6 added_mass = yaml_numbers(yaml, "added_mass").asDiagonal();
  const Vec6 nu_there = flipped(nu);
  Reaction reaction;
  reaction.drag = flipped(-(linear + quadratic.cwiseProduct(nu_there.cwiseAbs())).cwiseProduct(nu_there));
  reaction.coriolis = flipped(minus_coriolis(added_mass, nu_there));
  reaction.inertia = flipped(-(added_mass * flipped(acceleration)));
  return reaction;
}

// A motion at random, in water that flows.
struct Motion {
  BodyMotion body;
  Vec3 current_W;
  Vec6 acceleration;  // in B's axes
};

Motion random_motion(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3{normal(random), normal(random), normal(random)}; };
  Motion motion;
  const Eigen::Quaterniond q{normal(random), normal(random), normal(random), normal(random)};
  motion.body = {q.normalized().toRotationMatrix(), 2.0 * vector(), vector()};
  motion.current_W = vector();
  motion.acceleration << vector(), vector();
  return motion;
}

Vec6 in_axes_of_world(const Vec6& wrench_B, const Mat3& R_WB) {
  Vec6 wrench_W;
  wrench_W << R_WB * wrench_B.head<3>(), R_WB * wrench_B.tail<3>();
  return wrench_W;
}

enum class Coriolis { kCompared, kNot };

// Compares the converted example with the original.
template <typename Simulator>
void expect_equal_wrenches(const std::string& heading, const std::string& language, Simulator simulator,
                           Coriolis coriolis = Coriolis::kCompared) {
  const std::string original = block_after(heading, language);
  const std::string converted = block_after(heading, "toml");
  ASSERT_FALSE(original.empty()) << heading;
  ASSERT_FALSE(converted.empty()) << heading;
  const Scene scene = scene_of(converted);
  const HydrodynamicModel* const model = scene.bodies().at(0).hydrodynamics;
  ASSERT_NE(model, nullptr);

  std::mt19937_64 random(23);
  for (int n = 0; n < kMotions; ++n) {
    const Motion motion = random_motion(random);
    const Mat3& R_WB = motion.body.R_WB;
    Vec6 nu;
    nu << R_WB.transpose() * (motion.body.velocity_W - motion.current_W),
        R_WB.transpose() * motion.body.angular_velocity_W;
    const Reaction there = simulator(original, nu, motion.acceleration);

    HydrodynamicState state;
    state.motion = motion.body;
    state.at_drag.water.velocity_W = state.at_added_mass.water.velocity_W = motion.current_W;
    HydrodynamicLoad here = model->load(state);
    const double scale = there.drag.norm() + there.coriolis.norm() + there.inertia.norm();
    EXPECT_LT((here.drag_W - in_axes_of_world(there.drag, R_WB)).norm(), 1e-12 * scale) << heading;

    const Mat6 added_mass_W = model->matrices(state).added_mass_W;
    const Vec6 inertia_W = -(added_mass_W * in_axes_of_world(motion.acceleration, R_WB));
    EXPECT_LT((inertia_W - in_axes_of_world(there.inertia, R_WB)).norm(), 1e-12 * scale) << heading;

    // The term of accelerated water is ours: a steady current accelerates in axes that turn.
    if (coriolis == Coriolis::kNot) continue;
    state.at_added_mass.water.velocity_W = Vec3::Zero();
    state.motion.velocity_W = motion.body.velocity_W - motion.current_W;
    here = model->load(state);
    EXPECT_LT((here.added_mass_W - in_axes_of_world(there.coriolis, R_WB)).norm(), 1e-12 * scale) << heading;
  }
}

TEST(LoadConventions, ExampleOfGzSimGivesItsWrench) {
  expect_equal_wrenches("gz-sim", "xml", gz_sim);
}

TEST(LoadConventions, ExampleOfGzSimHasItsCurrent) {
  const std::vector<double> there = element(block_after("gz-sim", "xml"), "default_current");
  ASSERT_EQ(there.size(), 3U);
  EXPECT_EQ(scene_of(block_after("gz-sim", "toml")).current_W(), Vec3(there[0], there[1], there[2]));
}

TEST(LoadConventions, ExampleOfVrxGivesItsWrench) {
  expect_equal_wrenches("VRX", "xml", vrx, Coriolis::kNot);
}

TEST(LoadConventions, ExampleOfUuvSimulatorGivesItsWrench) {
  expect_equal_wrenches("uuv_simulator", "xml", uuv_simulator);
}

TEST(LoadConventions, ExampleOfMarineGymGivesItsWrench) {
  expect_equal_wrenches("MarineGym", "yaml", marine_gym);
}

// What others write is refused with the hint that leads here.
TEST(LoadConventions, UnconvertedNumbersAreRefused) {
  const std::string body = "[[body]]\nid = 1\nshape = { type = \"box\" }\n";
  for (const char* const table : {"[body.drag]\nlinear = [-4.0, -6.2, -5.2, -0.07, -0.07, -0.07]",
                                  "[body.added_mass]\nxDotU = -5.5", "[body.drag]\nxUabsU = -18.2"}) {
    const Expected<SceneDescription> scene = parse_scene(body + table, "a.toml", {});
    ASSERT_FALSE(scene) << table;
    EXPECT_THAT(scene.error().message(), HasSubstr("Negate"));
  }
}

}  // namespace
}  // namespace buoyancy
