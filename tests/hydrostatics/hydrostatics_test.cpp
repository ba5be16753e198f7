// Hydrostatics against closed forms, against the wrench and against each other.
#include "hydrostatics/hydrostatics.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/immersed_part.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRelative = 1e-13;
const Water kWater{.level = 0.0, .density = 1000.0, .gravity = 10.0};
constexpr double kWeight = 1e4;  // [N/m^3], of kWater

Pose at_height(double height) {
  return {Vec3(3.0, -2.0, height), Eigen::Quaterniond::Identity()};
}

Hydrostatics hydrostatics_of(const HydrostaticMesh& mesh, const Pose& pose,
                             const Vec3& reference_B = Vec3::Zero(),
                             const std::optional<Vec3>& center_of_mass_B = std::nullopt) {
  const auto found = hydrostatics(mesh, pose, kWater, reference_B, center_of_mass_B);
  EXPECT_TRUE(found.has_value());
  return found.value_or(Hydrostatics{});
}

void expect_near(const Vec3& found, const Vec3& expected, double tolerance) {
  EXPECT_LE((found - expected).norm(), tolerance)
      << found.transpose() << ", expected " << expected.transpose();
}

void expect_undefined(const Vec3& v) {
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(std::isnan(v[i])) << v.transpose();
}

TEST(Hydrostatics, MatchesClosedFormForUprightBox) {
  const double length = 5.0;
  const double beam = 2.0;
  const double draft = 0.75;
  const HydrostaticMesh mesh = mesh_of(BoxShape{.size = {length, beam, 3.0}, .segments = {7, 5, 6}});
  const Vec3 center_of_mass_B(0.0, 0.0, 0.25);
  const Hydrostatics found = hydrostatics_of(mesh, at_height(1.5 - draft), Vec3::Zero(), center_of_mass_B);

  const double volume = length * beam * draft;
  const double area = length * beam;
  EXPECT_NEAR(found.volume, volume, kRelative * volume);
  expect_near(found.center_of_buoyancy_W, {0.0, 0.0, -1.5 + draft / 2}, kRelative);
  EXPECT_NEAR(found.wetted_area, area + 2.0 * (length + beam) * draft, kRelative * area);
  EXPECT_NEAR(found.waterplane_area, area, kRelative * area);
  expect_near(found.waterplane_centroid_W, {0.0, 0.0, -1.5 + draft}, kRelative);

  const double about_length = length * beam * beam * beam / 12.0;
  const double about_beam = beam * length * length * length / 12.0;
  EXPECT_NEAR(found.waterplane_second_moments[0], about_length, 2 * kRelative * about_beam);
  EXPECT_NEAR(found.waterplane_second_moments[1], about_beam, 2 * kRelative * about_beam);
  EXPECT_NEAR(std::abs(found.waterplane_axes_W[0].x()), 1.0, kRelative);
  EXPECT_NEAR(std::abs(found.waterplane_axes_W[1].y()), 1.0, kRelative);
  for (std::size_t i = 0; i < 2; ++i) {
    const double radius = (i == 0 ? about_length : about_beam) / volume;
    const double center_height = -1.5 + draft / 2;
    EXPECT_NEAR(found.metacentric_radii[i], radius, 1e-12);
    expect_near(found.metacenters_W[i], {0.0, 0.0, center_height + radius}, 1e-12);
    EXPECT_NEAR(found.metacentric_heights[i], center_height + radius - 0.25, 1e-12);
  }

  const Hydrostatics without = hydrostatics_of(mesh, at_height(1.5 - draft));
  EXPECT_EQ(without.metacentric_radii, found.metacentric_radii);
  for (const double height : without.metacentric_heights) EXPECT_TRUE(std::isnan(height)) << "no mass";

  // The reference point, B's origin, lies midships over the waterplane: heave, roll and pitch do not couple.
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  stiffness(2, 2) = kWeight * area;
  stiffness(3, 3) = kWeight * (about_length + volume * (-1.5 + draft / 2));
  stiffness(4, 4) = kWeight * (about_beam + volume * (-1.5 + draft / 2));
  EXPECT_LE((found.stiffness - stiffness).norm(), 1e-12 * stiffness.norm()) << found.stiffness;
}

