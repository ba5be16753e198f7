// The bounds that are published with the results, against the formulas of docs/mathematics.md, "Error
// bounds". The test adds up every term itself: a term, a factor or a power of the scale that is missing
// shows, although errors are far below their bounds.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "hydrostatics/tank.h"
#include "hydrostatics/volume_elements.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Squared lengths of a face's edges, the longest last.
std::array<double, 3> squared_edges(const HydrostaticMesh& mesh, const Triangle& face) {
  std::array<double, 3> squares{};
  for (std::size_t i = 0; i < 3; ++i) {
    squares[i] = (mesh.vertex(face[(i + 1) % 3]) - mesh.vertex(face[i])).squaredNorm();
  }
  std::ranges::sort(squares);
  return squares;
}

// [m^2], A_r.
double rounding_area(const HydrostaticMesh& mesh) {
  double sum = 0.0;
  for (const Triangle& face : mesh.surface.triangles) {
    const std::array<double, 3> squares = squared_edges(mesh, face);
    const Vec3 a = mesh.vertex(face[0]);
    const double twice_area = (mesh.vertex(face[1]) - a).cross(mesh.vertex(face[2]) - a).norm();
    sum += 0.5 * std::max(twice_area, std::sqrt(squares[0] * squares[1]));
  }
  return sum;
}

// [m], L_r: the distance to the farthest corner of the box.
double farthest_corner(const HydrostaticMesh& mesh, const Vec3& point_B) {
  double farthest = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 y;
    for (unsigned i = 0; i < 3; ++i) y[i] = (corner >> i & 1U) == 0 ? mesh.box_min[i] : mesh.box_max[i];
    farthest = std::max(farthest, (mesh.center_B + y - point_B).norm());
  }
  return farthest;
}

double rounding_of_mesh(const HydrostaticMesh& mesh) {
  return 2.0 * kEpsilon * (64.0 * std::abs(mesh.volume) + mesh.diagonal * rounding_area(mesh));
}

// The sum over the faces that the water cuts.
template <typename Term>
double sum_over_cut_faces(const HydrostaticMesh& mesh, const WaterPlane& plane, const Term& term) {
  double sum = 0.0;
  for (const Triangle& face : mesh.surface.triangles) {
    int wet = 0;
    for (const std::int32_t i : face) {
      wet += dot(Point<double>::from(plane.up_B), mesh.point(i)) - plane.h_c < 0.0 ? 1 : 0;
    }
    if (wet % 3 != 0) sum += term(face);
  }
  return sum;
}

// What a method's result depends on beside the mesh: [m].
struct Reach {
  double cancels = 0.0;  // the distance from c that its intermediate values reach
  double apex = 0.0;     // the distance from c at which what it leaves out may act
};

Reach reach_of(Method method, const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const double depth = std::abs(plane.h_c);
  const double apex = apex_on_water(mesh, plane).norm();
  switch (method) {
    case Method::kFast:
      return {mesh.center_B.norm(), mesh.center_B.norm()};
    case Method::kImproved:
      return {std::max(depth, apex), apex};
    case Method::kExact:
      return {std::max(depth, apex), 0.0};
    case Method::kFastSurface:
    case Method::kExactSurface:
      return {depth, 0.0};
    case Method::kHierarchical:
      break;
  }
  return {};
}

struct AtPose {
  Pose pose;
  Water water;
  Vec3 reference_B;
};

double area_of(const HydrostaticMesh& mesh) {  // [m^2]
  double sum = 0.0;
  for (const Triangle& face : mesh.surface.triangles) {
    const Vec3 a = mesh.vertex(face[0]);
    sum += 0.5 * (mesh.vertex(face[1]) - a).cross(mesh.vertex(face[2]) - a).norm();
  }
  return sum;
}

// Piercing, submerged and adversarial poses in water of any density; reference points near and far away.
AtPose random_request(const NamedMesh& named, const HydrostaticMesh& mesh, int turn, RandomPoses& random) {
  AtPose at;
  at.water = {.up_W = random.direction(),
              .level = random.uniform(-3.0, 3.0),
              .density = random.uniform(0.5, 2000.0),
              .gravity = random.uniform(0.5, 25.0)};
  at.pose = turn % 4 == 3 ? random.adversarial(named.mesh, at.water)
                          : random.crossing(bounding_box(named.mesh), at.water);
  if (turn % 4 == 2) at.pose.p_WB -= random.uniform(0.1, 30.0) * mesh.diagonal * at.water.up_W;
  at.reference_B = mesh.center_B + mesh.diagonal * random.far_vector(-1.0, 3.0);
  return at;
}

void expect_bound(double found, double expected, const std::string& where) {
  EXPECT_NEAR(found / expected, 1.0, 1e-11) << where << ": " << found << ", by the formula " << expected;
}

