// The wetted surface's moments, and the volume integrals that follow from them, against rational arithmetic.
#include "hydrostatics/wetted_moments.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "geometry/shapes.h"
#include "hydrostatics/displacement_moments.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"
#include "tests/truth/wetted_moments_reference.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
const Water kWater;

// The largest errors over the poses of the volume integrals against rationals; all but `volume` in units of
// eps times the quantity's scale.
struct Errors {
  double volume = 0.0, moment = 0.0, area = 0.0, waterplane_moment = 0.0, second_moments = 0.0;
};

double to_double(const Rational& value) {
  return value.convert_to<double>();
}

template <typename Matrix>
double difference(const Matrix& exact, const Eigen::MatrixXd& found) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < found.size(); ++i) {
    const double one = to_double(exact(i % found.rows(), i / found.rows()) -
                                 Rational(found(i % found.rows(), i / found.rows())));
    sum += one * one;
  }
  return std::sqrt(sum);
}

// The product's volume integrals and the exact ones, both about the product's point.
struct BothIntegrals {
  WettedMoments wet;
  DisplacementMoments<double> found;
  DisplacementMoments<Rational> exact;
};

BothIntegrals integrals_both_ways(const HydrostaticMesh& mesh, const Pose& pose) {
  const WaterPlane plane = water_plane_in_body(pose, kWater, mesh.center_B);
  BothIntegrals both;
  both.wet = wetted_moments(*mesh.tree, plane);
  both.found = displacement_moments(both.wet.moments, both.wet.height, plane.up_B);
  const Vec3T<Rational> k = exact_plane<Rational>(pose, kWater).up_B;
  const Rational h_c = Rational(kWater.level) - kWater.up_W.cast<Rational>().dot(pose.p_WB.cast<Rational>()) -
                       k.dot(mesh.center_B.cast<Rational>());
  const auto about_c =
      displacement_moments<Rational>(wetted_moments_reference<Rational>(mesh.surface, k, h_c), -h_c, k);
  both.exact = about_c.moved(both.wet.point.cast<Rational>());
  return both;
}

TEST(WettedMoments, MatchesRationalArithmeticToRounding) {
  for (const NamedMesh& named : closed_test_meshes()) {
    if (named.mesh.triangles.size() > 800) continue;  // rationals are slow
    const HydrostaticMesh mesh = make_hydrostatic_mesh({named.mesh, {}});
    RandomPoses random(44);
    Errors worst;
    for (int i = 0; i < 8; ++i) {
      const Pose pose = i % 4 == 3 ? random.adversarial(named.mesh, kWater)
                                   : random.crossing(bounding_box(named.mesh), kWater);
      const BothIntegrals both = integrals_both_ways(mesh, pose);
      const auto update_max = [](double& max, double error) { max = std::max(max, error); };
      const double area = mesh.area * kEpsilon;
      const double L = mesh.diagonal;
      update_max(worst.volume, std::abs(to_double(both.exact.volume - Rational(both.found.volume))));
      update_max(worst.moment, difference(both.exact.moment, both.found.moment) / (area * L * L));
      // If a face lies in the water plane to within rounding, whether it counts as waterplane is undefined.
      if (i % 4 == 3) continue;
      update_max(
          worst.area,
          std::abs(to_double(both.exact.waterplane_area - Rational(both.found.waterplane_area))) / area);
      update_max(worst.waterplane_moment,
                 difference(both.exact.waterplane_moment, both.found.waterplane_moment) / (area * L));
      update_max(worst.second_moments,
                 difference(both.exact.waterplane_second_moments, both.found.waterplane_second_moments) /
                     (area * L * L));
    }
    EXPECT_LE(worst.volume, mesh.volume_tolerance()) << named.name;
    for (const double error : {worst.moment, worst.area, worst.waterplane_moment, worst.second_moments}) {
      EXPECT_LE(error, 4.0) << named.name;
    }
  }
}

