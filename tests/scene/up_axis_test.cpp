#include "scene/up_axis.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "scene/scene_report.h"
#include "tests/geometry/mesh_files.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;

class UpAxis : public testing::Test {
 protected:
  UpAxis() {
    for (const std::string axis : {"x", "y", "z"}) {
      const std::string tag = "<up_axis>" + std::string(1, static_cast<char>(axis[0] - 32)) + "_UP</up_axis>";
      directory_.write(axis + "_up.dae", tetrahedron::collada(tag));
    }
    directory_.write("plain.obj", tetrahedron::obj());
  }

  std::vector<Warning> warnings_of(const std::string& bodies, const std::string& water = "",
                                   const UpAxisCheck& check = {}) {
    const auto scene = Scene::load(directory_.write("pool.toml", water + bodies));
    EXPECT_TRUE(scene) << scene.error().message();
    return scene ? up_axis_warnings(*scene, check) : std::vector<Warning>{};
  }

  static std::string body(const std::string& mesh, int id = 1) {
    return "[[body]]\nid = " + std::to_string(id) + "\nmesh = \"" + mesh + "\"\n";
  }

  TempDir directory_;
};

TEST_F(UpAxis, IsNotedWhereItIsNotTheScenes) {
  const std::vector<Warning> warnings = warnings_of(body("y_up.dae"));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_EQ(warnings[0].subject, (directory_.path() / "pool.toml").string() + ": body 1");
  EXPECT_EQ(warnings[0].actual, "mesh '" + (directory_.path() / "y_up.dae").string() +
                                    "' has y up in its file, which is y of the body");
  EXPECT_EQ(warnings[0].expected, "z of the body, which is up in the water");
  EXPECT_EQ(warnings[0].hint,
            "orientation = [0.707106781187, 0.707106781187, 0, 0] (w, x, y, z) of the mesh stands it up");
  EXPECT_TRUE(warnings_of(body("z_up.dae")).empty());
  EXPECT_TRUE(warnings_of(body("plain.obj")).empty());
}

TEST_F(UpAxis, IsComparedWithUpOfTheWater) {
  EXPECT_TRUE(warnings_of(body("y_up.dae"), "[world]\nup = [0, 1, 0]\n").empty());
  const std::vector<Warning> down = warnings_of(body("z_up.dae"), "[world]\nup = [0, 0, -1]\n");
  ASSERT_EQ(down.size(), 1U);
  EXPECT_EQ(down[0].hint, "orientation = [0, 1, 0, 0] (w, x, y, z) of the mesh stands it up");
}

// The stated orientation is used as it is printed.
TEST_F(UpAxis, IsUpAgainWithTheStatedOrientation) {
  for (const std::string mesh : {"x_up.dae", "y_up.dae", "z_up.dae"}) {
    for (const std::string up : {"[1, 0, 0]", "[0, 1, 0]", "[0, 0, -1]", "[0.6, 0, -0.8]"}) {
      const std::string water = "[world]\nup = " + up + "\n";
      const std::vector<Warning> warnings = warnings_of(body(mesh), water);
      if (warnings.empty()) continue;
      const std::string orientation = warnings[0].hint.substr(0, warnings[0].hint.find(']') + 1);
      const std::string part = "[[body]]\nid = 1\n[[body.part]]\nmesh = \"" + mesh + "\"\n";
      EXPECT_TRUE(warnings_of(part + orientation + "\n", water).empty()) << mesh << up << orientation;
      EXPECT_EQ(warnings_of(part, water).size(), 1U);
    }
  }
}

// A factor of -1 turns the axis round, and the winding with it.
TEST_F(UpAxis, IsUpAgainAlsoInAMirroredMesh) {
  const std::string file = "mesh = { file = \"y_up.dae\", scale = [1, -1, 1]";
  const std::string head = "[[body]]\nid = 1\n" + file;
  const std::vector<Warning> warnings = warnings_of(head + " }\n");
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].actual.ends_with(" has y up in its file, which is -y of the body"));
  EXPECT_TRUE(warnings[0].hint.starts_with("orientation = [0.707106781187, -0.707106781187, 0, 0]"))
      << warnings[0].hint;
  const std::string orientation = warnings[0].hint.substr(0, warnings[0].hint.find(']') + 1);
  EXPECT_TRUE(warnings_of(head + ", " + orientation + " }\n").empty());
}

TEST_F(UpAxis, IsNotedWithTheOptionOfTheProgram) {
  const std::string y_up = body("y_up.dae");
  const std::string mirrored = "[[body]]\nid = 1\nmesh = { file = \"y_up.dae\", scale = [1, -1, 1] }\n";
  const std::string in_scene = "; in a scene file, orientation = [0.707106781187, ";
  const auto hint_of = [&](const std::string& bodies, const UpAxisCheck& check) {
    const std::vector<Warning> warnings = warnings_of(bodies, "", check);
    return warnings.size() == 1 ? warnings[0].hint : "";
  };
  const auto starts = [](const std::string& text, const std::string& start) {
    return text.starts_with(start);
  };
  EXPECT_PRED2(starts, hint_of(y_up, {.remedy = UpRemedy::kOption}), "Pass --up y" + in_scene);
  EXPECT_PRED2(starts, hint_of(y_up, {.remedy = UpRemedy::kArgument}), "Pass up=\"y\"" + in_scene);
  EXPECT_PRED2(starts, hint_of(y_up, {.remedy = UpRemedy::kShipAxis}), "Pass --up y" + in_scene);
  // One is an axis of the file, the other of the mesh as it is placed.
  EXPECT_PRED2(starts, hint_of(mirrored, {.remedy = UpRemedy::kOption}), "Pass --up y" + in_scene);
  EXPECT_PRED2(starts, hint_of(mirrored, {.remedy = UpRemedy::kShipAxis}), "Pass --up=-y" + in_scene);

  EXPECT_EQ(hint_of(y_up, {Vec3::UnitY(), UpRemedy::kShipAxis}), "");
  const std::vector<Warning> of_ship =
      warnings_of(body("z_up.dae"), "", {Vec3::UnitY(), UpRemedy::kShipAxis});
  ASSERT_EQ(of_ship.size(), 1U);
  EXPECT_EQ(of_ship[0].expected, "y of the body, which is the ship's upward axis");
  EXPECT_EQ(of_ship[0].hint,
            "Pass --up z; in a scene file, orientation = [1, 0, 0, 0] (w, x, y, z) of the mesh stands it up");
}

