// The paper's statements on its five methods, section 5 and figure 4: a cube and a sphere lowered into the
// water, rho g = 1.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

const Water kPaperWater{.up_W = Vec3::UnitZ(), .level = 0.0, .density = 1.0, .gravity = 1.0};

// The largest |F - closed form| over h, the height of the body's centre over the water.
template <typename ClosedForm>
double max_error(const TriangleMesh& source, Method method, double reach, const ClosedForm& closed_form) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
  const Solver solver(mesh, method);
  double max = 0.0;
  for (int step = 1; step < 40; ++step) {
    const double h = reach * (step / 20.0 - 1.0);
    const Pose pose{Vec3(0, 0, h), Eigen::Quaterniond::Identity()};
    const double force = buoyancy(solver, pose, kPaperWater, Vec3::Zero()).force_W.z();
    max = std::max(max, std::abs(force - closed_form(h)));
  }
  return max;
}

double cube_force(double h) {
  return 0.5 - h;
}
double sphere_force(double h) {
  return std::numbers::pi / 3.0 * (h - 1.0) * (h - 1.0) * (h + 2.0);
}

const TriangleMesh& cube(int segments) {
  static const TriangleMesh coarse = make_shape(BoxShape{.segments = {10, 10, 10}});
  static const TriangleMesh fine = make_shape(BoxShape{.segments = {100, 100, 100}});
  return segments == 10 ? coarse : fine;
}

TEST(PaperMethods, MatchesCubeForceToRoundingWhenExact) {
  for (const int segments : {10, 100}) {
    EXPECT_LE(max_error(cube(segments), Method::kExact, 0.5, cube_force), 1e-13);
    EXPECT_LE(max_error(cube(segments), Method::kExactSurface, 0.5, cube_force), 1e-13);
  }
}

TEST(PaperMethods, ConvergesExceptForFastWhenMeshIsRefined) {
  const double fast = max_error(cube(10), Method::kFast, 0.5, cube_force);
  const double fast_fine = max_error(cube(100), Method::kFast, 0.5, cube_force);
  EXPECT_GT(fast, 0.05);
  EXPECT_GT(fast_fine, 0.5 * fast);
  EXPECT_LT(max_error(cube(100), Method::kImproved, 0.5, cube_force),
            0.2 * max_error(cube(10), Method::kImproved, 0.5, cube_force));
  const TriangleMesh coarse = make_shape(SphereShape{.radius = 1, .segments = 50});
  const TriangleMesh fine = make_shape(SphereShape{.radius = 1, .segments = 200});
  EXPECT_LT(max_error(fine, Method::kFastSurface, 1.0, sphere_force),
            0.2 * max_error(coarse, Method::kFastSurface, 1.0, sphere_force));
}

TEST(PaperMethods, ConvergesWithSecondOrderOnSpheresWhenExact) {
  const TriangleMesh coarse = make_shape(SphereShape{.radius = 1, .segments = 50});
  const TriangleMesh fine = make_shape(SphereShape{.radius = 1, .segments = 200});
  for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
    const double error = max_error(coarse, method, 1.0, sphere_force);
    const double fine_error = max_error(fine, method, 1.0, sphere_force);
    EXPECT_LT(error, 4e-3 * 4.19);
    EXPECT_NEAR(error / fine_error, 16.0, 1.6) << "an inscribed mesh's error falls as 1/N";
  }
}

TEST(PaperMethods, CountsCutTrianglesAtEveryLevelWhenExact) {
  // Regression test against a defect of the authors' published code, which compares heights with 0 instead of
  // the water level.
  const HydrostaticMesh mesh = make_hydrostatic_mesh({cube(10), {}});
  for (const double level : {-3.0, 0.0, 5.0, 1234.5}) {
    for (const Vec3& up : {Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(-1, 0, 0)}) {
      Water water = kPaperWater;
      water.level = level;
      water.up_W = up;
      const Pose pose{up * (level + 0.23), Eigen::Quaterniond::Identity()};
      for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
        EXPECT_NEAR(buoyancy(Solver(mesh, method), pose, water, Vec3::Zero()).volume, 0.27, 1e-12);
      }
    }
  }
}

TEST(PaperMethods, KeepsSmallVolumes) {
  // The authors' published code treats any volume below 1e-5 as zero.
  const TriangleMesh tiny = moved_and_scaled(cube(10), Vec3::Zero(), 1e-3);
  const HydrostaticMesh mesh = make_hydrostatic_mesh({tiny, {}});
  const Pose pose{Vec3(0, 0, 0.25e-3), Eigen::Quaterniond::Identity()};
  for (const Method method : {Method::kExact, Method::kExactSurface, Method::kHierarchical}) {
    EXPECT_NEAR(buoyancy(Solver(mesh, method), pose, kPaperWater, Vec3::Zero()).volume, 0.25e-9, 1e-22);
  }
}

