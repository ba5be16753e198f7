// The stress catalogue, "Cases": the water plane through vertices, edges and faces or within a few ulp of
// them; bodies that barely touch the water, and bodies that are nearly submerged.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/hydrostatics.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/stress/exact_truth.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"

namespace buoyancy {
namespace {

const Water kLevelZero{.up_W = Vec3::UnitZ(), .level = 0.0, .density = 1.0, .gravity = 1.0};

TriangleMesh octahedron() {
  TriangleMesh mesh;
  for (const double side : {1.0, -1.0}) {
    for (int axis = 0; axis < 3; ++axis) mesh.add_vertex(side * Vec3::Unit(axis));
  }
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  return mesh;
}

// All 24 quaternions for which R_WB maps axes to axes, without rounding in R.
std::vector<Eigen::Quaterniond> axis_rotations() {
  std::vector<Eigen::Quaterniond> found;
  for (const double w : {0.0, 1.0}) {
    for (const double x : {-1.0, 0.0, 1.0}) {
      for (const double y : {-1.0, 0.0, 1.0}) {
        for (const double z : {-1.0, 0.0, 1.0}) {
          const double squared = w + std::abs(x) + std::abs(y) + std::abs(z);
          const bool first_positive = w > 0 || x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
          if (first_positive && (squared == 1.0 || squared == 2.0 || squared == 4.0))
            found.emplace_back(w, x, y, z);
        }
      }
    }
  }
  return found;
}

TEST(StressGrazing, TreatsFeaturesOnPlaneAsDry) {
  StressCase stress("vertex, edge, whole face on the plane (dry by convention)", "rational arithmetic",
                    "G_V, G_V L_r; standing on the water: 0");
  const StressedBody diamond("octahedron", octahedron());
  const StressedBody box("box", make_shape(BoxShape{.segments = {2, 2, 2}}));
  EXPECT_EQ(axis_rotations().size(), 24U);
  for (const Eigen::Quaterniond& q_WB : axis_rotations()) {
    // Heights at which a corner, the four edges around the middle, or whole faces lie in the water plane.
    for (const double height : {1.0, 0.0, -1.0}) {
      check_exactly(stress, diamond, {Vec3(0, 0, height), q_WB}, kLevelZero, Vec3(0.5, 0.25, 0));
    }
    for (const double height : {0.5, 0.0, -0.5}) {
      check_exactly(stress, box, {Vec3(0, 0, height), q_WB}, kLevelZero, Vec3(0.5, 0.25, 0));
    }
    visit_exact_solvers(diamond.mesh, [&](const std::string& method, const Solver& solver) {
      stress.check(buoyancy(solver, {Vec3(0, 0, 1), q_WB}, kLevelZero, Vec3::Zero()).volume, 0.0,
                   "on a corner, " + method);
    });
    visit_exact_solvers(box.mesh, [&](const std::string& method, const Solver& solver) {
      stress.check(buoyancy(solver, {Vec3(0, 0, 0.5), q_WB}, kLevelZero, Vec3::Zero()).volume, 0.0,
                   "on a face, " + method);
    });
    // A face in the water plane does not count as wetted area; the waterplane includes it instead.
    const auto standing = hydrostatics(box.mesh, {Vec3(0, 0, 0.5), q_WB}, kLevelZero, Vec3::Zero(), {});
    const auto awash = hydrostatics(box.mesh, {Vec3(0, 0, -0.5), q_WB}, kLevelZero, Vec3::Zero(), {});
    stress.require(standing && awash, "hydrostatics");
    if (!standing || !awash) continue;
    stress.check(standing->wetted_area, 0.0, "wetted area of a box on the water");
    stress.check(standing->waterplane_area, 0.0, "waterplane of a box on the water");
    stress.check(std::abs(awash->wetted_area - 5.0), 4 * kEpsilon * box.mesh.area,
                 "wetted area of a box awash");
    stress.check(std::abs(awash->waterplane_area - 1.0), 4 * kEpsilon * box.mesh.area,
                 "waterplane of a box awash");
  }

  // Any rotation about a vertex at B's origin, and about an edge along x through it; the origin lies in the
  // water plane.
  for_each_turn(301, tries(6), [&](RandomPoses& random, const StressedBody& body, int) {
    const auto vertex = static_cast<std::int32_t>(random.pick(body.source.vertex_count()));
    const StressedBody moved(body.name, moved_and_scaled(body.source, -body.source.vertex(vertex)));
    const Pose pose{Vec3(0, 0, kStressWater.level), random.rotation()};
    check_exactly(stress, moved, pose, kStressWater, reference_near(random, moved), ", a vertex");
  });
  const StressedBody bar("box with an edge in x",
                         moved_and_scaled(make_shape(BoxShape{.segments = {3, 2, 2}}), {0, 0.5, 0.5}));
  const StressedBody slab("box with a face in z",
                          moved_and_scaled(make_shape(BoxShape{.segments = {3, 3, 2}}), {0, 0, 0.5}));
  RandomPoses random(302);
  for (int i = 0; i < tries(60); ++i) {
    const double angle = random.uniform(-3.1, 3.1);
    check_exactly(
        stress, bar,
        {Vec3(0, 0, kStressWater.level), Eigen::Quaterniond(std::cos(angle), std::sin(angle), 0, 0)},
        kStressWater, Vec3::Zero(), ", an edge");
    const Eigen::Quaterniond about_z(std::cos(angle), 0, 0, std::sin(angle));
    const Eigen::Quaterniond upside_down(0, 1, 0, 0);
    for (const Eigen::Quaterniond& q_WB : {about_z, Eigen::Quaterniond(about_z * upside_down)}) {
      check_exactly(stress, slab, {Vec3(0, 0, kStressWater.level), q_WB}, kStressWater, Vec3::Zero(),
                    ", a face");
    }
  }
}

double shifted_by_ulps(double value, int ulps) {
  for (; ulps > 0; --ulps) value = std::nextafter(value, INFINITY);
  for (; ulps < 0; ++ulps) value = std::nextafter(value, -INFINITY);
  return value;
}

TEST(StressGrazing, IsExactForFlatFaceWithinUlpsOfPlane) {
  StressCase stress("all of a big flat face within k ulp of the plane, k = -8 .. 8", "rational arithmetic",
                    "G_V, G_V L_r");
  const TriangleMesh box = make_shape(BoxShape{.size = {2, 2, 1}, .segments = {4, 4, 1}});
  const TriangleMesh plate = make_shape(BoxShape{.size = {1, 1, 1e-3}, .segments = {5, 5, 1}});
  RandomPoses random(303);
  // Upright in B, and rotated in B, so that the face's vertices are rounded to both sides of its plane.
  const Eigen::Quaterniond rotation = random.rotation();
  for (const bool oblique : {false, true}) {
    for (const TriangleMesh* shape : {&box, &plate}) {
      const TriangleMesh mesh = oblique ? turned(*shape, rotation) : *shape;
      const std::string name = shape == &box ? "box" : "plate";
      const StressedBody body(oblique ? "oblique " + name : name, mesh);
      const double half = shape == &box ? 0.5 : 0.5e-3;
      for (const double level : {0.0, 0.3, 1000.3}) {
        for (const double face : {half, -half}) {
          for (int k = -8; k <= 8; ++k) {
            if (tries(20) < 20 && k % 4 != 0) continue;
            Water water = kStressWater;
            water.level = level;
            Pose pose;
            // A tilt of a few ulp makes some of the face wet and some dry.
            const Eigen::Quaterniond tilt{1.0, random.uniform(-4, 4) * kEpsilon,
                                          random.uniform(-4, 4) * kEpsilon, 0.0};
            pose.q_WB = tilt * (oblique ? rotation.conjugate() : Eigen::Quaterniond::Identity());
            pose.p_WB.z() = shifted_by_ulps(level - face, k);
            check_exactly(stress, body, pose, water, reference_near(random, body));
          }
        }
      }
    }
  }
}

// Bodies that touch the water with a tip, an edge or a face.
struct Grazing {
  StressedBody body;
  Eigen::Quaterniond q_WB;
};

std::vector<Grazing> grazing_bodies(RandomPoses& random) {
  std::vector<Grazing> found;
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond on_an_edge(Eigen::AngleAxisd(0.6, Vec3::UnitX()));
  for (const StressedBody& body : stressed_bodies()) found.push_back({body, random.rotation()});
  const StressedBody box("box", make_shape(BoxShape{.segments = {3, 3, 3}}));
  found.push_back({box, upright});
  found.push_back({box, on_an_edge});
  found.push_back(
      {StressedBody("sphere", make_shape(RockShape{.frequency = 4, .roughness = 0})), random.rotation()});
  found.push_back({StressedBody("plate", make_shape(BoxShape{.size = {1, 1, 1e-3}})), on_an_edge});
  return found;
}

double lowest_point(const TriangleMesh& mesh, const Eigen::Quaterniond& q_WB) {
  double lowest = INFINITY;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    lowest = std::min(lowest, (q_WB * mesh.vertex(static_cast<std::int32_t>(v))).z());
  }
  return lowest;
}

// [m^3], the allowed error of each method's volume where the water reaches no farther than `plane`. Rounding
// errors come from
//   exact_surface  the heights: 4 eps L A_wp, the catalogue's gate;
//   hierarchical   the heights and, where the water runs along an edge, the dry parts of large triangles,
//                  which are subtracted again;
//   exact          the heights and the positions of the cut points, under an apex that lies L away.
double grazing_gate(Method method, const TrueWaterplane& plane, double diagonal) {
  const double gate = 4 * kEpsilon * diagonal;
  if (method == Method::kHierarchical) return gate * (plane.area + plane.cut_area);
  if (method == Method::kExact) return gate * (plane.area + diagonal * plane.perimeter);
  return gate * plane.area;
}

TEST(StressGrazing, BoundsErrorOfTinyWetTips) {
  StressCase stress("grazing: wet volume 1e-9 V_T and less; no c_B below the bound", "rational arithmetic",
                    "4 eps L A_wp; more along edges (hierarchical), of the waterline (exact)");
  RandomPoses random(304);
  for (int round = 0; round < tries(3); ++round) {
    for (const Grazing& grazing : grazing_bodies(random)) {
      const StressedBody& body = grazing.body;
      for (int exponent = -3; exponent >= -16; --exponent) {
        const double draft = body.mesh.diagonal * std::pow(10.0, exponent) * random.uniform(0.3, 1.0);
        const Pose pose{Vec3(0, 0, -lowest_point(body.source, grazing.q_WB) - draft), grazing.q_WB};
        const Truth truth({&body.source}, pose, kLevelZero, body.mesh.center_B);
        if (truth.volume_error(0.0) > 1e-9 * body.mesh.volume) continue;
        // Rounding decides whether a tip, or a face that a body rests on, is in the water.
        const TrueWaterplane plane =
            true_waterplane(body.source, pose, kLevelZero, 4 * kEpsilon * body.mesh.diagonal);
        visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
          const BuoyancyResult result = buoyancy(solver, pose, kLevelZero, body.mesh.center_B);
          const double gate = grazing_gate(solver.method(), plane, body.mesh.diagonal);
          const std::string where = body.name + ", " + method;
          const double torque_gate = gate * body.mesh.max_lever_arm(body.mesh.center_B);
          stress.check(truth.volume_error(result.volume, gate), gate, "volume, " + where);
          stress.check(truth.torque_error(result.torque_W, torque_gate), torque_gate, "torque, " + where);
          const bool has_center = result.center_of_buoyancy_W != Vec3::Zero();
          stress.require(!has_center || result.volume > result.force_error_bound, "c_B, " + where);
        });
      }
    }
  }
}

