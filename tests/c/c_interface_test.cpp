// The C interface as C++ sees it: what comparison.c does not compare, errors, handles and threads.

#include <algorithm>
#include <array>
#include <cfenv>
#include <climits>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
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

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr buoyancy_error kInvalid = BUOYANCY_ERROR_INVALID_ARGUMENT;
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

std::shared_ptr<const QueryMesh> tetrahedron_of_cpp() {
  return QueryMesh::make(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1},
                         std::vector<std::int64_t>{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}, "mesh")
      .value();
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

// What a call returns, and whether its reason contains a text.
void expect_failure(buoyancy_error error, buoyancy_error expected, const std::string& reason) {
  EXPECT_EQ(error, expected) << last_error();
  EXPECT_THAT(last_error(), HasSubstr(reason));
}

template <typename Number>
Number* misaligned(Number* numbers) {
  using Byte = std::conditional_t<std::is_const_v<Number>, const char, char>;
  return reinterpret_cast<Number*>(reinterpret_cast<Byte*>(numbers) + 1);
}

// An array of results in a struct of the C interface, and the numbers of one pose in C++.
template <typename Struct, typename Of>
struct Result {
  double* Struct::*array;
  std::size_t per_pose;
  const double* (*of)(const Of&);
};

// Calls with each array alone, and compares it with the results of C++ bit for bit.
template <typename Struct, typename Of, typename Call>
void expect_each_alone(const std::vector<Result<Struct, Of>>& results, const std::vector<Of>& expected,
                       const Call& call) {
  for (std::size_t number = 0; number < results.size(); ++number) {
    const Result<Struct, Of>& result = results[number];
    std::vector<double> values(result.per_pose * expected.size() + 1, 9.0);
    std::vector<double> of_cpp;
    for (const Of& of : expected) of_cpp.insert(of_cpp.end(), result.of(of), result.of(of) + result.per_pose);
    of_cpp.push_back(9.0);  // behind the array
    Struct wanted{};
    wanted.size = sizeof wanted;
    wanted.*result.array = values.data();
    ASSERT_EQ(call(wanted), BUOYANCY_OK) << last_error();
    EXPECT_EQ(std::memcmp(values.data(), of_cpp.data(), values.size() * sizeof(double)), 0)
        << "array " << number;
    wanted.*result.array = misaligned(values.data());
    expect_failure(call(wanted), kInvalid, "no multiple of");
  }
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
  EXPECT_THAT(last_error(), HasSubstr("mesh: "));
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
  const auto query = [&](const buoyancy_wrenches& wanted) {
    return buoyancy_mesh_query(mesh, nullptr, BUOYANCY_METHOD_HIERARCHICAL, 0.0, &poses, &wanted, 1);
  };
  WrenchTable all(table.size());
  ASSERT_EQ(query(wrenches_of(all)), BUOYANCY_OK);
  const auto expect_alone = [&](auto member, auto array) {
    WrenchTable some(table.size());
    WrenchTable expected(table.size());
    expected.*array = all.*array;
    buoyancy_wrenches wanted{};
    wanted.size = sizeof wanted;
    wanted.*member = (some.*array).data();
    ASSERT_EQ(query(wanted), BUOYANCY_OK);
    EXPECT_EQ(some, expected);
    wanted.*member = misaligned((some.*array).data());
    expect_failure(query(wanted), kInvalid, "no multiple of");
  };
  expect_alone(&buoyancy_wrenches::statuses, &WrenchTable::statuses);
  expect_alone(&buoyancy_wrenches::forces, &WrenchTable::forces);
  expect_alone(&buoyancy_wrenches::torques, &WrenchTable::torques);
  expect_alone(&buoyancy_wrenches::volumes, &WrenchTable::volumes);
  expect_alone(&buoyancy_wrenches::centers_of_buoyancy, &WrenchTable::centers);
  expect_alone(&buoyancy_wrenches::force_error_bounds, &WrenchTable::force_bounds);
  expect_alone(&buoyancy_wrenches::torque_error_bounds, &WrenchTable::torque_bounds);
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
  const auto same = tetrahedron_of_cpp();
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
  WrenchTable expected(n);
  std::vector<BodyLoads> expected_loads(n);
  evaluate_poses(*same.find(3), water_of(same), table.arrays(), expected.arrays(), expected_loads);
  using Of = const BodyLoads&;
  const std::vector<Result<buoyancy_loads, BodyLoads>> results{
      {&buoyancy_loads::immersions, 1, [](Of of) { return &of.immersion; }},
      {&buoyancy_loads::buoyancy_forces, 3, [](Of of) { return of.buoyancy_force.data(); }},
      {&buoyancy_loads::buoyancy_torques, 3, [](Of of) { return of.buoyancy_torque.data(); }},
      {&buoyancy_loads::drag_forces, 3, [](Of of) { return of.drag_force.data(); }},
      {&buoyancy_loads::drag_torques, 3, [](Of of) { return of.drag_torque.data(); }},
      {&buoyancy_loads::added_mass_forces, 3, [](Of of) { return of.added_mass_force.data(); }},
      {&buoyancy_loads::added_mass_torques, 3, [](Of of) { return of.added_mass_torque.data(); }},
      {&buoyancy_loads::added_masses, 36, [](Of of) { return of.added_mass[0].data(); }},
      {&buoyancy_loads::dampings, 36, [](Of of) { return of.damping[0].data(); }},
      {&buoyancy_loads::water_velocities, 3, [](Of of) { return of.water_velocity.data(); }}};
  expect_each_alone(results, expected_loads, [&](const buoyancy_loads& loads) {
    WrenchTable computed(n);
    const buoyancy_wrenches wrenches = wrenches_of(computed);
    const buoyancy_error error = buoyancy_scene_query(scene, 3, &poses, &wrenches, &loads, 0);
    if (error == BUOYANCY_OK) {
      EXPECT_EQ(computed, expected);
    }
    return error;
  });
  EXPECT_GT(expected_loads[0].immersion + expected_loads[2].immersion, 0.0);
  EXPECT_EQ(expected_loads[1].immersion, 0.0);
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
  for (const std::int64_t none : {-1, 2})
    expect_failure(buoyancy_scene_get_body(scene, none, &box), kInvalid, "index: " + std::to_string(none));
  buoyancy_scene_free(scene);
}

