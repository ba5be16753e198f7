// The sums of the paper's methods over all triangles: against sums of this file, against the oracle, and the
// same bits on every instruction set of this processor.
#include "hydrostatics/wetted_surface.h"

#include <bit>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hydrostatics/buoyancy.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/agreement.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/exact_oracle.h"

namespace buoyancy {
namespace {

const Water kUnitWater{.up_W = Vec3::UnitZ(), .level = 0.25, .density = 1.0, .gravity = 1.0};
constexpr std::array kMethodsOfPaper{Method::kFast, Method::kImproved, Method::kExact, Method::kFastSurface,
                                     Method::kExactSurface};

std::vector<double> fields(const Displacement& found) {
  return {found.volume,     found.moment.x(), found.moment.y(), found.moment.z(),
          found.force.x(),  found.force.y(),  found.force.z(),  found.torque.x(),
          found.torque.y(), found.torque.z(), found.rounding,   found.truncation_bound};
}

// Half of the poses are random and half adversarial; a quarter have an up direction other than z.
struct PoseInWater {
  Pose pose;
  Water water;
};
std::vector<PoseInWater> poses_for(const TriangleMesh& source, int count, std::uint64_t seed) {
  const BoundingBox box = bounding_box(source);
  RandomPoses random(seed);
  std::vector<PoseInWater> poses;
  for (int i = 0; i < count; ++i) {
    Water water = kUnitWater;
    if (i % 4 == 3) water.up_W = random.direction();
    poses.push_back({i % 2 == 0 ? random.crossing(box, water) : random.adversarial(source, water), water});
  }
  return poses;
}

TEST(WettedSurface, GivesSameBitsOnEveryInstructionSet) {
  const std::vector<std::string> targets =
      simd_targets();  // while a target is forced, there is only that one
  ASSERT_FALSE(targets.empty());
  const std::string& baseline = targets.back();
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}}, WithTree::kNo);
    const std::vector<PoseInWater> poses = poses_for(named.mesh, 100, 41);
    for (const Method method : kMethodsOfPaper) {
      const Solver solver(mesh, method);
      int different = 0;
      for (const PoseInWater& at : poses) {
        const WaterPlane plane = water_plane_in_body(at.pose, at.water, mesh.center_B);
        EXPECT_TRUE(force_simd_target(baseline));
        const std::vector<double> expected = fields(solver.displacement(plane));
        for (const std::string& target : targets) {
          EXPECT_TRUE(force_simd_target(target));
          different += fields(solver.displacement(plane)) == expected ? 0 : 1;
        }
        force_simd_target("");
      }
      EXPECT_EQ(different, 0) << named.name << ", " << to_string(method);
    }
  }
}

// The rock is made of sums, products, quotients and roots only, so that its bits do not depend on the
// mathematical library.
TEST(WettedSurface, IsBitIdenticalAcrossCompilersAndBuildTypes) {
  const HydrostaticMesh mesh =
      make_hydrostatic_mesh({make_shape(RockShape{.frequency = 11, .roughness = 0.5}), {}}, WithTree::kNo);
  const std::map<Method, std::uint64_t> golden{{Method::kFast, 0x369c2f54da022f64},
                                               {Method::kImproved, 0xa676a7f8f4d5f9d1},
                                               {Method::kExact, 0x2d2555118c49cdb0},
                                               {Method::kFastSurface, 0x9fb749ef70336fc8},
                                               {Method::kExactSurface, 0x19ddfed7149e8c2f}};
  for (const auto& [method, expected] : golden) {
    const Solver solver(mesh, method);
    std::uint64_t hash = 0xCBF29CE484222325U;  // FNV-1a
    for (int i = 0; i < 64; ++i) {
      const double a = 0.05 * i;
      const Pose pose{Vec3(3.0 * a, -a, 0.06 * (i % 32) - 0.9),
                      Eigen::Quaterniond(1.0 - 0.3 * a, 0.5 - a, 0.2 * a, 0.7 * a - 0.1)};
      for (const double value : fields(solver.displacement(water_plane_in_body(pose, {}, mesh.center_B)))) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned byte = 0; byte < 8; ++byte)
          hash = (hash ^ (bits >> (8 * byte) & 0xFFU)) * 0x100000001B3U;
      }
    }
    EXPECT_EQ(hash, expected) << to_string(method)
                              << ": if the change of bits is intended, the new value is 0x" << std::hex
                              << hash;
  }
}

using Real = long double;
using RealPoint = Point<Real>;

RealPoint real(const Point<double>& a) {
  return {a.x, a.y, a.z};
}
RealPoint real(const Vec3& a) {
  return {a.x(), a.y(), a.z()};
}

// A vertex's height as the product rounds it, which decides between wet and dry.
double height(const HydrostaticMesh& mesh, const WaterPlane& plane, std::int32_t vertex) {
  return dot(Point<double>::from(plane.up_B), mesh.point(vertex)) - plane.h_c;
}

// What an approximation adds up, triangle by triangle.
struct ReferenceSum {
  Real volume = 0, bound = 0;
  RealPoint moment{0, 0, 0}, torque{0, 0, 0};
};

