#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/scene/scene_texts.h"

namespace buoyancy {
namespace {

std::string with_shape(const std::string& shape) {
  return "[[body]]\nid = 1\nshape = " + shape + "\n";
}

TEST(ParseShape, ReadsAllSizesOfEveryShape) {
  const std::vector<std::pair<std::string, Shape>> shapes{
      {R"({ type = "box", size = [1, 2.5, 3], segments = [4, 5, 6] })", BoxShape{{1, 2.5, 3}, {4, 5, 6}}},
      {R"({ type = "sphere", radius = 2, segments = 7 })", SphereShape{2, 7}},
      {R"({ type = "cylinder", radius = 2, height = 3, segments = 8, stacks = 9 })",
       CylinderShape{2, 3, 8, 9}},
      {R"({ type = "cone", radius = 2, height = 3, segments = 8, stacks = 9 })", ConeShape{2, 3, 8, 9}},
      {R"({ type = "torus_knot", radius = 2, tube = 0.1, p = 5, q = 3, tubular = 90, radial = 6 })",
       TorusKnotShape{2, 0.1, 5, 3, 90, 6}},
      {R"({ type = "wigley", length = 3, beam = 0.3, draft = 0.1875, freeboard = 0.1, segments = 10, levels = 4 })",
       WigleyShape{3, 0.3, 0.1875, 0.1, 10, 4}},
      {R"({ type = "rock", radius = 2, frequency = 5, roughness = 0.5, seed = 99 })",
       RockShape{2, 5, 0.5, 99}},
  };
  for (const auto& [text, shape] : shapes) {
    const SceneDescription scene = parsed(with_shape(text));
    EXPECT_EQ(std::get<Shape>(scene.bodies[0].mesh.source), shape) << text;
  }
}

TEST(ParseShape, UsesDefaultsForMissingSizes) {
  const std::vector<Shape> defaults{BoxShape{},       SphereShape{}, CylinderShape{}, ConeShape{},
                                    TorusKnotShape{}, WigleyShape{}, RockShape{}};
  for (const Shape& shape : defaults) {
    const SceneDescription scene = parsed(with_shape("{ type = \"" + std::string(type_name(shape)) + "\" }"));
    EXPECT_EQ(std::get<Shape>(scene.bodies[0].mesh.source), shape);
  }
}

TEST(ParseShape, ReportsErrorsWithLine) {
  for (const auto& [shape, expected] : std::vector<std::pair<std::string, std::string>>{
           {"{ }", "pool.toml:3: body 1, shape: no key 'type'"},
           {"{ typ = \"box\" }", "no key 'type'"},
           {"{ type = \"spere\" }", "The nearest is 'sphere'."},
           {"{ type = \"sphere\", radius = -1 }",
            "pool.toml:3: body 1, shape: radius = -1; expected a length from 1e-09 to 1e+09 (m)."},
           {"{ type = \"sphere\", radius = \"big\" }", "radius = \"big\""},
           {"{ type = \"sphere\", segments = 2.5 }", "segments = 2.5; expected a whole number"},
           {"{ type = \"box\", segments = [1, 2, 4294967297] }", "expected an array of 3 whole numbers"},
           {"{ type = \"box\", segments = [1, 2] }", "expected an array of 3 whole numbers"},
           {"{ type = \"box\", segments = [1, 2, 3.0] }", "expected an array of 3 whole numbers"},
           {"{ type = \"box\", size = [1, 2] }", "expected an array of 3 finite numbers (m)"},
       }) {
    expect_parse_errors({{with_shape(shape), expected}});
  }
}

}  // namespace
}  // namespace buoyancy
