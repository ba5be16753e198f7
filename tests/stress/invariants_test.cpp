// The stress catalogue, "Invariants": they hold for every closed mesh at every pose, random and adversarial.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/wetted_moments.h"
#include "tests/stress/exact_truth.h"
#include "tests/stress/stress_case.h"
#include "tests/stress/stressed_body.h"
#include "tests/truth/stiffness_autodiff.h"
#include "tests/truth/wetted_moments_reference.h"

namespace buoyancy {
namespace {

// The same plane with the water on its other side.
Water from_above(Water water) {
  water.up_W = -water.up_W;
  water.level = -water.level;
  return water;
}

TEST(StressInvariants, WetAndDryVolumesSumToTotal) {
  StressCase stress("V_wet + V_dry = V_T", "V_T", "G_V");
  for_each_turn(101, tries(1000), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    const Pose pose = stressed_pose(random, body, i, water);
    visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
      const double wet = buoyancy(solver, pose, water, body.mesh.center_B).volume;
      const double dry = buoyancy(solver, pose, from_above(water), body.mesh.center_B).volume;
      const double factor =
          std::max(depth_factor(solver, pose, water), depth_factor(solver, pose, from_above(water)));
      stress.check(std::abs((wet - body.mesh.volume) + dry), factor * body.volume_tolerance(),
                   body.name + ", " + method);
    });
  });
}

// F/(rho g) in B and tau_c/(rho g) along k, as computed from the surface moments without projection.
struct Unprojected {
  Vec3 force;
  double twist;
};

Unprojected from_moments(const MomentTree& tree, const WaterPlane& plane) {
  const WettedMoments wetted = wetted_moments(tree, plane);
  const Vec3& k = plane.up_B;
  const Vec3 force = wetted.moments.N.transpose() * k + wetted.height * wetted.moments.S;
  Mat3 pressure;  // (j, k): int y_j z n_k dA
  for (int j = 0; j < 3; ++j) {
    for (int n = 0; n < 3; ++n) {
      pressure(j, n) = wetted.height * wetted.moments.N(j, n);
      for (int i = 0; i < 3; ++i) pressure(j, n) += k[i] * wetted.moments.second(i, j, n);
    }
  }
  const Vec3 torque(pressure(1, 2) - pressure(2, 1), pressure(2, 0) - pressure(0, 2),
                    pressure(0, 1) - pressure(1, 0));
  return {force, k.dot(torque + wetted.point.cross(force))};
}

double horizontal(const Vec3& force, const Vec3& k) {
  return (force - k.dot(force) * k).norm();
}

TEST(StressInvariants, HorizontalForceVanishesBeforeProjection) {
  // The pressures on the two sides of a thin plate cancel; each is as large as A_s times the depth: 1.3 G_V
  // are measured with the plate half submerged. The published force has no such component.
  StressCase stress("horizontal force = 0 before projection", "0", "G_V; exact_surface: 2 G_V");
  for_each_turn(102, tries(1000), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    const Pose pose = stressed_pose(random, body, i, water);
    const WaterPlane plane = water_plane_in_body(pose, water, body.mesh.center_B);
    visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
      const Displacement found = solver.displacement(plane);
      const double factor =
          depth_factor(solver, pose, water) * (solver.method() == Method::kExactSurface ? 2.0 : 1.0);
      stress.check(horizontal(found.force, plane.up_B), factor * body.volume_tolerance(),
                   body.name + ", " + method);
    });
    stress.check(horizontal(from_moments(*body.mesh.tree, plane).force, plane.up_B), body.volume_tolerance(),
                 body.name + ", all moments");
  });
}

TEST(StressInvariants, TorqueAboutUpVanishesBeforeProjection) {
  StressCase stress("torque about up = 0 before projection", "0", "G_V L_r");
  for (const StressedBody& body : stressed_bodies()) {
    const double gate = body.torque_tolerance(body.mesh.center_B);
    RandomPoses random(103);
    for (int i = 0; i < tries(1000); ++i) {
      Water water = kStressWater;
      const Pose pose = stressed_pose(random, body, i, water);
      const WaterPlane plane = water_plane_in_body(pose, water, body.mesh.center_B);
      visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
        const Displacement found = solver.displacement(plane);
        stress.check(std::abs(plane.up_B.dot(found.torque)), depth_factor(solver, pose, water) * gate,
                     body.name + ", " + method);
      });
      stress.check(std::abs(from_moments(*body.mesh.tree, plane).twist), gate, body.name + ", all moments");
    }
  }
}

