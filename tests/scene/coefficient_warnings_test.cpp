#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "scene/scene_report.h"
#include "tests/scene/scene_texts.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::vector<std::string> warnings_of(const std::string& text) {
  return messages_of(scene_warnings(prepared(text)));
}

void expect_one_warning(const std::string& text, const std::string& start) {
  EXPECT_THAT(warnings_of(text), ElementsAre(StartsWith(start)));
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
  for (const std::string table : {"[body.drag]\nlinear", "[body.added_mass]\nmatrix"}) {
    expect_one_warning(
        body + table + " = [1, 1, 1, 1, 1, 1]\n",
        "pool.toml: body 7: method = \"fast_surface\" with drag or added mass in waves; expected "
        "\"hierarchical\"");
  }
}

// A box of 1 x 2 x 3 m with one of the tables.
std::string slab(const std::string& table) {
  return "[[body]]\nid = 7\nshape = { type = \"box\", size = [1, 2, 3] }\n" + table + "\n";
}

TEST(CoefficientWarnings, WarnsAboutCentersFarFromTheMesh) {
  for (const auto& table : {std::pair{"[body.drag]", "linear"}, {"[body.added_mass]", "matrix"}}) {
    const auto at = [&](const Vec3& center) {
      return slab(std::string(table.first) + "\n" + table.second + " = [1, 1, 1, 1, 1, 1]\ncenter = [" +
                  format_vector(center) + "]");
    };
    // The faces are at 0.5, 1 and 1.5 m, and the diagonal is 3.742 m.
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        Vec3 center(0.4, -0.8, 1.2);
        center[axis] = side * (0.5 * (1 + axis) + 3.7);
        EXPECT_TRUE(warnings_of(at(center)).empty()) << center.transpose();
        center[axis] = side * (0.5 * (1 + axis) + 3.8);
        expect_one_warning(at(center), "pool.toml: body 7: " + std::string(table.first) + " center = [" +
                                           format_vector(center) + "] is 3.8 m from the mesh");
      }
    }
  }
}

TEST(CoefficientWarnings, WarnsAboutCoefficientsOfAnotherSize) {
  const std::array<std::string, 6> axes{"x", "y", "z", "about x", "about y", "about z"};
  const double mass = 1025.0 * 100.0 * 6.0;  // [kg], 100 times the displaced water
  const double drag = 100.0 * 0.5 * 1025.0 * 22.0;
  const double square = 14.0;  // [m^2], of the diagonal
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto with = [&](const std::string& table, double number) {
      Vec6 numbers = Vec6::Ones();
      numbers[static_cast<Eigen::Index>(axis)] = number;
      return slab(table + "[" + format_vector(numbers.head<3>()) + ", " + format_vector(numbers.tail<3>()) +
                  "]");
    };
    const std::string added_mass = "[body.added_mass]\nmatrix = ", quadratic = "[body.drag]\nquadratic = ";
    const double most_mass = axis < 3 ? mass : mass * square;
    const double most_drag = axis < 3 ? drag : drag * square * std::sqrt(square);
    EXPECT_TRUE(warnings_of(with(added_mass, 0.999 * most_mass)).empty()) << axes[axis];
    EXPECT_TRUE(warnings_of(with(quadratic, 0.999 * most_drag)).empty()) << axes[axis];
    EXPECT_THAT(
        warnings_of(with(added_mass, 1.001 * most_mass)),
        ElementsAre(AllOf(StartsWith("pool.toml: body 7: [body.added_mass] matrix " + axes[axis] + " = "),
                          HasSubstr("expected at most 100 times the displaced water: "))));
    EXPECT_THAT(
        warnings_of(with(quadratic, 1.001 * most_drag)),
        ElementsAre(AllOf(StartsWith("pool.toml: body 7: [body.drag] quadratic " + axes[axis] + " = "),
                          HasSubstr("expected a drag coefficient of at most 100"))));
  }
  expect_one_warning(
      scene_with_crate("[body.added_mass]\nmatrix = [1, 110000, 1, 1, 1, 1]\n"),
      "pool.toml: body 7: [body.added_mass] matrix y = 110000 kg; expected at most 100 times the "
      "displaced water: 1.025e+05 kg for this mesh");
}

TEST(CoefficientWarnings, WarnsAboutEqualBodiesOnce) {
  const std::string drag = "[body.drag]\nlinear = [1, 1, 1, 1, 1, 1]\ncenter = [0, 0, 9]\n";
  const std::string second = "[[body]]\nid = 8\nshape = { type = \"box\" }\n";
  expect_one_warning(scene_with_crate(drag) + second + drag,
                     "pool.toml: body 7 and 1 other: [body.drag] center");
}

}  // namespace
}  // namespace buoyancy
