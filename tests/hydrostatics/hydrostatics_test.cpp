// Hydrostatics against closed forms, against the wrench and against each other.
#include "hydrostatics/hydrostatics.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kRelative = 1e-13;
const Water kWater{.level = 0.0, .density = 1000.0, .gravity = 10.0};
constexpr double kWeight = 1e4;  // [N/m^3], of kWater

HydrostaticMesh mesh_of(const Shape& shape) {
  return make_hydrostatic_mesh({make_shape(shape), {}});
}

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

TEST(Hydrostatics, MatchesClosedFormForUprightCylinder) {
  for (const int sides : {3, 8, 64}) {
    const double radius = 0.5;
    const double draft = 1.25;
    const HydrostaticMesh mesh =
        mesh_of(CylinderShape{.radius = radius, .height = 2.0, .segments = sides, .stacks = 3});
    const Hydrostatics found = hydrostatics_of(mesh, at_height(1.0 - draft));
    const double side = 2.0 * radius * std::sin(std::numbers::pi / sides);
    const double area = 0.5 * sides * radius * radius * std::sin(2.0 * std::numbers::pi / sides);
    const double second = area / 24.0 * (6.0 * radius * radius - side * side);
    EXPECT_NEAR(found.waterplane_area, area, kRelative);
    EXPECT_NEAR(found.volume, area * draft, kRelative);
    EXPECT_NEAR(found.wetted_area, area + sides * side * draft, 4 * kRelative);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(found.waterplane_second_moments[i], second, kRelative) << sides;
      EXPECT_NEAR(found.metacentric_radii[i], second / (area * draft), kRelative) << sides;
    }
    EXPECT_NEAR(found.stiffness(2, 2), kWeight * area, kWeight * kRelative);
    for (const int i : {3, 4}) {
      EXPECT_NEAR(found.stiffness(i, i), kWeight * (second + area * draft * (draft / 2 - 1.0)),
                  kWeight * 4 * kRelative);
    }
  }
}

struct HullWaterplane {
  double area, about_length, about_beam;
};

// The waterplane of the mesh at a level of its grid: the half-breadth is linear from station to station.
HullWaterplane polygon_waterplane(const WigleyShape& hull, double zeta) {
  HullWaterplane plane{};
  const auto breadth = [&](int station) {
    const double xi = 2.0 * station / hull.segments - 1.0;
    return 0.5 * hull.beam * (1.0 - xi * xi) * (1.0 - zeta * zeta);
  };
  const double h = hull.length / hull.segments;
  for (int i = 0; i < hull.segments; ++i) {
    const double x = hull.length * (static_cast<double>(i) / hull.segments - 0.5);
    const double y = breadth(i);
    const double Y = breadth(i + 1);
    plane.area += h * (y + Y);
    plane.about_length += h * (y * y * y + y * y * Y + y * Y * Y + Y * Y * Y) / 6.0;
    const double middle = x + 0.5 * h;
    // Simpson's rule, exact for the cubic x^2 y.
    plane.about_beam += h / 3.0 * (x * x * y + 2.0 * middle * middle * (y + Y) + (x + h) * (x + h) * Y);
  }
  return plane;
}

TEST(Hydrostatics, MatchesPolygonalWaterplaneOfWigleyHull) {
  const WigleyShape hull{.segments = 24, .levels = 8};
  const HydrostaticMesh mesh = mesh_of(hull);
  for (const int level : {0, 2, 5}) {  // down from the design waterplane
    const double zeta = -static_cast<double>(level) / hull.levels;
    const Hydrostatics found = hydrostatics_of(mesh, at_height(-hull.draft * zeta));
    const HullWaterplane expected = polygon_waterplane(hull, zeta);
    EXPECT_NEAR(found.waterplane_area, expected.area, 1e-12 * expected.area) << level;
    EXPECT_NEAR(found.waterplane_second_moments[0], expected.about_length, 1e-12 * expected.about_beam)
        << level;
    EXPECT_NEAR(found.waterplane_second_moments[1], expected.about_beam, 1e-12 * expected.about_beam)
        << level;
    EXPECT_NEAR(found.metacentric_radii[0], expected.about_length / found.volume, 1e-10) << level;
    const double center_height = found.center_of_buoyancy_W.z();
    EXPECT_NEAR(found.stiffness(2, 2), kWeight * expected.area, 1e-11 * kWeight);
    EXPECT_NEAR(found.stiffness(3, 3), kWeight * (expected.about_length + found.volume * center_height),
                1e-11 * kWeight);
    EXPECT_NEAR(found.stiffness(4, 4), kWeight * (expected.about_beam + found.volume * center_height),
                1e-11 * kWeight);
  }
}

