#include "scene/scene_file.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/geometry/mesh_files.h"
#include "tests/scene/scene_texts.h"

namespace buoyancy {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(SceneFile, ReadsRepairsOfEveryMesh) {
  const SceneDescription scene = parsed(R"(
[world]
up = [0, 0, -1]
[[body]]
id = 1
mesh = "hull.obj"
repair = "none"
mirror = "y"
close_holes = 0.25
freeboard = 1.5
[[body.tank]]
mesh = "tank.obj"
close_holes = 0.125
fill = 0
[body.client]
orientation = [0, 1, 0, 0]
)");
  const MeshRepair& repair = scene.bodies[0].mesh.repair;
  EXPECT_EQ(repair.policy, RepairPolicy::kNone);
  EXPECT_EQ(repair.mirror, Axis::kY);
  EXPECT_TRUE(repair.closing.holes);
  EXPECT_EQ(repair.closing.max_change, 0.25);
  EXPECT_EQ(repair.closing.freeboard, 1.5);
  // Half a turn about x: what is up in the water is z of the body.
  EXPECT_TRUE(repair.closing.up_B.isApprox(Vec3::UnitZ()));
  const MeshRepair& of_tank = scene.bodies[0].tanks[0].mesh.repair;
  EXPECT_EQ(of_tank.policy, RepairPolicy::kAutomatic);
  EXPECT_EQ(of_tank.closing.max_change, 0.125);
  EXPECT_EQ(parse("[[body]]\nid = 1\nmesh = \"a.obj\"\n")->bodies[0].mesh.repair, MeshRepair{});
}

TEST(SceneFile, UsesDefaultsForMissingKeys) {
  const SceneDescription scene = parsed(scene_with_crate());
  EXPECT_EQ(scene.name, "pool.toml");
  EXPECT_EQ(scene.water.up_W, Vec3::UnitZ());
  EXPECT_EQ(scene.water.level, 0.0);
  EXPECT_EQ(scene.water.density, 1025.0);
  EXPECT_EQ(scene.water.gravity, 9.80665);
  EXPECT_EQ(scene.limits.vertices, ImportLimits{}.vertices);
  ASSERT_EQ(scene.bodies.size(), 1U);
  const BodyDescription& body = scene.bodies[0];
  EXPECT_EQ(body.id, 7);
  EXPECT_EQ(body.name, "body 7");
  EXPECT_EQ(std::get<Shape>(body.mesh.source), Shape(BoxShape{}));
  EXPECT_EQ(body.mesh.placement.scale, Vec3::Ones());
  EXPECT_EQ(body.method, Method::kHierarchical);
  EXPECT_EQ(body.tolerance, std::nullopt);
  EXPECT_EQ(body.open, OpenPolicy::kRefuse);
  EXPECT_EQ(body.reference_B, Vec3::Zero());
  EXPECT_EQ(body.source_location, "pool.toml:1");
  EXPECT_FALSE(body.dynamics.given);
}

TEST(SceneFile, ReadsEveryKey) {
  const SceneDescription scene = parsed(R"(
[world]
gravity = 1.62
up = [0, 3, 4]
[water]
level = -2
density = 1000
[limits]
mesh_bytes = 11
vertices = 12
faces = 13
import_seconds = 14
[[body]]
id = 3
name = "duck"
mesh = "meshes/duck.dae"
scale = 0.01
method = "fast_surface"
tolerance = 0.5
open = "dry_boundary"
reference_point = [1, 2, 3.5]
outputs = ["wrench"]
[body.client]
mass = 12
center_of_mass = [0.1, 0.2, 0.3]
inertia = [4, 5, 6, 0.4, 0.5, 0.6]
position = [7, 8, 9]
orientation = [0, 0, 0, -2]
linear_velocity = [1, 0, 0]
angular_velocity = [0, 1, 0]
linear_damping = 10
linear_damping_quadratic = 11
angular_damping = 12
angular_damping_quadratic = 13
)");
  EXPECT_EQ(scene.water.gravity, 1.62);
  EXPECT_TRUE(scene.water.up_W.isApprox(Vec3(0, 0.6, 0.8), 1e-15));
  EXPECT_EQ(scene.water.level, -2.0);
  EXPECT_EQ(scene.water.density, 1000.0);
  EXPECT_EQ(scene.water_location, "pool.toml:5");
  EXPECT_EQ(scene.limits.mesh_bytes, 11U);
  EXPECT_EQ(scene.limits.vertices, 12U);
  EXPECT_EQ(scene.limits.faces, 13U);
  EXPECT_EQ(scene.limits.import_seconds, 14.0);

  const BodyDescription& body = scene.bodies.at(0);
  EXPECT_EQ(body.id, 3);
  EXPECT_EQ(body.name, "duck");
  EXPECT_EQ(std::get<MeshFile>(body.mesh.source).path, std::filesystem::path("scenes/meshes/duck.dae"));
  EXPECT_EQ(body.mesh.placement.scale, Vec3::Constant(0.01));
  EXPECT_EQ(body.method, Method::kFastSurface);
  EXPECT_EQ(body.tolerance, 0.5);
  EXPECT_EQ(body.open, OpenPolicy::kDryBoundary);
  EXPECT_EQ(body.reference_B, Vec3(1, 2, 3.5));

  const DynamicsSpec& dynamics = body.dynamics;
  EXPECT_TRUE(dynamics.given);
  EXPECT_EQ(dynamics.mass, 12.0);
  EXPECT_FALSE(dynamics.density);
  EXPECT_EQ(dynamics.center_of_mass_B, Vec3(0.1, 0.2, 0.3));
  Mat3 inertia_B;
  inertia_B << 4, 0.4, 0.5, 0.4, 5, 0.6, 0.5, 0.6, 6;
  EXPECT_EQ(dynamics.inertia_B, inertia_B);
  EXPECT_EQ(dynamics.position, Vec3(7, 8, 9));
  EXPECT_EQ(dynamics.orientation.coeffs(), Eigen::Quaterniond(0, 0, 0, -1).coeffs());
  EXPECT_EQ(dynamics.linear_velocity, Vec3::UnitX());
  EXPECT_EQ(dynamics.angular_velocity, Vec3::UnitY());
  EXPECT_EQ(dynamics.linear_damping, 10.0);
  EXPECT_EQ(dynamics.linear_damping_quadratic, 11.0);
  EXPECT_EQ(dynamics.angular_damping, 12.0);
  EXPECT_EQ(dynamics.angular_damping_quadratic, 13.0);
}

TEST(SceneFile, EnablesHydrostaticsOnlyIfRequested) {
  const auto requested = [](const std::string& keys) {
    return parse(scene_with_crate(keys)).value().bodies[0].hydrostatics;
  };
  EXPECT_FALSE(requested(""));
  EXPECT_FALSE(requested("outputs = [\"wrench\"]\n"));
  EXPECT_TRUE(requested("outputs = [\"wrench\", \"hydrostatics\"]\n"));
  EXPECT_TRUE(requested("outputs = [\"hydrostatics\", \"wrench\"]\n"));
}

TEST(SceneFile, ReadsEveryMethod) {
  for (const Method method : kAllMethods) {
    const SceneDescription scene =
        parsed(scene_with_crate("method = \"" + std::string(to_string(method)) + "\"\n"));
    EXPECT_EQ(scene.bodies[0].method, method);
  }
}

TEST(SceneFile, KeepsOrderOfBodies) {
  const SceneDescription scene =
      parsed(scene_with_crate("[[body]]\nid = -2\nshape = { type = \"sphere\", radius = 2 }\n"));
  ASSERT_EQ(scene.bodies.size(), 2U);
  EXPECT_EQ(scene.bodies[1].id, -2);
  EXPECT_EQ(scene.bodies[1].source_location, "pool.toml:4");
}

TEST(SceneFile, KeepsAbsoluteMeshPaths) {
  const SceneDescription scene = parsed("[[body]]\nid = 1\nmesh = \"/models/../models/duck.dae\"\n");
  EXPECT_EQ(std::get<MeshFile>(scene.bodies[0].mesh.source).path, std::filesystem::path("/models/duck.dae"));
}

TEST(SceneFile, NormalisesDirectionsOfAnyLength) {
  const SceneDescription scene = parsed(
      scene_with_crate("[body.client]\norientation = [1e300, 1e300, 0, 0]\n[world]\nup = [0, 0, 1e-300]\n"));
  EXPECT_EQ(scene.water.up_W, Vec3::UnitZ());
  EXPECT_NEAR(scene.bodies[0].dynamics.orientation.norm(), 1.0, 1e-15);
}

TEST(SceneFile, ReportsCompleteErrors) {
  EXPECT_EQ(parse_error(scene_with_crate("[body.client]\nmass = -1\n")),
            "pool.toml:5: body 7, [body.client]: mass = -1; expected a finite number above 0 (kg).");
  EXPECT_EQ(
      parse_error("[water]\ndesnity = 1000\n" + scene_with_crate()),
      "pool.toml:2: [water]: unknown key 'desnity'; expected one of level, density, depth, wave_pressure, "
      "time_origin, ramp, waves, current, layer. The nearest known key is 'density'.");
}

TEST(SceneFile, SuggestsNearestKeyInEveryTable) {
  expect_parse_errors({
      {scene_with_crate("[wrold]\nup = [0, 0, 1]\n"), "pool.toml:4: the scene: unknown key 'wrold'"},
      {"[[boddy]]\nid = 1\n", "nearest known key is 'body'"},
      {scene_with_crate("[world]\ngravty = 9.8\n"), "pool.toml:5: [world]: unknown key 'gravty'"},
      {scene_with_crate("[world]\ngravty = 9.8\n"), "nearest known key is 'gravity'"},
      {scene_with_crate("[limits]\nface = 3\n"), "nearest known key is 'faces'"},
      {scene_with_crate("[limits]\nmemory_bytes = 3\n"), "unknown key 'memory_bytes'"},
      {scene_with_crate("metod = \"exact\"\n"), "pool.toml:4: body 7: unknown key 'metod'"},
      {scene_with_crate("metod = \"exact\"\n"), "nearest known key is 'method'"},
      {scene_with_crate("metod = \"exact\"\n"),
       "expected one of id, name, mesh, scale, shape, repair, mirror, close_holes, freeboard, method, "
       "tolerance, open, reference_point, up, outputs, drag, added_mass, part, compartment, tank, client."},
      {scene_with_crate("[body.clinet]\n"), "nearest known key is 'client'"},
      {scene_with_crate("[body.client]\nmas = 3\n"), "pool.toml:5: body 7, [body.client]: unknown key 'mas'"},
      {scene_with_crate("[body.client]\nmas = 3\n"), "nearest known key is 'mass'"},
      {"[[body]]\nidd = 1\nshape = { type = \"box\" }\n", "nearest known key is 'id'"},
      {"[[body]]\nid = 1\nshap = { type = \"box\" }\n", "nearest known key is 'shape'"},
      {"[[body]]\nid = 1\nshape = { type = \"box\", sizes = [1, 1, 1] }\n",
       "pool.toml:3: body 1, shape: unknown key 'sizes'"},
      {"[[body]]\nid = 1\nshape = { type = \"sphere\", stacks = 3 }\n",
       "expected one of type, radius, segments"},
  });
}

TEST(SceneFile, RejectsWrongTypesAndRanges) {
  expect_parse_errors({
      {scene_with_crate("tolerance = 1.5\n"),
       "pool.toml:4: body 7: tolerance = 1.5; expected a number from 0 to 1."},
      {scene_with_crate("name = 3\n"), "name = 3; expected a string"},
      {scene_with_crate("name = \"\"\n"), "name = \"\"; expected a string"},
      {scene_with_crate("name = \"a\\u001bb\"\n"), "without control characters"},
      {scene_with_crate("method = \"exakt\"\n"),
       "expected one of fast, improved, exact, fast_surface, exact_surface, hierarchical. The nearest is "
       "'exact'."},
      {scene_with_crate("method = \"a\\u001b[31m\"\n"), "method = \"a?[31m\"; expected"},
      {scene_with_crate("method = \"exat\"\n"), "The nearest is 'exact'."},
      {scene_with_crate("method = 3\n"), "method = 3; expected one of fast"},
      {scene_with_crate("open = \"refsue\"\n"),
       "expected one of refuse, dry_boundary. The nearest is 'refuse'."},
      {scene_with_crate("open = true\n"), "open = true"},
      {scene_with_crate("close_holes = 0.1\n"), "a repair and 'shape'"},
      {"[[body]]\nid = 1\nmesh = \"a.obj\"\nmirror = \"w\"\n", "mirror = \"w\"; expected one of x, y, z"},
      {"[[body]]\nid = 1\nmesh = \"a.obj\"\nrepair = \"no\"\n", "expected one of automatic, none"},
      {scene_with_crate("outputs = [\"hydrostatics\"]\n"),
       "pool.toml:4: body 7: outputs = [\"hydrostatics\"]; expected [\"wrench\"], with \"hydrostatics\" and "
       "\"loads\" in it as needed. Likely cause: every response holds wrenches. Add \"wrench\" to the list."},
      {scene_with_crate("outputs = [\"wrench\", \"hydrostatic\"]\n"),
       "The nearest to 'hydrostatic' is 'hydrostatics'."},
      {scene_with_crate("outputs = [\"wrench\", \"wrench\"]\n"), "expected [\"wrench\"], with "},
      {scene_with_crate("outputs = [\"wrench\", \"load\"]\n"), "The nearest to 'load' is 'loads'."},
      {scene_with_crate("outputs = []\n"),
       "outputs = []; expected [\"wrench\"], with \"hydrostatics\" and \"loads\" in it as needed"},
      {scene_with_crate("outputs = \"wrench\"\n"), "expected [\"wrench\"], with "},
      {scene_with_crate("outputs = [\"wrench\", 1]\n"), "expected [\"wrench\"], with "},

      {scene_with_crate("reference_point = [1, 2]\n"), "expected an array of 3 finite numbers (m)"},
      {scene_with_crate("reference_point = [1, 2, inf]\n"), "expected an array of 3 finite numbers (m)"},
      {scene_with_crate("reference_point = [1, 2, \"3\"]\n"), "expected an array of 3 finite numbers (m)"},
      {scene_with_crate("reference_point = 3\n"), "expected an array of 3 finite numbers (m)"},
      {scene_with_crate("client = 3\n"), "client = 3; expected a table"},
      {scene_with_crate("scale = 2\n"), "both 'scale' and 'shape'"},
      {scene_with_crate("mesh = \"duck.dae\"\n"), "both 'mesh' and 'shape'"},
      {"[[body]]\nid = 1\n", "neither 'mesh' nor 'shape'"},
      {"[[body]]\nid = 1\nmesh = 5\n", "mesh = 5; expected a string"},
      {"[[body]]\nid = 1\nshape = \"box\"\n", "shape = \"box\"; expected a table"},
      {"[[body]]\nshape = { type = \"box\" }\n", "[[body]] number 1: no key 'id'"},
      {"[body]\nid = 1\n", "Write [[body]] in double brackets"},
      {"body = [1, 2]\n", "expected a section [[body]] for each body"},
      {"body = []\n", "no body"},
      {"", "no body"},
      {scene_with_crate("[[body]]\nid = 7\nshape = { type = \"box\" }\n"),
       "pool.toml:4: body 7: id = 7; expected a unique id for each body. Likely cause: the body at "
       "pool.toml:1 has the same id."},
      {scene_with_crate("[world]\nup = [0, 0, 0]\n"), "up = [0, 0, 0]; expected a direction"},
      {"water = 3\n" + scene_with_crate(), "water = 3; expected a table"},
      {scene_with_crate("[body.client]\nmass = 1\ndensity = 2\n"), "both 'mass' and 'density'"},
      {scene_with_crate("[body.client]\norientation = [0, 0, 0, 0]\n"),
       "expected a quaternion (w, x, y, z), not zero"},
      {scene_with_crate("[body.client]\norientation = [1, 0, 0]\n"), "expected an array of 4 finite numbers"},
      {scene_with_crate("[body.client]\ninertia = [1, 1]\n"),
       "expected an array of 3 or 6 finite numbers (kg m^2)"},
      {scene_with_crate("[body.client]\ninertia = [1, 1, 0]\n"), "expected a positive definite matrix"},
      {scene_with_crate("[body.client]\ninertia = [1, 1, 1, 2, 0, 0]\n"),
       "expected a positive definite matrix"},
      {scene_with_crate("[body.client]\ninertia = [0, 0, 0]\n"), "expected a positive definite matrix"},
      {scene_with_crate("[body.client]\ninertia = [2, 0, 0, 2, 0, 3]\n"),
       "URDF's is Ixx, Ixy, Ixz, Iyy, Iyz, Izz"},
      {scene_with_crate("[body.client]\ncenter_of_mass = 1\n"), "center_of_mass = 1"},
      {scene_with_crate("[body.client]\nposition = []\n"), "position = []"},
  });
}

TEST(SceneFile, RejectsImpossibleInertia) {
  const auto inertia_error = [](const std::string& inertia) {
    return parse_error(scene_with_crate("[body.client]\ninertia = " + inertia + "\n"));
  };
  EXPECT_EQ(
      inertia_error("[1, 1, 4]"),
      "pool.toml:5: body 7, [body.client]: inertia = [1, 1, 4]; expected principal moments of which none "
      "exceeds the sum of the other two, as for any body (here they are 1, 1, 4 kg m^2). Likely cause: a "
      "number in another unit, another order of the numbers (URDF's is Ixx, Ixy, Ixz, Iyy, Iyz, Izz), a "
      "product of inertia of the wrong sign, sums of m x^2 instead of m (y^2 + z^2), or too large a "
      "correction from another point to the centre of mass. Give [Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, "
      "Ixz, Iyz] about the centre of mass, or leave inertia out: it then follows from a closed mesh.");
  for (const char* inertia : {"[4, 1, 1]", "[1, 4, 1]", "[8.0, 230.0, 245.0]", "[1e300, 1e300, 4e300]",
                              "[1e-300, 1e-300, 4e-300]", "[2, 2, 2, 1.5, 0, 0]", "[1, 1, 2.03]"}) {
    EXPECT_THAT(inertia_error(inertia), HasSubstr("the sum of the other two")) << inertia;
  }
}

TEST(SceneFile, AcceptsInertiaOfThinPlatesAndRods) {
  for (const char* inertia :
       {"[1, 1, 2]", "[0.0833, 0.0833, 0.1667]", "[0.333, 0.333, 0.667]", "[1e-9, 1, 1]", "[0.1, 0.2, 0.3]",
        "[1.5, 1.5, 1, 0.5, 0, 0]", "[1e300, 1e300, 2e300]", "[5e-324, 5e-324, 5e-324]"}) {
    EXPECT_EQ(parse_error(scene_with_crate("[body.client]\ninertia = " + std::string(inertia) + "\n")),
              "accepted");
  }
}

TEST(SceneFile, LocatesTomlSyntaxErrors) {
  EXPECT_THAT(parse_error("[world]\nup = [0, 0, 1\n[water]\n"),
              AllOf(StartsWith("pool.toml:3:"), HasSubstr("expected TOML")));
}

TEST(SceneFile, ReportsFirstOfSeveralErrors) {
  EXPECT_THAT(parse_error("[world]\ngravity = -1\n[[body]]\nid = \"x\"\n"), HasSubstr("gravity"));
}

TEST(SceneFile, ResolvesMeshesAgainstItsDirectory) {
  const TempDir directory;
  const auto path = directory.write("pool.toml", "[[body]]\nid = 1\nmesh = \"duck.dae\"\n");
  const Expected<SceneDescription> scene = read_scene_file(path);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->name, path);
  EXPECT_EQ(std::get<MeshFile>(scene->bodies[0].mesh.source).path, directory.path() / "duck.dae");
}