TEST(StressGrazing, IsExactWhenNearlySubmerged) {
  StressCase stress("nearly submerged", "complement: V_T less the dry tip, rational", "G_V, G_V L_r");
  RandomPoses random(305);
  for (const Grazing& grazing : grazing_bodies(random)) {
    const StressedBody& body = grazing.body;
    const Eigen::Quaterniond q_WB = Eigen::Quaterniond(0, 1, 0, 0) * grazing.q_WB;  // upside down
    const double highest = -lowest_point(body.source, grazing.q_WB);
    for (int exponent = -2; exponent >= -16; exponent -= 2) {
      const double freeboard = body.mesh.diagonal * std::pow(10.0, exponent);
      check_exactly(stress, body, {Vec3(0, 0, freeboard - highest), q_WB}, kLevelZero,
                    reference_near(random, body));
    }
  }
}

TEST(StressGrazing, IsConstantAtEveryDepthWhenSubmerged) {
  StressCase stress("submerged, depth to 1e4 m", "the constants",
                    "same bits; exact and exact_surface: G_V (1 + 8 depth/L)");
  for_each_turn(306, tries(4), [&](RandomPoses& random, const StressedBody& body, int) {
    Pose pose{Vec3::Zero(), random.rotation()};
    const Vec3 reference_B = reference_near(random, body);
    const Vec3 center_W = pose.q_WB * body.box.center();
    std::vector<BuoyancyResult> shallow;
    for (const double depth : {0.6 * body.mesh.diagonal, 3.0 * body.mesh.diagonal, 1e2 * body.mesh.diagonal,
                               0.6 * body.mesh.diagonal + 1e4}) {
      pose.p_WB = Vec3(0, 0, -depth) - center_W;
      const Truth truth({&body.source}, pose, kLevelZero, reference_B);
      std::size_t next = 0;
      visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
        const BuoyancyResult result = buoyancy(solver, pose, kLevelZero, reference_B);
        const std::string where = body.name + ", " + method;
        check_result(stress, body, result, truth, reference_B, depth_factor(solver, pose, kLevelZero), where);
        stress.require(result.immersion == Immersion::kSubmerged, where);
        if (next == shallow.size()) shallow.push_back(result);
        if (solver.method() == Method::kHierarchical) {
          stress.require(same_bits(result, shallow[next]), "bits, " + where);
          stress.check(std::abs(result.volume - body.mesh.volume), 0.0, "V_T, " + where);
        }
        ++next;
      });
    }
  });
}

TEST(StressGrazing, IsZeroWhenDry) {
  StressCase stress("dry", "zero, all six methods", "same bits");
  for_each_turn(307, tries(40), [&](RandomPoses& random, const StressedBody& body, int) {
    Pose pose{Vec3::Zero(), random.rotation()};
    const double clearance = body.mesh.diagonal * std::pow(10.0, random.uniform(-9, 5));
    pose.p_WB.z() = clearance - lowest_point(body.source, pose.q_WB);
    for (const Method method : kAllMethods) {
      const BuoyancyResult result = buoyancy(Solver(body.mesh, method), pose, kLevelZero, body.mesh.center_B);
      stress.require(result.status == BuoyancyStatus::kOk && result.volume == 0.0 &&
                         result.force_W.isZero(0.0) && result.torque_W.isZero(0.0) &&
                         result.center_of_buoyancy_W.isZero(0.0),
                     body.name + ", " + std::string(to_string(method)));
    }
  });
}

}  // namespace
}  // namespace buoyancy
