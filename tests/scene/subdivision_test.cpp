// The sections [[body.part]], [[body.compartment]] and [[body.tank]], and the bodies prepared from them.
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "base/json.h"
#include "scene/floating_bodies.h"
#include "scene/scene_report.h"
#include "tests/geometry/mesh_files.h"
#include "tests/scene/scene_texts.h"
#include "tests/support/scene_of.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kBox = "shape = { type = \"box\", size = [1, 1, 1] }\n";

std::vector<std::string> warnings_of(const std::string& text) {
  return messages_of(scene_warnings(scene_of(text)));
}

TEST(Subdivision, ReadsEverySection) {
  const SceneDescription scene = parsed(
      scene_with_crate("[[body.part]]\nname = \"float\"\n" + kBox + "position = [3, 0, 0]\n" +
                       "orientation = [2, 0, 0, 2]\n[[body.compartment]]\n" + kBox +
                       "permeability = 0.85\nflooded = 0.25\n[[body.tank]]\n" + kBox +
                       "fill = 0.5\n[[body.tank]]\nmesh = \"tank.stl\"\nscale = 0.001\nliquid_volume = 0.75\n"
                       "density = 850\n"));
  const BodyDescription& body = scene.bodies[0];
  ASSERT_EQ(body.parts.size(), 1U);
  EXPECT_EQ(body.parts[0].name, "float");
  EXPECT_EQ(body.parts[0].mesh.placement.position_B, Vec3(3, 0, 0));
  EXPECT_EQ(body.parts[0].mesh.placement.orientation_B.w(), body.parts[0].mesh.placement.orientation_B.z())
      << "not normalised";
  ASSERT_EQ(body.compartments.size(), 1U);
  EXPECT_EQ(body.compartments[0].name, "compartment 0");
  EXPECT_EQ(body.compartments[0].permeability, 0.85);
  EXPECT_EQ(body.compartments[0].flooded, 0.25);
  ASSERT_EQ(body.tanks.size(), 2U);
  EXPECT_EQ(body.tanks[0].density, 1025.0) << "the water's";
  EXPECT_EQ(body.tanks[0].fill, 0.5);
  EXPECT_EQ(body.tanks[1].name, "tank 1");
  EXPECT_EQ(body.tanks[1].mesh.placement.scale, Vec3::Constant(0.001));
  EXPECT_EQ(body.tanks[1].liquid_volume, 0.75);
  EXPECT_EQ(body.tanks[1].density, 850.0);
}

TEST(Subdivision, ExplainsWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"[body.part]\n" + kBox, "Write [[body.part]] in double brackets"},
      {"[[body.part]]\n", "part 0: neither 'mesh' nor 'shape'"},
      {"[[body.part]]\nmesh = \"a.stl\"\n" + kBox, "both 'mesh' and 'shape'"},
      {"[[body.part]]\n" + kBox + "permeability = 1\n", "pool.toml:6: body 7, part 0: unknown key"},
      {"[[body.compartment]]\n" + kBox + "permeabilty = 1\n", "nearest known key is 'permeability'"},
      {"[[body.tank]]\n" + kBox, "neither 'fill' nor 'liquid_volume'"},
      {"[[body.tank]]\n" + kBox + "fill = 0.5\nliquid_volume = 1\n", "both 'fill' and 'liquid_volume'"},
      {"[[body.tank]]\n" + kBox + "fill = 0.5\norientation = [0, 0, 0, 0]\n",
       "a quaternion (w, x, y, z), not"},
      {"[[body.tank]]\nshape = { type = \"box\", sizes = [1, 1, 1] }\nfill = 0.5\n",
       "pool.toml:5: body 7, tank 0, shape: unknown key 'sizes'"},
      {"[[body.tank]]\n" + kBox + "fill = 0.5\nsurface = \"flat\"\n", "level, none"},
      {"[[body.tank]]\n" + kBox + "fill = 0.5\nsurface = \"none\"\nfill_axis = \"w\"\n", "x, y, z"},
      {"[[body.tank]]\n" + kBox + "fill = 0.5\nfill_axis = \"x\"\n",
       "a fill axis only with surface = \"none\""},
      {"[[body.tank]]\nname = \"ballast\"\n" + kBox + "liquid_volume = 1.5\n",
       "pool.toml:4: body 7, tank 'ballast', liquid_volume: 1.5 m^3; expected at most the tank's volume, 1 "
       "m^3"},
      {"[[body.tank]]\nmesh = \"no_such_tank.stl\"\nfill = 0.5\n", "no_such_tank.stl"},
  };
  for (const auto& [text, expected] : wrong) {
    EXPECT_THAT(preparation_error(scene_with_crate(text)), HasSubstr(expected));
  }
}