std::string file_error(const std::filesystem::path& path) {
  const Expected<SceneDescription> scene = read_scene_file(path);
  return scene ? "accepted" : scene.error().message();
}

TEST(SceneFile, NamesUnreadableFiles) {
  const TempDir directory;
  const std::filesystem::path missing = directory.path() / "missing.toml";
  EXPECT_THAT(file_error(missing), StartsWith(missing.string() + ": no such file"));
  EXPECT_THAT(file_error(directory.path()), StartsWith(directory.path().string() + ": is a directory"));
  EXPECT_THAT(file_error("/dev/null"), HasSubstr("is not a regular file"));
  EXPECT_THAT(file_error(directory.write("empty.toml", "")), HasSubstr("no body"));
  const std::filesystem::path large = directory.write("large.toml", "");
  std::filesystem::resize_file(large, 64'000'000);
  EXPECT_THAT(file_error(large), HasSubstr(large.string() + ":1:1: ")) << "read, but no TOML";
  std::filesystem::resize_file(large, 64'000'001);
  EXPECT_THAT(file_error(large), HasSubstr("64000001 bytes"));
}

TEST(SingleMeshScene, HasOneBodyInDefaultWater) {
  const SceneDescription scene = single_mesh_scene("models/duck.dae", Method::kExactSurface, 0.25,
                                                   OpenPolicy::kDryBoundary, {.scale = {1.0, 2.0, -3.0}});
  EXPECT_EQ(scene.water.level, 0.0);
  EXPECT_EQ(scene.water.density, 1025.0);
  ASSERT_EQ(scene.bodies.size(), 1U);
  EXPECT_EQ(scene.bodies[0].id, 1);
  EXPECT_EQ(scene.bodies[0].name, "duck.dae");
  EXPECT_EQ(std::get<MeshFile>(scene.bodies[0].mesh.source).path, std::filesystem::path("models/duck.dae"));
  EXPECT_EQ(scene.bodies[0].mesh.placement.scale, Vec3(1.0, 2.0, -3.0));
  EXPECT_EQ(scene.bodies[0].method, Method::kExactSurface);
  EXPECT_EQ(scene.bodies[0].tolerance, 0.25);
  EXPECT_EQ(scene.bodies[0].open, OpenPolicy::kDryBoundary);
}

