#include "hydrostatics/buoyancy.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/immersion.h"
#include "hydrostatics/wetted_tree_sum.h"
#include "tests/hydrostatics/forced_target.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/support/allocation_count.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"

namespace buoyancy {
namespace {

const HydrostaticMesh& unit_box() {
  static const HydrostaticMesh mesh =
      make_hydrostatic_mesh({make_shape(BoxShape{.segments = {4, 4, 4}}), {}});
  return mesh;
}

Pose at_height(double z) {
  return {Vec3(0, 0, z), Eigen::Quaterniond::Identity()};
}

TEST(Immersion, IsConservativeForGrazingBodies) {
  const TriangleMesh source = make_shape(BoxShape{.size = {1.0, 0.7, 0.4}});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
  const Solver within(mesh, Method::kHierarchical, 1e-2);
  RandomPoses random(61);
  int dry = 0;
  int wet = 0;
  int rough = 0;
  for (int i = 0; i < 4000; ++i) {
    Water water;
    water.up_W = i % 2 == 0 ? Vec3::UnitZ() : random.direction();
    water.level = random.uniform(-10, 10);
    Pose pose{random.far_vector(-1, 9), random.rotation()};
    const bool above = i % 4 < 2;
    const Vec3 up_B = pose.q_WB.conjugate() * water.up_W;
    double grazing = above ? 1e300 : -1e300;
    for (std::size_t v = 0; v < source.vertex_count(); ++v) {
      const double height = up_B.dot(source.vertex(static_cast<std::int32_t>(v)));
      grazing = above ? std::min(grazing, height) : std::max(grazing, height);
    }
    const double gap = std::pow(10.0, random.uniform(-17, -6)) * (above ? 1.0 : -1.0);
    pose.p_WB += (water.level - water.up_W.dot(pose.p_WB) - grazing + gap) * water.up_W;

    const ExactPlane<Rational> exact = exact_plane<Rational>(pose, water);
    int below = 0;
    for (std::size_t v = 0; v < source.vertex_count(); ++v) {
      const Vec3T<Rational> y = source.vertex(static_cast<std::int32_t>(v)).cast<Rational>();
      below += static_cast<int>(exact.up_B.dot(y) < exact.h);
    }
    const auto expect_conservative = [&](Immersion immersion) {
      if (immersion == Immersion::kDry) {
        EXPECT_EQ(below, 0) << i;
      } else if (immersion == Immersion::kSubmerged) {
        EXPECT_EQ(below, static_cast<int>(source.vertex_count())) << i;
      }
    };
    const Immersion quick = quick_immersion(mesh, pose, water);
    expect_conservative(quick);
    const WaterPlane plane = within.plane_in_body(pose, water);
    expect_conservative(immersion(mesh, plane));
    expect_conservative(immersion(mesh, water_plane_in_body(pose, water, mesh.center_B)));
    dry += static_cast<int>(quick == Immersion::kDry);
    wet += static_cast<int>(quick == Immersion::kSubmerged);
    rough += static_cast<int>(plane.error > 0.0);
  }
  EXPECT_GT(dry, 300);
  EXPECT_GT(wet, 300);
  EXPECT_GT(rough, 1000);
}

TEST(Buoyancy, IsZeroWithZeroBoundForDryBody) {
  for (const Method method : kAllMethods) {
    const BuoyancyResult result = buoyancy(Solver(unit_box(), method), at_height(0.6), {}, Vec3::Zero());
    EXPECT_EQ(result.status, BuoyancyStatus::kOk);
    EXPECT_EQ(result.immersion, Immersion::kDry);
    EXPECT_EQ(result.force_W, Vec3::Zero());
    EXPECT_EQ(result.volume, 0.0);
    EXPECT_EQ(result.force_error_bound, 0.0);
  }
}

TEST(Buoyancy, TreatsFaceOnWaterAsDry) {
  // The box stands on the water, then is just fully submerged.
  for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
    EXPECT_EQ(buoyancy(Solver(unit_box(), method), at_height(0.5), {}, Vec3::Zero()).volume, 0.0);
    EXPECT_NEAR(buoyancy(Solver(unit_box(), method), at_height(-0.5), {}, Vec3::Zero()).volume, 1.0, 1e-15);
  }
}

TEST(Buoyancy, OmitsCentreWhenVolumeIsWithinItsErrorBound) {
  const BuoyancyResult result =
      buoyancy(Solver(unit_box(), Method::kExact), at_height(0.5 - 1e-16), {}, Vec3::Zero());
  EXPECT_EQ(result.center_of_buoyancy_W, Vec3::Zero());
}

TEST(Buoyancy, ReportsOutOfRangeInsteadOfInfinity) {
  const Solver solver(unit_box(), Method::kExact);
  for (const std::string& target : simd_targets()) {
    const ForcedTarget forced(target);
    for (const double z : {1e308, -1e308}) {
      Pose pose = at_height(z);
      Water water;
      water.up_W = Vec3(0.6, 0, 0.8);
      pose.p_WB.x() = z;
      const BuoyancyResult result = buoyancy(solver, pose, water, Vec3::Zero());
      EXPECT_EQ(result.status, BuoyancyStatus::kOutOfRange) << target << ' ' << z;
      EXPECT_EQ(result.force_W, Vec3::Zero());
    }
  }
  Water heavy;
  heavy.density = 1e300;
  heavy.gravity = 1e300;
  const BuoyancyResult result = buoyancy(solver, at_height(0), heavy, Vec3::Zero());
  EXPECT_EQ(result.status, BuoyancyStatus::kOutOfRange);
  EXPECT_EQ(result.torque_W, Vec3::Zero());
  EXPECT_EQ(result.volume, 0.0);
}

// A box without its top face, whose boundary lies at z = 0.5.
HydrostaticMesh open_box() {
  TriangleMesh mesh = make_shape(BoxShape{.segments = {4, 4, 4}});
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.vertex(t[0]).z() == 0.5 && mesh.vertex(t[1]).z() == 0.5 && mesh.vertex(t[2]).z() == 0.5;
  });
  ValidatedMesh validated{mesh, {}};
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(mesh.vertex_count()); ++i) {
    const Vec3 at = mesh.vertex(i);
    if (at.z() == 0.5 && at.head<2>().cwiseAbs().maxCoeff() == 0.5) validated.boundary_vertices.push_back(i);
  }
  return make_hydrostatic_mesh(validated);
}

