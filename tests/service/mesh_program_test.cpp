// Runs buoyancy-mesh as a program.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/mesh_export.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/support/build_paths.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"

namespace buoyancy::service {
namespace {

using Json = nlohmann::json;

struct ProgramRun {
  int exit_code = -1;
  std::string output;
  std::string error;
};

ProgramRun run(const std::string& name, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), built_program(name));
  ChildProcess program(command_of(std::move(arguments)));
  const std::optional<int> exit_code = program.wait(kWaitTimeout);
  return {exit_code.value_or(-1), program.standard_output(), program.standard_error()};
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

TriangleMesh open_box() {
  TriangleMesh box = box_mesh(Vec3::Zero(), {4.0, 2.0, 1.0});
  std::erase_if(box.triangles, [&box](const Triangle& t) {
    return box.vertex(t[0]).z() == 1.0 && box.vertex(t[1]).z() == 1.0 && box.vertex(t[2]).z() == 1.0;
  });
  return box;
}

class MeshProgram : public testing::Test {
 protected:
  std::string write(const std::string& name, const TriangleMesh& mesh) const {
    return dir_.write(name, export_mesh(mesh, ExportFormat::kObj));
  }
  std::string path(const std::string& name) const { return dir_.path(name); }
  ProgramRun mesh(std::vector<std::string> arguments) const {
    return run("buoyancy-mesh", std::move(arguments));
  }