TEST(Hydrostatics, MatchesClosedFormForHeeledBox) {
  const double length = 5.0;
  const double beam = 2.0;
  const HydrostaticMesh mesh = mesh_of(BoxShape{.size = {length, beam, 3.0}, .segments = {7, 5, 6}});
  for (const double heel : {0.1, -0.4, 0.9}) {
    for (const double yaw : {0.0, 0.7, 2.0}) {
      const Eigen::Quaterniond q(Eigen::AngleAxisd(yaw, Vec3::UnitZ()) *
                                 Eigen::AngleAxisd(heel, Vec3::UnitX()));
      const Hydrostatics found = hydrostatics_of(mesh, {Vec3(1, 2, 0), q});
      const double width = beam / std::cos(heel);
      EXPECT_NEAR(found.waterplane_area, length * width, 1e-12);
      EXPECT_NEAR(found.volume, 15.0, 1e-12);
      EXPECT_NEAR(found.waterplane_second_moments[0], length * width * width * width / 12.0, 1e-11);
      EXPECT_NEAR(found.waterplane_second_moments[1], width * length * length * length / 12.0, 1e-11);
      const Vec3 along_W(std::cos(yaw), std::sin(yaw), 0.0);
      EXPECT_NEAR(std::abs(found.waterplane_axes_W[0].dot(along_W)), 1.0, 1e-12);
      expect_near(found.waterplane_axes_W[1], Vec3::UnitZ().cross(found.waterplane_axes_W[0]), 1e-15);
      expect_near(found.waterplane_centroid_W, Vec3::Zero(), 1e-12);
    }
  }
}

TEST(Hydrostatics, IsZeroOrNanForDryBody) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 4});
  const Hydrostatics found = hydrostatics_of(mesh, at_height(10.0), Vec3::Zero(), Vec3::Zero());
  EXPECT_EQ(found.volume, 0.0);
  EXPECT_EQ(found.wetted_area, 0.0);
  EXPECT_EQ(found.waterplane_area, 0.0);
  EXPECT_EQ(found.waterplane_second_moments, (std::array<double, 2>{}));
  EXPECT_TRUE(found.stiffness.isZero(0.0));
  expect_undefined(found.center_of_buoyancy_W);
  expect_undefined(found.waterplane_centroid_W);
  for (std::size_t i = 0; i < 2; ++i) {
    expect_undefined(found.waterplane_axes_W[i]);
    expect_undefined(found.metacenters_W[i]);
    EXPECT_TRUE(std::isnan(found.metacentric_radii[i]));
    EXPECT_TRUE(std::isnan(found.metacentric_heights[i]));
  }
}

TEST(Hydrostatics, IsConstantWithoutWaterplaneForSubmergedBody) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 4});
  RandomPoses random(41);
  const Vec3 center_of_mass_B(0.1, -0.05, -0.2);
  const Vec3 reference_B(0.3, 0.2, 0.1);
  for (const double depth : {-3.0, -1e6}) {
    const Pose pose{Vec3(1, 2, depth), random.rotation()};
    const Hydrostatics found = hydrostatics_of(mesh, pose, reference_B, center_of_mass_B);
    EXPECT_EQ(found.volume, mesh.volume);
    EXPECT_EQ(found.wetted_area, mesh.area);
    EXPECT_EQ(found.waterplane_area, 0.0);
    EXPECT_EQ(found.waterplane_second_moments, (std::array<double, 2>{}));
    expect_undefined(found.waterplane_centroid_W);
    expect_undefined(found.waterplane_axes_W[0]);
    const Vec3 center_W = pose.q_WB * (mesh.center_B + mesh.centroid);
    expect_near(found.center_of_buoyancy_W, center_W, 1e-15);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(found.metacentric_radii[i], 0.0);
      expect_near(found.metacenters_W[i], center_W, 1e-15);
      EXPECT_NEAR(found.metacentric_heights[i], (center_W - pose.q_WB * center_of_mass_B).z(), 1e-15);
    }
    // Rotation about a horizontal axis e: -d tau/d theta = rho g V e (height of the centre over the reference
    // point).
    const double lever = (center_W - pose.q_WB * reference_B).z();
    EXPECT_TRUE(found.stiffness.topRows(3).isZero(0.0));
    EXPECT_NEAR(found.stiffness(3, 3), kWeight * mesh.volume * lever, 1e-9);
    EXPECT_NEAR(found.stiffness(4, 4), kWeight * mesh.volume * lever, 1e-9);
    EXPECT_NEAR(found.stiffness(5, 5), 0.0, 1e-9);
  }
}