// A terminal would interpret control characters of the file, so messages must not contain them.
TEST(SceneFile, RemovesControlCharactersFromErrors) {
  for (const std::string& text :
       {scene_with_crate("open = \x7f\n"), scene_with_crate("\"sc\\u001bale\" = 1\n"),
        scene_with_crate("outputs = [\"wre\\u0007nch\"]\n"),
        scene_with_crate("method = \"ex\\u009bact\\n\"\n")}) {
    const std::string message = parse_error(text);
    EXPECT_NE(message, "accepted");
    EXPECT_TRUE(std::none_of(message.begin(), message.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    })) << message;
  }
}

TEST(SceneFile, ReadsEventsInTheOrderOfTime) {
  const std::string inside =
      "[[body.compartment]]\nshape = { type = \"box\" }\n[[body.tank]]\nshape = { type = \"box\" }\nfill = "
      "0\n[body.client]\n";
  const SceneDescription scene =
      parsed(scene_with_crate(
          inside + "[[body.client.event]]\ntime = 5\ncompartment = 0\nflooded = 0.5\n[[body.client.event]]\n"
                   "time = 2.5\ntank = 0\nliquid_volume = 0.25\n"));
  const std::vector<ConditionEvent>& events = scene.bodies[0].dynamics.events;
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].time, 2.5);
  EXPECT_TRUE(events[0].is_tank);
  EXPECT_EQ(events[0].value, 0.25);
  EXPECT_EQ(events[1].time, 5.0);
  EXPECT_FALSE(events[1].is_tank);
  EXPECT_EQ(events[1].index, 0);
  EXPECT_EQ(events[1].value, 0.5);
  for (const auto& [event, expected] : {
           std::pair{"compartment = 0\nflooded = 1", "time"},
           std::pair{"time = 1", "neither 'compartment' nor 'tank'"},
           std::pair{"time = 1\ncompartment = 0\ntank = 0\nflooded = 1\nliquid_volume = 1",
                     "both 'compartment' and 'tank'"},
           std::pair{"time = 1\ncompartment = 0", "flooded"},
           std::pair{"time = 1\ntank = 0", "liquid_volume"},
           std::pair{"time = 1\ncompartment = 0\nliquid_volume = 1", "liquid_volume"},
       }) {
    expect_parse_errors({{scene_with_crate(inside + "[[body.client.event]]\n" + event + "\n"), expected}});
  }
  expect_parse_errors({{scene_with_crate("[body.client]\n[[body.client.event]]\ntime = 1\ntank = 0\n"
                                         "liquid_volume = 1\n"),
                        "the body has none"},
                       {scene_with_crate("[body.client.event]\ntime = 1\n"), "double brackets"}});
}

}  // namespace
}  // namespace buoyancy