TEST(WettedMoments, AreThoseOfTheBodyWhateverItsScale) {
  const TriangleMesh rock = make_shape(RockShape{.frequency = 4});
  const TriangleMesh file = rounded_to_float32(moved_and_scaled(rock, Vec3(0.75, -3.5, 0.25)));
  for (const double scale : {1e-3, 0.0254, 7.0}) {
    const TriangleMesh source = moved_and_scaled(file, Vec3::Zero(), scale);
    const HydrostaticMesh in_file_units = make_hydrostatic_mesh({source, {}}, WithTree::kYes, scale);
    const HydrostaticMesh in_metres = make_hydrostatic_mesh({source, {}});
    ASSERT_EQ(in_file_units.tree->scale, scale);
    ASSERT_EQ(in_metres.tree->scale, 1.0);
    RandomPoses random(47);
    for (int i = 0; i < 20; ++i) {
      const Pose pose = random.crossing(bounding_box(source), kWater);
      const WaterPlane plane = water_plane_in_body(pose, kWater, in_metres.center_B);
      const WettedMoments one = wetted_moments(*in_metres.tree, plane);
      const WettedMoments other = wetted_moments(*in_file_units.tree, plane);
      const SurfaceMoments<double> moved = other.moments.moved(one.point - other.point);
      const double error = 16.0 * kEpsilon * in_metres.area;
      const double L = in_metres.diagonal;
      EXPECT_NEAR(other.area, one.area, error);
      EXPECT_LE((moved.S - one.moments.S).norm(), error);
      EXPECT_LE((moved.N - one.moments.N).norm(), error * L);
      EXPECT_LE((moved.P - one.moments.P).norm(), error * L * L);
      EXPECT_NEAR(other.height, one.height + plane.up_B.dot(other.point - one.point), 16.0 * kEpsilon * L);
    }
  }
}

TEST(WettedMoments, KeepsDigitsOfMillionthVolumeCap) {
  const HydrostaticMesh mesh =
      make_hydrostatic_mesh({make_shape(RockShape{.frequency = 8, .roughness = 0.0}), {}});
  RandomPoses random(45);
  for (int i = 0; i < 20; ++i) {
    Pose pose{Vec3::Zero(), random.rotation()};
    double dry = 1.01;
    double wet = 0.9;
    for (int step = 0; step < 60; ++step) {
      pose.p_WB.z() = 0.5 * (dry + wet);
      const WaterPlane plane = water_plane_in_body(pose, kWater, mesh.center_B);
      const WettedMoments moments = wetted_moments(*mesh.tree, plane);
      const double volume = displacement_moments(moments.moments, moments.height, plane.up_B).volume;
      (volume < 1e-6 * mesh.volume ? dry : wet) = pose.p_WB.z();
    }
    const BothIntegrals both = integrals_both_ways(mesh, pose);
    const double volume = to_double(both.exact.volume);
    const double area = to_double(both.exact.waterplane_area);
    const double second = difference(both.exact.waterplane_second_moments, Mat3::Zero());
    EXPECT_NEAR(both.found.volume, volume, 1e-11 * volume);
    EXPECT_NEAR(both.found.waterplane_area, area, 1e-12 * area);
    EXPECT_LE(difference(both.exact.waterplane_second_moments, both.found.waterplane_second_moments),
              1e-11 * second);
  }
}

TEST(WettedMoments, TakesHeightsFromLeafCentres) {
  const TriangleMesh sphere = make_shape(RockShape{.frequency = 40, .roughness = 0.0});
  const HydrostaticMesh mesh = make_hydrostatic_mesh({sphere, {}});
  constexpr double kLeaf = 0.1;  // [m], the size of a leaf
  RandomPoses random(46);
  for (int i = 0; i < 8; ++i) {
    Pose pose{Vec3::Zero(), random.rotation()};
    double lowest = 0.0;
    for (std::size_t v = 0; v < sphere.vertex_count(); ++v) {
      lowest = std::min(lowest, (pose.q_WB * sphere.vertex(static_cast<std::int32_t>(v))).z());
    }
    const double draft = 1e-9;
    pose.p_WB.z() = -lowest - draft;
    const BothIntegrals both = integrals_both_ways(mesh, pose);
    // A cone's volume is A draft/3, so that a height error z is a relative volume error of 3 z/draft.
    const double volume = to_double(both.exact.volume);
    EXPECT_LE(std::abs(both.found.volume - volume), 3.0 * kEpsilon * kLeaf / draft * volume);
  }
}

}  // namespace
}  // namespace buoyancy
