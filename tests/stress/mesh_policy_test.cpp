// The stress catalogue, "Cases": meshes that are not one simple closed surface, their treatment at load and
// the results for those that are accepted; convergence for meshes of round bodies.
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/stress/exact_truth.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"

namespace buoyancy {
namespace {

TriangleMesh box_from(const Vec3& corner, const Vec3& size) {
  return moved_and_scaled(make_shape(BoxShape{.size = {size.x(), size.y(), size.z()}, .segments = {2, 2, 2}}),
                          corner + 0.5 * size);
}

MeshValidation validate(const TriangleMesh& mesh, bool count_intersecting_pairs = false) {
  return validate_mesh({mesh, {}}, "mesh",
                       {OpenPolicy::kRefuse, count_intersecting_pairs, RepairPolicy::kNone});
}

void check_at_random_poses(StressCase& stress, const StressedBody& body, int poses) {
  RandomPoses random(501);
  for (int i = 0; i < poses; ++i) {
    Water water = kStressWater;
    const Pose pose = stressed_pose(random, body, i, water);
    check_exactly(stress, body, pose, water, reference_near(random, body));
  }
}

TEST(StressMeshPolicy, ReorientsAndReportsInsideOutMeshes) {
  StressCase stress("inside-out mesh, one inside-out component",
                    "V < 0 at load; reoriented and reported; then rational", "G_V, G_V L_r");
  const TriangleMesh rock = make_shape(RockShape{.frequency = 3, .roughness = 0.4});
  const TriangleMesh crate = box_from({4, 0, 1}, {1, 1, 1});
  struct InsideOut {
    std::string name;
    TriangleMesh given, meant;
    bool whole;  // true if all of it is inside out
  };
  const std::vector<InsideOut> cases{
      {"rock inside out", inside_out(rock), rock, true},
      {"crate inside out beside a rock", joined(rock, inside_out(crate)), joined(rock, crate), false},
      {"rock inside out beside a crate", joined(crate, inside_out(rock)), joined(crate, rock), false}};
  for (const InsideOut& one : cases) {
    const MeshValidation validation = validate(one.given);
    ASSERT_TRUE(validation.mesh) << one.name;
    stress.require(validation.report.flipped == one.whole, "the report on the whole, " + one.name);
    int components_flipped = 0;
    for (const ComponentReport& component : validation.report.components) {
      components_flipped += static_cast<int>(component.flipped);
      stress.require(component.volume > 0.0, "the component's volume, " + one.name);
    }
    stress.require(components_flipped == 1, "the report on components, " + one.name);
    if (one.whole) stress.require(make_hydrostatic_mesh({one.given, {}}).volume < 0.0, "V at load");
    // The mesh as intended and as accepted.
    const StressedBody meant(one.name, one.meant);
    const StressedBody accepted(one.name, validation.mesh->mesh);
    RandomPoses random(502);
    for (int i = 0; i < tries(20); ++i) {
      Water water = kStressWater;
      const Pose pose = stressed_pose(random, meant, i, water);
      const Vec3 reference_B = reference_near(random, meant);
      const Truth truth({&meant.source}, pose, water, reference_B);
      visit_exact_solvers(accepted.mesh, [&](const std::string& method, const Solver& solver) {
        check_result(stress, meant, buoyancy(solver, pose, water, reference_B), truth, reference_B,
                     depth_factor(solver, pose, water), one.name + ", " + method);
      });
    }
  }
}

TEST(StressMeshPolicy, AcceptsOnlyBalancedEdgesAndReportsAll) {
  StressCase stress("open, non-manifold, duplicate faces",
                    "paired edges; int n dA = 0; int n x^T dA = V I; V from x, y, z agree", "G_V");
  const TriangleMesh rock = make_shape(RockShape{.frequency = 4, .roughness = 0.4});

  TriangleMesh open = rock;
  open.triangles.pop_back();
  const MeshValidation of_open = validate(open);
  stress.require(!of_open.mesh && of_open.refusal && of_open.report.boundary_edges == 3, "open: rejected");
  stress.require(of_open.report.area_vector.norm() > 1e-3, "open: int n dA");
  const Vec3& by_axis = of_open.report.volume_by_axis;
  stress.require(by_axis.maxCoeff() - by_axis.minCoeff() > 1e-6, "open: V from x, y, z");

  TriangleMesh finned = rock;
  const std::int32_t fin = finned.add_vertex({5, 5, 5});
  finned.triangles.push_back({rock.triangles[0][0], rock.triangles[0][1], fin});
  const MeshValidation of_finned = validate(finned);
  stress.require(!of_finned.mesh && of_finned.refusal && of_finned.report.non_manifold_edges == 1,
                 "fin: rejected");

  TriangleMesh doubled = rock;
  doubled.triangles.push_back(rock.triangles[7]);
  const MeshValidation of_doubled = validate(doubled);
  stress.require(!of_doubled.mesh && of_doubled.refusal && of_doubled.report.duplicate_faces == 1,
                 "duplicate face: rejected");

  TriangleMesh misoriented = rock;
  std::swap(misoriented.triangles[5][0], misoriented.triangles[5][1]);
  const MeshValidation of_misoriented = validate(misoriented);
  stress.require(!of_misoriented.mesh && of_misoriented.report.misoriented_edges == 3,
                 "misoriented: rejected");

  // Two boxes that share an edge, and two that share a face, which exists twice with opposite orientations.
  const TriangleMesh by_edge = joined(box_from({0, 0, 0}, {1, 1, 1}), box_from({1, 1, 0}, {1, 1, 1}));
  const TriangleMesh by_face = joined(box_from({0, 0, 0}, {1, 1, 1}), box_from({1, 0, 0}, {1, 1, 1}));
  for (const TriangleMesh* mesh : {&by_edge, &by_face}) {
    const MeshValidation balanced = validate(*mesh);
    ASSERT_TRUE(balanced.mesh) << balanced.refusal->message();
    stress.require(balanced.report.balanced_edges > 0, "balanced: reported");
    check_at_random_poses(stress, StressedBody("balanced", balanced.mesh->mesh), tries(16));
  }

  // Identities of closed surfaces, in the report and in the moments of the whole.
  for (const StressedBody& body : stressed_bodies()) {
    const MeshReport report = validate(body.source).report;
    const Vec3& volumes = report.volume_by_axis;
    stress.check(volumes.maxCoeff() - volumes.minCoeff(), body.volume_tolerance(),
                 "V from x, y, z, " + body.name);
    stress.check(report.area_vector.norm() * body.mesh.diagonal, body.volume_tolerance(),
                 "int n dA, " + body.name);
    const SurfaceMoments<double> whole = body.mesh.tree->total;
    stress.check(whole.S.norm() * body.mesh.diagonal, body.volume_tolerance(), "S, " + body.name);
    stress.check((whole.N - body.mesh.volume * Mat3::Identity()).norm(), body.volume_tolerance(),
                 "N = V I, " + body.name);
  }
}

TEST(StressMeshPolicy, SumsCavitiesComponentsAndShells) {
  StressCase stress("cavities, several components, nested shells", "additivity: the parts by themselves",
                    "G_V, G_V L_r");
  const TriangleMesh hull = make_shape(BoxShape{.size = {4, 4, 4}, .segments = {2, 2, 2}});
  const TriangleMesh hole = inside_out(make_shape(BoxShape{.size = {3, 3, 3}, .segments = {2, 2, 2}}));
  const TriangleMesh core = make_shape(RockShape{.frequency = 3, .roughness = 0.3});
  const TriangleMesh aside = moved_and_scaled(core, {5, 1, 0.5});
  struct Parts {
    std::string name;
    std::vector<TriangleMesh> meshes;
  };
  const std::vector<Parts> cases{{"box with a cavity", {hull, hole}},
                                 {"box with a cavity and a rock in it", {hull, hole, core}},
                                 {"two rocks", {core, aside}},
                                 {"all of it", {hull, hole, core, aside}}};
  for (const Parts& parts : cases) {
    TriangleMesh together = parts.meshes[0];
    for (std::size_t n = 1; n < parts.meshes.size(); ++n) together = joined(together, parts.meshes[n]);
    const MeshValidation validation = validate(together);
    ASSERT_TRUE(validation.mesh) << parts.name;
    std::vector<StressedBody> alone;
    int cavities = 0;
    for (const TriangleMesh& part : parts.meshes) {
      alone.emplace_back("", part);
      cavities += static_cast<int>(alone.back().mesh.volume < 0.0);
    }
    for (const ComponentReport& component : validation.report.components) {
      cavities -= static_cast<int>(component.cavity);
      stress.require(!component.flipped && !component.nested, "the report, " + parts.name);
    }
    stress.require(cavities == 0, "cavities, " + parts.name);

    const StressedBody body(parts.name, validation.mesh->mesh);
    RandomPoses random(503);
    for (int i = 0; i < tries(200); ++i) {
      Water water = kStressWater;
      const Pose pose = stressed_pose(random, body, i, water);
      const Vec3 reference_B = reference_near(random, body);
      visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
        BuoyancyResult sum;
        for (const StressedBody& part : alone) {
          const BuoyancyResult one = buoyancy(Solver(part.mesh, solver.method()), pose, water, reference_B);
          sum.volume += one.volume;
          sum.torque_W += one.torque_W;
        }
        check_result(stress, body, buoyancy(solver, pose, water, reference_B), sum, reference_B, 1.0,
                     parts.name + ", " + method);
      });
      if (i % 10 < 2) check_exactly(stress, body, pose, water, reference_B);
    }
  }
}

