#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_report.h"
#include "tests/scene/scene_texts.h"

namespace buoyancy {
namespace {

Scene prepared(const std::string& text) {
  Expected<Scene> scene = Scene::prepare(parse(text).value());
  return *std::move(scene);
}

std::vector<std::string> warnings_of(const std::string& text) {
  std::vector<std::string> messages;
  for (const Warning& warning : scene_warnings(prepared(text))) messages.push_back(warning.message());
  return messages;
}

void expect_one_warning(const std::string& text, const std::string& start) {
  const std::vector<std::string> warnings = warnings_of(text);
  ASSERT_EQ(warnings.size(), 1U) << (warnings.empty() ? "none" : warnings[1]);
  EXPECT_EQ(warnings[0].rfind(start, 0), 0U) << warnings[0];
}

TEST(CoefficientWarnings, DoesNotWarnAboutUsualCoefficients) {
  EXPECT_TRUE(warnings_of(kVehicleScene).empty());
  // A plate of 1 m and 1 mm: the water that moves with it is 800 times what it displaces.
  EXPECT_TRUE(warnings_of("[[body]]\nid = 7\nshape = { type = \"box\", size = [1, 1, 0.001] }\n"
                          "[body.added_mass]\nmatrix = [0, 0, 820, 0, 0, 0]\n")
                  .empty());
}

TEST(CoefficientWarnings, WarnsAboutDragThatCanDriveTheBody) {
  const auto full = [](const char* coupling) {
    return scene_with_crate(
        "[body.drag]\nquadratic = [1, 0, 0, 0, 0, 0, " + std::string(coupling) +
        ", 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, "
        "0, 1]\n");
  };
  EXPECT_TRUE(warnings_of(full("0.1")).empty());
  expect_one_warning(full("1.99"),
                     "pool.toml: body 7: [body.drag] quadratic drives the body at a twist of [");
}

TEST(CoefficientWarnings, WarnsAboutMethodsWithoutABoundInWaves) {
  const std::string body =
      "[water.waves]\ntype = \"regular\"\nheight = 0.1\nperiod = 8\n[[body]]\nid = 7\nshape = { type = "
      "\"box\" }\nmethod = \"fast_surface\"\n";
  EXPECT_TRUE(warnings_of(body).empty());
  expect_one_warning(
      body + "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\n",
      "pool.toml: body 7: method = \"fast_surface\" with drag or added mass in waves; expected "
      "\"hierarchical\"");
}

TEST(CoefficientWarnings, WarnsAboutCentersFarFromTheMesh) {
  const auto at = [](const char* center) {
    return scene_with_crate("[body.added_mass]\nmatrix = [1, 1, 1, 1, 1, 1]\ncenter = [0, 0, " +
                            std::string(center) + "]\n");
  };
  EXPECT_TRUE(warnings_of(at("2.2")).empty()) << "the box ends at 0.5 m and its diagonal is 1.73 m";
  expect_one_warning(at("2.3"),
                     "pool.toml: body 7: [body.added_mass] center = [0, 0, 2.3] is 1.8 m from the mesh");
}

TEST(CoefficientWarnings, WarnsAboutCoefficientsOfAnotherSize) {
  expect_one_warning(
      scene_with_crate("[body.added_mass]\nmatrix = [1, 110000, 1, 1, 1, 1]\n"),
      "pool.toml: body 7: [body.added_mass] matrix y = 110000 kg; expected at most 100 times the "
      "displaced water: 1.025e+05 kg for this mesh");
  expect_one_warning(
      scene_with_crate("[body.drag]\nquadratic = [1, 1, 1, 1, 1, 1e8]\n"),
      "pool.toml: body 7: [body.drag] quadratic about z = 100000000 N m/(rad/s)^2; expected a drag "
      "coefficient of at most 100");
}

TEST(CoefficientWarnings, WarnsAboutEqualBodiesOnce) {
  const std::string drag = "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\ncenter = [0, 0, 9]\n";
  const std::string second = "[[body]]\nid = 8\nshape = { type = \"box\" }\n";
  expect_one_warning(scene_with_crate(drag) + second + drag,
                     "pool.toml: body 7 and 1 other: [body.drag] center");
}

}  // namespace
}  // namespace buoyancy