TEST(Hydrostatics, AgreesWithWrenchOnVolumeAndCentre) {
  for (const NamedMesh& named : closed_test_meshes()) {
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    const Solver solver(mesh, Method::kHierarchical);
    RandomPoses random(42);
    for (int i = 0; i < 200; ++i) {
      const Pose pose = i % 2 == 0 ? random.crossing(bounding_box(named.mesh), kWater)
                                   : random.adversarial(named.mesh, kWater);
      const BuoyancyResult wrench = buoyancy(solver, pose, kWater, mesh.center_B);
      const Hydrostatics found = hydrostatics_of(mesh, pose, mesh.center_B);
      EXPECT_LE(std::abs(found.volume - wrench.volume), 2 * mesh.volume_tolerance())
          << named.name << ", pose " << i;
      if (wrench.volume > 1e-3 * mesh.volume) {
        expect_near(found.center_of_buoyancy_W, wrench.center_of_buoyancy_W,
                    1e4 * kEpsilon * (mesh.diagonal + mesh.center_B.norm()));
      }
      EXPECT_GE(found.waterplane_area, 0.0);
      EXPECT_LE(found.wetted_area, mesh.area * (1 + 1e-12));
    }
  }
}

TEST(Hydrostatics, HasNoWaterplaneBetweenSeparateParts) {
  const TriangleMesh boxes =
      joined(make_shape(BoxShape{}), moved_and_scaled(make_shape(BoxShape{}), {3, 0, 2}));
  const HydrostaticMesh mesh = make_hydrostatic_mesh({boxes, {}});
  const Hydrostatics found = hydrostatics_of(mesh, at_height(-1.0));
  EXPECT_NEAR(found.volume, 1.0, kRelative);
  EXPECT_NEAR(found.wetted_area, 6.0, kRelative);
  EXPECT_EQ(found.waterplane_area, 0.0);
  EXPECT_EQ(found.metacentric_radii, (std::array<double, 2>{}));
  expect_near(found.metacenters_W[0], Vec3::Zero(), kRelative);
  EXPECT_EQ(found.stiffness(2, 2), 0.0);
}

TEST(Hydrostatics, MatchesClosedHullForOpenHullWithDryRim) {
  TriangleMesh open = make_shape(BoxShape{.size = {3, 2, 1}, .segments = {3, 2, 2}});
  const HydrostaticMesh closed = make_hydrostatic_mesh({open, {}});
  std::vector<std::int32_t> rim;
  const auto on_deck = [&](std::int32_t i) { return open.vertex(i).z() == 0.5; };
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(open.vertex_count()); ++i) {
    if (on_deck(i)) rim.push_back(i);
  }
  std::erase_if(open.triangles,
                [&](const Triangle& t) { return on_deck(t[0]) && on_deck(t[1]) && on_deck(t[2]); });
  const HydrostaticMesh hull = make_hydrostatic_mesh({open, rim});
  const Pose pose{Vec3(0, 0, 0.1), Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Vec3(1, 2, 0).normalized()))};
  const Hydrostatics expected = hydrostatics_of(closed, pose);
  const Hydrostatics found = hydrostatics_of(hull, pose);
  EXPECT_NEAR(found.volume, expected.volume, kRelative);
  EXPECT_NEAR(found.waterplane_area, expected.waterplane_area, 10 * kRelative);
  EXPECT_LE((found.stiffness - expected.stiffness).norm(), kRelative * 10 * expected.stiffness.norm());
  expect_near(found.metacenters_W[1], expected.metacenters_W[1], 10 * kRelative);
}