TEST(StressMeshPolicy, CountsSelfIntersectionTwice) {
  StressCase stress("self-intersecting", "winding-number volume: the two bodies by themselves; reported",
                    "G_V, G_V L_r");
  const TriangleMesh crate = box_from({0, 0, 0}, {2, 2, 2});
  const TriangleMesh other = box_from({1, 0.75, 0.5}, {2, 1.5, 1.25});
  const MeshValidation validation = validate(joined(crate, other), true);
  ASSERT_TRUE(validation.mesh);
  stress.require(validation.report.intersecting_pairs.value_or(0) > 0, "reported");
  stress.require(to_text(validation.report).find("intersect") != std::string::npos, "reported in words");
  stress.require(validate(crate, true).report.intersecting_pairs == 0, "no false report");
  const StressedBody body("two boxes in each other", validation.mesh->mesh);
  stress.check(std::abs(body.mesh.volume - (8.0 + 2.0 * 1.5 * 1.25)), body.volume_tolerance(), "V_T");
  RandomPoses random(504);
  for (int i = 0; i < tries(60); ++i) {
    Water water = kStressWater;
    const Pose pose = stressed_pose(random, body, i, water);
    const Vec3 reference_B = reference_near(random, body);
    const Truth sum({&crate, &other}, pose, water, reference_B);
    visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
      check_result(stress, body, buoyancy(solver, pose, water, reference_B), sum, reference_B,
                   depth_factor(solver, pose, water), method);
    });
  }
}

