// The stress catalogue, "Cases": degenerate triangles and bodies, invalid faces, denormals, unwelded files.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/format.h"
#include "geometry/shapes.h"
#include "geometry/sheet_rounding_area.h"
#include "tests/geometry/mesh_files.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/stress/exact_truth.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"

namespace buoyancy {
namespace {

TriangleMesh small_rock() {
  return make_shape(RockShape{.frequency = 3, .roughness = 0.4, .seed = 7});
}

// Adds a corner m near edge ab of the face a b c: a m c and m b c replace the face, and the sliver a b m
// closes the gap. along: position of m on ab; off: its distance from ab towards c, as a share of the face's
// height.
TriangleMesh with_sliver(TriangleMesh mesh, std::size_t face, double along, double off) {
  const auto [a, b, c] = mesh.triangles[face];
  const Vec3 on_edge = mesh.vertex(a) + along * (mesh.vertex(b) - mesh.vertex(a));
  const std::int32_t m = mesh.add_vertex(on_edge + off * (mesh.vertex(c) - on_edge));
  mesh.triangles[face] = {a, m, c};
  mesh.triangles.push_back({m, b, c});
  mesh.triangles.push_back({a, b, m});
  return mesh;
}

TEST(StressPoorMeshes, IsExactForSliversAndNeedles) {
  StressCase stress("slivers, needles (aspect 1e8), collinear triangles",
                    "rational arithmetic; the mesh without them",
                    "G_V, G_V L_r; of needles' bodies: the rounding area for A_s");
  const std::vector<StressedBody> plain{{"box", make_shape(BoxShape{.segments = {2, 2, 2}})},
                                        {"rock", small_rock()}};
  for (const StressedBody& body : plain) {
    for (const double off : {0.0, 1e-8, 1e-12, 1e-16}) {
      for (const double along : {0.5, 1e-8}) {
        TriangleMesh spoilt = body.source;
        for (const std::size_t face : {0U, 5U, 11U, 17U, 29U, 41U})
          spoilt = with_sliver(spoilt, face, along, off);
        const StressedBody poor(body.name + " with slivers", spoilt);
        // The midpoint of a box's edge has few bits: the area of such slivers is exactly 0.
        const bool same_body = off == 0.0 && along == 0.5 && body.name == "box";
        RandomPoses random(401);
        for (int i = 0; i < tries(12); ++i) {
          Water water = kStressWater;
          const Pose pose = stressed_pose(random, poor, i, water);
          const Vec3 reference_B = reference_near(random, poor);
          check_exactly(stress, poor, pose, water, reference_B);
          if (!same_body) continue;
          const std::vector<BuoyancyResult> without = results_of(body.mesh, pose, water, reference_B);
          std::size_t next = 0;
          visit_exact_solvers(poor.mesh, [&](const std::string& method, const Solver& solver) {
            stress.check(std::abs(buoyancy(solver, pose, water, reference_B).volume - without[next++].volume),
                         body.volume_tolerance(), "inserted, " + method);
          });
        }
      }
    }
  }
  // G_V does not hold for bodies all of whose faces are needles: it is exceeded from an aspect ratio of 1 :
  // 100 on (exact, exact_surface), or of 1 : 1000 (hierarchical).
  for (const bool oblique : {false, true}) {
    const std::vector<NamedMesh> needles{
        {"bar 1 : 1000", make_shape(BoxShape{.size = {1000, 1, 1}})},
        {"bar 1 : 1e8", make_shape(BoxShape{.size = {1e8, 1, 1}})},
        {"rod 1 : 1e8", make_shape(CylinderShape{.radius = 0.5, .height = 1e8, .segments = 12})},
        {"cone 1 : 1e8", make_shape(ConeShape{.radius = 0.5, .height = 1e8, .segments = 12})}};
    for (const NamedMesh& named : needles) {
      RandomPoses random(402);
      const StressedBody needle((oblique ? "oblique " : "") + named.name,
                                oblique ? turned(named.mesh, random.rotation()) : named.mesh);
      const double wide =
          kEpsilon * (64.0 * needle.mesh.volume + needle.mesh.diagonal * sheet_rounding_area(needle.source));
      for (int i = 0; i < tries(40); ++i) {
        Water water = kStressWater;
        const Pose pose = stressed_pose(random, needle, i, water);
        check_exactly(stress, needle, pose, water, reference_near(random, needle), "",
                      wide / needle.volume_tolerance());
      }
    }
  }
}

TEST(StressPoorMeshes, DropsAndReportsFacesThatRepeatAnIndex) {
  StressCase stress("faces that repeat an index", "dropped at load, reported", "same bits");
  const TriangleMesh clean = make_shape(RockShape{.frequency = 6});
  TriangleMesh poor = clean;
  RandomPoses random(403);
  constexpr std::int64_t kBad = 40;
  for (std::int64_t n = 0; n < kBad; ++n) {
    const auto a = static_cast<std::int32_t>(random.pick(clean.vertex_count()));
    const auto b = static_cast<std::int32_t>(random.pick(clean.vertex_count()));
    const std::vector<Triangle> kinds{{a, a, b}, {a, b, a}, {b, a, a}, {a, a, a}};
    const auto place = static_cast<std::ptrdiff_t>(random.pick(poor.triangles.size()));
    poor.triangles.insert(poor.triangles.begin() + place, kinds[random.pick(kinds.size())]);
  }
  const MeshValidation of_clean = validate_mesh({clean, {}}, "clean");
  const MeshValidation of_poor = validate_mesh({poor, {}}, "poor");
  ASSERT_TRUE(of_clean.mesh && of_poor.mesh);
  stress.require(of_poor.report.dropped_faces == kBad, "the report");
  const HydrostaticMesh clean_mesh = make_hydrostatic_mesh(*of_clean.mesh);
  const HydrostaticMesh poor_mesh = make_hydrostatic_mesh(*of_poor.mesh);
  for (int i = 0; i < tries(100); ++i) {
    const Pose pose = random.crossing(bounding_box(clean), kStressWater);
    for (const Method method : kAllMethods) {
      const BuoyancyResult one = buoyancy(Solver(clean_mesh, method), pose, kStressWater, Vec3::Zero());
      const BuoyancyResult other = buoyancy(Solver(poor_mesh, method), pose, kStressWater, Vec3::Zero());
      stress.require(
          one.volume == other.volume && one.force_W == other.force_W && one.torque_W == other.torque_W,
          std::string(to_string(method)));
    }
  }
}

TEST(StressPoorMeshes, IsExactForThinPlate) {
  StressCase stress("thin plate, thickness 1e-8", "rational arithmetic", "G_V, G_V L_r");
  for (const int segments : {1, 4}) {
    const StressedBody plate("plate of " + std::to_string(segments),
                             make_shape(BoxShape{.size = {1, 1, 1e-8}, .segments = {segments, segments, 1}}));
    RandomPoses random(404);
    for (int i = 0; i < tries(100); ++i) {
      Water water = kStressWater;
      const Pose pose = stressed_pose(random, plate, i, water);
      check_exactly(stress, plate, pose, water, reference_near(random, plate));
    }
    // The plate lies flat in the water, with the water plane between its two sides.
    for (int i = 0; i < tries(40); ++i) {
      const double height = kStressWater.level + 1e-8 * random.uniform(-0.6, 0.6);
      const Eigen::Quaterniond flat{1.0, random.uniform(-1e-8, 1e-8), random.uniform(-1e-8, 1e-8),
                                    random.uniform(-1, 1)};
      check_exactly(stress, plate, {Vec3(0, 0, height), flat}, kStressWater, reference_near(random, plate));
    }
  }
}

bool is_finite(const BuoyancyResult& result) {
  return result.force_W.allFinite() && result.torque_W.allFinite() && std::isfinite(result.volume) &&
         result.center_of_buoyancy_W.allFinite() && std::isfinite(result.dropped_force) &&
         std::isfinite(result.dropped_torque);
}

TEST(StressPoorMeshes, StaysFiniteWithDenormals) {
  StressCase stress("denormals in the pose or the mesh", "finite, never 0/0; all six methods", "finite");
  constexpr double kDenormal = std::numeric_limits<double>::denorm_min();
  std::vector<StressedBody> bodies;
  for (const double scale : {1.0, 1e-90, 1e-110, 1e-155, 1e-165, 1e-250, 1e-310, 1e-322}) {
    bodies.emplace_back("rock of " + format_shortest(scale) + " m",
                        moved_and_scaled(small_rock(), Vec3::Zero(), scale));
  }
  TriangleMesh speckled = make_shape(BoxShape{.segments = {2, 2, 2}});  // denormals replace its zeros
  for (std::vector<double>* axis : {&speckled.x, &speckled.y, &speckled.z}) {
    for (double& coordinate : *axis) {
      if (coordinate == 0.0) coordinate = axis == &speckled.y ? -kDenormal : 3 * kDenormal;
    }
  }
  bodies.emplace_back("box with denormal corners", speckled);
  // Its deck lies in the water plane at height 0, with tilts down to denormals.
  bodies.emplace_back("box below its deck",
                      moved_and_scaled(make_shape(BoxShape{.segments = {6, 6, 2}}), {0, 0, -0.5}));
  for (const StressedBody& body : bodies) {
    for (const double height : {0.0, kDenormal, -kDenormal, 1e-310, -1e-310, -0.3 * body.mesh.diagonal}) {
      for (const double tilt : {0.0, kDenormal, -1e-310, 1e-170, 1e-160, 1e-155, 0.4}) {
        const Pose pose{Vec3(kDenormal, -kDenormal, height), Eigen::Quaterniond(1.0, tilt, -tilt, kDenormal)};
        const Water water{.up_W = Vec3::UnitZ(), .level = 0.0, .density = 1.0, .gravity = 1.0};
        for (const Method method : kAllMethods) {
          for (const double tolerance : {0.0, 1e-3}) {
            const BuoyancyResult result =
                buoyancy(Solver(body.mesh, method, tolerance), pose, water, body.mesh.center_B);
            const std::string where = body.name + ", " + std::string(to_string(method));
            stress.require(is_finite(result), where);
            stress.require(result.status == BuoyancyStatus::kOk, "the status of " + where);
          }
        }
        if (body.mesh.diagonal > 1e-3 && tilt == 0.4 && height == 0.0)
          check_exactly(stress, body, pose, water, Vec3(0.1, kDenormal, 0));
      }
    }
  }
}

// The mesh as an STL file stores it: single precision, every face with its own three corners.
std::string binary_stl(const TriangleMesh& mesh) {
  std::string bytes(80, '\0');
  append_bytes(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& face : mesh.triangles) {
    for (int i = 0; i < 3; ++i) append_bytes(bytes, 0.0F);
    for (const std::int32_t corner : face) {
      const Vec3 at = mesh.vertex(corner);
      for (int i = 0; i < 3; ++i) append_bytes(bytes, static_cast<float>(at[i]));
    }
    append_bytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

TEST(StressPoorMeshes, MatchesWeldedMeshForUnweldedStl) {
  StressCase stress("unwelded STL against the same mesh welded", "rational arithmetic; the welded mesh",
                    "G_V, G_V L_r");
  const TempDir directory;
  const std::vector<NamedMesh> meshes{{"rock", small_rock()},
                                      {"knot", make_shape(TorusKnotShape{.tubular = 40, .radial = 5})}};
  for (const NamedMesh& named : meshes) {
    const auto imported = import_mesh(directory.write(named.name + ".stl", binary_stl(named.mesh)));
    ASSERT_TRUE(imported) << imported.error().message();
    stress.require(imported->mesh.vertex_count() == 3 * named.mesh.triangles.size(), "stored face by face");
    const MeshValidation validation = validate_mesh(*imported, named.name);
    ASSERT_TRUE(validation.mesh);
    stress.require(validation.report.vertices_welded == static_cast<std::int64_t>(named.mesh.vertex_count()),
                   "welded again");
    const StressedBody original(named.name, rounded_to_float32(named.mesh));
    const StressedBody unwelded(named.name + ", unwelded", imported->mesh);
    const StressedBody welded(named.name + ", welded", validation.mesh->mesh);
    RandomPoses random(405);
    for (int i = 0; i < tries(24); ++i) {
      Water water = kStressWater;
      const Pose pose = stressed_pose(random, original, i, water);
      const Vec3 reference_B = reference_near(random, original);
      const Truth truth({&original.source}, pose, water, reference_B);
      for (const StressedBody* body : {&unwelded, &welded}) {
        visit_exact_solvers(body->mesh, [&](const std::string& method, const Solver& solver) {
          check_result(stress, original, buoyancy(solver, pose, water, reference_B), truth, reference_B, 1.0,
                       body->name + ", " + method);
        });
      }
    }
  }
}

}  // namespace
}  // namespace buoyancy
