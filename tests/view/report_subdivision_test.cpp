// Compartments and tanks in the page of buoyancy-report, in a real browser.
#include <array>
#include <cmath>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "engine/subdivision_load.h"
#include "scene/scene.h"
#include "tests/support/contains.h"
#include "tests/view/report_page_test.h"
#include "tests/view/subdivided_hull.h"

namespace buoyancy::view {
namespace {

constexpr double kFloatRounding = 2e-6;  // of the page's coordinates, which are float32

class ReportPageOfTanks : public ReportPageTest {
 protected:
  void SetUp() override {
    PageTest::SetUp();
    scene_path_ = write_subdivided_hull(directory_);
  }

  // A run of these attitudes of body 1, one second apart, with its origin a metre over the water.
  void open(const std::vector<Eigen::Quaterniond>& attitudes) {
    std::string run = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";
    for (std::size_t i = 0; i < attitudes.size(); ++i) {
      const Eigen::Quaterniond& q = attitudes[i];
      run += std::to_string(1'000'000 * i);
      run += ",1,0,0,1";
      for (const double component : {q.w(), q.x(), q.y(), q.z()}) run += ',' + format_shortest(component);
      run += '\n';
    }
    open_run(scene_path_, directory_.write("run.csv", run));
  }

  std::string scene_path_;
};

TEST_F(ReportPageOfTanks, FillsTanksToTheirVolumeAtEveryAttitude) {
  // Upright, on its side, and any.
  std::vector<Eigen::Quaterniond> attitudes{Eigen::Quaterniond::Identity(),
                                            Eigen::Quaterniond(std::sqrt(0.5), std::sqrt(0.5), 0.0, 0.0)};
  std::mt19937_64 generator(2501);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    const double w = normal(generator);
    const double x = normal(generator);
    const double y = normal(generator);
    attitudes.push_back(Eigen::Quaterniond(w, x, y, normal(generator)).normalized());
  }
  std::vector<double> times(attitudes.size());
  std::iota(times.begin(), times.end(), 0.0);
  ASSERT_NO_FATAL_FAILURE(open(attitudes));
  // Of the drawn triangles, whose corners are relative to the tank's centre.
  const nlohmann::json drawn = browser().run(R"(
    const { scene, seek } = buoyancy_report;
    const { tanks } = scene.bodies.get(1).group.inside;
    const cross = (u, v) => [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    const describe = ({ walls, surface, level }) => {
      let volume = 0, area = [0, 0, 0], upwards = Infinity, unlevel = 0, above = -Infinity;
      walls.updateMatrixWorld(true);
      const height_of = (corner) => walls.localToWorld(new THREE.Vector3(...corner)).dot(scene.up);
      const top = surface.geometry.getAttribute('position').array;
      const level_W = height_of(Array.from(top.slice(0, 3)));
      for (const [mesh, is_surface] of [[walls, false], [surface, true]]) {
        const numbers = mesh.geometry.getAttribute('position').array;
        for (let i = 0; i < numbers.length; i += 9) {
          const [a, b, c] = [0, 3, 6].map((k) => Array.from(numbers.slice(i + k, i + k + 3)));
          const normal = cross(b.map((x, k) => x - a[k]), c.map((x, k) => x - a[k]));
          volume += dot(a, cross(b, c)) / 6;
          area = area.map((x, k) => x + 0.5 * normal[k]);
          for (const corner of [a, b, c]) {
            const height = height_of(corner) - level_W;
            if (is_surface) unlevel = Math.max(unlevel, Math.abs(height));
            else above = Math.max(above, height);
          }
          if (is_surface) {
            const turned = new THREE.Vector3(...normal).applyQuaternion(walls.parent.quaternion);
            upwards = Math.min(upwards, turned.dot(scene.up));
          }
        }
      }
      return { volume, open: Math.hypot(...area), upwards, unlevel, above, level };
    };
    return arguments[0].map((time) => { seek(time); return tanks.map(describe); });)",
                                             times);
  const Scene scene = Scene::load(scene_path_).value();
  const std::vector<BodyTank>& tanks = scene.bodies()[0].subdivision->tanks;
  for (std::size_t i = 0; i < attitudes.size(); ++i) {
    for (std::size_t t = 0; t < tanks.size(); ++t) {
      SCOPED_TRACE(testing::Message() << "attitude " << i << ", tank " << tanks[t].name);
      const nlohmann::json& liquid = drawn[i][t];
      EXPECT_NEAR(liquid["volume"].get<double>(), tanks[t].liquid_volume, 10 * kFloatRounding);
      EXPECT_LT(liquid["open"].get<double>(), 10 * kFloatRounding) << "walls and surface close";
      EXPECT_LT(liquid["unlevel"].get<double>(), kFloatRounding);
      EXPECT_LT(liquid["above"].get<double>(), kFloatRounding);
      EXPECT_GT(liquid["upwards"].get<double>(), -kFloatRounding);
      const TankLiquid exact = tank_liquid(with_liquid(tanks[t], tanks[t].liquid_volume),
                                           attitudes[i].conjugate() * scene.water().up_W);
      EXPECT_NEAR(liquid["level"].get<double>(), exact.surface.h_c, kFloatRounding);
    }
  }
}

TEST_F(ReportPageOfTanks, ShowsLiquidUpToItsLevelThroughHull) {
  ASSERT_NO_FATAL_FAILURE(open({Eigen::Quaterniond::Identity(), Eigen::Quaterniond::Identity()}));
  browser().run(
      "buoyancy_report.scene.elevation = 0; buoyancy_report.scene.azimuth = -Math.PI / 2;"
      "buoyancy_report.scene.render();");  // from the side
  const Image image = browser().screenshot();
  const auto at = [&image](std::array<int, 2> pixel) { return image.pixel(pixel[0], pixel[1]); };
  // The wide tank is from 0.9 to 2.9 m over the water. Its wall at y = -1 is towards the camera.
  const auto is_liquid = [](const Colour& colour) { return colour.blue > colour.green + 15; };
  EXPECT_TRUE(is_liquid(at(pixel_of(-1.2, -1.0, 1.7))));
  EXPECT_FALSE(is_liquid(at(pixel_of(-1.2, -1.0, 2.1))));
  EXPECT_FALSE(is_liquid(at(pixel_of(-1.8, -1.0, 1.7)))) << "beside the tank";
  const auto share = [&](int x, int from, int to) {
    int liquid = 0;
    for (int y = from; y < to; ++y) liquid += is_liquid(image.pixel(x, y)) ? 1 : 0;
    return static_cast<double>(liquid) / (to - from);
  };
  const std::array<int, 2> top = pixel_of(-1.2, -1.0, 2.9);
  const std::array<int, 2> bottom = pixel_of(-1.2, -1.0, 0.9);
  EXPECT_NEAR(share(top[0], top[1], bottom[1]), 0.5, 0.04);
  // The hull keeps its waterline.
  EXPECT_TRUE(waterline_at(image, 1.9, -1.5, 0.0));
}

TEST_F(ReportPageOfTanks, TintsAndListsWhatIsInside) {
  ASSERT_NO_FATAL_FAILURE(open({Eigen::Quaterniond::Identity(), Eigen::Quaterniond::Identity()}));
  const nlohmann::json tints = browser().run(R"(
    const { compartments } = buoyancy_report.scene.bodies.get(1).group.inside;
    const colours = ['compartment', 'flooded'].map((name) => new THREE.Color(subdivision_colours[name]));
    return compartments.map(({ material: { uniforms } }) => (uniforms.colour.value.r - colours[0].r) / (colours[1].r - colours[0].r));)");
  EXPECT_NEAR(tints[0].get<double>(), 0.25, 1e-9);
  EXPECT_NEAR(tints[1].get<double>(), 0.0, 1e-9);
  EXPECT_EQ(browser().run("return buoyancy_report.scene.bodies.get(1).drawn.material.transparent;"), true);

  const nlohmann::json table = browser().run(
      "return Array.from(document.querySelectorAll('#subdivision tbody tr')).map((row) => "
      "Array.from(row.cells).map((cell) => cell.textContent));");
  EXPECT_EQ(table, nlohmann::json({{"engine room", "compartment", "2", "permeability 0.85", "25", "–", "–"},
                                   {"hold", "compartment", "2", "permeability 1", "0", "–", "–"},
                                   {"wide", "tank", "12", "1,000 kg/m³", "–", "6", "50"},
                                   {"ring", "tank", "3", "850 kg/m³", "–", "1.25", "41.67"}}));
  EXPECT_TRUE(contains(text_of("#legend"), "flooded compartment"));
  EXPECT_EQ(browser().run("return buoyancy_report.data.model.meshes.length;"), 6)
      << "hull with its part, two compartments, two tanks, box";
}

TEST_F(ReportPageOfTanks, ShowsConditionsFromTheirTimeOn) {
  ASSERT_NO_FATAL_FAILURE(
      // One message cannot be used.
      open_run(scene_path_, directory_.write("run.lcmlog", log_of_conditions()), 1));
  const nlohmann::json shown = browser().run(R"(
    return [0, 1, 2, 3].map((time) => {
      buoyancy_report.seek(time);
      const cells = Array.from(document.querySelectorAll('#subdivision tbody tr')).map((row) => Array.from(row.cells).map((cell) => cell.textContent));
      const { tanks, compartments } = buoyancy_report.scene.bodies.get(1).group.inside;
      return { flooded: cells[0][4], liquid: cells[2][5], fill: cells[2][6], level: tanks[0].level, opacity: compartments[0].material.uniforms.opacity.value };
    });)");
  EXPECT_EQ(shown[0]["flooded"], "25");
  EXPECT_EQ(shown[0]["liquid"], "6");
  EXPECT_NEAR(shown[0]["level"].get<double>(), 0.0, kFloatRounding);
  EXPECT_EQ(shown[1]["liquid"], "12");
  EXPECT_EQ(shown[1]["fill"], "100");
  EXPECT_NEAR(shown[1]["level"].get<double>(), 1.0, kFloatRounding) << "relative to its middle";
  EXPECT_EQ(shown[2]["flooded"], "100");
  EXPECT_GT(shown[2]["opacity"].get<double>(), shown[1]["opacity"].get<double>() + 0.3);
  EXPECT_EQ(shown[3]["liquid"], "–") << "unknown";
}

TEST_F(ReportPageOfTanks, PlacesMetacentreAndCentreOfMass) {
  const std::vector<Eigen::Quaterniond> attitudes{Eigen::Quaterniond::Identity(),
                                                  Eigen::Quaterniond(1.0, 0.3, -0.2, 0.7).normalized(),
                                                  Eigen::Quaterniond(0.2, -1.0, 0.4, 0.3).normalized()};
  ASSERT_NO_FATAL_FAILURE(open(attitudes));
  const Scene scene = Scene::load(scene_path_).value();
  const Body& body = scene.bodies()[0];
  const auto metacentres =
      browser().run("return Array.from(buoyancy_report.bodies[0].metacentres);").get<std::vector<double>>();
  for (std::size_t row = 0; row < attitudes.size(); ++row) {
    const Pose pose{Vec3(0.0, 0.0, 1.0), attitudes[row]};
    const Hydrostatics expected = subdivided_hydrostatics(body, nullptr, scene.water(), pose).value();
    const Hydrostatics of_hull =
        hydrostatics(body.solver.mesh(), pose, scene.water(), body.reference_B, body.center_of_mass_B)
            .value();
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(metacentres.at(6 * row + i),
                  expected.metacenters_W[i / 3][static_cast<Eigen::Index>(i % 3)], 1e-6)
          << row << ' ' << i;
    }
    if (row > 0) continue;  // not every attitude immerses what is flooded
    EXPECT_GT(expected.metacenters_W[0].z(), of_hull.metacenters_W[0].z() + 0.01)
        << "less volume, and that higher";
  }
  // 12 t at -1 m, 6 t of water at 0.4 m, and 1.0625 t of liquid in the ring, which is 0.41667 m high.
  const auto mass_center = browser()
                               .run(
                                   "return buoyancy_report.scene.bodies.get(1).markers.centre_of_mass"
                                   ".position.toArray();")
                               .get<std::vector<double>>();
  const double ring = 1062.5;
  const double mass = 12'000.0 + 6'000.0 + ring;
  EXPECT_NEAR(mass_center[0], ring * 0.5 / mass, kFloatRounding);
  EXPECT_NEAR(mass_center[2], 1.0 + (-12'000.0 + 6'000.0 * 0.4 + ring * (-0.25 + 1.25 / 6.0)) / mass,
              kFloatRounding);
}

}  // namespace
}  // namespace buoyancy::view
