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

TEST(SceneFile, TakesDefaultsForWhatIsLeftOut) {
  const Expected<SceneDescription> scene = parsed(crate_and());
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->name, "pool.toml");
  EXPECT_EQ(scene->water.up_W, Vec3::UnitZ());
  EXPECT_EQ(scene->water.level, 0.0);
  EXPECT_EQ(scene->water.density, 1025.0);
  EXPECT_EQ(scene->water.gravity, 9.80665);
  EXPECT_EQ(scene->limits.vertices, ImportLimits{}.vertices);
  ASSERT_EQ(scene->bodies.size(), 1U);
  const BodyDescription& body = scene->bodies[0];
  EXPECT_EQ(body.id, 7);
  EXPECT_EQ(body.name, "body 7");
  EXPECT_EQ(std::get<Shape>(body.source), Shape(BoxShape{}));
  EXPECT_EQ(body.scale, 1.0);
  EXPECT_EQ(body.method, Method::kHierarchical);
  EXPECT_EQ(body.tolerance, 0.0);
  EXPECT_EQ(body.open, OpenPolicy::kRefuse);
  EXPECT_EQ(body.reference_B, Vec3::Zero());
  EXPECT_EQ(body.source_location, "pool.toml:1");
  EXPECT_FALSE(body.client.given);
}

TEST(SceneFile, TakesEveryKeyThatIsGiven) {
  const Expected<SceneDescription> scene = parsed(R"(
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
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->water.gravity, 1.62);
  EXPECT_TRUE(scene->water.up_W.isApprox(Vec3(0, 0.6, 0.8), 1e-15));
  EXPECT_EQ(scene->water.level, -2.0);
  EXPECT_EQ(scene->water.density, 1000.0);
  EXPECT_EQ(scene->limits.mesh_bytes, 11U);
  EXPECT_EQ(scene->limits.vertices, 12U);
  EXPECT_EQ(scene->limits.faces, 13U);
  EXPECT_EQ(scene->limits.import_seconds, 14.0);

  const BodyDescription& body = scene->bodies.at(0);
  EXPECT_EQ(body.id, 3);
  EXPECT_EQ(body.name, "duck");
  EXPECT_EQ(std::get<MeshFile>(body.source).path, std::filesystem::path("scenes/meshes/duck.dae"));
  EXPECT_EQ(body.scale, 0.01);
  EXPECT_EQ(body.method, Method::kFastSurface);
  EXPECT_EQ(body.tolerance, 0.5);
  EXPECT_EQ(body.open, OpenPolicy::kDryBoundary);
  EXPECT_EQ(body.reference_B, Vec3(1, 2, 3.5));

  const DynamicsSpec& client = body.client;
  EXPECT_TRUE(client.given);
  EXPECT_EQ(client.mass, 12.0);
  EXPECT_FALSE(client.density);
  EXPECT_EQ(client.center_of_mass_B, Vec3(0.1, 0.2, 0.3));
  Mat3 inertia_B;
  inertia_B << 4, 0.4, 0.5, 0.4, 5, 0.6, 0.5, 0.6, 6;
  EXPECT_EQ(client.inertia_B, inertia_B);
  EXPECT_EQ(client.position, Vec3(7, 8, 9));
  EXPECT_EQ(client.orientation.coeffs(), Eigen::Quaterniond(0, 0, 0, -1).coeffs());
  EXPECT_EQ(client.linear_velocity, Vec3::UnitX());
  EXPECT_EQ(client.angular_velocity, Vec3::UnitY());
  EXPECT_EQ(client.linear_damping, 10.0);
  EXPECT_EQ(client.linear_damping_quadratic, 11.0);
  EXPECT_EQ(client.angular_damping, 12.0);
  EXPECT_EQ(client.angular_damping_quadratic, 13.0);
}

TEST(SceneFile, KeepsHydrostaticsOffUnlessTheOutputsNameThem) {
  const auto asks = [](const std::string& keys) {
    return parsed(crate_and(keys)).value().bodies[0].hydrostatics;
  };
  EXPECT_FALSE(asks(""));
  EXPECT_FALSE(asks("outputs = [\"wrench\"]\n"));
  EXPECT_TRUE(asks("outputs = [\"wrench\", \"hydrostatics\"]\n"));
  EXPECT_TRUE(asks("outputs = [\"hydrostatics\", \"wrench\"]\n"));
}