TEST(CInterface, GivesHydrostatics) {
  buoyancy_mesh* mesh = tetrahedron();
  buoyancy_scene* scene = scene_from(kBodies);
  const Scene same = scene_of(kBodies);
  PoseTable table = random_poses(300, 1.0, 12);
  table.quaternions[8] = 2.0;
  const std::size_t n = table.size();
  const buoyancy_poses poses = poses_of(table);
  std::vector<BodyHydrostatics> expected(n);
  evaluate_hydrostatics(*same.find(3), same.water(), table.arrays(), expected);
  using Of = const BodyHydrostatics&;
  using Members = buoyancy_hydrostatics;
  const std::vector<Result<Members, BodyHydrostatics>> results{
      {&Members::volumes, 1, [](Of of) { return &of.submerged_volume; }},
      {&Members::centers_of_buoyancy, 3, [](Of of) { return of.center_of_buoyancy.data(); }},
      {&Members::wetted_areas, 1, [](Of of) { return &of.wetted_area; }},
      {&Members::waterplane_areas, 1, [](Of of) { return &of.waterplane_area; }},
      {&Members::waterplane_centroids, 3, [](Of of) { return of.waterplane_centroid.data(); }},
      {&Members::waterplane_second_moments, 2, [](Of of) { return of.waterplane_second_moments.data(); }},
      {&Members::waterplane_axes, 6, [](Of of) { return of.waterplane_axes[0].data(); }},
      {&Members::metacentric_radii, 2, [](Of of) { return of.metacentric_radii.data(); }},
      {&Members::metacenters, 6, [](Of of) { return of.metacenters[0].data(); }},
      {&Members::metacentric_heights, 2, [](Of of) { return of.metacentric_heights.data(); }},
      {&Members::stiffnesses, 36, [](Of of) { return of.stiffness[0].data(); }}};
  std::vector<std::int32_t> statuses(n, -1);
  expect_each_alone(results, expected, [&](Members wanted) {
    wanted.statuses = statuses.data();
    return buoyancy_scene_hydrostatics(scene, 3, &poses, &wanted, 2);
  });
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(statuses[i], static_cast<std::int32_t>(expected[i].status));
  EXPECT_EQ(statuses[2], BUOYANCY_STATUS_BAD_QUATERNION);
  Members none{};
  none.size = sizeof none;
  expect_failure(buoyancy_scene_hydrostatics(scene, 4, &poses, &none, 1), BUOYANCY_ERROR_SCENE,
                 "hydrostatics");

  // Of a mesh, with and without a centre of mass, which alone makes a difference to the heights.
  std::array<double, 3> center{0.25, 0.2, 0.3};
  const auto mesh_of_cpp = tetrahedron_of_cpp();
  Body body = *mesh_of_cpp->body(Method::kHierarchical, 0.0, false).value();
  for (const bool known : {false, true}) {
    if (known) body.center_of_mass_B = Vec3(center[0], center[1], center[2]);
    evaluate_hydrostatics(body, {}, table.arrays(), expected);
    expect_each_alone(results, expected, [&](const Members& wanted) {
      return buoyancy_mesh_hydrostatics(mesh, nullptr, known ? center.data() : nullptr, &poses, &wanted, 1);
    });
  }
  for (double& coordinate : center) {
    const double before = std::exchange(coordinate, kInfinity);
    expect_failure(buoyancy_mesh_hydrostatics(mesh, nullptr, center.data(), &poses, &none, 1), kInvalid,
                   "center_of_mass: inf");
    coordinate = before;
  }
  buoyancy_sea* sea = sea_of(kWaves);
  buoyancy_water water{};
  buoyancy_default_water(&water, sizeof water);
  water.sea = sea;
  expect_failure(buoyancy_mesh_hydrostatics(mesh, &water, nullptr, &poses, &none, 1), kInvalid,
                 "water->sea: waves");
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
        velocities(3 * kPoints), expected_velocities(3 * kPoints), accelerations(3 * kPoints),
        expected_accelerations(3 * kPoints), pressures(kPoints), expected_pressures(kPoints);
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
                                    velocities.data(), accelerations.data(), 1),
              BUOYANCY_OK);
    water_at_points(same, points, utimes, {expected_pressures, expected_velocities, expected_accelerations});
    EXPECT_EQ(pressures, expected_pressures);
    EXPECT_EQ(velocities, expected_velocities);
    EXPECT_EQ(accelerations, expected_accelerations);
    buoyancy_sea_free(sea);
  }
}