TEST(PaperMethods, KeepsSignOfRestoringTorqueOnCoarseBox) {
  // A flat box heeled by 0.2 rad: centroid times force per triangle would reverse the sign of this torque.
  const HydrostaticMesh mesh = make_hydrostatic_mesh({make_shape(BoxShape{.size = {2, 2, 0.5}}), {}});
  const Eigen::Quaterniond heeled(Eigen::AngleAxisd(0.2, Vec3::UnitX()));
  const Pose pose{Vec3::Zero(), heeled};
  const Vec3 exact = buoyancy(Solver(mesh, Method::kExact), pose, kPaperWater, Vec3::Zero()).torque_W;
  const Vec3 surface =
      buoyancy(Solver(mesh, Method::kExactSurface), pose, kPaperWater, Vec3::Zero()).torque_W;
  EXPECT_LT(exact.x(), -0.1) << "against the heel";
  EXPECT_LE((exact - surface).norm(), 1e-14);
}

TEST(PaperMethods, DependsOnBodyOriginOnlyForFast) {
  // The same cube with its mesh's origin at a corner: the result of fast changes, that of improved does not.
  const TriangleMesh cornered = moved_and_scaled(cube(10), Vec3(0.5, 0.5, 0.5));
  const HydrostaticMesh centred_mesh = make_hydrostatic_mesh({cube(10), {}});
  const HydrostaticMesh cornered_mesh = make_hydrostatic_mesh({cornered, {}});
  const Pose pose{Vec3(0, 0, 0.03), Eigen::Quaterniond::Identity()};
  const Pose cornered_pose{Vec3(-0.5, -0.5, -0.47), Eigen::Quaterniond::Identity()};
  const auto volume = [&](Method method, bool corner) {
    return corner ? buoyancy(Solver(cornered_mesh, method), cornered_pose, kPaperWater, Vec3::Zero()).volume
                  : buoyancy(Solver(centred_mesh, method), pose, kPaperWater, Vec3::Zero()).volume;
  };
  EXPECT_GT(std::abs(volume(Method::kFast, true) - volume(Method::kFast, false)), 0.05);
  EXPECT_NEAR(volume(Method::kImproved, true), volume(Method::kImproved, false), 1e-12);
  EXPECT_NEAR(volume(Method::kExact, true), volume(Method::kExact, false), 1e-12);
}

TEST(PaperMethods, GivesTotalVolumeWhenSubmerged) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh({cube(10), {}});
  const Pose pose{Vec3(0, 0, -2), Eigen::Quaterniond::Identity()};
  for (const Method method : kAllMethods) {
    const BuoyancyResult result = buoyancy(Solver(mesh, method), pose, kPaperWater, Vec3::Zero());
    EXPECT_NEAR(result.volume, 1.0, 1e-13) << to_string(method);
    EXPECT_NEAR(result.force_W.z(), 1.0, 1e-13) << to_string(method);
    EXPECT_LE(result.torque_W.norm(), 1e-13) << to_string(method);
  }
}

TEST(PaperMethods, IsFoundByExactName) {
  for (const Method method : kAllMethods) EXPECT_EQ(method_from_name(to_string(method)), method);
  EXPECT_EQ(method_from_name("exactly"), std::nullopt);
  EXPECT_EQ(method_from_name(""), std::nullopt);
}

TEST(PaperMethods, ShrinksBoundWhenMeshIsRefined) {
  const Pose tilted{Vec3(0, 0, 0.1), Eigen::Quaterniond(1.0, 0.3, -0.2, 0.1)};
  for (const Method method : {Method::kImproved, Method::kFastSurface}) {
    double bound = 1.0;
    for (const int segments : {2, 8, 32}) {
      const HydrostaticMesh mesh =
          make_hydrostatic_mesh({make_shape(BoxShape{.segments = {segments, segments, segments}}), {}});
      const double finer =
          buoyancy(Solver(mesh, method), tilted, kPaperWater, Vec3::Zero()).force_error_bound;
      EXPECT_LT(finer, 0.5 * bound) << to_string(method) << ", " << segments;
      bound = finer;
    }
  }
}

}  // namespace
}  // namespace buoyancy
