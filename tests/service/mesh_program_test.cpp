// Runs buoyancy-mesh as a program.
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "geometry/mesh_export.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/support/child_process.h"
#include "tests/support/contains.h"
#include "tests/support/temp_dir.h"

namespace buoyancy::service {
namespace {

using Json = nlohmann::json;

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
  FinishedProcess mesh(std::vector<std::string> arguments) const {
    return run_program("buoyancy-mesh", std::move(arguments));
  }

  TempDir dir_;
};

TEST_F(MeshProgram, ReportsHolesAndTheCommandThatClosesThem) {
  const std::string open = write("open.obj", open_box());
  const FinishedProcess report = mesh({"report", open});
  EXPECT_EQ(report.exit_code, 1);
  EXPECT_TRUE(contains(report.standard_output, "1: 4 edges"));
  EXPECT_TRUE(contains(report.standard_output, "buoyancy-mesh repair " + open + " OUTPUT.ply --rims"));

  const Json json = Json::parse(mesh({"report", "--json", open}).standard_output);
  EXPECT_EQ(json["usable"], 0);
  EXPECT_FALSE(json["meshes"][0]["usable"].get<bool>());
  EXPECT_NEAR(json["meshes"][0]["closing"]["volume"].get<double>(), 8.0, 1e-12);
  EXPECT_NEAR(json["meshes"][0]["holes"][0]["area"].get<double>(), 8.0, 1e-12);
  EXPECT_TRUE(json["meshes"][0]["error"].is_string());
}

TEST_F(MeshProgram, ReportsManyMeshesInALineEach) {
  const std::string good = write("good.obj", rock_mesh());
  const std::string bad = write("bad.obj", open_box());
  const FinishedProcess report = mesh({"report", good, bad, path("none.stl")});
  EXPECT_EQ(report.exit_code, 1);
  EXPECT_TRUE(contains(report.standard_output, "good.obj: usable, "));
  EXPECT_TRUE(contains(report.standard_output, "bad.obj: not usable: "));
  EXPECT_TRUE(contains(report.standard_output, "none.stl: not usable: "));
  EXPECT_TRUE(contains(report.standard_output, "3 meshes: 1 usable, 2 not\n"));
  EXPECT_EQ(mesh({"report", good, good}).exit_code, 0);
}

TEST_F(MeshProgram, WritesWhatTheServiceAccepts) {
  const std::string open = write("open.obj", open_box());
  for (const std::string ending : {".stl", ".PLY", ".obj"}) {
    const std::string output = path("closed" + ending);
    const FinishedProcess repair = mesh({"repair", open, output, "--rims"});
    ASSERT_EQ(repair.exit_code, 0) << repair.standard_error;
    const FinishedProcess report = mesh({"report", "--json", output});
    EXPECT_EQ(report.exit_code, 0) << report.standard_output;
    const Json json = Json::parse(report.standard_output)["meshes"][0];
    EXPECT_NEAR(json["volume"].get<double>(), 8.0, 1e-6);
    EXPECT_TRUE(json["repair"]["steps"].empty());
    // Repaired again, it stays as it is, byte by byte.
    const std::string again = path("again" + ending);
    ASSERT_EQ(mesh({"repair", output, again}).exit_code, 0);
    EXPECT_EQ(read_file(output), read_file(again)) << ending;
    const std::string scene = dir_.write("scene.toml", "[[body]]\nid = 1\nmesh = \"closed" + ending + "\"\n");
    EXPECT_EQ(run_program("buoyancyd", {"--scene", scene, "--check"}).exit_code, 0);
  }
}

TEST_F(MeshProgram, WritesNothingIfTheMeshCannotBeHad) {
  const std::string open = write("open.obj", open_box());
  const FinishedProcess repair = mesh({"repair", open, path("closed.ply"), "--close"});
  EXPECT_EQ(repair.exit_code, 1);
  EXPECT_TRUE(contains(repair.standard_output, "too large"));
  EXPECT_TRUE(contains(repair.standard_error, "boundary edges"));
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
  const FinishedProcess one = mesh({"repair", tube, path("closed.ply"), "--rim", "2"});
  EXPECT_EQ(one.exit_code, 1);
  EXPECT_TRUE(contains(one.standard_error,
                       "Hole 1 (2 m^2, between (0, 0, 0) and (0, 2, 1)) would be left: add --rim 1"));
  const FinishedProcess both = mesh({"repair", tube, path("closed.ply"), "--rim", "2", "--rim", "1"});
  EXPECT_EQ(both.exit_code, 0) << both.standard_error;
  EXPECT_TRUE(contains(both.standard_output, "2 holes closed by flat caps, 4 m^2"));
  EXPECT_TRUE(
      contains(both.standard_output,
               "different caps over them differ by 0 m^3 (estimate; exact if the openings are flat)"));
  const FinishedProcess raised = mesh({"repair", tube, path("closed.ply"), "--freeboard", "1", "--up", "x"});
  EXPECT_TRUE(contains(raised.standard_error, "Holes that do not face up would be left: add --rims"));
}

TEST_F(MeshProgram, PlacesAndMirrorsWhatItWrites) {
  // Half a box in millimetres, y up, with an open side in its plane of symmetry z = 0.
  TriangleMesh half = box_mesh({0.0, 0.0, 0.0}, {4000.0, 1000.0, 500.0});
  std::erase_if(half.triangles, [&half](const Triangle& t) {
    return half.vertex(t[0]).z() == 0.0 && half.vertex(t[1]).z() == 0.0 && half.vertex(t[2]).z() == 0.0;
  });
  const std::string input = write("half.obj", half);
  const std::string output = path("whole.stl");
  const FinishedProcess repair =
      mesh({"repair", input, output, "--mirror", "z", "--scale", "0.001", "--up", "y", "--json"});
  ASSERT_EQ(repair.exit_code, 0) << repair.standard_error;
  const Json json = Json::parse(repair.standard_output);
  EXPECT_NEAR(json["volume"].get<double>(), 4.0, 1e-6);
  EXPECT_EQ(json["repair"]["steps"][0]["step"], "mirror");
  const Json box = Json::parse(mesh({"report", "--json", output}).standard_output)["meshes"][0]["box"];
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
  EXPECT_EQ(read_file(stl), read_file(again));
  EXPECT_EQ(read_file(stl).size(), 84 + 50 * rock.triangles.size());
}

TEST_F(MeshProgram, ComparesMeshes) {
  const std::string box = write("box.obj", box_mesh(Vec3::Zero(), {4.0, 2.0, 1.0}));
  const std::string high = write("high.obj", box_mesh(Vec3::Zero(), {4.0, 2.0, 1.5}));
  const FinishedProcess compare =
      mesh({"compare", box, high, "--json", "--poses", "500", "--density", "1000", "--gravity", "10"});
  ASSERT_EQ(compare.exit_code, 0) << compare.standard_error;
  const Json json = Json::parse(compare.standard_output);
  EXPECT_NEAR(json["a"]["volume"].get<double>(), 8.0, 1e-12);
  EXPECT_NEAR(json["b"]["centroid"][2].get<double>(), 0.75, 1e-12);
  EXPECT_NEAR(json["volume_between"].get<double>(), 4.0, json["volume_between_error"].get<double>());
  EXPECT_LT(json["volume_between_error"].get<double>(), 1e-9);
  EXPECT_NEAR(json["distance_from_b"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(json["force_difference"].get<double>(), 40'000.0, 40'000.0 * 1e-9);
  EXPECT_LE(json["force_difference"].get<double>(), json["force_bound"].get<double>());
  EXPECT_TRUE(contains(mesh({"compare", box, high}).standard_output, "never more than"));
  const FinishedProcess open = mesh({"compare", box, write("open.obj", open_box())});
  EXPECT_EQ(open.exit_code, 1);
  EXPECT_TRUE(contains(open.standard_error, "compare needs two closed meshes"));
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
  const FinishedProcess wrap = mesh({"repair", input, path("wrap.ply"), "--wrap", "0.05", "--json"});
  if (wrap.standard_error.find("built with OpenVDB") != std::string::npos)
    GTEST_SKIP() << wrap.standard_error;
  ASSERT_EQ(wrap.exit_code, 0) << wrap.standard_error;
  const Json json = Json::parse(wrap.standard_output);
  EXPECT_NEAR(json["volume"].get<double>(), std::pow(0.52, 3.0), 0.02 * std::pow(0.52, 3.0));
  EXPECT_LT(json["wrap"]["distance_from_wrap"].get<double>(), 0.03);
  EXPECT_EQ(mesh({"report", path("wrap.ply")}).exit_code, 0);

  // Half of a longer box, without the plate in its plane of symmetry.
  TriangleMesh half = apart;
  for (double& x : half.x) x += 0.25;
  std::erase_if(half.triangles, [&half](const Triangle& t) {
    return half.vertex(t[0]).x() < 0.0 && half.vertex(t[1]).x() < 0.0 && half.vertex(t[2]).x() < 0.0;
  });
  const FinishedProcess whole = mesh(
      {"repair", write("half.obj", half), path("whole.ply"), "--mirror", "x", "--wrap", "0.05", "--json"});
  ASSERT_EQ(whole.exit_code, 0) << whole.standard_error;
  const double expected = 1.02 * 0.52 * 0.52;
  EXPECT_NEAR(Json::parse(whole.standard_output)["volume"].get<double>(), expected, 0.02 * expected);

  const FinishedProcess too_fine = mesh({"repair", input, path("wrap.ply"), "--wrap", "1e-5"});
  EXPECT_EQ(too_fine.exit_code, 1);
  EXPECT_TRUE(contains(too_fine.standard_error, "a finer grid than memory holds"));
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
    const FinishedProcess refused = mesh(arguments);
    EXPECT_EQ(refused.exit_code, 2) << arguments[0] << " " << refused.standard_error;
    EXPECT_EQ(refused.standard_error.rfind("buoyancy-mesh: ", 0), 0U) << refused.standard_error;
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
  const FinishedProcess check = run_program("buoyancyd", {"--scene", scene, "--check"});
  EXPECT_EQ(check.exit_code, 2);
  EXPECT_TRUE(contains(check.standard_output, "1: 4 edges"));
  EXPECT_TRUE(contains(check.standard_error, "body 1, "));
  EXPECT_TRUE(contains(check.standard_error, "body 2, part 'part 0', "));
  EXPECT_TRUE(contains(check.standard_error, "refused for body 1"));
  EXPECT_EQ(check.standard_output.find("mesh "), check.standard_output.rfind("mesh "))
      << check.standard_output;
  EXPECT_FALSE(contains(check.standard_error, "body 3"));
  const Json json =
      Json::parse(run_program("buoyancyd", {"--scene", scene, "--check", "--json"}).standard_output);
  ASSERT_EQ(json["refused"].size(), 3U);
  EXPECT_EQ(json["refused"][0]["holes"].size(), 1U);
  EXPECT_TRUE(json["refused"][1]["error"].is_string());
  EXPECT_EQ(json["refused"][2].size(), 1U) << "the error alone: the mesh was reported before";
}

}  // namespace
}  // namespace buoyancy::service