TEST(CInterface, SaysWhichFileCannotBeRead) {
  const TempDir directory;
  buoyancy_mesh* mesh = nullptr;
  buoyancy_scene* scene = nullptr;
  EXPECT_EQ(buoyancy_mesh_load("no/such/mesh.obj", nullptr, &mesh), BUOYANCY_ERROR_FILE);
  EXPECT_THAT(last_error(), HasSubstr("no/such/mesh.obj"));
  EXPECT_EQ(buoyancy_scene_load("no/such/scene.toml", &scene), BUOYANCY_ERROR_FILE);
  EXPECT_THAT(last_error(), HasSubstr("no/such/scene.toml"));
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

// Arguments that every function accepts, which a test changes one by one.
class CArguments : public testing::Test {
 protected:
  static constexpr std::int64_t kPoses = 4;

  CArguments() {
    buoyancy_default_water(&water_, sizeof water_);
    hydrostatics_.size = sizeof hydrostatics_;
    loads_.size = sizeof loads_;
  }
  ~CArguments() override {
    buoyancy_mesh_free(mesh_);
    buoyancy_sea_free(sea_);
    buoyancy_scene_free(scene_);
  }

  buoyancy_error query() {
    return buoyancy_mesh_query(mesh_, &water_, method_, tolerance_, &poses_, &wrenches_, threads_);
  }
  // Everything with poses, and everything with points.
  std::vector<buoyancy_error> query_poses() {
    return {query(), buoyancy_mesh_hydrostatics(mesh_, &water_, nullptr, &poses_, &hydrostatics_, threads_),
            buoyancy_scene_query(scene_, 3, &poses_, &wrenches_, &loads_, threads_),
            buoyancy_scene_hydrostatics(scene_, 3, &poses_, &hydrostatics_, threads_)};
  }
  std::vector<buoyancy_error> query_points() {
    return {buoyancy_sea_elevations(sea_, points_, numbers_, numbers_, utimes_.data(), point_utimes_,
                                    elevations_.data(), threads_),
            buoyancy_sea_water_at(sea_, points_, numbers_, utimes_.data(), point_utimes_, elevations_.data(),
                                  nullptr, nullptr, threads_)};
  }
  void expect_all(const std::vector<buoyancy_error>& errors, buoyancy_error expected,
                  const std::string& reason) {
    EXPECT_THAT(errors, testing::Each(expected)) << last_error();
    if (expected != BUOYANCY_OK) {
      EXPECT_THAT(last_error(), HasSubstr(reason));
    }
  }

  const PoseTable table_ = random_poses(kPoses, 0.5, 3);
  WrenchTable out_{kPoses};
  std::vector<double> elevations_ = std::vector<double>(kPoses + 1);
  const std::array<std::int64_t, kPoses + 1> utimes_{kNow, kNow, kNow, kNow, kNow};
  buoyancy_mesh* mesh_ = tetrahedron();
  buoyancy_sea* sea_ = sea_of(kWaves);
  buoyancy_scene* scene_ = scene_from(kBodies);
  buoyancy_water water_{};
  buoyancy_poses poses_ = poses_of(table_);
  buoyancy_wrenches wrenches_ = wrenches_of(out_);
  buoyancy_hydrostatics hydrostatics_{};
  buoyancy_loads loads_{};
  buoyancy_method method_ = BUOYANCY_METHOD_HIERARCHICAL;
  double tolerance_ = 0.0;
  std::int32_t threads_ = 1;
  std::int64_t points_ = kPoses;
  const double* numbers_ = table_.positions.data();
  std::int64_t point_utimes_ = 1;
};

TEST_F(CArguments, LimitsThreads) {
  for (const std::int32_t threads :
       {INT_MIN, -1, 0, 1, BUOYANCY_MAX_THREADS, BUOYANCY_MAX_THREADS + 1, INT_MAX}) {
    threads_ = threads;
    const bool valid = threads >= 0 && threads <= 1024;
    const std::string reason = "threads: " + std::to_string(threads) + "; expected 0 to 1024";
    expect_all(query_poses(), valid ? BUOYANCY_OK : kInvalid, reason);
    expect_all(query_points(), valid ? BUOYANCY_OK : kInvalid, reason);
  }
}

// With NULL for arrays: a number that is not refused has arrays that are missing.
TEST_F(CArguments, LimitsCounts) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 40;
  poses_.positions = nullptr;
  numbers_ = nullptr;
  for (const std::int64_t count : {INT64_MIN, -1L, 0L, 1L, kLimit, kLimit + 1, INT64_MAX}) {
    poses_.count = points_ = count;
    const bool valid = count >= 0 && count <= kLimit;
    expect_all(query_poses(), count == 0 ? BUOYANCY_OK : kInvalid,
               valid ? "poses->positions: NULL" : "poses->count: " + std::to_string(count));
    expect_all(query_points(), count == 0 ? BUOYANCY_OK : kInvalid,
               valid ? ": NULL" : "count: " + std::to_string(count));
  }
  constexpr std::int64_t kMeshLimit = INT_MAX;
  const std::array<double, 9> vertices{};
  buoyancy_mesh* mesh = nullptr;
  for (const std::int64_t count : {INT64_MIN, -1L, kMeshLimit, kMeshLimit + 1, INT64_MAX}) {
    const bool valid = count == kMeshLimit;
    for (const bool narrow : {false, true}) {
      const auto create = [&](const double* at, std::int64_t n, std::int64_t m) {
        return narrow ? buoyancy_mesh_create(at, n, nullptr, m, nullptr, &mesh)
                      : buoyancy_mesh_create_64(at, n, nullptr, m, nullptr, &mesh);
      };
      expect_failure(create(nullptr, count, 0), kInvalid, valid ? "vertices: NULL" : "vertex_count: ");
      expect_failure(create(vertices.data(), 3, count), kInvalid, valid ? "faces: NULL" : "face_count: ");
    }
  }
}