TEST(StressInvariants, VolumeNeverFallsAsLevelRises) {
  StressCase stress("V never falls as the level rises", "the level before", "G_V");
  for_each_turn(104, tries(60), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    const Pose pose = stressed_pose(random, body, i, water);
    std::vector<double> levels;
    // From dry to submerged.
    const double middle = water.up_W.dot(pose.p_WB + pose.q_WB * body.box.center());
    for (int step = -20; step <= 20; ++step) {
      levels.push_back(middle + 0.026 * step * body.mesh.diagonal);
    }
    // A few ulp around the heights of vertices, where the volume may jump.
    for (int v = 0; v < 8; ++v) {
      const auto vertex = static_cast<std::int32_t>(random.pick(body.source.vertex_count()));
      double level = water.up_W.dot(pose.p_WB + pose.q_WB * body.source.vertex(vertex));
      for (int ulp = 0; ulp < 3; ++ulp) level = std::nextafter(level, -INFINITY);
      for (int ulp = 0; ulp < 6; ++ulp) levels.push_back(level = std::nextafter(level, INFINITY));
    }
    std::sort(levels.begin(), levels.end());
    visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
      double highest = 0.0;
      for (const double level : levels) {
        Water raised = water;
        raised.level = level;
        const double volume = buoyancy(solver, pose, raised, body.mesh.center_B).volume;
        stress.check(std::max(0.0, highest - volume),
                     depth_factor(solver, pose, raised) * body.volume_tolerance(), body.name + ", " + method);
        highest = std::max(highest, volume);
      }
    });
  });
}

TEST(StressInvariants, VolumeChangeIsIntegralOfWaterplane) {
  StressCase stress("dV = integral of A_wp dh", "Simpson's rule between vertices, exact there", "G_V");
  for (const StressedBody& body : stressed_bodies()) {
    const Vec3& center = body.mesh.center_B;
    RandomPoses random(105);
    for (int i = 0; i < tries(500); ++i) {
      Pose pose;
      pose.q_WB = random.rotation();
      pose.p_WB = -(pose.q_WB * center);
      std::vector<double> heights;
      for (std::size_t v = 0; v < body.source.vertex_count(); ++v) {
        heights.push_back((pose.q_WB * (body.source.vertex(static_cast<std::int32_t>(v)) - center)).z());
      }
      std::sort(heights.begin(), heights.end());
      const std::size_t between = random.pick(heights.size() - 1);
      const double gap = heights[between + 1] - heights[between];
      if (gap < 1e-6 * body.mesh.diagonal) continue;
      const double low = heights[between] + 0.1 * gap;
      const double high = heights[between + 1] - 0.1 * gap;
      const auto area = [&](double level) {
        Water water = kStressWater;
        water.level = level;
        const auto found = hydrostatics(body.mesh, pose, water, center, std::nullopt);
        return found ? found->waterplane_area : kNaN;
      };
      const double integral =
          (high - low) / 6.0 * (area(low) + 4.0 * area(low + 0.5 * (high - low)) + area(high));
      visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
        Water below = kStressWater;
        Water above = kStressWater;
        below.level = low;
        above.level = high;
        const double change =
            buoyancy(solver, pose, above, center).volume - buoyancy(solver, pose, below, center).volume;
        stress.check(std::abs(change - integral), body.volume_tolerance(), body.name + ", " + method);
      });
    }
  }
}

// Checks the body's results against others, in the order of results_of().
void check_results(StressCase& stress, const StressedBody& body, const Pose& pose, const Water& water,
                   const Vec3& reference_B, const std::vector<BuoyancyResult>& others) {
  std::size_t next = 0;
  visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
    check_result(stress, body, buoyancy(solver, pose, water, reference_B), others.at(next++), reference_B,
                 depth_factor(solver, pose, water), body.name + ", " + method);
  });
}

TEST(StressInvariants, ResultIsIndependentOfFaceOrder) {
  StressCase stress("face order permuted", "the order before", "G_V, G_V L_r");
  for (const StressedBody& body : stressed_bodies()) {
    RandomPoses random(106);
    TriangleMesh shuffled = body.source;
    for (std::size_t n = shuffled.triangles.size(); n > 1; --n) {
      std::swap(shuffled.triangles[n - 1], shuffled.triangles[random.pick(n)]);
    }
    const StressedBody permuted(body.name, shuffled);
    for (int i = 0; i < tries(500); ++i) {
      Water water = kStressWater;
      const Pose pose = stressed_pose(random, body, i, water);
      const Vec3 reference_B = reference_near(random, body);
      check_results(stress, permuted, pose, water, reference_B,
                    results_of(body.mesh, pose, water, reference_B));
    }
  }
}

TEST(StressInvariants, TorqueShiftsWithReferencePoint) {
  StressCase stress("reference point moved: t' = t + (r - r') x F", "the other point", "G_V L_r");
  for_each_turn(107, tries(1000), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    const Pose pose = stressed_pose(random, body, i, water);
    const Vec3 r = reference_near(random, body);
    const Vec3 s = reference_near(random, body);
    visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
      const BuoyancyResult about_r = buoyancy(solver, pose, water, r);
      const BuoyancyResult about_s = buoyancy(solver, pose, water, s);
      const Vec3 lever_W = pose.q_WB.normalized() * (r - s);
      stress.check(
          (about_s.torque_W - about_r.torque_W - lever_W.cross(about_r.force_W)).norm(),
          depth_factor(solver, pose, water) * std::max(body.torque_tolerance(r), body.torque_tolerance(s)),
          body.name + ", " + method);
    });
  });
}