TEST(ErrorBounds, AreThoseOfTheirFormulas) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    const double near = rounding_of_mesh(mesh);
    RandomPoses random(51);
    for (int i = 0; i < 24; ++i) {
      const AtPose at = random_request(named, mesh, i, random);
      const WaterPlane plane = water_plane_in_body(at.pose, at.water, mesh.center_B);
      const double weight = at.water.density * at.water.gravity;
      for (const Method method : kAllMethods) {
        const std::string where = named.name + ", " + std::string(to_string(method));
        const Solver solver(mesh, method);
        const BuoyancyResult result = buoyancy(solver, at.pose, at.water, at.reference_B);
        if (result.immersion == Immersion::kDry) continue;
        const Displacement displaced = solver.displacement(plane);
        const Reach reach = reach_of(method, mesh, plane);
        double force = near * (1.0 + 3.0 * reach.cancels / mesh.diagonal);
        if (method == Method::kHierarchical) {
          // The leaves that the water cuts hold the cut faces, and others.
          const auto cut = [&mesh](const Triangle& face) {
            const std::array<double, 3> squares = squared_edges(mesh, face);
            return 0.5 * kEpsilon * squares[2] * std::sqrt(squares[1]);
          };
          const bool is_usual = mesh.meets_volume_tolerance();
          EXPECT_GE(displaced.rounding, is_usual ? 0.0 : (1.0 - 1e-6) * sum_over_cut_faces(mesh, plane, cut));
          EXPECT_LE(near + displaced.rounding, mesh.max_rounding_bound() * (1.0 + 1e-6)) << where;
          force += displaced.rounding;
          if (result.immersion == Immersion::kPiercing) {
            WaterPlane rough = plane;
            rough.error = 1e-9 * mesh.diagonal;
            expect_bound(solver.displacement(rough).truncation_bound - displaced.truncation_bound,
                         rough.error * (area_of(mesh) + std::abs(mesh.volume) / mesh.diagonal),
                         "rough plane, " + where);
          }
        } else if (is_exact(method) && !mesh.meets_volume_tolerance()) {
          force += kEpsilon * mesh.diagonal * sum_over_cut_faces(mesh, plane, [&](const Triangle& face) {
                     return squared_edges(mesh, face)[2];
                   });
        }
        // Against the sum over the triangles in wetted_surface_test.cpp.
        if (!is_exact(method)) force += displaced.truncation_bound;
        double lever = farthest_corner(mesh, at.reference_B);
        if (reach.apex > 0.0) {
          lever = std::max(lever, reach.apex + (at.reference_B - mesh.center_B).norm());
        }
        expect_bound(result.force_error_bound, weight * force, "force, " + where);
        expect_bound(result.torque_error_bound, weight * force * lever, "torque, " + where);
      }
    }
  }
}

// Without the plane: from bounds of the box, and from the constants of the mesh.
TEST(ErrorBounds, OfSubmergedBodiesAreThoseOfRounding) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    const Water water{.up_W = Vec3(0.6, 0.0, 0.8), .level = 2.0, .density = 1025.0, .gravity = 9.8};
    RandomPoses random(52);
    for (int i = 0; i < 8; ++i) {
      const Vec3 reference_B = mesh.center_B + mesh.diagonal * random.far_vector(-1.0, 3.0);
      Pose pose{Vec3::Zero(), random.rotation()};
      pose.p_WB = -random.uniform(2.0, 9.0) * mesh.diagonal * water.up_W - pose.q_WB * mesh.center_B;
      const double force = water.density * water.gravity * rounding_of_mesh(mesh);
      const double torque = force * farthest_corner(mesh, reference_B);
      BuoyancyResult from_bounds;
      for (const double tolerance : {0.0, 1e-3}) {
        const Solver solver(mesh, Method::kHierarchical, tolerance);
        ASSERT_TRUE(try_buoyancy_from_bounds(solver, submerged_constants(mesh, water, reference_B), pose,
                                             water, reference_B, from_bounds));
        for (const BuoyancyResult& result : {from_bounds, buoyancy(solver, pose, water, reference_B)}) {
          ASSERT_EQ(result.immersion, Immersion::kSubmerged);
          expect_bound(result.force_error_bound, force, named.name);
          expect_bound(result.torque_error_bound, torque, named.name);
        }
      }
    }
  }
}

TEST(ErrorBounds, OfATankCoverItsMeshItsCutFacesAndTheLevel) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    RandomPoses random(53);
    for (int i = 0; i < 12; ++i) {
      const Tank tank{
          .mesh = &mesh, .liquid_volume = random.uniform(0.02, 0.98) * mesh.volume, .density = 850.0};
      const TankLiquid liquid = tank_liquid(tank, random.direction());
      const Displacement below = Solver(mesh, Method::kHierarchical).displacement(liquid.surface);
      const double excess = std::abs(below.volume - tank.liquid_volume);
      expect_bound(liquid.volume_error, rounding_of_mesh(mesh) + below.rounding + excess, named.name);
    }
    const Tank full{.mesh = &mesh, .liquid_volume = mesh.volume, .density = 850.0};
    expect_bound(tank_liquid(full, Vec3::UnitX()).volume_error, rounding_of_mesh(mesh), named.name);
  }
}

}  // namespace
}  // namespace buoyancy