TEST(Subdivision, RejectsOpenMeshes) {
  const TempDir directory;
  const std::string open = directory.write("open.obj", kOpenObj);
  for (const std::string section : {"part", "compartment", "tank"}) {
    const std::string fill = section == "tank" ? "fill = 0.5\n" : "";
    const std::string message =
        preparation_error(scene_with_crate("[[body." + section + "]]\nmesh = \"" + open + "\"\n" + fill));
    EXPECT_THAT(message, AllOf(HasSubstr("body 7, " + section + " '" + section + " 0', "), HasSubstr("open"),
                               Not(HasSubstr("dry_boundary"))));
  }
  EXPECT_THAT(preparation_error("[[body]]\nid = 1\nmesh = \"" + open +
                                "\"\nopen = \"dry_boundary\"\n[[body.tank]]\nfill = 0.5\n" + kBox),
              HasSubstr("an open mesh; expected a closed mesh"));
}

TEST(Subdivision, RejectsAScaleWithoutAMesh) {
  EXPECT_THAT(parse_error("[[body]]\nid = 7\nscale = 2\n[[body.part]]\n" + kBox),
              HasSubstr("pool.toml:3: body 7: scale = 2; expected a scale only with a mesh file"));
}

TEST(Subdivision, SharesMeshesOfEqualBodies) {
  const std::string keys =
      kBox + "[[body.part]]\n" + kBox + "position = [1, 0, 0]\n[[body.tank]]\n" + kBox + "fill = 0.5\n";
  const Scene scene = scene_of("[[body]]\nid = 1\n" + keys + "[[body]]\nid = 2\n" + keys);
  EXPECT_EQ(scene.meshes().size(), 3U) << "the box, the moved box, both together";
  EXPECT_EQ(scene.bodies()[0].prepared_mesh, scene.bodies()[1].prepared_mesh);
  EXPECT_EQ(scene.bodies_with_subdivision(), 2U);
  ASSERT_NE(scene.bodies()[1].parts, nullptr);
  EXPECT_EQ(scene.bodies()[1].parts->at(0).name, "hull");
  EXPECT_EQ(scene.bodies()[1].parts->at(1).name, "part 0");
}

TEST(Subdivision, OfABodyWithoutSectionsIsAbsent) {
  const Scene scene = scene_of(scene_with_crate());
  EXPECT_EQ(scene.bodies()[0].parts, nullptr);
  EXPECT_EQ(scene.bodies()[0].subdivision, nullptr);
  EXPECT_EQ(scene.bodies_with_subdivision(), 0U);
}

// One part inside another is no cavity: parts are added up as they are.
TEST(Subdivision, AddsPartsInsideOthers) {
  const std::string text =
      "[[body]]\nid = 1\n[[body.part]]\nshape = { type = \"box\", size = [3, 3, 3] }\n[[body.part]]\n" + kBox;
  EXPECT_NEAR(scene_of(text).bodies()[0].prepared_mesh->mesh.volume, 28.0, 1e-12);
  EXPECT_THAT(warnings_of(text),
              ElementsAre(HasSubstr("parts 'part 0' and 'part 1': overlap by 1 m^3 (100 %)")));
}

// A mesh far from its own origin is turned and moved back to where it was: nothing is lost but the last bit.
TEST(Subdivision, PlacesMeshesThatLieFarFromTheirOrigin) {
  const TempDir directory;
  std::string obj;
  for (int i = 0; i < 8; ++i) {
    obj += "v " + std::to_string(1000.0 + (i & 1)) + " " + std::to_string(2000.0 + ((i >> 1) & 1)) + " " +
           std::to_string(-500.0 + (i >> 2)) + "\n";
  }
  obj += "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  const std::string mesh = directory.write("far.obj", obj);
  const Eigen::Quaterniond q = Eigen::Quaterniond(1, 2, -2, 4).normalized();
  const Vec3 center = q * Vec3(1000.5, 2000.5, -499.5);
  const Scene scene =
      scene_of("[[body]]\nid = 1\n[[body.part]]\nmesh = \"" + mesh +
               "\"\norientation = [1, 2, -2, 4]\nposition = [" + format_shortest(-center.x()) + ", " +
               format_shortest(-center.y()) + ", " + format_shortest(-center.z()) + "]\n");
  const HydrostaticMesh& placed = scene.bodies()[0].prepared_mesh->mesh;
  EXPECT_NEAR(placed.volume, 1.0, 4e-16);
  for (std::int32_t i = 0; i < 8; ++i) {
    EXPECT_NEAR((placed.vertex(i) - placed.centroid).norm(), std::sqrt(0.75), 4e-16) << i;
  }
}