  TempDir dir_;
};

TEST_F(MeshProgram, ReportsHolesAndTheCommandThatClosesThem) {
  const std::string open = write("open.obj", open_box());
  const ProgramRun report = mesh({"report", open});
  EXPECT_EQ(report.exit_code, 1);
  EXPECT_NE(report.output.find("1: 4 edges"), std::string::npos) << report.output;
  EXPECT_NE(report.output.find("buoyancy-mesh repair " + open + " OUTPUT.ply --rims"), std::string::npos)
      << report.output;

  const Json json = Json::parse(mesh({"report", "--json", open}).output);
  EXPECT_EQ(json["usable"], 0);
  EXPECT_FALSE(json["meshes"][0]["usable"].get<bool>());
  EXPECT_NEAR(json["meshes"][0]["closing"]["volume"].get<double>(), 8.0, 1e-12);
  EXPECT_NEAR(json["meshes"][0]["holes"][0]["area"].get<double>(), 8.0, 1e-12);
  EXPECT_TRUE(json["meshes"][0]["error"].is_string());
}

TEST_F(MeshProgram, ReportsManyMeshesInALineEach) {
  const std::string good = write("good.obj", rock_mesh());
  const std::string bad = write("bad.obj", open_box());
  const ProgramRun report = mesh({"report", good, bad, path("none.stl")});
  EXPECT_EQ(report.exit_code, 1);
  EXPECT_NE(report.output.find("good.obj: usable, "), std::string::npos) << report.output;
  EXPECT_NE(report.output.find("bad.obj: not usable: "), std::string::npos) << report.output;
  EXPECT_NE(report.output.find("none.stl: not usable: "), std::string::npos) << report.output;
  EXPECT_NE(report.output.find("3 meshes: 1 usable, 2 not\n"), std::string::npos) << report.output;
  EXPECT_EQ(mesh({"report", good, good}).exit_code, 0);
}

TEST_F(MeshProgram, WritesWhatTheServiceAccepts) {
  const std::string open = write("open.obj", open_box());
  for (const std::string ending : {".stl", ".PLY", ".obj"}) {
    const std::string output = path("closed" + ending);
    const ProgramRun repair = mesh({"repair", open, output, "--rims"});
    ASSERT_EQ(repair.exit_code, 0) << repair.error;
    const ProgramRun report = mesh({"report", "--json", output});
    EXPECT_EQ(report.exit_code, 0) << report.output;
    const Json json = Json::parse(report.output)["meshes"][0];
    EXPECT_NEAR(json["volume"].get<double>(), 8.0, 1e-6);
    EXPECT_TRUE(json["repair"]["steps"].empty());
    // Repaired again, it stays as it is, byte by byte.
    const std::string again = path("again" + ending);
    ASSERT_EQ(mesh({"repair", output, again}).exit_code, 0);
    EXPECT_EQ(bytes_of(output), bytes_of(again)) << ending;
    const std::string scene = dir_.write("scene.toml", "[[body]]\nid = 1\nmesh = \"closed" + ending + "\"\n");
    EXPECT_EQ(run("buoyancyd", {"--scene", scene, "--check"}).exit_code, 0);
  }
}

TEST_F(MeshProgram, WritesNothingIfTheMeshCannotBeHad) {
  const std::string open = write("open.obj", open_box());
  const ProgramRun repair = mesh({"repair", open, path("closed.ply"), "--close"});
  EXPECT_EQ(repair.exit_code, 1);
  EXPECT_NE(repair.output.find("too large"), std::string::npos) << repair.output;
  EXPECT_NE(repair.error.find("boundary edges"), std::string::npos) << repair.error;
  EXPECT_FALSE(std::filesystem::exists(path("closed.ply")));
}

TEST_F(MeshProgram, NamesTheHolesThatWouldBeLeft) {
  // A box without its two ends.
  TriangleMesh box = box_mesh(Vec3::Zero(), {4.0, 2.0, 1.0});
  std::erase_if(box.triangles, [&box](const Triangle& t) {
    const auto all = [&](auto&& condition) {
      return condition(box.vertex(t[0])) && condition(box.vertex(t[1])) && condition(box.vertex(t[2]));
    };
    return all([](const Vec3& v) { return v.x() == 0.0; }) || all([](const Vec3& v) { return v.x() == 4.0; });
  });
  const std::string tube = write("tube.obj", box);
  const ProgramRun one = mesh({"repair", tube, path("closed.ply"), "--rim", "2"});
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_NE(one.error.find("Hole 1 (2 m^2, between (0, 0, 0) and (0, 2, 1)) would be left: add --rim 1"),
            std::string::npos)
      << one.error;
  const ProgramRun both = mesh({"repair", tube, path("closed.ply"), "--rim", "2", "--rim", "1"});
  EXPECT_EQ(both.exit_code, 0) << both.error;
  EXPECT_NE(both.output.find("2 holes closed by flat caps, 4 m^2"), std::string::npos) << both.output;
  EXPECT_NE(
      both.output.find("different caps over them differ by 0 m^3 (estimate; exact if the openings are flat)"),
      std::string::npos)
      << both.output;
  const ProgramRun raised = mesh({"repair", tube, path("closed.ply"), "--freeboard", "1", "--up", "x"});
  EXPECT_NE(raised.error.find("Holes that do not face up would be left: add --rims"), std::string::npos)
      << raised.error;
}

TEST_F(MeshProgram, PlacesAndMirrorsWhatItWrites) {
  // Half a box in millimetres, y up, with an open side in its plane of symmetry z = 0.
  TriangleMesh half = box_mesh({0.0, 0.0, 0.0}, {4000.0, 1000.0, 500.0});
  std::erase_if(half.triangles, [&half](const Triangle& t) {
    return half.vertex(t[0]).z() == 0.0 && half.vertex(t[1]).z() == 0.0 && half.vertex(t[2]).z() == 0.0;
  });
  const std::string input = write("half.obj", half);
  const std::string output = path("whole.stl");
  const ProgramRun repair =
      mesh({"repair", input, output, "--mirror", "z", "--scale", "0.001", "--up", "y", "--json"});
  ASSERT_EQ(repair.exit_code, 0) << repair.error;
  const Json json = Json::parse(repair.output);
  EXPECT_NEAR(json["volume"].get<double>(), 4.0, 1e-6);
  EXPECT_EQ(json["repair"]["steps"][0]["step"], "mirror");
  const Json box = Json::parse(mesh({"report", "--json", output}).output)["meshes"][0]["box"];
  EXPECT_NEAR(box["max"][2].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(box["max"][1].get<double>() - box["min"][1].get<double>(), 1.0, 1e-6);
}

TEST_F(MeshProgram, KeepsATriangleOrderThatIsInOrder) {
  const TriangleMesh rock = rock_mesh();
  const std::string input = write("rock.obj", rock);
  const std::string stl = path("rock.stl");
  ASSERT_EQ(mesh({"repair", input, stl}).exit_code, 0);
  const std::string again = path("rock_again.stl");
  ASSERT_EQ(mesh({"repair", stl, again}).exit_code, 0);
  EXPECT_EQ(bytes_of(stl), bytes_of(again));
  EXPECT_EQ(bytes_of(stl).size(), 84 + 50 * rock.triangles.size());
}

TEST_F(MeshProgram, ComparesMeshes) {
  const std::string box = write("box.obj", box_mesh(Vec3::Zero(), {4.0, 2.0, 1.0}));
  const std::string high = write("high.obj", box_mesh(Vec3::Zero(), {4.0, 2.0, 1.5}));
  const ProgramRun compare =
      mesh({"compare", box, high, "--json", "--poses", "500", "--density", "1000", "--gravity", "10"});
  ASSERT_EQ(compare.exit_code, 0) << compare.error;
  const Json json = Json::parse(compare.output);
  EXPECT_NEAR(json["a"]["volume"].get<double>(), 8.0, 1e-12);
  EXPECT_NEAR(json["b"]["centroid"][2].get<double>(), 0.75, 1e-12);
  EXPECT_NEAR(json["volume_between"].get<double>(), 4.0, json["volume_between_error"].get<double>());
  EXPECT_LT(json["volume_between_error"].get<double>(), 1e-9);
  EXPECT_NEAR(json["distance_from_b"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(json["force_difference"].get<double>(), 40'000.0, 40'000.0 * 1e-9);
  EXPECT_LE(json["force_difference"].get<double>(), json["force_bound"].get<double>());
  EXPECT_NE(mesh({"compare", box, high}).output.find("never more than"), std::string::npos);
  const ProgramRun open = mesh({"compare", box, write("open.obj", open_box())});
  EXPECT_EQ(open.exit_code, 1);
  EXPECT_NE(open.error.find("compare needs two closed meshes"), std::string::npos) << open.error;
}

TEST_F(MeshProgram, WrapsWhatDoesNotClose) {
  // The sides of a cube as six plates that do not meet.
  TriangleMesh plates = cube_mesh();
  plates = unwelded(plates);
  for (std::size_t i = 0; i < plates.vertex_count(); ++i) {
    for (std::vector<double>* coordinates : {&plates.x, &plates.y, &plates.z}) (*coordinates)[i] *= 0.5;
  }
  TriangleMesh apart;
  for (const Triangle& t : plates.triangles) {
    const Vec3 a = plates.vertex(t[0]);
    const Vec3 normal = (plates.vertex(t[1]) - a).cross(plates.vertex(t[2]) - a).normalized();
    Triangle moved{};
    for (std::size_t i = 0; i < 3; ++i) moved[i] = apart.add_vertex(plates.vertex(t[i]) + 0.01 * normal);
    apart.triangles.push_back(moved);
  }
  const std::string input = write("plates.obj", apart);
  EXPECT_EQ(mesh({"repair", input, path("closed.ply"), "--rims"}).exit_code, 1);
  const ProgramRun wrap = mesh({"repair", input, path("wrap.ply"), "--wrap", "0.05", "--json"});
  if (wrap.error.find("built with OpenVDB") != std::string::npos) GTEST_SKIP() << wrap.error;
  ASSERT_EQ(wrap.exit_code, 0) << wrap.error;
  const Json json = Json::parse(wrap.output);
  EXPECT_NEAR(json["volume"].get<double>(), std::pow(0.52, 3.0), 0.02 * std::pow(0.52, 3.0));
  EXPECT_LT(json["wrap"]["distance_from_wrap"].get<double>(), 0.03);
  EXPECT_EQ(mesh({"report", path("wrap.ply")}).exit_code, 0);

  // Half of a longer box, without the plate in its plane of symmetry.
  TriangleMesh half = apart;
  for (double& x : half.x) x += 0.25;
  std::erase_if(half.triangles, [&half](const Triangle& t) {
    return half.vertex(t[0]).x() < 0.0 && half.vertex(t[1]).x() < 0.0 && half.vertex(t[2]).x() < 0.0;
  });
  const ProgramRun whole = mesh(
      {"repair", write("half.obj", half), path("whole.ply"), "--mirror", "x", "--wrap", "0.05", "--json"});
  ASSERT_EQ(whole.exit_code, 0) << whole.error;
  const double expected = 1.02 * 0.52 * 0.52;
  EXPECT_NEAR(Json::parse(whole.output)["volume"].get<double>(), expected, 0.02 * expected);

  const ProgramRun too_fine = mesh({"repair", input, path("wrap.ply"), "--wrap", "1e-5"});
  EXPECT_EQ(too_fine.exit_code, 1);
  EXPECT_NE(too_fine.error.find("a finer grid than memory holds"), std::string::npos) << too_fine.error;
}

TEST_F(MeshProgram, RefusesOptionsThatDoNotBelongTogether) {
  const std::string box = write("box.obj", cube_mesh());
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"report", box, "--close"},
                                             {"report", box, "--poses", "3"},
                                             {"report", box, "--wrap", "0.1"},
                                             {"repair", box},
                                             {"repair", box, path("box.3mf")},
                                             {"repair", box, box},
                                             {"compare", box},
                                             {"report", box, "--up", "w"},
                                             {"repair", box, path("b.ply"), "--max-change", "-1"},
                                             {"mend", box},
                                             {"report"}}) {
    const ProgramRun refused = mesh(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments[0] << " " << refused.error;
    EXPECT_EQ(refused.error.rfind("buoyancy-mesh: ", 0), 0U) << refused.error;
  }
}

TEST_F(MeshProgram, ChecksEveryMeshOfAScene) {
  write("open.obj", open_box());
  write("good.obj", cube_mesh());
  const std::string scene = dir_.write("scene.toml", R"([[body]]
id = 1
mesh = "open.obj"
[[body]]
id = 2
mesh = "good.obj"
[[body.part]]
mesh = "none.obj"
[[body]]
id = 3
mesh = "open.obj"
close_holes = 3.0
[[body]]
id = 4
mesh = "./open.obj"
)");
  const ProgramRun check = run("buoyancyd", {"--scene", scene, "--check"});
  EXPECT_EQ(check.exit_code, 2);
  EXPECT_NE(check.output.find("1: 4 edges"), std::string::npos) << check.output;
  EXPECT_NE(check.error.find("body 1, "), std::string::npos) << check.error;
  EXPECT_NE(check.error.find("body 2, part 'part 0', "), std::string::npos) << check.error;
  EXPECT_NE(check.error.find("refused for body 1"), std::string::npos) << check.error;
  EXPECT_EQ(check.output.find("mesh "), check.output.rfind("mesh ")) << check.output;
  EXPECT_EQ(check.error.find("body 3"), std::string::npos) << check.error;
  const Json json = Json::parse(run("buoyancyd", {"--scene", scene, "--check", "--json"}).output);
  ASSERT_EQ(json["refused"].size(), 3U);
  EXPECT_EQ(json["refused"][0]["holes"].size(), 1U);
  EXPECT_TRUE(json["refused"][1]["error"].is_string());
  EXPECT_EQ(json["refused"][2].size(), 1U) << "the error alone: the mesh was reported before";
}

}  // namespace
}  // namespace buoyancy::service