TEST(Hydrostatics, WigleyHullConvergesQuadratically) {
  double last = std::numeric_limits<double>::infinity();
  for (const int refinement : {1, 2, 4, 8}) {
    const WigleyShape hull{.segments = 16 * refinement, .levels = 4 * refinement};
    const Hydrostatics found = hydrostatics_of(mesh_of(hull), at_height(0.0));
    const double volume = 4.0 / 9.0 * hull.length * hull.beam * hull.draft;
    const double area = 2.0 / 3.0 * hull.length * hull.beam;
    const double about_length = 4.0 / 105.0 * hull.length * std::pow(hull.beam, 3);
    const double about_beam = hull.beam * std::pow(hull.length, 3) / 30.0;
    const double buoyancy_center = -3.0 / 8.0 * hull.draft;
    const double error = std::max(
        {std::abs(found.volume / volume - 1.0), std::abs(found.waterplane_area / area - 1.0),
         std::abs(found.metacentric_radii[0] / (about_length / volume) - 1.0),
         std::abs(found.metacentric_radii[1] / (about_beam / volume) - 1.0),
         std::abs(found.center_of_buoyancy_W.z() / buoyancy_center - 1.0),
         std::abs(found.stiffness(4, 4) / (kWeight * (about_beam + volume * buoyancy_center)) - 1.0)});
    EXPECT_LT(error, last / 3.5) << refinement;
    last = error;
  }
  EXPECT_LT(last, 1e-3);
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

TEST(Hydrostatics, DerivesGmConsistentWithRightingStiffness) {
  const HydrostaticMesh mesh = mesh_of(RockShape{.frequency = 8, .roughness = 0.5, .seed = 3});
  const BoundingBox box = bounding_box(mesh.surface);
  RandomPoses random(43);
  int crossing = 0;
  for (int i = 0; i < 100; ++i) {
    const Pose pose = random.crossing(box, kWater);
    const Vec3 center_of_mass_B = 0.3 * random.direction();
    const Hydrostatics found = hydrostatics_of(mesh, pose, center_of_mass_B, center_of_mass_B);
    if (!(found.volume > 1e-2 * mesh.volume) || !(found.waterplane_area > 0.0)) continue;
    ++crossing;
    const Vec3 to_waterplane_W = found.waterplane_centroid_W - pose.q_WB * center_of_mass_B;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const Vec3& e = found.waterplane_axes_W[axis];
      const double righting = e.dot(found.stiffness.block<3, 3>(3, 3) * e);
      // Rotation about the centre of mass also lowers the waterplane's centroid, by its distance from the
      // axis.
      const double distance = Vec3::UnitZ().cross(e).dot(to_waterplane_W);
      const double lowering = found.waterplane_area * distance * distance;
      const double expected = kWeight * (found.volume * found.metacentric_heights[axis] + lowering);
      EXPECT_NEAR(righting, expected, 1e-10 * kWeight) << i;
    }
  }
  EXPECT_GT(crossing, 40);
}

TEST(Hydrostatics, OmitsOnlyGmWithoutCentreOfMass) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  const Hydrostatics with = hydrostatics_of(mesh, at_height(0.1), Vec3::Zero(), Vec3::Zero());
  const Hydrostatics without = hydrostatics_of(mesh, at_height(0.1));
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(std::isfinite(with.metacentric_heights[i]));
    EXPECT_TRUE(std::isnan(without.metacentric_heights[i]));
  }
  EXPECT_EQ(with.metacentric_radii, without.metacentric_radii);
  EXPECT_EQ(with.stiffness, without.stiffness);
}

TEST(Hydrostatics, ReturnsNulloptBeyondDoubleRange) {
  const HydrostaticMesh mesh = mesh_of(BoxShape{});
  EXPECT_FALSE(hydrostatics(mesh, at_height(0.1), kWater, Vec3(1e200, 0, 0), std::nullopt));
}

}  // namespace
}  // namespace buoyancy
