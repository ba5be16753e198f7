// [water.current], [body.drag] and [body.added_mass] of scene files.

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string drag(const std::string& keys) {
  return scene_with_crate("[body.drag]\n" + keys + "\n");
}
std::string added_mass(const std::string& keys) {
  return scene_with_crate("[body.added_mass]\n" + keys + "\n");
}

// A matrix of 36 numbers: this diagonal, and one more element.
std::string matrix(const std::vector<double>& diagonal, int row, int column, double value) {
  std::string text = "[";
  for (int i = 0; i < 36; ++i) {
    double number = i / 6 == i % 6 ? diagonal[static_cast<std::size_t>(i % 6)] : 0.0;
    if (i == 6 * row + column) number = value;
    text += std::to_string(number) + ", ";
  }
  return text + "]";
}

TEST(LoadsToml, ReadsEveryKey) {
  const SceneDescription scene = parsed(
      "[water.current]\nvelocity = [0.5, 0, -0.1]\n"
      "[[body]]\nid = 7\nshape = { type = \"box\" }\noutputs = [\"wrench\", \"loads\"]\n"
      "[body.drag]\nlinear = [20, 60, 61, 5, 6, 8]\nquadratic = [18, 22, 37, 1.5, 1.6, 1.7]\n"
      "center = [0.1, 0.2, 0.3]\nimmersion = \"wetted_area\"\n"
      "[body.added_mass]\nmatrix = " +
      matrix({5, 126, 127, 0.1, 33, 34}, 1, 1, 128) + "\ncenter = [1, 2, 3]\nimmersion = \"none\"\n");
  EXPECT_EQ(scene.sea.current_W, Vec3(0.5, 0.0, -0.1));
  const BodyDescription& body = scene.bodies[0];
  EXPECT_TRUE(body.loads);
  EXPECT_FALSE(body.hydrostatics);
  EXPECT_EQ(body.drag->linear.diagonal(), Vec6(20, 60, 61, 5, 6, 8));
  EXPECT_EQ(body.drag->quadratic.diagonal(), Vec6(18, 22, 37, 1.5, 1.6, 1.7));
  EXPECT_EQ(body.drag->center_B, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(body.drag->immersion, ImmersionScaling::kWettedArea);
  EXPECT_EQ(body.added_mass->matrix, Mat6(Vec6(5, 128, 127, 0.1, 33, 34).asDiagonal()));
  EXPECT_EQ(body.added_mass->center_B, Vec3(1, 2, 3));
  EXPECT_EQ(body.added_mass->immersion, ImmersionScaling::kNone);
}

TEST(LoadsToml, ReadsAMatrixRowByRow) {
  const SceneDescription scene = parsed(drag("linear = " + matrix({9, 9, 9, 9, 9, 9}, 1, 5, 4)));
  EXPECT_EQ(scene.bodies[0].drag->linear(1, 5), 4.0);
  EXPECT_EQ(scene.bodies[0].drag->linear(5, 1), 0.0);
  EXPECT_EQ(scene.bodies[0].drag->quadratic, Mat6(Mat6::Zero()));
  EXPECT_EQ(scene.bodies[0].drag->immersion, ImmersionScaling::kVolume);
  EXPECT_EQ(scene.bodies[0].drag->center_B, std::nullopt);
}

TEST(LoadsToml, TablesMayBeLeftOut) {
  const auto scene = parse(scene_with_crate());
  ASSERT_TRUE(scene);
  EXPECT_EQ(scene->sea.current_W, Vec3(Vec3::Zero()));
  EXPECT_FALSE(scene->bodies[0].drag);
  EXPECT_FALSE(scene->bodies[0].added_mass);
  EXPECT_FALSE(scene->bodies[0].loads);
}

TEST(LoadsToml, RejectsWrongInputWithFileAndLine) {
  const std::vector<double> ones{1, 1, 1, 1, 1, 1};
  expect_parse_errors({
      {drag("linear = [1, 2, 3]"),
       "pool.toml:5: body 7, [body.drag]: linear = [1, 2, 3]; expected an array of 6 or 36 finite numbers"},
      {drag("quadratic = [1, 2, 3, 4, 5, nan]"), "expected an array of 6 or 36 finite numbers (N/(m/s)^2"},
      {drag("linear = [1, 2, 3, 4, 5, \"6\"]"), "expected an array of 6 or 36 finite numbers"},
      {drag("linear = 3"), "linear = 3; expected an array of 6 or 36 finite numbers"},
      {drag("linear = [-4, 2, 3, 4, 5, 6]"),
       "expected no negative number on the diagonal (here row 1, column 1 is -4). Likely cause: the sign "
       "convention of another program. Negate: here positive numbers oppose the motion and add inertia; "
       "gz-sim and Fossen write the other sign."},
      {drag("quadratic = [4, 2, 3, 4, 5, -6]"), "here row 6, column 6 is -6"},
      {drag("linear = " + matrix(ones, 0, 1, 2.5)), "symmetric part is positive semidefinite"},
      {drag("immersion = \"volum\"\nlinear = [1, 1, 1, 1, 1, 1]"), "The nearest is 'volume'"},
      {drag("center = [0, 0]\nlinear = [1, 1, 1, 1, 1, 1]"), "expected an array of 3 finite numbers (m)"},
      {drag("lineer = [1, 1, 1, 1, 1, 1]"), "nearest known key is 'linear'"},
      {drag("center = [0, 0, 0]"), "pool.toml:4: body 7, [body.drag]: neither 'linear' nor 'quadratic'"},
      {added_mass("matrix = [5, 126, 126, 0.1, 33]"), "expected an array of 6 or 36 finite numbers (kg"},
      {added_mass("matrix = [5, -126, 126, 0.1, 33, 33]"), "gz-sim and Fossen write the other sign"},
      {added_mass("matrix = [5, inf, 126, 0.1, 33, 33]"), "finite numbers"},
      {added_mass("matrix = " + matrix(ones, 0, 1, 0.5)), "pool.toml:5: body 7, [body.added_mass]: matrix ="},
      {added_mass("matrix = " + matrix(ones, 0, 1, 0.5)),
       "expected a symmetric matrix (row 2, column 1 is 0, "},
      {added_mass("center = [0, 0, 0]"), "no key 'matrix'; expected 6 numbers (a diagonal) or 36"},
      {added_mass("matrx = [1, 1, 1, 1, 1, 1]"), "nearest known key is 'matrix'"},
      {scene_with_crate("drag = 3\n"), "pool.toml:4: body 7: drag = 3; expected a table"},
      {scene_with_crate("[water.current]\nspeed = 1\n"),
       "pool.toml:5: [water.current]: unknown key 'speed'; expected one of velocity, profile."},
      {scene_with_crate("[water.current]\n"), "pool.toml:4: [water.current]: no key 'velocity'"},
      {scene_with_crate("[water.current]\nvelocity = [1, 2]\n"),
       "expected an array of 3 finite numbers (m/s)"},
      {scene_with_crate("[water.current]\nvelocity = [1, 2, nan]\n"), "3 finite numbers (m/s)"},
      {scene_with_crate("[water]\ncurrent = [1, 0, 0]\n"), "current = [1, 0, 0]; expected a table"},
  });
}

TEST(LoadsToml, RecognisesKeysOfOtherPrograms) {
  for (const char* key : {"xU", "xUU", "xUabsU", "xUabsV", "nRabsR", "kPabsP", "Z_w", "X_u"}) {
    EXPECT_THAT(parse_error(drag(std::string(key) + " = -5.0")),
                AllOf(StartsWith("pool.toml:5: body 7, [body.drag]: " + std::string(key) +
                                 " = -5.0; expected linear and quadratic, each 6 numbers"),
                      HasSubstr("Negate")));
  }
  for (const char* key : {"xDotU", "nDotR", "zDotQ", "X_udot"}) {
    EXPECT_THAT(parse_error(added_mass(std::string(key) + " = -5.0")),
                HasSubstr("expected matrix, 6 numbers"));
  }
  EXPECT_THAT(parse_error(drag("matrix = [1, 1, 1, 1, 1, 1]")), HasSubstr("unknown key 'matrix'"));
}

// The two tables obey the same rules, each without the other.
struct LoadTable {
  std::string section, text;
  Vec3 (*center_B)(const HydrodynamicCoefficients&);
};

class SceneWithLoads : public testing::TestWithParam<LoadTable> {};
INSTANTIATE_TEST_SUITE_P(
    DragAndAddedMass, SceneWithLoads,
    testing::Values(LoadTable{"[body.drag]", "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\n",
                              [](const HydrodynamicCoefficients& c) { return c.drag->center_B; }},
                    LoadTable{"[body.drag]", "[body.drag]\nquadratic = [1, 1, 1, 1, 1, 1]\n",
                              [](const HydrodynamicCoefficients& c) { return c.drag->center_B; }},
                    LoadTable{"[body.added_mass]", "[body.added_mass]\nmatrix = [1, 1, 1, 1, 1, 1]\n",
                              [](const HydrodynamicCoefficients& c) { return c.added_mass->center_B; }}));

TEST_P(SceneWithLoads, TakesTheCentreOfMassOrTheCentroid) {
  const std::string cone = "[[body]]\nid = 7\nshape = { type = \"cone\" }\n" + GetParam().text;
  const auto center_of = [](const Scene& scene) {
    return GetParam().center_B(scene.bodies()[0].hydrodynamics->coefficients());
  };
  const Scene by_volume = scene_of(cone);
  EXPECT_TRUE(center_of(by_volume).isApprox(by_volume.meshes()[0]->mass_properties.centroid_B));
  EXPECT_GT(center_of(by_volume).norm(), 0.1);
  const std::string client = "[body.client]\ncenter_of_mass = [0.1, 0.2, 0.3]\n";
  EXPECT_EQ(center_of(scene_of(cone + client)), Vec3(0.1, 0.2, 0.3));
  const Scene given = scene_of(cone + "center = [1, 2, 3]\n" + client);
  EXPECT_EQ(center_of(given), Vec3(1, 2, 3));
  EXPECT_EQ(given.bodies_with_hydrodynamics(), 1U);
  EXPECT_EQ(given.bodies_with_loads(), 0U);
}

TEST_P(SceneWithLoads, RefusesWhatAnOpenMeshCannotGive) {
  const TempDir directory;
  directory.write("open.obj", kOpenObj);
  const auto error = [&](const std::string& keys) {
    return preparation_error(
        "[[body]]\nid = 7\nmesh = \"open.obj\"\nopen = \"dry_boundary\"\n" + GetParam().text + keys,
        directory.path());
  };
  const std::string center = "center = [0, 0, 0]\n";
  EXPECT_EQ(error(center), "pool.toml:1: body 7, " + GetParam().section +
                               ": immersion = \"volume\" with an open mesh; expected \"wetted_area\" or "
                               "\"none\". Likely cause: an open mesh encloses no volume that the submerged "
                               "one could be compared with. Set immersion, or close the mesh.");
  for (const std::string scaling : {"immersion = \"none\"\n", "immersion = \"wetted_area\"\n"}) {
    EXPECT_THAT(error(scaling), HasSubstr(GetParam().section + ": no center; expected center = [x, y, z]"));
    EXPECT_EQ(error(scaling + center), "accepted");
  }
}

TEST_P(SceneWithLoads, RefusesTheWettedAreaInWaves) {
  for (const std::string waves :
       {"{ type = \"regular\", height = 0.4, period = 4.0 }", "\"received\"", "[]"}) {
    const std::string water = "[water]\nwaves = " + waves + "\n";
    const auto error_with = [&](const std::string& immersion) {
      return preparation_error(water + scene_with_crate(GetParam().text + "immersion = " + immersion + "\n"));
    };
    const std::string error = error_with("\"wetted_area\"");
    if (waves == "[]") {
      EXPECT_EQ(error, "accepted");
    } else {
      EXPECT_THAT(error,
                  StartsWith("pool.toml:3: body 7: immersion = \"wetted_area\"; expected \"volume\" or "
                             "\"none\" in waves"));
    }
    for (const std::string other : {"\"volume\"", "\"none\""}) EXPECT_EQ(error_with(other), "accepted");
  }
}

// The tree over the mesh is what the wetted area is computed with, whatever the method.
TEST_P(SceneWithLoads, PreparesTheMeshForTheWettedArea) {
  const auto has_tree = [](const std::string& keys) {
    const Scene scene = scene_of(scene_with_crate("method = \"exact\"\n" + GetParam().text + keys));
    return static_cast<bool>(scene.meshes()[0]->mesh.tree);
  };
  EXPECT_TRUE(has_tree("immersion = \"wetted_area\"\n"));
  EXPECT_FALSE(has_tree(""));
}

}  // namespace
}  // namespace buoyancy
