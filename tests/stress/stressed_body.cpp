#include "tests/stress/stressed_body.h"

#include <utility>

#include <gtest/gtest.h>

#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {

StressedBody::StressedBody(std::string body_name, TriangleMesh from)
    : name(std::move(body_name)),
      source(std::move(from)),
      mesh(make_hydrostatic_mesh({source, {}})),
      box(bounding_box(source)) {}

const std::vector<StressedBody>& stressed_bodies() {
  static const std::vector<StressedBody> bodies = [] {
    const TriangleMesh rock =
        make_shape(RockShape{.radius = 1.0, .frequency = 4, .roughness = 0.4, .seed = 7});
    std::vector<StressedBody> made;
    made.reserve(11);
    made.emplace_back("box", make_shape(BoxShape{}));
    made.emplace_back("box of many faces", make_shape(BoxShape{.size = {1, 2, 3}, .segments = {3, 4, 5}}));
    made.emplace_back("rock", rock);
    made.emplace_back("torus knot", make_shape(TorusKnotShape{.tubular = 40, .radial = 5}));
    made.emplace_back("box with a cavity",
                      joined(make_shape(BoxShape{.size = {2, 2, 2}, .segments = {3, 3, 3}}),
                             inside_out(make_shape(SphereShape{.radius = 0.8, .segments = 6}))));
    made.emplace_back("two boxes apart",
                      joined(make_shape(BoxShape{}), moved_and_scaled(make_shape(BoxShape{}), {3, 0, 1})));
    made.emplace_back("plate 1 : 1000", make_shape(BoxShape{.size = {1, 1, 1e-3}, .segments = {6, 6, 1}}));
    made.emplace_back("needle 1 : 8192", make_shape(BoxShape{.size = {8192, 1, 1}, .segments = {40, 1, 1}}));
    made.emplace_back("rock of 1e-6 m", moved_and_scaled(rock, Vec3::Zero(), 1e-6));
    made.emplace_back("rock of 1e6 m", moved_and_scaled(rock, Vec3::Zero(), 1e6));
    made.emplace_back("rock 2 km from its origin", moved_and_scaled(rock, {1200, -1600, 200}));
    return made;
  }();
  return bodies;
}

Pose stressed_pose(RandomPoses& random, const StressedBody& body, int turn, Water& water) {
  if (turn % 4 == 3) water.up_W = random.direction();
  return turn % 2 == 0 ? random.crossing(body.box, water) : random.adversarial(body.source, water);
}

Vec3 reference_near(RandomPoses& random, const StressedBody& body) {
  return body.box.center() + 0.5 * body.mesh.diagonal * random.direction();
}

void for_each_turn(std::uint64_t seed, int turns,
                   const std::function<void(RandomPoses&, const StressedBody&, int)>& check) {
  for (const StressedBody& body : stressed_bodies()) {
    RandomPoses random(seed);
    for (int turn = 0; turn < turns; ++turn) check(random, body, turn);
  }
}

void visit_exact_solvers(const HydrostaticMesh& mesh,
                         const std::function<void(const std::string&, const Solver&)>& visit) {
  for (const Method method : {Method::kExact, Method::kExactSurface}) {
    visit(std::string(to_string(method)), Solver(mesh, method));
  }
  for (const std::string& target : simd_targets()) {
    EXPECT_TRUE(force_simd_target(target));
    visit("hierarchical on " + target, Solver(mesh, Method::kHierarchical));
  }
  force_simd_target("");
}

std::vector<BuoyancyResult> results_of(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                                       const Vec3& reference_B) {
  std::vector<BuoyancyResult> results;
  visit_exact_solvers(mesh, [&](const std::string&, const Solver& solver) {
    results.push_back(buoyancy(solver, pose, water, reference_B));
  });
  return results;
}

double depth_factor(const Solver& solver, const Pose& pose, const Water& water) {
  if (solver.method() == Method::kHierarchical) return 1.0;
  const HydrostaticMesh& mesh = solver.mesh();
  const WaterPlane plane = water_plane_in_body(pose, water, mesh.center_B);
  if (immersion(mesh, plane) != Immersion::kSubmerged) return 1.0;
  return 1.0 + 8.0 * (plane.h_c + 0.5 * mesh.diagonal) / mesh.diagonal;
}

bool same_bits(const BuoyancyResult& a, const BuoyancyResult& b) {
  return a.status == b.status && a.force_W == b.force_W && a.torque_W == b.torque_W && a.volume == b.volume &&
         a.center_of_buoyancy_W == b.center_of_buoyancy_W && a.force_error_bound == b.force_error_bound &&
         a.torque_error_bound == b.torque_error_bound;
}

}  // namespace buoyancy
