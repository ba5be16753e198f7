// The C interface as C++ sees it: what comparison.c does not compare, errors, handles and threads.

#include <algorithm>
#include <array>
#include <cfenv>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>

#include "c/buoyancy.h"
#include "hydrostatics/hydrostatics.h"
#include "query/pose_evaluation.h"
#include "query/query_mesh.h"
#include "query/query_sea.h"
#include "tests/query/pose_table.h"
#include "tests/support/build_paths.h"
#include "tests/support/scene_of.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t kNow = 1'790'000'000'000'000;  // [us], of 2026
const std::string kWaves =
    "[water]\nlevel = 0.25\nwaves = { type = \"regular\", height = 0.3, period = 2.5, direction = 30 }\n";
const std::string kBodies =
    "[[body]]\nid = 3\nname = \"rock\"\nshape = { type = \"rock\", frequency = 6, radius = 1.0, seed = 5 }\n"
    "outputs = [\"wrench\", \"loads\"]\nreference_point = [0.1, 0.2, 0.3]\n"
    "[body.drag]\nlinear = [20, 60, 60, 5, 5, 8]\n[body.added_mass]\nmatrix = [5, 126, 126, 1, 33, 33]\n"
    "[[body]]\nid = 4\nmethod = \"exact_surface\"\nshape = { type = \"box\", size = [1, 1, 1] }\n";

std::string last_error() {
  return buoyancy_last_error();
}