TEST(Buoyancy, AcceptsOpenMeshOnlyWhileBoundaryIsDry) {
  const HydrostaticMesh mesh = open_box();
  ASSERT_TRUE(mesh.is_open());
  for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
    const Solver solver(mesh, method);
    const BuoyancyResult floating = buoyancy(solver, at_height(0.2), {}, Vec3::Zero());
    EXPECT_EQ(floating.status, BuoyancyStatus::kOk);
    EXPECT_NEAR(floating.volume, 0.3, 1e-15);
    const BuoyancyResult awash = buoyancy(solver, at_height(-0.5), {}, Vec3::Zero());
    EXPECT_EQ(awash.status, BuoyancyStatus::kOk) << "a boundary on the plane is dry";
    EXPECT_NEAR(awash.volume, 1.0, 1e-15);
    const BuoyancyResult sunk = buoyancy(solver, at_height(-0.51), {}, Vec3::Zero());
    EXPECT_EQ(sunk.status, BuoyancyStatus::kOpenEdgeWet);
    EXPECT_EQ(sunk.force_W, Vec3::Zero());
    const BuoyancyResult dry = buoyancy(solver, at_height(2), {}, Vec3::Zero());
    EXPECT_EQ(dry.status, BuoyancyStatus::kOk);
  }
}

TEST(Buoyancy, DoesNotAllocateAfterWarmUp) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 12});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
  RandomPoses random(17);
  std::vector<Pose> poses;
  poses.reserve(50);
  for (int i = 0; i < 50; ++i) poses.push_back(random.crossing(bounding_box(rock), {}));
  for (const Method method : kAllMethods) {
    for (const double tolerance : {0.0, 1e-4, 1e-2}) {
      const Solver solver(mesh, method, tolerance);
      buoyancy(solver, at_height(0.0), {}, Vec3::Zero());  // afloat, since a dry body allocates no tables
      const AllocationCount allocations;
      for (const Pose& pose : poses) buoyancy(solver, pose, {}, Vec3::Zero());
      EXPECT_EQ(allocations.count(), 0) << to_string(method) << ", tolerance " << tolerance;
    }
  }
}

}  // namespace
}  // namespace buoyancy