// The faces on one side of a plane through the middle, and the rest. Every edge between the two gets a
// triangle to one common point in both parts, with opposite orientations: both parts are closed, and their
// sum is exactly the whole.
struct TwoParts {
  TriangleMesh first, second;
};

TwoParts cut_in_two(const StressedBody& body, const Vec3& normal) {
  const TriangleMesh& mesh = body.source;
  TwoParts parts{mesh, mesh};
  parts.first.triangles.clear();
  parts.second.triangles.clear();
  std::multiset<std::array<std::int32_t, 2>> edges;  // of the first part
  for (const Triangle& t : mesh.triangles) {
    const Vec3 middle = (mesh.vertex(t[0]) + mesh.vertex(t[1]) + mesh.vertex(t[2])) / 3.0;
    const bool in_first = normal.dot(middle - body.box.center()) < 0.0;
    (in_first ? parts.first : parts.second).triangles.push_back(t);
    if (!in_first) continue;
    for (std::size_t n = 0; n < 3; ++n) edges.insert({t[n], t[(n + 1) % 3]});
  }
  const Vec3 apex = body.box.center();
  const std::int32_t in_first = parts.first.add_vertex(apex);
  const std::int32_t in_second = parts.second.add_vertex(apex);
  for (const auto& [from, to] : edges) {
    if (edges.contains({to, from})) continue;
    parts.first.triangles.push_back({to, from, in_first});
    parts.second.triangles.push_back({from, to, in_second});
  }
  return parts;
}

TEST(StressInvariants, ClosedPartsSumToWhole) {
  StressCase stress("mesh cut in two closed parts: sums agree", "the whole mesh", "G_V, G_V L_r");
  for (const StressedBody& body : stressed_bodies()) {
    RandomPoses random(108);
    for (int cut = 0; cut < 3; ++cut) {
      const TwoParts parts = cut_in_two(body, random.direction());
      const StressedBody first("", parts.first);
      const StressedBody second("", parts.second);
      for (int i = 0; i < tries(100); ++i) {
        Water water = kStressWater;
        const Pose pose = stressed_pose(random, body, i, water);
        const Vec3 reference_B = reference_near(random, body);
        std::vector<BuoyancyResult> sums = results_of(first.mesh, pose, water, reference_B);
        const std::vector<BuoyancyResult> rest = results_of(second.mesh, pose, water, reference_B);
        for (std::size_t n = 0; n < sums.size(); ++n) {
          sums[n].volume += rest[n].volume;
          sums[n].torque_W += rest[n].torque_W;
        }
        check_results(stress, body, pose, water, reference_B, sums);
      }
    }
  }
}

TEST(StressInvariants, TorqueAndStiffnessAreDerivatives) {
  StressCase stress("torque = -dU/dtheta, stiffness = -d(F, torque)/dpose",
                    "dual numbers through the templated kernel", "1e-9 relative");
  for_each_turn(109, tries(60), [&](RandomPoses& random, const StressedBody& body, int i) {
    Water water = kStressWater;
    if (i % 4 == 3) water.up_W = random.direction();
    const Pose pose = random.crossing(body.box, water);
    const Vec3 reference_B = reference_near(random, body);

    // U = -rho g H with H the integral of the height over the displaced volume, H = k . M - h_c V.
    const DualPlane plane = dual_water_plane(body.mesh, pose, water, reference_B);
    const auto displaced = displacement_moments<Dual>(
        wetted_moments_reference<Dual>(body.mesh.surface, plane.up_B, plane.h_c), -plane.h_c, plane.up_B);
    const Dual H = plane.up_B.dot(displaced.moment) - plane.h_c * displaced.volume;
    const Vec3 force_W(H.slope[0], H.slope[1], H.slope[2]);
    const Vec3 torque_W(H.slope[3], H.slope[4], H.slope[5]);
    visit_exact_solvers(body.mesh, [&](const std::string& method, const Solver& solver) {
      const BuoyancyResult result = buoyancy(solver, pose, water, reference_B);
      const std::string where = body.name + ", " + method;
      stress.check((result.force_W - force_W).norm(), 1e-9 * body.mesh.volume, "force, " + where);
      stress.check((result.torque_W - torque_W).norm(), 1e-9 * body.mesh.volume * body.mesh.diagonal,
                   "torque, " + where);
    });

    const auto found = hydrostatics(body.mesh, pose, water, reference_B, std::nullopt);
    stress.require(found.has_value(), body.name);
    if (!found) return;
    // The area of a tiny waterplane is known only to eps A_s.
    const double area = found->waterplane_area;
    if (stiffness_tolerance(body.mesh, area) > 1e-9) return;
    stress.check(
        max_difference(found->stiffness, stiffness_autodiff(body.mesh, pose, water, reference_B), area > 0.0),
        1e-9, "stiffness, " + body.name);
  });
}

}  // namespace
}  // namespace buoyancy