TEST_F(CArguments, LimitsUtimes) {
  poses_.utimes = utimes_.data();
  for (const std::int64_t count : {-1, 0, 1, 2, 3, 4, 5}) {
    poses_.utime_count = point_utimes_ = count;
    const bool one_or_all = count == 1 || count == kPoses;
    const std::string reason = "utime_count: " + std::to_string(count);
    expect_all(query_poses(), one_or_all || count == 0 ? BUOYANCY_OK : kInvalid, reason);
    expect_all(query_points(), one_or_all ? BUOYANCY_OK : kInvalid, reason);
  }
  poses_.utime_count = 1;
  poses_.utimes = nullptr;
  expect_all(query_poses(), kInvalid, "utimes: NULL");
}

TEST_F(CArguments, LimitsNumbers) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  struct Case {
    std::string name;
    double& number;
    std::vector<double> valid;
    std::vector<double> invalid;
  };
  const double nan = std::nan("");
  buoyancy_mesh_options options{};
  buoyancy_default_mesh_options(&options, sizeof options);
  for (Case& c : std::vector<Case>{
           {"tolerance", tolerance_, {0.0, 1.0}, {-tiny, std::nextafter(1.0, 2.0), nan, kInfinity}},
           {"water->level", water_.level, {-1e9, 1e9}, {nan, kInfinity, -kInfinity}},
           {"water->density", water_.density, {0.0, 1e9}, {-tiny, nan, kInfinity}},
           {"water->gravity", water_.gravity, {0.0, 1e9}, {-tiny, nan, kInfinity}},
           {"water->up", water_.up[0], {tiny, -1e308}, {nan, kInfinity}},
           {"water->up", water_.up[1], {tiny, -1e308}, {nan, kInfinity}},
           {"water->up", water_.up[2], {tiny, -1e308}, {0.0, nan, kInfinity}}}) {
    const double before = c.number;
    for (const double valid : c.valid) {
      c.number = valid;
      EXPECT_EQ(query(), BUOYANCY_OK) << last_error();
    }
    for (const double invalid : c.invalid) {
      c.number = invalid;
      expect_failure(query(), kInvalid, c.name + ": ");
    }
    c.number = before;
  }
  for (const buoyancy_method method : {INT_MIN, -1, 0, 1, 2, 3, 4, 5, 6, INT_MAX}) {
    method_ = method;
    const bool valid = method >= 0 && method <= 5;
    expect_all({query()}, valid ? BUOYANCY_OK : kInvalid, "method: " + std::to_string(method));
  }
}