TEST(SceneFile, ReadsEveryMethodByItsName) {
  for (const Method method : kAllMethods) {
    const auto scene = parsed(crate_and("method = \"" + std::string(to_string(method)) + "\"\n"));
    ASSERT_TRUE(scene) << scene.error().message();
    EXPECT_EQ(scene->bodies[0].method, method);
  }
}

TEST(SceneFile, KeepsTheBodiesInTheFilesOrder) {
  const auto scene = parsed(crate_and("[[body]]\nid = -2\nshape = { type = \"sphere\", radius = 2 }\n"));
  ASSERT_TRUE(scene) << scene.error().message();
  ASSERT_EQ(scene->bodies.size(), 2U);
  EXPECT_EQ(scene->bodies[1].id, -2);
  EXPECT_EQ(scene->bodies[1].source_location, "pool.toml:4");
}

TEST(SceneFile, LeavesAnAbsoluteMeshPathAsItIs) {
  const auto scene = parsed("[[body]]\nid = 1\nmesh = \"/models/../models/duck.dae\"\n");
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(std::get<MeshFile>(scene->bodies[0].source).path, std::filesystem::path("/models/duck.dae"));
}

TEST(SceneFile, NormalisesDirectionsOfAnySize) {
  const auto scene =
      parsed(crate_and("[body.client]\norientation = [1e300, 1e300, 0, 0]\n[world]\nup = [0, 0, 1e-300]\n"));
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->water.up_W, Vec3::UnitZ());
  EXPECT_NEAR(scene->bodies[0].client.orientation.norm(), 1.0, 1e-15);
}

TEST(SceneFile, SaysInFullWhatIsWrong) {
  EXPECT_EQ(refusal_of(crate_and("[body.client]\nmass = -1\n")),
            "pool.toml:5: body 7, [body.client]: mass = -1; expected a finite number above 0 (kg).");
  EXPECT_EQ(
      refusal_of("[water]\ndesnity = 1000\n" + crate_and()),
      "pool.toml:2: [water]: unknown key 'desnity'; expected one of level, density. The nearest known key is "
      "'density'.");
}

TEST(SceneFile, NamesTheNearestKeyOfAnUnknownOneInEveryTable) {
  const std::vector<std::pair<std::string, std::string>> mistyped{
      {crate_and("[wrold]\nup = [0, 0, 1]\n"), "pool.toml:4: the scene: unknown key 'wrold'"},
      {"[[boddy]]\nid = 1\n", "nearest known key is 'body'"},
      {crate_and("[world]\ngravty = 9.8\n"), "pool.toml:5: [world]: unknown key 'gravty'"},
      {crate_and("[world]\ngravty = 9.8\n"), "nearest known key is 'gravity'"},
      {crate_and("[limits]\nface = 3\n"), "nearest known key is 'faces'"},
      {crate_and("[limits]\nmemory_bytes = 3\n"), "unknown key 'memory_bytes'"},
      {crate_and("metod = \"exact\"\n"), "pool.toml:4: body 7: unknown key 'metod'"},
      {crate_and("metod = \"exact\"\n"), "nearest known key is 'method'"},
      {crate_and("metod = \"exact\"\n"),
       "expected one of id, name, mesh, scale, shape, method, tolerance, open, reference_point, outputs, "
       "client."},
      {crate_and("[body.clinet]\n"), "nearest known key is 'client'"},
      {crate_and("[body.client]\nmas = 3\n"), "pool.toml:5: body 7, [body.client]: unknown key 'mas'"},
      {crate_and("[body.client]\nmas = 3\n"), "nearest known key is 'mass'"},
      {"[[body]]\nidd = 1\nshape = { type = \"box\" }\n", "nearest known key is 'id'"},
      {"[[body]]\nid = 1\nshap = { type = \"box\" }\n", "nearest known key is 'shape'"},
      {"[[body]]\nid = 1\nshape = { type = \"box\", sizes = [1, 1, 1] }\n",
       "pool.toml:3: body 1, shape: unknown key 'sizes'"},
      {"[[body]]\nid = 1\nshape = { type = \"sphere\", stacks = 3 }\n",
       "expected one of type, radius, segments"},
  };
  for (const auto& [text, told] : mistyped) {
    const std::string message = refusal_of(text);
    EXPECT_NE(message.find(told), std::string::npos) << message << "\nshould say: " << told;
  }
}