TEST(Subdivision, WarnsAboutSpacesThatStickOutOrOverlap) {
  const std::string hull = "[[body]]\nid = 1\nshape = { type = \"box\", size = [4, 2, 1] }\n";
  EXPECT_TRUE(warnings_of(hull + "[[body.compartment]]\nshape = { type = \"box\", size = [1, 2, 1] }\n"
                                 "position = [1.5, 0, 0]\n[[body.tank]]\nfill = 0.5\n"
                                 "shape = { type = \"box\", size = [1, 2, 1] }\nposition = [0.5, 0, 0]\n")
                  .empty())
      << "they touch the hull and each other";
  EXPECT_THAT(
      warnings_of(hull +
                  "[[body.compartment]]\nname = \"bow\"\nshape = { type = \"box\", size = [1, 2, 1] }\n"
                  "position = [1.75, 0, 0]\n[[body.tank]]\nfill = 0.5\n"
                  "shape = { type = \"box\", size = [1, 1, 1] }\nposition = [1, 0, 0]\n"),
      ElementsAre(HasSubstr("compartment 'bow': 0.5 m^3 (25 %) outside the hull"),
                  HasSubstr("compartment 'bow' and tank 'tank 0': overlap by 0.25 m^3 (25 %)")));
}

TEST(Subdivision, FloatsWithItsCompartmentsAndTanks) {
  const Scene scene = scene_of(
      "[[body]]\nid = 1\nshape = { type = \"box\", size = [4, 2, 1] }\n[[body.compartment]]\n"
      "shape = { type = \"box\", size = [1, 2, 1] }\nflooded = 0.5\npermeability = "
      "0.9\n[[body.compartment]]\n"
      "shape = { type = \"box\", size = [1, 2, 1] }\nposition = [1.5, 0, 0]\nflooded = 0\n[[body.tank]]\n"
      "shape = { type = \"box\", size = [1, 1, 1] }\nposition = [-1, 0, 0]\nliquid_volume = 0.25\ndensity = "
      "800\n");
  const Body& body = scene.bodies()[0];
  const RigidBodyMass mass{.mass = 2000.0, .center_of_mass_B = Vec3(0, 0, -0.1)};
  const FloatingBody floating = floating_body_of(body, body.prepared_mesh->mesh, mass).value();
  ASSERT_EQ(floating.volumes().size(), 2U) << "the hull and what is flooded";
  EXPECT_EQ(floating.volumes()[1].placed.signed_permeability, -0.45);
  EXPECT_EQ(floating.total_mass(), 2200.0);
  const BodyCondition damaged{.flooded = {0.0, 1.0}, .liquid_volumes = {1.0}};
  const FloatingBody later = floating_body_of(body, body.prepared_mesh->mesh, mass, &damaged).value();
  EXPECT_EQ(later.volumes()[1].placed.signed_permeability, -1.0);
  EXPECT_EQ(later.total_mass(), 2800.0);
}

TEST(Subdivision, TurnsTheFillAxisWithItsTank) {
  const std::string piston = "[[body.tank]]\nfill = 0.25\nsurface = \"none\"\n" + kBox;
  const SceneDescription scene = parsed(
      scene_with_crate("[[body.tank]]\nfill = 0.25\nsurface = \"level\"\n" + kBox + piston + piston +
                       "fill_axis = \"-x\"\n" + piston + "fill_axis = \"x\"\norientation = [2, 0, 0, 2]\n"));
  const std::vector<TankDescription>& tanks = scene.bodies[0].tanks;
  ASSERT_EQ(tanks.size(), 4U);
  EXPECT_FALSE(tanks[0].piston_axis_B);
  EXPECT_EQ(tanks[1].piston_axis_B, Vec3(0, 0, 1)) << "the default";
  EXPECT_EQ(tanks[2].piston_axis_B, Vec3(-1, 0, 0));
  EXPECT_LE((tanks[3].piston_axis_B.value() - Vec3(0, 1, 0)).norm(), 1e-15);
}

TEST(Subdivision, ReportsThePistonOfATank) {
  const Scene scene = scene_of(scene_with_crate("[[body.tank]]\nfill = 0.25\nsurface = \"none\"\n" + kBox +
                                                "fill_axis = \"-x\"\n[[body.tank]]\nfill = 0.25\n" + kBox));
  EXPECT_THAT(scene_report_text(scene), HasSubstr("piston along -x"));
  const auto tanks = Json::parse(scene_report_json(scene)).at("bodies").at(0).at("tanks");
  EXPECT_EQ(tanks.at(0).at("piston_axis"), Json({-1.0, 0.0, 0.0}));
  EXPECT_FALSE(tanks.at(1).contains("piston_axis"));
}

}  // namespace
}  // namespace buoyancy