TEST(OrientationWithUp, TurnsEachAxisUpWithoutRounding) {
  TriangleMesh mesh;
  mesh.add_vertex({0.1, 0.7, 1.0 / 3.0});
  for (const std::string name : {"x", "y", "z", "-x", "-y", "-z"}) {
    const Vec3 axis = axis_from_name(name).value();
    for (const double sign : {1.0, -1.0}) {
      TriangleMesh placed = mesh;
      const Vec3 scale(sign, 1.0, sign);
      place(placed, {.scale = scale, .orientation_B = orientation_with_up(axis, scale)});
      EXPECT_EQ(placed.z[0], axis.dot(Vec3(mesh.x[0], mesh.y[0], mesh.z[0]))) << name;
      std::vector<double> sizes{std::abs(placed.x[0]), std::abs(placed.y[0]), std::abs(placed.z[0])};
      std::sort(sizes.begin(), sizes.end());
      EXPECT_EQ(sizes, (std::vector<double>{0.1, 1.0 / 3.0, 0.7})) << name;
    }
  }
  // A hull keeps its bow where it can.
  for (const std::string name : {"y", "-y", "z", "-z"}) {
    EXPECT_EQ(orientation_with_up(axis_from_name(name).value(), Vec3::Ones()) * Vec3::UnitX(), Vec3::UnitX());
  }
}

TEST_F(UpAxis, MayBeTurnedByTheStartOfTheBody) {
  EXPECT_TRUE(warnings_of(body("y_up.dae") + "[body.client]\ndensity = 300\norientation = [0.8, 0.6, 0, 0]\n")
                  .empty());
  EXPECT_EQ(warnings_of(body("y_up.dae") + "[body.client]\ndensity = 300\n").size(), 1U);
}

TEST_F(UpAxis, IsCheckedForEveryMeshOfABody) {
  const std::string hull = "[[body]]\nid = 1\nshape = { type = \"box\", size = [4, 4, 4] }\n";
  EXPECT_EQ(warnings_of(hull + "[[body.part]]\nmesh = \"y_up.dae\"\nposition = [5, 0, 0]\n").size(), 1U);
  EXPECT_EQ(warnings_of(hull + "[[body.compartment]]\nmesh = \"y_up.dae\"\n").size(), 1U);
  EXPECT_EQ(warnings_of(hull + "[[body.tank]]\nmesh = \"x_up.dae\"\nfill = 0.5\n").size(), 1U);
}

TEST_F(UpAxis, IsNotedOnceForEqualBodies) {
  const std::vector<Warning> warnings =
      warnings_of(body("y_up.dae", 3) + body("y_up.dae", 4) + body("y_up.dae", 5));
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_TRUE(warnings[0].subject.ends_with(": body 3 and 2 others")) << warnings[0].subject;
}

TEST_F(UpAxis, IsAmongTheWarningsOfTheCheck) {
  const auto scene = Scene::load(directory_.write("pool.toml", body("y_up.dae")));
  ASSERT_TRUE(scene);
  ASSERT_EQ(scene_warnings(*scene).size(), 1U);
  EXPECT_EQ(scene_warnings(*scene)[0].message(), up_axis_warnings(*scene)[0].message());
}

TEST(PolygonReport, ScalesWithTheMesh) {
  const TempDir directory;
  directory.write("quad.obj",
                  "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nv 0.5 0.5 -1\n"
                  "f 1 2 3 4\nf 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\n");
  const auto report_of = [&](const std::string& scale) {
    const auto scene = Scene::load(
        directory.write("pool.toml", "[[body]]\nid = 1\nmesh = \"quad.obj\"\nscale = " + scale + "\n"));
    EXPECT_TRUE(scene) << scene.error().message();
    return scene->meshes()[0]->report;
  };
  const PolygonSplit one = report_of("1").source.polygons;
  const PolygonSplit ten = report_of("10").source.polygons;
  EXPECT_EQ(one.non_planar, 1);
  EXPECT_NEAR(one.split_volume, 0.1 / 6.0, 1e-9);
  EXPECT_NEAR(ten.split_volume, 1000.0 * one.split_volume, 1e-9);
  EXPECT_NEAR(ten.largest_distance, 10.0 * one.largest_distance, 1e-12);
  EXPECT_THAT(to_text(report_of("10")),
              HasSubstr("1 of four or more corners, split into triangles; 1 not planar, up to "));
  EXPECT_EQ(report_of("1").vertices_stored, 4 + 4 * 3);
}

}  // namespace
}  // namespace buoyancy