TEST(SceneFile, RefusesWrongTypesAndRanges) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {crate_and("tolerance = 1.5\n"),
       "pool.toml:4: body 7: tolerance = 1.5; expected a number from 0 to 1."},
      {crate_and("tolerance = -0.1\n"), "tolerance = -0.1"},
      {crate_and("tolerance = nan\n"), "tolerance = nan"},
      {crate_and("tolerance = \"small\"\n"), "tolerance = \"small\"; expected a number"},
      {crate_and("name = 3\n"), "name = 3; expected a text"},
      {crate_and("name = \"\"\n"), "name = \"\"; expected a text"},
      {crate_and("name = \"a\\u001bb\"\n"), "without control characters"},
      {crate_and("method = \"exakt\"\n"),
       "expected one of fast, improved, exact, fast_surface, exact_surface, hierarchical. The nearest is "
       "'exact'."},
      {crate_and("method = \"a\\u001b[31m\"\n"), "method = \"a?[31m\"; expected"},
      {crate_and("method = \"exat\"\n"), "The nearest is 'exact'."},
      {crate_and("method = 3\n"), "method = 3; expected one of fast"},
      {crate_and("open = \"refsue\"\n"), "expected one of refuse, dry_boundary. The nearest is 'refuse'."},
      {crate_and("open = true\n"), "open = true"},
      {crate_and("outputs = [\"hydrostatics\"]\n"),
       "pool.toml:4: body 7: outputs = [\"hydrostatics\"]; expected [\"wrench\"] or [\"wrench\", "
       "\"hydrostatics\"]. Likely cause: wrenches are what every request is answered with. Write outputs = "
       "[\"wrench\", \"hydrostatics\"]."},
      {crate_and("outputs = [\"wrench\", \"hydrostatic\"]\n"),
       "The nearest to 'hydrostatic' is 'hydrostatics'."},
      {crate_and("outputs = [\"wrench\", \"wrench\"]\n"), "expected [\"wrench\"] or [\"wrench\", "},
      {crate_and("outputs = []\n"), "outputs = []; expected [\"wrench\"] or [\"wrench\", \"hydrostatics\"]"},
      {crate_and("outputs = \"wrench\"\n"), "expected [\"wrench\"] or [\"wrench\", "},
      {crate_and("outputs = [\"wrench\", 1]\n"), "expected [\"wrench\"] or [\"wrench\", "},

      {crate_and("reference_point = [1, 2]\n"), "expected an array of 3 finite numbers (m)"},
      {crate_and("reference_point = [1, 2, inf]\n"), "expected an array of 3 finite numbers (m)"},
      {crate_and("reference_point = [1, 2, \"3\"]\n"), "expected an array of 3 finite numbers (m)"},
      {crate_and("reference_point = 3\n"), "expected an array of 3 finite numbers (m)"},
      {crate_and("client = 3\n"), "client = 3; expected a table"},
      {crate_and("scale = 2\n"), "'scale' beside 'shape'"},
      {crate_and("mesh = \"duck.dae\"\n"), "both 'mesh' and 'shape'"},
      {"[[body]]\nid = 1\n", "neither 'mesh' nor 'shape'"},
      {"[[body]]\nid = 1\nmesh = \"duck.dae\"\nscale = 0\n", "scale = 0; expected a finite number above 0."},
      {"[[body]]\nid = 1\nmesh = 5\n", "mesh = 5; expected a text"},
      {"[[body]]\nid = 1\nshape = \"box\"\n", "shape = \"box\"; expected a table"},
      {"[[body]]\nshape = { type = \"box\" }\n", "[[body]] number 1: no key 'id'"},
      {"[[body]]\nid = 1.0\nshape = { type = \"box\" }\n", "id = 1.0; expected a whole number"},
      {"[[body]]\nid = 2147483648\nshape = { type = \"box\" }\n", "id = 2147483648; expected a whole number"},
      {"[body]\nid = 1\n", "Write [[body]] in double brackets"},
      {"body = [1, 2]\n", "expected a section [[body]] for each body"},
      {"body = []\n", "no body"},
      {"", "no body"},
      {crate_and("[[body]]\nid = 7\nshape = { type = \"box\" }\n"),
       "pool.toml:4: body 7: id = 7; expected an id of its own for each body. Likely cause: the body at "
       "pool.toml:1 has the same id."},
      {crate_and("[world]\nup = [0, 0, 0]\n"), "up = [0, 0, 0]; expected a direction"},
      {crate_and("[world]\ngravity = -9.8\n"),
       "gravity = -9.8; expected a finite number of at least 0 (m/s^2)"},
      {crate_and("[water]\ndensity = inf\n"), "density = inf"},
      {crate_and("[water]\nlevel = \"high\"\n"), "level = \"high\"; expected a finite number (m)"},
      {"water = 3\n" + crate_and(), "water = 3; expected a table"},
      {crate_and("[limits]\nmesh_bytes = 0\n"), "mesh_bytes = 0; expected a whole number of at least 1"},
      {crate_and("[limits]\nvertices = 1.5\n"), "vertices = 1.5"},
      {crate_and("[limits]\nfaces = -1\n"), "faces = -1"},
      {crate_and("[limits]\nimport_seconds = 0\n"), "import_seconds = 0"},
      {crate_and("[body.client]\nmass = 1\ndensity = 2\n"), "both 'mass' and 'density'"},
      {crate_and("[body.client]\ndensity = 0\n"), "density = 0; expected a finite number above 0 (kg/m^3)"},
      {crate_and("[body.client]\norientation = [0, 0, 0, 0]\n"),
       "expected a quaternion (w, x, y, z), not zero"},
      {crate_and("[body.client]\norientation = [1, 0, 0]\n"), "expected an array of 4 finite numbers"},
      {crate_and("[body.client]\ninertia = [1, 1]\n"), "expected an array of 3 or 6 finite numbers (kg m^2)"},
      {crate_and("[body.client]\ninertia = [1, 1, 0]\n"), "expected a positive definite matrix"},
      {crate_and("[body.client]\ninertia = [1, 1, 1, 2, 0, 0]\n"), "expected a positive definite matrix"},
      {crate_and("[body.client]\ninertia = [0, 0, 0]\n"), "expected a positive definite matrix"},
      {crate_and("[body.client]\ninertia = [2, 0, 0, 2, 0, 3]\n"), "URDF's is Ixx, Ixy, Ixz, Iyy, Iyz, Izz"},
      {crate_and("[body.client]\nlinear_damping = -1\n"), "linear_damping = -1"},
      {crate_and("[body.client]\nlinear_damping_quadratic = -1\n"), "linear_damping_quadratic = -1"},
      {crate_and("[body.client]\nangular_damping = -1\n"), "angular_damping = -1"},
      {crate_and("[body.client]\nangular_damping_quadratic = -1\n"), "angular_damping_quadratic = -1"},
      {crate_and("[body.client]\ncenter_of_mass = 1\n"), "center_of_mass = 1"},
      {crate_and("[body.client]\nposition = []\n"), "position = []"},
  };
  for (const auto& [text, told] : wrong) {
    const std::string message = refusal_of(text);
    EXPECT_NE(message.find(told), std::string::npos) << message << "\nshould say: " << told;
  }
}