// Every struct, with every size but its own.
TEST_F(CArguments, LimitsSizesOfStructs) {
  buoyancy_mesh_options options{};
  buoyancy_mesh_info mesh_info{};
  buoyancy_sea_info sea_info{};
  buoyancy_body_info body_info{};
  buoyancy_mesh* mesh = nullptr;
  mesh_info.size = sizeof mesh_info;
  sea_info.size = sizeof sea_info;
  body_info.size = sizeof body_info;
  buoyancy_default_mesh_options(&options, sizeof options);
  struct Case {
    std::string name;
    std::size_t& size;
    std::function<buoyancy_error()> call;
  };
  const std::array<double, 12> vertices{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const std::array<std::int32_t, 12> faces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  std::size_t default_size = sizeof(buoyancy_water);
  std::size_t default_options_size = sizeof(buoyancy_mesh_options);
  for (Case& c : std::vector<Case>{
           {"water", water_.size, [&] { return query(); }},
           {"water", water_.size, [&] { return query_poses()[1]; }},
           {"poses", poses_.size, [&] { return query(); }},
           {"wrenches", wrenches_.size, [&] { return query(); }},
           {"wrenches", wrenches_.size, [&] { return query_poses()[2]; }},
           {"loads", loads_.size, [&] { return query_poses()[2]; }},
           {"hydrostatics", hydrostatics_.size, [&] { return query_poses()[1]; }},
           {"hydrostatics", hydrostatics_.size, [&] { return query_poses()[3]; }},
           {"info", mesh_info.size, [&] { return buoyancy_mesh_get_info(mesh_, &mesh_info); }},
           {"info", sea_info.size, [&] { return buoyancy_sea_get_info(sea_, &sea_info); }},
           {"info", body_info.size, [&] { return buoyancy_scene_get_body(scene_, 0, &body_info); }},
           {"options", options.size,
            [&] {
              buoyancy_mesh_free(mesh);
              return buoyancy_mesh_create(vertices.data(), 4, faces.data(), 4, &options, &mesh);
            }},
           {"water", default_size,
            [&] {
              buoyancy_water water{};
              return buoyancy_default_water(&water, default_size);
            }},
           {"options", default_options_size, [&] {
              buoyancy_mesh_options defaults{};
              return buoyancy_default_mesh_options(&defaults, default_options_size);
            }}}) {
    const std::size_t right = c.size;
    EXPECT_EQ(c.call(), BUOYANCY_OK) << c.name << ": " << last_error();
    for (const std::size_t wrong : {std::size_t{0}, right - 8, right - 1, right + 1, right + 8}) {
      c.size = wrong;
      expect_failure(c.call(), kInvalid,
                     c.name + ": size = " + std::to_string(wrong) + "; expected " + std::to_string(right));
    }
    c.size = right;
  }
  EXPECT_EQ(mesh, nullptr);
}

TEST_F(CArguments, MustNotBeNull) {
  std::size_t length = 0;
  const std::array<double, 9> vertices{};
  EXPECT_EQ(buoyancy_mesh_report(mesh_, nullptr, 0, &length), BUOYANCY_OK);
  expect_failure(buoyancy_mesh_report(mesh_, nullptr, 1, &length), kInvalid, "text: NULL");
  expect_failure(buoyancy_mesh_query(mesh_, nullptr, 0, 0.0, nullptr, &wrenches_, 1), kInvalid,
                 "poses: NULL");
  expect_failure(buoyancy_mesh_query(mesh_, nullptr, 0, 0.0, &poses_, nullptr, 1), kInvalid,
                 "wrenches: NULL");
  expect_failure(buoyancy_mesh_hydrostatics(mesh_, nullptr, nullptr, &poses_, nullptr, 1), kInvalid,
                 "hydrostatics: NULL");
  expect_failure(buoyancy_scene_hydrostatics(scene_, 3, &poses_, nullptr, 1), kInvalid, "hydrostatics: NULL");
  expect_failure(buoyancy_default_water(nullptr, sizeof(buoyancy_water)), kInvalid, "water: NULL");
  expect_failure(buoyancy_default_mesh_options(nullptr, sizeof(buoyancy_mesh_options)), kInvalid,
                 "options: NULL");
  expect_failure(buoyancy_mesh_create(vertices.data(), 3, nullptr, 0, nullptr, nullptr), kInvalid,
                 "mesh: NULL");
  expect_failure(buoyancy_sea_from_toml(nullptr, nullptr, &sea_), kInvalid, "toml: NULL");
  expect_failure(buoyancy_scene_body_count(scene_, nullptr), kInvalid, "count: NULL");
  expect_failure(buoyancy_mesh_get_info(mesh_, nullptr), kInvalid, "info: NULL");
  poses_.quaternions = nullptr;
  expect_all(query_poses(), kInvalid, "poses->quaternions: NULL");
  poses_ = poses_of(table_);
  for (const double* buoyancy_poses::*array :
       {&buoyancy_poses::positions, &buoyancy_poses::quaternions, &buoyancy_poses::linear_velocities,
        &buoyancy_poses::angular_velocities}) {
    const double* const before = std::exchange(poses_.*array, misaligned(poses_.*array));
    expect_all(query_poses(), kInvalid, "no multiple of 8");
    poses_.*array = before;
  }
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
  expect_failure(create(4, 0), BUOYANCY_ERROR_MESH, "no face");
  expect_failure(create(3), BUOYANCY_ERROR_MESH, "vertex index 3");
  faces[0] = -7;
  expect_failure(create(), BUOYANCY_ERROR_MESH, "vertex index -7");
  faces[0] = 0;
  for (const double scale : {0.0, -1.0, kInfinity, std::nan("")}) {
    options.scale = scale;
    expect_failure(create(), kInvalid, "options->scale: ");
  }
  for (const double scale : {1e-3, 1e3}) {
    options.scale = scale;
    EXPECT_EQ(create(), BUOYANCY_OK) << last_error();
    EXPECT_EQ(buoyancy_mesh_free(mesh), BUOYANCY_OK);
  }
  for (std::int32_t* choice : {&options.open, &options.count_intersecting_pairs}) {
    for (const std::int32_t value : {-1, 2, 1, 0}) {
      *choice = value;
      const bool valid = value == 0 || value == 1;
      EXPECT_EQ(create(), valid ? BUOYANCY_OK : kInvalid) << last_error();
      EXPECT_EQ(mesh != nullptr, valid);
      if (!valid) {
        EXPECT_THAT(last_error(),
                    HasSubstr(choice == &options.open ? "options->open: " : "intersecting_pairs: "));
      }
      buoyancy_mesh_free(mesh);
    }
  }
}

TEST(CInterface, TakesASeaFromAGrid) {
  // A plane over another level is water at rest.
  const std::vector<double> elevations(30, 0.25);
  buoyancy_grid grid{sizeof(buoyancy_grid), elevations.data(), 5, 6, {-10.0, -8.0}, {4.0, 4.0}, 0};
  buoyancy_water water{};
  ASSERT_EQ(buoyancy_default_water(&water, sizeof water), BUOYANCY_OK);
  water.level = 1.0;
  buoyancy_sea* sea = nullptr;
  ASSERT_EQ(buoyancy_sea_from_grid(&grid, &water, &sea), BUOYANCY_OK) << last_error();
  const std::array<double, 2> x1{0.5, 11.0};
  const std::array<double, 2> x2{1.0, 0.0};
  const std::int64_t utime = 0;
  std::array<double, 2> heights{};
  ASSERT_EQ(buoyancy_sea_elevations(sea, 2, x1.data(), x2.data(), &utime, 1, heights.data(), 1), BUOYANCY_OK);
  EXPECT_NEAR(heights[0], 0.25, 1e-12);
  EXPECT_TRUE(std::isnan(heights[1])) << "beyond the edge";
  buoyancy_sea_info info{};
  info.size = sizeof info;
  ASSERT_EQ(buoyancy_sea_get_info(sea, &info), BUOYANCY_OK);
  EXPECT_EQ(info.level, 1.0);
  EXPECT_EQ(info.wave_components, 0);

  buoyancy_sea* none = sea;
  water.sea = sea;
  expect_failure(buoyancy_sea_from_grid(&grid, &water, &none), kInvalid, "water->sea");
  EXPECT_EQ(none, nullptr);
  buoyancy_sea_free(sea);
  grid.rows = 4;
  grid.spacing[1] = 0.0;
  expect_failure(buoyancy_sea_from_grid(&grid, nullptr, &none), BUOYANCY_ERROR_SCENE, "spacing[1] = 0");
  grid.rows = std::int64_t{1} << 40;
  expect_failure(buoyancy_sea_from_grid(&grid, nullptr, &none), kInvalid, "grid->rows");
  grid.rows = 2;
  expect_failure(buoyancy_sea_from_grid(&grid, nullptr, &none), BUOYANCY_ERROR_SCENE, "2 rows");
  grid.elevations = nullptr;
  expect_failure(buoyancy_sea_from_grid(&grid, nullptr, &none), kInvalid, "grid->elevations: NULL");
  expect_failure(buoyancy_sea_from_grid(nullptr, nullptr, &none), kInvalid, "grid: NULL");
}

TEST(CInterface, SaysWhatIsWrongWithASeaOrAScene) {
  buoyancy_sea* sea = nullptr;
  buoyancy_scene* scene = nullptr;
  expect_failure(buoyancy_sea_from_toml("[water]\nlevl = 1", nullptr, &sea), BUOYANCY_ERROR_SCENE, "level");
  expect_failure(buoyancy_sea_from_toml("\xff\xfe", nullptr, &sea), BUOYANCY_ERROR_SCENE, "sea");
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
  expect_failure(query(BUOYANCY_METHOD_HIERARCHICAL), kInvalid, "water->density");
  water.density = 1025.0;
  water.up[0] = 1.0;
  expect_failure(query(BUOYANCY_METHOD_HIERARCHICAL), kInvalid, "water->up");
  water.up[0] = 0.0;
  expect_failure(query(BUOYANCY_METHOD_EXACT), kInvalid, "Use hierarchical");
  buoyancy_sea_free(sea);
  expect_failure(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_ERROR_HANDLE, "water->sea");
  // What the sea itself states is no contradiction, wherever its up points.
  for (int i = 0; i < 50; ++i) {
    sea = sea_of("[world]\nup = [" + std::to_string(0.1 * i) + ", " + std::to_string(0.7 - 0.03 * i) +
                 ", 1]\ngravity = 9.81\n[water]\nlevel = 0.25\ndensity = 1010\n");
    buoyancy_sea_info info{};
    info.size = sizeof info;
    ASSERT_EQ(buoyancy_sea_get_info(sea, &info), BUOYANCY_OK);
    water = {sizeof water, info.level, info.density, info.gravity, {info.up[0], info.up[1], info.up[2]}, sea};
    EXPECT_EQ(query(BUOYANCY_METHOD_HIERARCHICAL), BUOYANCY_OK) << last_error();
    buoyancy_sea_free(sea);
  }
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