buoyancy_mesh* tetrahedron() {
  const std::array<double, 12> vertices{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<std::int32_t, 12> faces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  buoyancy_mesh* mesh = nullptr;
  EXPECT_EQ(buoyancy_mesh_create(vertices.data(), 4, faces.data(), 4, nullptr, &mesh), BUOYANCY_OK)
      << last_error();
  return mesh;
}

buoyancy_sea* sea_of(const std::string& text) {
  buoyancy_sea* sea = nullptr;
  EXPECT_EQ(buoyancy_sea_from_toml(text.c_str(), nullptr, &sea), BUOYANCY_OK) << last_error();
  return sea;
}

buoyancy_scene* scene_from(const std::string& text) {
  buoyancy_scene* scene = nullptr;
  EXPECT_EQ(buoyancy_scene_from_toml(text.c_str(), nullptr, &scene), BUOYANCY_OK) << last_error();
  return scene;
}

buoyancy_poses poses_of(const PoseTable& table) {
  return {.size = sizeof(buoyancy_poses),
          .count = static_cast<std::int64_t>(table.size()),
          .positions = table.positions.data(),
          .quaternions = table.quaternions.data(),
          .linear_velocities = table.linear_velocities.data(),
          .angular_velocities = table.angular_velocities.data(),
          .utimes = table.utimes.empty() ? nullptr : table.utimes.data(),
          .utime_count = static_cast<std::int64_t>(table.utimes.size())};
}

buoyancy_wrenches wrenches_of(WrenchTable& table) {
  return {sizeof(buoyancy_wrenches), table.statuses.data(),     table.forces.data(),
          table.torques.data(),      table.volumes.data(),      table.centers.data(),
          table.force_bounds.data(), table.torque_bounds.data()};
}

TEST(CInterface, NamesVersionsErrorsAndStatuses) {
  EXPECT_STREQ(buoyancy_version(), BUOYANCY_TEST_VERSION);
  EXPECT_EQ(buoyancy_version_number() / 10000, std::stoi(BUOYANCY_TEST_VERSION));
  EXPECT_STREQ(buoyancy_error_name(BUOYANCY_OK), "OK");
  EXPECT_STREQ(buoyancy_error_name(BUOYANCY_ERROR_SCENE), "SCENE");
  EXPECT_STREQ(buoyancy_error_name(-5), "UNKNOWN_ERROR");
  for (int value = -1; value <= kBodyStatusCount; ++value) {
    EXPECT_STREQ(buoyancy_status_name(value), to_string(static_cast<BodyStatus>(value)));
  }
  EXPECT_STREQ(buoyancy_status_name(BUOYANCY_STATUS_NO_SEA), "NO_SEA");
}

TEST(CInterface, ReportsWhatValidationFound) {
  buoyancy_mesh* mesh = tetrahedron();
  buoyancy_mesh_info info{};
  info.size = sizeof info;
  ASSERT_EQ(buoyancy_mesh_get_info(mesh, &info), BUOYANCY_OK);
  EXPECT_EQ(info.size, sizeof info);
  EXPECT_EQ(info.triangles, 4);
  EXPECT_EQ(info.vertices_welded, 4);
  EXPECT_NEAR(info.volume, 1.0 / 6.0, 1e-15);
  EXPECT_NEAR(info.centroid[1], 0.25, 1e-15);
  EXPECT_EQ(info.box_max[2], 1.0);
  EXPECT_EQ(info.intersecting_pairs, -1);
  EXPECT_EQ(info.closed, 1);
  EXPECT_EQ(info.flipped, 0);
  EXPECT_EQ(info.components, 1);

  std::size_t length = 0;
  ASSERT_EQ(buoyancy_mesh_report(mesh, nullptr, 0, &length), BUOYANCY_OK);
  std::string text(length + 1, '?');
  ASSERT_EQ(buoyancy_mesh_report(mesh, text.data(), text.size(), nullptr), BUOYANCY_OK);
  EXPECT_EQ(std::strlen(text.c_str()), length);
  std::array<char, 5> cut{'?', '?', '?', '?', '?'};
  ASSERT_EQ(buoyancy_mesh_report(mesh, cut.data(), 4, &length), BUOYANCY_OK);
  EXPECT_EQ(cut[3], '\0');
  EXPECT_EQ(cut[4], '?');
  EXPECT_EQ(text.substr(0, 3), cut.data());
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, AppliesTheOptionsOfAMesh) {
  const std::array<double, 12> vertices{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<std::int64_t, 9> open{0, 2, 1, 0, 1, 3, 0, 3, 2};
  buoyancy_mesh_options options{};
  ASSERT_EQ(buoyancy_default_mesh_options(&options, sizeof options), BUOYANCY_OK);
  options.scale = 2.0;
  options.count_intersecting_pairs = 1;
  buoyancy_mesh* mesh = nullptr;
  EXPECT_EQ(buoyancy_mesh_create_64(vertices.data(), 4, open.data(), 3, &options, &mesh),
            BUOYANCY_ERROR_MESH);
  EXPECT_EQ(mesh, nullptr);
  EXPECT_NE(last_error().find("mesh: "), std::string::npos) << last_error();
  options.open = BUOYANCY_OPEN_DRY_BOUNDARY;
  ASSERT_EQ(buoyancy_mesh_create_64(vertices.data(), 4, open.data(), 3, &options, &mesh), BUOYANCY_OK)
      << last_error();
  buoyancy_mesh_info info{};
  info.size = sizeof info;
  ASSERT_EQ(buoyancy_mesh_get_info(mesh, &info), BUOYANCY_OK);
  EXPECT_EQ(info.box_max[0], 2.0);
  EXPECT_EQ(info.closed, 0);
  EXPECT_EQ(info.holes, 1);
  EXPECT_EQ(info.intersecting_pairs, 0);
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, GivesOnlyTheResultsThatAreWanted) {
  buoyancy_mesh* mesh = tetrahedron();
  const PoseTable table = random_poses(50, 0.5, 3);
  const buoyancy_poses poses = poses_of(table);
  WrenchTable all(table.size());
  WrenchTable some(table.size());
  const WrenchTable untouched(table.size());
  const buoyancy_wrenches wrenches = wrenches_of(all);
  ASSERT_EQ(buoyancy_mesh_query(mesh, nullptr, BUOYANCY_METHOD_HIERARCHICAL, 0.0, &poses, &wrenches, 1),
            BUOYANCY_OK);
  buoyancy_wrenches wanted{};
  wanted.size = sizeof wanted;
  wanted.torques = some.torques.data();
  ASSERT_EQ(buoyancy_mesh_query(mesh, nullptr, BUOYANCY_METHOD_HIERARCHICAL, 0.0, &poses, &wanted, 1),
            BUOYANCY_OK);
  EXPECT_EQ(some.torques, all.torques);
  EXPECT_EQ(some.forces, untouched.forces);
  EXPECT_EQ(some.statuses, untouched.statuses);
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, GivesPosesThatCannotBeEvaluatedAStatus) {
  buoyancy_mesh* mesh = tetrahedron();
  PoseTable table = random_poses(4, 0.5, 3);
  table.positions[3] = kInfinity;
  table.quaternions[8] = 2.0;
  const buoyancy_poses poses = poses_of(table);
  WrenchTable out(table.size());
  const buoyancy_wrenches wrenches = wrenches_of(out);
  ASSERT_EQ(buoyancy_mesh_query(mesh, nullptr, BUOYANCY_METHOD_HIERARCHICAL, 0.0, &poses, &wrenches, 1),
            BUOYANCY_OK);
  EXPECT_EQ(out.statuses, (std::vector<std::int32_t>{BUOYANCY_STATUS_OK, BUOYANCY_STATUS_NON_FINITE_POSE,
                                                     BUOYANCY_STATUS_BAD_QUATERNION, BUOYANCY_STATUS_OK}));
  EXPECT_EQ(out.forces[5], 0.0);
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, KnowsEveryMethod) {
  buoyancy_mesh* mesh = tetrahedron();
  const auto same = QueryMesh::make(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                                    std::vector<std::int64_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "mesh")
                        .value();
  const PoseTable table = random_poses(50, 0.5, 3);
  const buoyancy_poses poses = poses_of(table);
  const std::array methods{std::pair{BUOYANCY_METHOD_HIERARCHICAL, Method::kHierarchical},
                           std::pair{BUOYANCY_METHOD_FAST, Method::kFast},
                           std::pair{BUOYANCY_METHOD_IMPROVED, Method::kImproved},
                           std::pair{BUOYANCY_METHOD_EXACT, Method::kExact},
                           std::pair{BUOYANCY_METHOD_FAST_SURFACE, Method::kFastSurface},
                           std::pair{BUOYANCY_METHOD_EXACT_SURFACE, Method::kExactSurface}};
  static_assert(methods.size() == kAllMethods.size());
  for (const auto& [number, method] : methods) {
    WrenchTable computed(table.size());
    WrenchTable expected(table.size());
    const buoyancy_wrenches wrenches = wrenches_of(computed);
    ASSERT_EQ(buoyancy_mesh_query(mesh, nullptr, number, 0.0, &poses, &wrenches, 1), BUOYANCY_OK);
    evaluate_poses(*same->body(method, 0.0, false).value(), {}, table.arrays(), expected.arrays());
    EXPECT_EQ(computed, expected) << to_string(method);
  }
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, GivesTheLoadsOfABody) {
  const std::string text = kWaves + "[water.current]\nvelocity = [0.3, -0.2, 0.1]\n" + kBodies;
  buoyancy_scene* scene = scene_from(text);
  const Scene same = scene_of(text);
  PoseTable table = random_poses(9000, 1.0, 8);  // more than one block
  table.utimes = {kNow};
  table.positions[3] = kInfinity;
  const std::size_t n = table.size();
  const buoyancy_poses poses = poses_of(table);
  WrenchTable computed(n);
  WrenchTable expected(n);
  std::vector<double> immersions(n, 9.0), forces(3 * n), drag_torques(3 * n), masses(36 * n),
      dampings(36 * n), water(3 * n);
  buoyancy_loads loads{};
  loads.size = sizeof loads;
  loads.immersions = immersions.data();
  loads.buoyancy_forces = forces.data();
  loads.drag_torques = drag_torques.data();
  loads.added_masses = masses.data();
  loads.dampings = dampings.data();
  loads.water_velocities = water.data();
  const buoyancy_wrenches wrenches = wrenches_of(computed);
  ASSERT_EQ(buoyancy_scene_query(scene, 3, &poses, &wrenches, &loads, 0), BUOYANCY_OK) << last_error();
  std::vector<BodyLoads> expected_loads(n);
  evaluate_poses(*same.find(3), water_of(same), table.arrays(), expected.arrays(), expected_loads);
  EXPECT_EQ(computed, expected);
  for (std::size_t i = 0; i < n; ++i) {
    const BodyLoads& of = expected_loads[i];
    ASSERT_EQ(immersions[i], of.immersion) << i;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(forces[3 * i + k], of.buoyancy_force[k]);
      EXPECT_EQ(drag_torques[3 * i + k], of.drag_torque[k]);
      EXPECT_EQ(water[3 * i + k], of.water_velocity[k]);
    }
    for (std::size_t k = 0; k < 36; ++k) {
      EXPECT_EQ(masses[36 * i + k], of.added_mass[k / 6][k % 6]);
      EXPECT_EQ(dampings[36 * i + k], of.damping[k / 6][k % 6]);
    }
  }
  EXPECT_EQ(immersions[1], 0.0);
  buoyancy_scene_free(scene);
}

TEST(CInterface, ListsTheBodiesOfAScene) {
  buoyancy_scene* scene = scene_from(kBodies);
  std::int64_t count = 0;
  ASSERT_EQ(buoyancy_scene_body_count(scene, &count), BUOYANCY_OK);
  EXPECT_EQ(count, 2);
  buoyancy_body_info rock{};
  buoyancy_body_info box{};
  rock.size = sizeof rock;
  box.size = sizeof box;
  ASSERT_EQ(buoyancy_scene_get_body(scene, 0, &rock), BUOYANCY_OK);
  ASSERT_EQ(buoyancy_scene_get_body(scene, 1, &box), BUOYANCY_OK);
  EXPECT_EQ(rock.id, 3);
  EXPECT_STREQ(rock.name, "rock");
  EXPECT_EQ(rock.method, BUOYANCY_METHOD_HIERARCHICAL);
  EXPECT_EQ(rock.reference_point[2], 0.3);
  EXPECT_TRUE(std::isnan(rock.center_of_mass[0]));
  EXPECT_EQ(rock.has_loads, 1);
  EXPECT_EQ(rock.has_hydrostatics, 1);
  EXPECT_EQ(box.method, BUOYANCY_METHOD_EXACT_SURFACE);
  EXPECT_EQ(box.has_loads, 0);
  EXPECT_EQ(box.has_hydrostatics, 0);
  EXPECT_NEAR(box.volume, 1.0, 1e-15);
  EXPECT_EQ(buoyancy_scene_get_body(scene, 2, &box), BUOYANCY_ERROR_INVALID_ARGUMENT);
  EXPECT_EQ(buoyancy_scene_get_body(scene, -1, &box), BUOYANCY_ERROR_INVALID_ARGUMENT);
  buoyancy_scene_free(scene);
}

TEST(CInterface, GivesHydrostatics) {
  buoyancy_mesh* mesh = tetrahedron();
  buoyancy_scene* scene = scene_from(kBodies);
  const Scene same = scene_of(kBodies);
  const PoseTable table = random_poses(300, 1.0, 12);
  const std::size_t n = table.size();
  const buoyancy_poses poses = poses_of(table);
  std::vector<std::int32_t> statuses(n, -1);
  std::vector<double> volumes(n), axes(6 * n), heights(2 * n), stiffnesses(36 * n);
  buoyancy_hydrostatics hydrostatics{};
  hydrostatics.size = sizeof hydrostatics;
  hydrostatics.statuses = statuses.data();
  hydrostatics.volumes = volumes.data();
  hydrostatics.waterplane_axes = axes.data();
  hydrostatics.metacentric_heights = heights.data();
  hydrostatics.stiffnesses = stiffnesses.data();
  ASSERT_EQ(buoyancy_scene_hydrostatics(scene, 3, &poses, &hydrostatics, 2), BUOYANCY_OK) << last_error();
  std::vector<BodyHydrostatics> expected(n);
  evaluate_hydrostatics(*same.find(3), same.water(), table.arrays(), expected);
  for (std::size_t i = 0; i < n; ++i) {
    EXPECT_EQ(statuses[i], static_cast<std::int32_t>(expected[i].status));
    EXPECT_EQ(volumes[i], expected[i].submerged_volume);
    EXPECT_TRUE(std::isnan(heights[2 * i]));  // the scene gives no centre of mass
    for (std::size_t k = 0; k < 36; ++k)
      EXPECT_EQ(stiffnesses[36 * i + k], expected[i].stiffness[k / 6][k % 6]);
    for (std::size_t k = 0; k < 6; ++k) {
      const double axis = expected[i].waterplane_axes[k / 3][k % 3];
      EXPECT_TRUE(axes[6 * i + k] == axis || std::isnan(axis));
    }
  }
  EXPECT_EQ(buoyancy_scene_hydrostatics(scene, 4, &poses, &hydrostatics, 1), BUOYANCY_ERROR_SCENE);
  EXPECT_NE(last_error().find("hydrostatics"), std::string::npos);

  const std::array<double, 3> center{0.25, 0.25, 0.25};
  ASSERT_EQ(buoyancy_mesh_hydrostatics(mesh, nullptr, center.data(), &poses, &hydrostatics, 1), BUOYANCY_OK);
  const auto wet =
      static_cast<std::size_t>(std::max_element(volumes.begin(), volumes.end()) - volumes.begin());
  EXPECT_FALSE(std::isnan(heights[2 * wet]));
  EXPECT_NEAR(volumes[wet], 1.0 / 6.0, 1e-12);
  buoyancy_sea* sea = sea_of(kWaves);
  buoyancy_water water{};
  buoyancy_default_water(&water, sizeof water);
  water.sea = sea;
  EXPECT_EQ(buoyancy_mesh_hydrostatics(mesh, &water, nullptr, &poses, &hydrostatics, 1),
            BUOYANCY_ERROR_INVALID_ARGUMENT);
  buoyancy_sea_free(sea);
  buoyancy_scene_free(scene);
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, GivesTheWaterOfASea) {
  for (const std::string& text : {std::string("[water]\nlevel = 0.25\n"), kWaves,
                                  kWaves + "[water.current]\nvelocity = [0.3, -0.2, 0.1]\n"}) {
    const bool waves = text.starts_with(kWaves);
    buoyancy_scene* scene = scene_from(text + kBodies);
    buoyancy_sea* sea = nullptr;
    ASSERT_EQ(buoyancy_scene_sea(scene, &sea), BUOYANCY_OK) << last_error();
    buoyancy_scene_free(scene);  // the sea does not depend on it
    const QuerySea same = QuerySea::parse(text, "sea", {}).value();
    buoyancy_sea_info info{};
    info.size = sizeof info;
    ASSERT_EQ(buoyancy_sea_get_info(sea, &info), BUOYANCY_OK);
    EXPECT_EQ(info.level, 0.25);
    EXPECT_EQ(info.axis2[1], 1.0);
    EXPECT_EQ(info.depth, kInfinity);
    EXPECT_EQ(info.wave_components, waves ? 1 : 0);
    EXPECT_EQ(info.max_elevation, waves ? 0.15 : 0.0);

    constexpr std::size_t kPoints = 200;
    std::vector<double> x(kPoints), y(kPoints), points(3 * kPoints), computed(kPoints), expected(kPoints),
        velocities(3 * kPoints), expected_velocities(3 * kPoints), pressures(kPoints),
        expected_pressures(kPoints);
    std::vector<std::int64_t> utimes(kPoints);
    for (std::size_t i = 0; i < kPoints; ++i) {
      x[i] = 0.3 * static_cast<double>(i);
      y[i] = 20.0 - x[i];
      points[3 * i] = x[i];
      points[3 * i + 2] = 0.01 * (100.0 - static_cast<double>(i));
      utimes[i] = kNow + static_cast<std::int64_t>(i / 10) * 50'000;
    }
    x[7] = std::numeric_limits<double>::quiet_NaN();
    ASSERT_EQ(
        buoyancy_sea_elevations(sea, kPoints, x.data(), y.data(), utimes.data(), kPoints, computed.data(), 0),
        BUOYANCY_OK);
    sea_elevations(same, x, y, utimes, expected);
    EXPECT_EQ(std::isnan(computed[7]), waves);
    computed[7] = expected[7] = 0.0;
    EXPECT_EQ(computed, expected);
    ASSERT_EQ(buoyancy_sea_water_at(sea, kPoints, points.data(), utimes.data(), kPoints, pressures.data(),
                                    velocities.data(), nullptr, 1),
              BUOYANCY_OK);
    water_at_points(same, points, utimes, {expected_pressures, expected_velocities, {}});
    EXPECT_EQ(pressures, expected_pressures);
    EXPECT_EQ(velocities, expected_velocities);
    // One time for all points, and none at all.
    ASSERT_EQ(buoyancy_sea_elevations(sea, 0, nullptr, nullptr, utimes.data(), 1, nullptr, 0), BUOYANCY_OK);
    EXPECT_EQ(buoyancy_sea_elevations(sea, kPoints, x.data(), y.data(), nullptr, 0, computed.data(), 0),
              BUOYANCY_ERROR_INVALID_ARGUMENT);
    EXPECT_EQ(buoyancy_sea_elevations(sea, kPoints, x.data(), y.data(), utimes.data(), 3, computed.data(), 0),
              BUOYANCY_ERROR_INVALID_ARGUMENT);
    buoyancy_sea_free(sea);
  }
}

TEST(CInterface, SaysWhichFileCannotBeRead) {
  const TempDir directory;
  buoyancy_mesh* mesh = nullptr;
  buoyancy_scene* scene = nullptr;
  EXPECT_EQ(buoyancy_mesh_load("no/such/mesh.obj", nullptr, &mesh), BUOYANCY_ERROR_FILE);
  EXPECT_NE(last_error().find("no/such/mesh.obj"), std::string::npos);
  EXPECT_EQ(buoyancy_scene_load("no/such/scene.toml", &scene), BUOYANCY_ERROR_FILE);
  EXPECT_NE(last_error().find("no/such/scene.toml"), std::string::npos);
  const std::string folder = directory.path().string();
  EXPECT_EQ(buoyancy_mesh_load(folder.c_str(), nullptr, &mesh), BUOYANCY_ERROR_FILE);
  EXPECT_EQ(buoyancy_scene_load(folder.c_str(), &scene), BUOYANCY_ERROR_FILE);
  const std::string empty = folder + "/empty.obj";
  std::ofstream(empty).close();
  EXPECT_EQ(buoyancy_mesh_load(empty.c_str(), nullptr, &mesh), BUOYANCY_ERROR_MESH);
  EXPECT_EQ(buoyancy_mesh_load((source_dir() / "README.md").c_str(), nullptr, &mesh), BUOYANCY_ERROR_MESH);
  EXPECT_EQ(buoyancy_scene_load((source_dir() / "README.md").c_str(), &scene), BUOYANCY_ERROR_SCENE);
  ASSERT_EQ(buoyancy_scene_load((source_dir() / "scenes/box.toml").c_str(), &scene), BUOYANCY_OK);
  buoyancy_scene_free(scene);
}

// What a call returns, and whether its reason contains a text.
void expect_failure(buoyancy_error error, buoyancy_error expected, const char* reason) {
  EXPECT_EQ(error, expected) << last_error();
  EXPECT_NE(last_error().find(reason), std::string::npos) << "'" << reason << "' is not in: " << last_error();
}

TEST(CInterface, SaysWhichArgumentIsWrong) {
  buoyancy_mesh* mesh = tetrahedron();
  const PoseTable table = random_poses(4, 0.5, 3);
  WrenchTable out(4);
  const buoyancy_poses poses = poses_of(table);
  const buoyancy_wrenches wrenches = wrenches_of(out);
  const auto query = [&](const buoyancy_water* water, const buoyancy_poses* at, const buoyancy_wrenches* to,
                         buoyancy_method method = BUOYANCY_METHOD_HIERARCHICAL, double tolerance = 0.0,
                         std::int32_t threads = 1) {
    return buoyancy_mesh_query(mesh, water, method, tolerance, at, to, threads);
  };
  constexpr buoyancy_error kInvalid = BUOYANCY_ERROR_INVALID_ARGUMENT;
  expect_failure(query(nullptr, nullptr, &wrenches), kInvalid, "poses: NULL");
  expect_failure(query(nullptr, &poses, nullptr), kInvalid, "wrenches: NULL");
  expect_failure(query(nullptr, &poses, &wrenches, 6), kInvalid, "method: 6");
  expect_failure(query(nullptr, &poses, &wrenches, -1), kInvalid, "method: -1");
  expect_failure(query(nullptr, &poses, &wrenches, 0, -0.1), kInvalid, "tolerance: -0.1");
  expect_failure(query(nullptr, &poses, &wrenches, 0, std::nan("")), kInvalid, "tolerance: nan");
  expect_failure(query(nullptr, &poses, &wrenches, 0, 0.0, -1), kInvalid, "threads: -1");
  expect_failure(query(nullptr, &poses, &wrenches, 0, 0.0, 1025), kInvalid, "threads: 1025");

  const auto with_poses = [&](auto change, const char* reason) {
    buoyancy_poses changed = poses;
    change(changed);
    expect_failure(query(nullptr, &changed, &wrenches), kInvalid, reason);
  };
  with_poses([](buoyancy_poses& p) { p.size = 0; }, "poses: size = 0; expected 64");
  with_poses([](buoyancy_poses& p) { p.size += 8; }, "poses: size = 72");
  with_poses([](buoyancy_poses& p) { p.count = -1; }, "poses->count: -1");
  with_poses([](buoyancy_poses& p) { p.count = std::numeric_limits<std::int64_t>::max() / 4; },
             "poses->count");
  with_poses([](buoyancy_poses& p) { p.positions = nullptr; }, "poses->positions: NULL");
  with_poses([](buoyancy_poses& p) { p.quaternions = nullptr; }, "poses->quaternions: NULL");
  with_poses([](buoyancy_poses& p) { p.utime_count = 1; }, "utimes: NULL");
  with_poses([](buoyancy_poses& p) { p.utime_count = -1; }, "utime_count: -1");

  const auto with_water = [&](auto change, const char* reason) {
    buoyancy_water water{};
    buoyancy_default_water(&water, sizeof water);
    change(water);
    expect_failure(query(&water, &poses, &wrenches), kInvalid, reason);
  };
  with_water([](buoyancy_water& w) { w.size = 7; }, "water: size = 7");
  with_water([](buoyancy_water& w) { w.level = kInfinity; }, "water->level: inf");
  with_water([](buoyancy_water& w) { w.density = -1.0; }, "water->density: -1");
  with_water([](buoyancy_water& w) { w.density = std::nan(""); }, "water->density: nan");
  with_water([](buoyancy_water& w) { w.gravity = -9.81; }, "water->gravity: -9.81");
  with_water([](buoyancy_water& w) { w.up[2] = 0.0; }, "water->up: 0, 0, 0");
  with_water([](buoyancy_water& w) { w.up[0] = std::nan(""); }, "water->up: nan");

  buoyancy_wrenches misaligned = wrenches;
  misaligned.forces = reinterpret_cast<double*>(reinterpret_cast<char*>(out.forces.data()) + 1);
  expect_failure(query(nullptr, &poses, &misaligned), kInvalid, "wrenches->forces");
  expect_failure(buoyancy_default_water(nullptr, sizeof(buoyancy_water)), kInvalid, "water: NULL");
  buoyancy_water water{};
  expect_failure(buoyancy_default_water(&water, 8), kInvalid, "size = 8");
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, SaysWhatIsWrongWithAMesh) {
  const std::array<double, 12> vertices{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  std::array<std::int32_t, 12> faces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  buoyancy_mesh_options options{};
  buoyancy_default_mesh_options(&options, sizeof options);
  buoyancy_mesh* mesh = nullptr;
  const auto create = [&](std::int64_t vertex_count = 4, std::int64_t face_count = 4) {
    return buoyancy_mesh_create(vertices.data(), vertex_count, faces.data(), face_count, &options, &mesh);
  };
  expect_failure(create(-1), BUOYANCY_ERROR_INVALID_ARGUMENT, "vertex_count: -1");
  expect_failure(create(std::int64_t{1} << 62), BUOYANCY_ERROR_INVALID_ARGUMENT, "vertex_count");
  expect_failure(create(4, std::int64_t{1} << 61), BUOYANCY_ERROR_INVALID_ARGUMENT, "face_count");
  expect_failure(create(4, 0), BUOYANCY_ERROR_MESH, "no face");
  expect_failure(create(3), BUOYANCY_ERROR_MESH, "vertex index 3");
  faces[0] = -7;
  expect_failure(create(), BUOYANCY_ERROR_MESH, "vertex index -7");
  options.scale = -1.0;
  expect_failure(create(), BUOYANCY_ERROR_INVALID_ARGUMENT, "options->scale: -1");
  options.scale = 1.0;
  options.open = 2;
  expect_failure(create(), BUOYANCY_ERROR_INVALID_ARGUMENT, "options->open: 2");
  expect_failure(buoyancy_mesh_create(vertices.data(), 4, faces.data(), 4, nullptr, nullptr),
                 BUOYANCY_ERROR_INVALID_ARGUMENT, "mesh: NULL");
  EXPECT_EQ(mesh, nullptr);
}

TEST(CInterface, SaysWhatIsWrongWithASeaOrAScene) {
  buoyancy_sea* sea = nullptr;
  buoyancy_scene* scene = nullptr;
  expect_failure(buoyancy_sea_from_toml("[water]\nlevl = 1", nullptr, &sea), BUOYANCY_ERROR_SCENE, "level");
  expect_failure(buoyancy_sea_from_toml("\xff\xfe", nullptr, &sea), BUOYANCY_ERROR_SCENE, "sea");
  expect_failure(buoyancy_sea_from_toml(nullptr, nullptr, &sea), BUOYANCY_ERROR_INVALID_ARGUMENT,
                 "toml: NULL");
  expect_failure(buoyancy_scene_from_toml("[[body]]\nid = 1\nmesh = \"no.obj\"", nullptr, &scene),
                 BUOYANCY_ERROR_SCENE, "no.obj");
  EXPECT_EQ(scene, nullptr);

  buoyancy_scene* received = scene_from("[water]\nwaves = \"received\"\n" + kBodies);
  const PoseTable table = random_poses(4, 0.5, 3);
  const buoyancy_poses poses = poses_of(table);
  WrenchTable out(4);
  const buoyancy_wrenches wrenches = wrenches_of(out);
  expect_failure(buoyancy_scene_sea(received, &sea), BUOYANCY_ERROR_SCENE, "received");
  expect_failure(buoyancy_scene_query(received, 99, &poses, &wrenches, nullptr, 1), BUOYANCY_ERROR_SCENE,
                 "99");
  EXPECT_EQ(buoyancy_scene_query(received, 3, &poses, &wrenches, nullptr, 1), BUOYANCY_OK);
  EXPECT_EQ(out.statuses[0], BUOYANCY_STATUS_NO_SEA);
  buoyancy_scene_free(received);
}

TEST(CInterface, RefusesWaterThatContradictsItsSea) {
  buoyancy_mesh* mesh = tetrahedron();
  buoyancy_sea* sea = sea_of(kWaves);
  PoseTable table = random_poses(4, 0.5, 3);
  table.utimes = {kNow};
  const buoyancy_poses poses = poses_of(table);
  WrenchTable out(4);
  const buoyancy_wrenches wrenches = wrenches_of(out);
  buoyancy_water water{};
  buoyancy_default_water(&water, sizeof water);
  water.sea = sea;
  const auto query = [&](buoyancy_method method) {
    return buoyancy_mesh_query(mesh, &water, method, 0.0, &poses, &wrenches, 1);
  };
  EXPECT_EQ(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_OK);
  water.level = 0.25;  // that of the sea
  EXPECT_EQ(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_OK);
  water.level = 0.5;
  expect_failure(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_ERROR_INVALID_ARGUMENT,
                 "water->level: 0.5; expected 0.25");
  water.level = 0.0;
  water.density = 1000.0;
  expect_failure(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_ERROR_INVALID_ARGUMENT, "water->density");
  water.density = 1025.0;
  water.up[0] = 1.0;
  expect_failure(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_ERROR_INVALID_ARGUMENT, "water->up");
  water.up[0] = 0.0;
  expect_failure(query(BUOYANCY_METHOD_EXACT), BUOYANCY_ERROR_INVALID_ARGUMENT, "Use hierarchical");
  buoyancy_sea_free(sea);
  expect_failure(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_ERROR_HANDLE, "water->sea");
  buoyancy_mesh_free(mesh);
}

TEST(CInterface, RecognisesHandlesThatAreNone) {
  buoyancy_mesh* mesh = tetrahedron();
  buoyancy_scene* scene = scene_from(kBodies);
  buoyancy_mesh_info info{};
  info.size = sizeof info;
  std::int64_t count = 0;
  const auto not_a_mesh = reinterpret_cast<buoyancy_mesh*>(std::uintptr_t{0xdeadbeef});
  expect_failure(buoyancy_mesh_get_info(nullptr, &info), BUOYANCY_ERROR_HANDLE,
                 "mesh: NULL; expected a mesh");
  expect_failure(buoyancy_mesh_get_info(not_a_mesh, &info), BUOYANCY_ERROR_HANDLE, "no handle");
  expect_failure(buoyancy_mesh_get_info(reinterpret_cast<buoyancy_mesh*>(scene), &info),
                 BUOYANCY_ERROR_HANDLE, "a scene; expected a mesh");
  expect_failure(buoyancy_mesh_free(reinterpret_cast<buoyancy_mesh*>(scene)), BUOYANCY_ERROR_HANDLE,
                 "a scene");
  EXPECT_EQ(buoyancy_scene_body_count(scene, &count), BUOYANCY_OK);
  EXPECT_EQ(buoyancy_mesh_free(mesh), BUOYANCY_OK);
  EXPECT_EQ(buoyancy_mesh_free(nullptr), BUOYANCY_OK);
  expect_failure(buoyancy_mesh_free(mesh), BUOYANCY_ERROR_HANDLE, "it was freed");
  expect_failure(buoyancy_mesh_get_info(mesh, &info), BUOYANCY_ERROR_HANDLE, "it was freed");
  EXPECT_EQ(buoyancy_scene_free(scene), BUOYANCY_OK);
  expect_failure(buoyancy_scene_body_count(scene, &count), BUOYANCY_ERROR_HANDLE, "it was freed");
}

TEST(CInterface, KeepsTheLastErrorOfEachThread) {
  EXPECT_EQ(buoyancy_mesh_free(reinterpret_cast<buoyancy_mesh*>(std::uintptr_t{0xdeadbeef})),
            BUOYANCY_ERROR_HANDLE);
  const std::string here = last_error();
  std::thread([&] {
    EXPECT_EQ(last_error(), "");
    buoyancy_sea* sea = nullptr;
    EXPECT_EQ(buoyancy_sea_from_toml("[water]\nlevl = 1", nullptr, &sea), BUOYANCY_ERROR_SCENE);
    EXPECT_NE(last_error(), here);
  }).join();
  EXPECT_EQ(last_error(), here);
  buoyancy_sea_free(sea_of(""));  // success changes nothing
  EXPECT_EQ(last_error(), here);
}

#if !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)  // they need more address space than the limit
// Exits with 0 if a query whose unwanted results exceed the limit on memory says so.
[[noreturn]] void query_beyond_limit() {
  const rlimit limit{std::uint64_t{1} << 32, std::uint64_t{1} << 32};  // [bytes]
  setrlimit(RLIMIT_AS, &limit);
  const PoseTable table = random_poses(1, 0.5, 3);
  buoyancy_poses poses = poses_of(table);
  poses.count = std::int64_t{1} << 36;
  buoyancy_wrenches wrenches{};
  wrenches.size = sizeof wrenches;
  const buoyancy_error error =
      buoyancy_mesh_query(tetrahedron(), nullptr, BUOYANCY_METHOD_HIERARCHICAL, 0.0, &poses, &wrenches, 1);
  std::_Exit(error == BUOYANCY_ERROR_MEMORY && last_error().find("memory") != std::string::npos ? 0 : 1);
}

TEST(CInterface, ReportsThatMemoryIsUsedUp) {
  EXPECT_EXIT(query_beyond_limit(), testing::ExitedWithCode(0), "");
}
#endif

// What a program does with every kind of call.
struct Tour {
  std::vector<WrenchTable> wrenches;
  std::vector<double> elevations;
  std::vector<std::int32_t> hydrostatics;
  std::string report;

  bool operator==(const Tour&) const = default;
};

PoseTable poses_of_tour() {
  PoseTable table = random_poses(20, 0.5, 3);
  table.utimes = {kNow};
  return table;
}

Tour make_tour(const PoseTable& table) {
  Tour tour;
  const std::size_t n = table.size();
  const buoyancy_poses poses = poses_of(table);
  buoyancy_scene* scene = scene_from(kWaves + kBodies);
  buoyancy_sea* sea = nullptr;
  EXPECT_EQ(buoyancy_scene_sea(scene, &sea), BUOYANCY_OK) << last_error();
  buoyancy_mesh* mesh = tetrahedron();
  std::size_t length = 0;
  EXPECT_EQ(buoyancy_mesh_report(mesh, nullptr, 0, &length), BUOYANCY_OK);
  tour.report.resize(length + 1);
  EXPECT_EQ(buoyancy_mesh_report(mesh, tour.report.data(), length + 1, nullptr), BUOYANCY_OK);
  for (const std::int32_t id : {3, 4}) {
    const buoyancy_wrenches to = wrenches_of(tour.wrenches.emplace_back(n));
    EXPECT_EQ(buoyancy_scene_query(scene, id, &poses, &to, nullptr, 1), BUOYANCY_OK) << last_error();
  }
  for (const bool waves : {false, true}) {
    buoyancy_water water{};
    buoyancy_default_water(&water, sizeof water);
    if (waves) water.sea = sea;
    for (buoyancy_method method = 0; method <= BUOYANCY_METHOD_EXACT_SURFACE; ++method) {
      const buoyancy_wrenches to = wrenches_of(tour.wrenches.emplace_back(n));
      const double tolerance = method == BUOYANCY_METHOD_HIERARCHICAL ? 1e-4 : 0.0;
      buoyancy_mesh_query(mesh, &water, method, tolerance, &poses, &to, 1);  // refuses some methods in waves
    }
  }
  tour.hydrostatics.resize(n);
  buoyancy_hydrostatics hydrostatics{};
  hydrostatics.size = sizeof hydrostatics;
  hydrostatics.statuses = tour.hydrostatics.data();
  EXPECT_EQ(buoyancy_mesh_hydrostatics(mesh, nullptr, nullptr, &poses, &hydrostatics, 1), BUOYANCY_OK);
  tour.elevations.resize(n);
  EXPECT_EQ(buoyancy_sea_elevations(sea, poses.count, table.positions.data(), table.positions.data(), &kNow,
                                    1, tour.elevations.data(), 1),
            BUOYANCY_OK);
  buoyancy_mesh_free(mesh);
  buoyancy_sea_free(sea);
  buoyancy_scene_free(scene);
  return tour;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their frames are larger
void run_with_stack(std::size_t bytes, void* (*task)(void*), void* argument) {
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  ASSERT_EQ(pthread_attr_setstacksize(&attributes, bytes), 0);
  pthread_t thread{};
  ASSERT_EQ(pthread_create(&thread, &attributes, task, argument), 0) << bytes;
  pthread_join(thread, nullptr);
  pthread_attr_destroy(&attributes);
}

TEST(CInterface, NeedsTheStackThatItStates) {
  struct Call {
    const PoseTable table = poses_of_tour();
    Tour tour;
  } call;
  const Tour expected = make_tour(call.table);
  run_with_stack(
      BUOYANCY_STACK_SIZE,
      [](void* argument) -> void* {
        auto& [table, tour] = *static_cast<Call*>(argument);
        tour = make_tour(table);
        return nullptr;
      },
      &call);
  EXPECT_EQ(call.tour, expected);
}

TEST(CInterface, LeavesThreadsThatDoNotCallItTheirStack) {
  run_with_stack(
      static_cast<std::size_t>(PTHREAD_STACK_MIN) + 8192, [](void*) -> void* { return nullptr; }, nullptr);
}
#endif

TEST(CInterface, IsIndependentOfTheCallersFloatingPoint) {
  const PoseTable table = poses_of_tour();
  const Tour expected = make_tour(table);
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::feclearexcept(FE_ALL_EXCEPT);
    std::fesetround(rounding);
    const int flags = std::fetestexcept(FE_ALL_EXCEPT);
    feenableexcept(FE_ALL_EXCEPT & ~FE_INEXACT);
    const Tour tour = make_tour(table);
    const int traps = fedisableexcept(FE_ALL_EXCEPT);
    const int rounding_after = std::fegetround();
    const int flags_after = std::fetestexcept(FE_ALL_EXCEPT & ~FE_INEXACT);
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(tour, expected) << rounding;
    EXPECT_EQ(rounding_after, rounding);
    EXPECT_EQ(traps, FE_ALL_EXCEPT & ~FE_INEXACT);
    EXPECT_EQ(flags_after, flags);
  }
}

TEST(CInterface, ServesThreadsInParallel) {
  buoyancy_mesh* mesh = tetrahedron();
  buoyancy_sea* sea = sea_of(kWaves);
  PoseTable table = random_poses(100, 0.5, 3);
  table.utimes = {kNow};
  std::vector<WrenchTable> out(8, WrenchTable(table.size()));
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < out.size(); ++i) {
    threads.emplace_back([&, i] {
      buoyancy_water water{};
      buoyancy_default_water(&water, sizeof water);
      if (i % 2 == 0) water.sea = sea;
      const buoyancy_poses poses = poses_of(table);
      const buoyancy_wrenches wrenches = wrenches_of(out[i]);
      for (int n = 0; n < 5; ++n) {
        buoyancy_mesh* const own = tetrahedron();
        EXPECT_EQ(buoyancy_mesh_query(n == 0 ? own : mesh, &water, BUOYANCY_METHOD_HIERARCHICAL, 1e-3, &poses,
                                      &wrenches, n % 2),
                  BUOYANCY_OK);
        EXPECT_EQ(buoyancy_mesh_free(own), BUOYANCY_OK);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 2; i < out.size(); ++i) EXPECT_EQ(out[i], out[i - 2]);
  buoyancy_sea_free(sea);
  buoyancy_mesh_free(mesh);
}

}  // namespace
}  // namespace buoyancy