TEST(SceneFile, RefusesAnInertiaThatNoBodyHas) {
  const auto refusal = [](const std::string& inertia) {
    return refusal_of(crate_and("[body.client]\ninertia = " + inertia + "\n"));
  };
  EXPECT_EQ(
      refusal("[1, 1, 4]"),
      "pool.toml:5: body 7, [body.client]: inertia = [1, 1, 4]; expected principal moments of which none is "
      "above the sum of the other two, as of any body (here they are 1, 1, 4 kg m^2). Likely cause: a number "
      "in "
      "another unit, another order of the numbers (URDF's is Ixx, Ixy, Ixz, Iyy, Iyz, Izz), a product of "
      "inertia "
      "of the wrong sign, sums of m x^2 instead of m (y^2 + z^2), or too much taken off to move it from "
      "another "
      "point to the centre of mass. Give [Ixx, Iyy, Izz] or [Ixx, Iyy, Izz, Ixy, Ixz, Iyz] about the centre "
      "of "
      "mass, or leave inertia out: it is then a closed mesh's own.");
  for (const char* inertia : {"[4, 1, 1]", "[1, 4, 1]", "[8.0, 230.0, 245.0]", "[1e300, 1e300, 4e300]",
                              "[1e-300, 1e-300, 4e-300]", "[2, 2, 2, 1.5, 0, 0]", "[1, 1, 2.03]"}) {
    EXPECT_NE(refusal(inertia).find("the sum of the other two"), std::string::npos) << inertia;
  }
}