// An approximation as paper_methods.h defines it: whole triangles, and a bound on those that are cut.
ReferenceSum reference_sum(const HydrostaticMesh& mesh, const WaterPlane& plane, Method method) {
  const RealPoint apex = real(method == Method::kFast ? Vec3(-mesh.center_B) : apex_on_water(mesh, plane));
  const RealPoint up = real(plane.up_B);
  ReferenceSum sum;
  for (const Triangle& triangle : mesh.surface.triangles) {
    std::array<RealPoint, 3> y;
    std::array<Real, 3> z;
    int wet = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double corner_height = height(mesh, plane, triangle[i]);
      y[i] = real(mesh.point(triangle[i]));
      z[i] = corner_height;
      wet += corner_height < 0.0 ? 1 : 0;
    }
    if (wet == 0) continue;
    const RealPoint twice_area = cross(y[1] - y[0], y[2] - y[0]);
    const Real volume = dot(y[0] - apex, twice_area) / 6;
    const Real z_sum = z[0] + z[1] + z[2];
    if (wet < 3) {
      Real depths = 0;
      for (const Real height : z) depths += std::max(-height, Real(0));
      sum.bound += method == Method::kFastSurface ? depths * std::sqrt(dot(twice_area, twice_area)) / 6
                                                  : std::abs(volume);
    } else if (method == Method::kFastSurface) {
      // F = int z n dA at the triangle's centre of pressure.
      const RealPoint zy = (z_sum + z[0]) * y[0] + (z_sum + z[1]) * y[1] + (z_sum + z[2]) * y[2];
      sum.volume += z_sum * dot(up, twice_area) / 6;
      sum.torque += Real(1) / 24 * cross(zy, twice_area);
    } else {
      sum.volume += volume;
      sum.moment += volume / 4 * (y[0] + y[1] + y[2] + apex);
    }
  }
  if (method != Method::kFastSurface) sum.torque = cross(sum.moment, up);
  return sum;
}

TEST(WettedSurface, MatchesSumOverTrianglesForApproximations) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}}, WithTree::kNo);
    for (const Method method : {Method::kFast, Method::kImproved, Method::kFastSurface}) {
      const Solver solver(mesh, method);
      for (const PoseInWater& at : poses_for(named.mesh, 40, 43)) {
        const WaterPlane plane = water_plane_in_body(at.pose, at.water, mesh.center_B);
        const Displacement found = solver.displacement(plane);
        ReferenceSum expected = reference_sum(mesh, plane, method);
        // The bound of `fast` also holds the cone over the waterplane, unless the whole surface is wet.
        if (method == Method::kFast) {
          const Real cone = std::abs(plane.height(-mesh.center_B)) * 0.5 * mesh.area / 3.0;
          bool fully_submerged = true;
          for (std::size_t i = 0; i < mesh.surface.vertex_count(); ++i)
            fully_submerged = fully_submerged && height(mesh, plane, static_cast<std::int32_t>(i)) < 0.0;
          if (!fully_submerged) expected.bound += cone;
        }
        const double reach =
            mesh.diagonal + (method == Method::kFast ? mesh.center_B.norm() : 0.0) + std::abs(plane.h_c);
        const double tolerance = 1e-13 * mesh.area * reach;
        EXPECT_NEAR(found.volume, static_cast<double>(expected.volume), tolerance) << named.name;
        EXPECT_NEAR(found.truncation_bound, static_cast<double>(expected.bound), tolerance) << named.name;
        const Vec3 torque = expected.torque.vec3().cast<double>();
        EXPECT_LE((found.torque - torque).norm(), tolerance * reach)
            << named.name << ", " << to_string(method);
      }
    }
  }
}

TEST(WettedSurface, SumsSquaresOfLongestEdgesOfCutTriangles) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}}, WithTree::kNo);
    const Meshlets meshlets = build_meshlets(mesh.surface);
    for (const PoseInWater& at : poses_for(named.mesh, 20, 44)) {
      const WaterPlane plane = water_plane_in_body(at.pose, at.water, mesh.center_B);
      double expected = 0.0;
      for (const Triangle& triangle : mesh.surface.triangles) {
        int wet = 0;
        for (const std::int32_t i : triangle) wet += height(mesh, plane, i) < 0.0 ? 1 : 0;
        // The longest edge lies opposite the first corner.
        if (wet % 3 != 0) expected += (mesh.vertex(triangle[2]) - mesh.vertex(triangle[1])).squaredNorm();
      }
      const double tolerance = 1e-13 * expected;
      EXPECT_NEAR(sum_volume_elements(meshlets, plane, Vec3::Zero(), CutTriangles::kClip).cut_edges_squared,
                  expected, tolerance)
          << named.name;
      EXPECT_NEAR(sum_pressure_elements(meshlets, plane, CutTriangles::kClip).cut_edges_squared, expected,
                  tolerance)
          << named.name;
    }
  }
}

}  // namespace
}  // namespace buoyancy