// A liquid whose centre is at the reference point, with free surfaces of unequal second moments.
LiquidSum random_liquid(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                        RandomPoses& random) {
  LiquidSum liquid;
  liquid.mass = random.uniform(0.05, 0.3) * water.density * mesh.volume;
  const Vec3 u_B = pose.q_WB.conjugate() * water.up_W.unitOrthogonal();
  const Vec3 v_B = (pose.q_WB.conjugate() * water.up_W).cross(u_B);
  const double angle = random.uniform(0.0, 3.0);
  const Vec3 along = std::cos(angle) * u_B + std::sin(angle) * v_B;
  const Vec3 across = std::cos(angle) * v_B - std::sin(angle) * u_B;
  const double scale = 0.02 * water.density * mesh.volume * mesh.diagonal * mesh.diagonal;
  const double most = random.uniform(0.5, 1.0);
  const double least = random.uniform(0.0, 0.5);
  liquid.free_surface = scale * (most * along * along.transpose() + least * across * across.transpose());
  return liquid;
}

// The metacentric heights are those of the stiffness against turns about horizontal axes: about the principal
// axes of the waterplane or, without one, about those of the free surfaces, of which the first is the softer.
TEST(Hydrostatics, DerivesGmConsistentWithRightingStiffness) {
  int crossing = 0;
  int submerged = 0;
  for (const double scale : {1e-3, 1.0, 1e3}) {
    const TriangleMesh rock = moved_and_scaled(
        make_shape(RockShape{.frequency = 8, .roughness = 0.5, .seed = 3}), scale * Vec3(2, -3, 1), scale);
    const HydrostaticMesh mesh = make_hydrostatic_mesh({rock, {}});
    RandomPoses random(43);
    for (int i = 0; i < 100; ++i) {
      Water water{.level = 0.7 * scale, .density = 1025.0, .gravity = 9.8};
      if (i % 2 == 1) water.up_W = random.direction();
      Pose pose = random.crossing(bounding_box(rock), water);
      if (i % 5 == 4) pose.p_WB -= 3.0 * mesh.diagonal * water.up_W;
      const Vec3 center_of_mass_B = mesh.center_B + 0.1 * mesh.diagonal * random.direction();
      const LiquidSum liquid = i % 4 < 2 ? LiquidSum{} : random_liquid(mesh, pose, water, random);
      const std::optional<Hydrostatics> found = hydrostatics_of(
          immersed_part(mesh, water_plane_in_body(pose, water, mesh.center_B)), mesh.center_B,
          mesh.volume_tolerance(), pose.q_WB, water, center_of_mass_B, center_of_mass_B, liquid);
      ASSERT_TRUE(found);
      if (!(found->volume > 1e-2 * mesh.volume)) continue;
      const double weight = water.density * water.gravity * found->volume;  // [N]
      const double tolerance = 1e-10 * weight * mesh.diagonal;
      const Mat3 righting = found->stiffness.block<3, 3>(3, 3);
      if (found->waterplane_area == 0.0) {
        ++submerged;
        const Vec3 u = water.up_W.unitOrthogonal();
        const Vec3 v = water.up_W.cross(u);
        Eigen::Matrix2d horizontal;
        horizontal << u.dot(righting * u), u.dot(righting * v), v.dot(righting * u), v.dot(righting * v);
        const double mean = 0.5 * horizontal.trace();
        const double spread = std::sqrt(std::max(0.0, mean * mean - horizontal.determinant()));
        EXPECT_NEAR(weight * found->metacentric_heights[0], mean - spread, 1e4 * tolerance) << i;
        EXPECT_NEAR(weight * found->metacentric_heights[1], mean + spread, 1e4 * tolerance) << i;
        continue;
      }
      ++crossing;
      const Vec3 to_waterplane_W = found->waterplane_centroid_W - pose.q_WB * center_of_mass_B;
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const Vec3& e = found->waterplane_axes_W[axis];
        // A turn about the centre of mass also lowers the waterplane's centroid, by its distance from the
        // axis.
        const double distance = water.up_W.cross(e).dot(to_waterplane_W);
        const double lowering = water.density * water.gravity * found->waterplane_area * distance * distance;
        EXPECT_NEAR(e.dot(righting * e), weight * found->metacentric_heights[axis] + lowering, tolerance)
            << i;
      }
    }
  }
  EXPECT_GT(crossing, 100);
  EXPECT_GT(submerged, 40);
}

TEST(Hydrostatics, ReturnsNulloptBeyondDoubleRange) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  EXPECT_FALSE(hydrostatics(mesh, at_height(0.1), kWater, Vec3(1e200, 0, 0), std::nullopt));
}

}  // namespace
}  // namespace buoyancy