TEST(SceneFile, TakesTheInertiaOfThinPlatesAndRods) {
  for (const char* inertia :
       {"[1, 1, 2]", "[0.0833, 0.0833, 0.1667]", "[0.333, 0.333, 0.667]", "[1e-9, 1, 1]", "[0.1, 0.2, 0.3]",
        "[1.5, 1.5, 1, 0.5, 0, 0]", "[1e300, 1e300, 2e300]", "[5e-324, 5e-324, 5e-324]"}) {
    const Expected<SceneDescription> scene =
        parsed(crate_and("[body.client]\ninertia = " + std::string(inertia) + "\n"));
    EXPECT_TRUE(scene) << scene.error().message();
  }
}

TEST(SceneFile, SaysWhereItIsNotToml) {
  const std::string message = refusal_of("[world]\nup = [0, 0, 1\n[water]\n");
  EXPECT_EQ(message.rfind("pool.toml:3:", 0), 0U) << message;
  EXPECT_NE(message.find("expected TOML"), std::string::npos) << message;
}

TEST(SceneFile, NamesTheFirstOfSeveralFaults) {
  EXPECT_NE(refusal_of("[world]\ngravity = -1\n[[body]]\nid = \"x\"\n").find("gravity"), std::string::npos);
}

TEST(SceneFile, ResolvesMeshesAgainstItsOwnDirectory) {
  const TempDir directory;
  const auto path = directory.write("pool.toml", "[[body]]\nid = 1\nmesh = \"duck.dae\"\n");
  const Expected<SceneDescription> scene = read_scene_file(path);
  ASSERT_TRUE(scene) << scene.error().message();
  EXPECT_EQ(scene->name, path);
  EXPECT_EQ(std::get<MeshFile>(scene->bodies[0].source).path, directory.path() / "duck.dae");
}

std::string file_refusal(const std::filesystem::path& path) {
  const Expected<SceneDescription> scene = read_scene_file(path);
  return scene ? "accepted" : scene.error().message();
}

TEST(SceneFile, IsNamedWhereItCannotBeRead) {
  const TempDir directory;
  const std::filesystem::path missing = directory.path() / "missing.toml";
  EXPECT_EQ(file_refusal(missing).rfind(missing.string() + ": no such file", 0), 0U);
  EXPECT_EQ(file_refusal(directory.path()).rfind(directory.path().string() + ": is a directory", 0), 0U);
  EXPECT_NE(file_refusal("/dev/null").find("is not a regular file"), std::string::npos);
  EXPECT_NE(file_refusal(directory.write("empty.toml", "")).find("no body"), std::string::npos);
  const std::filesystem::path large = directory.write("large.toml", "");
  std::filesystem::resize_file(large, 64'000'001);
  EXPECT_NE(file_refusal(large).find("64000001 bytes"), std::string::npos);
}

TEST(SingleMeshScenes, HoldOneBodyInTheStandardSea) {
  const SceneDescription scene =
      single_mesh_scene("models/duck.dae", Method::kExactSurface, 0.25, OpenPolicy::kDryBoundary);
  EXPECT_EQ(scene.water.level, 0.0);
  EXPECT_EQ(scene.water.density, 1025.0);
  ASSERT_EQ(scene.bodies.size(), 1U);
  EXPECT_EQ(scene.bodies[0].id, 1);
  EXPECT_EQ(scene.bodies[0].name, "duck.dae");
  EXPECT_EQ(std::get<MeshFile>(scene.bodies[0].source).path, std::filesystem::path("models/duck.dae"));
  EXPECT_EQ(scene.bodies[0].method, Method::kExactSurface);
  EXPECT_EQ(scene.bodies[0].tolerance, 0.25);
  EXPECT_EQ(scene.bodies[0].open, OpenPolicy::kDryBoundary);
}

// A terminal obeys them: what a file holds must not reach it through a message.
TEST(SceneFile, TellsWhatIsWrongWithoutTheFilesControlCharacters) {
  for (const std::string& text :
       {crate_and("open = \x7f\n"), crate_and("\"sc\\u001bale\" = 1\n"),
        crate_and("outputs = [\"wre\\u0007nch\"]\n"), crate_and("method = \"ex\\u009bact\\n\"\n")}) {
    const std::string refusal = refusal_of(text);
    EXPECT_NE(refusal, "accepted");
    EXPECT_TRUE(std::none_of(refusal.begin(), refusal.end(), [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    })) << refusal;
  }
}

}  // namespace
}  // namespace buoyancy
