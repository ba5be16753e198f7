#include "scene/mesh_warnings.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_report.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// The warnings about a box of this mass [kg].
std::vector<std::string> warnings_of(const std::string& size, const std::string& mass) {
  const Scene scene = scene_of("[[body]]\nid = 1\nshape = { type = \"box\", size = " + size +
                               " }\n[body.client]\n" + mass + "\n");
  return messages_of(mesh_warnings(scene));
}

TEST(MeshWarnings, NoteAMeshInAnotherUnit) {
  EXPECT_THAT(
      warnings_of("[500, 250, 250]", "mass = 13"),
      ElementsAre("test scene: body 1: mass over volume = 13 kg / 3.125e+07 m^3 = 4.16e-07 kg/m^3; expected "
                  "20 to 20000 kg/m^3. Likely cause: a mesh in another unit than metres, such as "
                  "millimetres. scale = 0.001 gives 416 kg/m^3; where a scale is set, multiply it by that."));
  EXPECT_THAT(warnings_of("[20, 10, 10]", "mass = 26"), ElementsAre(HasSubstr("scale = 0.0254 gives")))
      << "inches";
  EXPECT_THAT(warnings_of("[0.0005, 0.00025, 0.00025]", "mass = 13"),
              ElementsAre(HasSubstr("scale = 1000 gives")));
}

TEST(MeshWarnings, SayNothingOfWhatFloatsOrSinks) {
  for (const std::string mass :
       {"mass = 20", "mass = 700", "mass = 20000", "density = 20", "density = 20000", ""}) {
    EXPECT_TRUE(warnings_of("[1, 1, 1]", mass).empty()) << mass;
  }
  EXPECT_EQ(warnings_of("[1, 1, 1]", "mass = 19.99").size(), 1U);
  EXPECT_EQ(warnings_of("[1, 1, 1]", "mass = 20000.1").size(), 1U);
  EXPECT_THAT(warnings_of("[1, 1, 1]", "density = 19.9"), ElementsAre(HasSubstr("density = 19.9 kg/m^3")));
  EXPECT_THAT(warnings_of("[1, 1, 1]", "density = 20001"), ElementsAre(HasSubstr("density = 20001 kg/m^3")));
  EXPECT_TRUE(warnings_of("[600, 800, 0.1]", "density = 700").size() == 1) << "1000.000005 m";
  EXPECT_TRUE(warnings_of("[600, 799, 0.1]", "density = 700").empty());
}

TEST(MeshWarnings, NoteWaterInGramsPerCubicCentimetre) {
  const auto of_water = [](const std::string& density) {
    return messages_of(
        mesh_warnings(scene_of("[water]\ndensity = " + density +
                               "\n[[body]]\nid = 1\nshape = { type = \"sphere\", radius = 1 }\n")));
  };
  EXPECT_THAT(
      of_water("1.025"),
      ElementsAre("test scene: water.density: 1.025 kg/m^3; expected about 1000 kg/m^3. Likely cause: grams "
                  "per cubic centimetre. Give kg/m^3, such as 1025 for sea water."));
  for (const std::string density : {"0.9", "1.15"}) EXPECT_EQ(of_water(density).size(), 1U) << density;
  for (const std::string density : {"0", "0.89", "1.2", "1000"})
    EXPECT_TRUE(of_water(density).empty()) << density;
}

TEST(MeshWarnings, ArePartOfThoseOfAScene) {
  const Scene scene = scene_of(
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [500, 250, 250] }\n"
      "[body.client]\nmass = 13\ninertia = [0.25, 0.22, 0.36]\n");
  EXPECT_EQ(scene_warnings(scene).size(), 1U);
}

}  // namespace
}  // namespace buoyancy