// The slope of log(error) over log(triangles), by least squares.
double slope_of(const std::vector<double>& triangles, const std::vector<double>& errors) {
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const double u = std::log(triangles[i]);
    const double v = std::log(errors[i]);
    x += u;
    y += v;
    xx += u * u;
    xy += u * v;
  }
  const auto n = static_cast<double>(triangles.size());
  return (n * xy - x * y) / (n * xx - x * x);
}

TEST(StressMeshPolicy, ConvergesAsOneOverTriangleCount) {
  StressCase stress("sphere, cylinder meshes refined", "closed form: cap, tilted cylinder",
                    "slope of log error over log N -1 +- 0.05");
  constexpr double kRadius = 0.5;
  const auto cap = [](double draft, double) {
    return std::numbers::pi / 3.0 * draft * draft * (3.0 * kRadius - draft);
  };
  const auto cylinder = [](double draft, double tilt) {  // the water plane meets neither end
    return std::numbers::pi * kRadius * kRadius * (1.0 + (draft - kRadius) / std::cos(tilt));
  };
  struct Refined {
    std::string name;
    std::function<Shape(int)> shape;
    std::function<double(double, double)> volume;
  };
  const std::vector<Refined> cases{
      {"sphere", [](int n) -> Shape { return SphereShape{.radius = kRadius, .segments = n}; }, cap},
      {"cylinder",
       [](int n) -> Shape {
         return CylinderShape{.radius = kRadius, .height = 2.0, .segments = n, .stacks = n / 4};
       },
       cylinder}};
  for (const Refined& refined : cases) {
    for (const double tilt : {0.0, 0.3}) {
      for (const double draft : {0.3, 0.5, 0.75}) {
        const Pose pose{Vec3(0, 0, kRadius - draft),
                        Eigen::Quaterniond(Eigen::AngleAxisd(tilt, Vec3::UnitX()))};
        for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
          std::vector<double> triangles;
          std::vector<double> errors;
          for (const int n : {16, 32, 64, 128}) {
            const HydrostaticMesh mesh = make_hydrostatic_mesh({make_shape(refined.shape(n)), {}});
            const Water water{.up_W = Vec3::UnitZ(), .level = 0.0, .density = 1.0, .gravity = 1.0};
            const double volume = buoyancy(Solver(mesh, method), pose, water, Vec3::Zero()).volume;
            triangles.push_back(static_cast<double>(mesh.surface.triangles.size()));
            errors.push_back(std::abs(volume - refined.volume(draft, tilt)));
          }
          stress.check(std::abs(slope_of(triangles, errors) + 1.0), 0.05,
                       refined.name + ", " + std::string(to_string(method)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace buoyancy
