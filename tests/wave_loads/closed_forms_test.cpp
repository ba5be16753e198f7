// Loads that are known in closed form, or as a sum or an integral in one variable. Waves run along +x unless
// said; their phase at the body's axis is -psi: eta = a cos(k x - psi).
//
// Without stretching, the load on a submerged body is that of the harmonic function f. Wheeler's stretching
// changes it by a relative amount of the order of k a, so that tiny waves have the unstretched load.
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <variant>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/wave_loads/body_in_sea.h"
#include "tests/waves/seas.h"

namespace buoyancy {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double angular_frequency(double k, double depth = kInfinity) {
  return std::sqrt(kStandardGravity * k * (std::isinf(depth) ? 1.0 : std::tanh(k * depth)));
}

SeaDescription one_wave(double amplitude, double k, double psi, WavePressure pressure,
                        double depth = kInfinity) {
  return sea_of({WaveComponents{{amplitude, angular_frequency(k, depth), 0.0, -psi * 180.0 / kPi}}}, pressure,
                depth);
}

SeaDescription tiny_wind_sea(double depth) {
  IrregularWaves waves = wind_sea(1e-4, 3.0);
  waves.direction = 25.0;
  return sea_of({waves}, WavePressure::kWheeler, depth);
}

Pose at(double x, double y, double z, double heading = 0.0) {
  Pose pose;
  pose.p_WB = {x, y, z};
  pose.q_WB = Eigen::Quaterniond(Eigen::AngleAxisd(heading, Vec3::UnitZ()));
  return pose;
}

// Calls add(k, f, gradient) for every component, unstretched: its share of f and of its gradient at p_W, and
// its horizontal wave vector k.
template <typename Add>
void for_each_component(const TestSea& sea, const Vec3& p_W, const Add& add) {
  const PreparedComponents& waves = sea.sea.prepared();
  const double depth = sea.sea.depth();
  std::vector<double> phases;
  sea.snapshot.phases_at(p_W.x(), p_W.y(), phases);
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double k = waves.wave_number[i];
    const bool deep = std::isinf(depth);
    const double even =
        deep ? std::exp(k * p_W.z()) : std::cosh(k * (p_W.z() + depth)) / std::cosh(k * depth);
    const double odd = deep ? even : std::sinh(k * (p_W.z() + depth)) / std::cosh(k * depth);
    const Vec3 horizontal(waves.k1[i], waves.k2[i], 0.0);
    const double cosine = waves.amplitude[i] * std::cos(phases[i]);
    const double sine = waves.amplitude[i] * std::sin(phases[i]);
    add(horizontal, even * cosine, Vec3(-even * sine * horizontal + odd * cosine * k * Vec3::UnitZ()));
  }
}

double sine_ratio(double x) {
  return x == 0.0 ? 1.0 : std::sin(x) / x;
}
double sinh_ratio(double x) {
  return x == 0.0 ? 1.0 : std::sinh(x) / x;
}

// Simpson's rule.
double integral(double from, double to, const std::function<double(double)>& function) {
  constexpr int kSteps = 2000;
  double sum = function(from) + function(to);
  for (int i = 1; i < kSteps; ++i)
    sum += (i % 2 == 0 ? 2.0 : 4.0) * function(from + (to - from) * i / kSteps);
  return sum * (to - from) / (3.0 * kSteps);
}

// The divided difference of exp at three numbers, by its series about their mean: the coefficients are the
// complete homogeneous symmetric polynomials. For numbers within 1 of each other.
std::complex<double> divided_difference_of_exp(std::complex<double> a, std::complex<double> b,
                                               std::complex<double> c) {
  const std::complex<double> mean = (a + b + c) / 3.0;
  a -= mean;
  b -= mean;
  c -= mean;
  std::complex<double> of_one = 1.0;
  std::complex<double> of_two = 1.0;
  std::complex<double> of_three = 1.0;
  std::complex<double> sum = 0.5;
  double factorial = 2.0;
  for (int n = 1; n <= 20; ++n) {
    of_one *= c;
    of_two = b * of_two + of_one;
    of_three = a * of_three + of_two;
    factorial *= n + 2;
    sum += of_three / factorial;
  }
  return std::exp(mean) * sum;
}

// The integral of the waves' unstretched pressure in deep water times the normal over a submerged surface,
// exact but for rounding: that of exp over a triangle is twice its area times its divided difference.
// `grow`: 1, or 0 for pressures that do not change with the height.
Vec3 wave_force_by_divided_differences(const SeaBody& body, const TestSea& sea, const Pose& pose,
                                       double grow) {
  const PreparedComponents& waves = sea.sea.prepared();
  std::vector<double> phases;
  sea.snapshot.phases_at(pose.p_WB.x(), pose.p_WB.y(), phases);
  const TriangleMesh& surface = body.mesh.surface;
  Vec3 force = Vec3::Zero();
  for (const Triangle& triangle : surface.triangles) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      corners[i] = pose.q_WB * (surface.vertex(triangle[i]) + body.mesh.center_B);
    }
    const Vec3 twice_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    double integral = 0.0;
    for (std::size_t i = 0; i < waves.size(); ++i) {
      const auto exponent = [&](const Vec3& x) {
        return std::complex<double>(grow * waves.wave_number[i] * (x.z() + pose.p_WB.z()),
                                    waves.k1[i] * x.x() + waves.k2[i] * x.y() + phases[i]);
      };
      integral +=
          waves.amplitude[i] *
          divided_difference_of_exp(exponent(corners[0]), exponent(corners[1]), exponent(corners[2])).real();
    }
    force -= integral * twice_area;
  }
  return force;
}

TEST(ClosedForm, SubmergedRockIsASumOfDividedDifferences) {
  const SeaBody rock(RockShape{0.7, 12});
  Pose pose = at(3.0, 4.0, -2.5);
  pose.q_WB = Eigen::Quaterniond(0.3, -0.7, 0.5, 0.4).normalized();
  const Vec3 weight = rock.mesh.volume * Vec3::UnitZ();
  for (const WavePressure pressure : {WavePressure::kHydrostatic, WavePressure::kWheeler}) {
    // Wheeler's stretching has no such form: it changes the load of waves so small by a thousandth.
    const bool hydrostatic = pressure == WavePressure::kHydrostatic;
    SeaDescription description = tiny_wind_sea(kInfinity);
    description.pressure = pressure;
    std::get<IrregularWaves>(description.systems[0]).significant_wave_height = hydrostatic ? 0.5 : 1e-3;
    const TestSea sea(description, 1'700'000);
    const Vec3 expected = wave_force_by_divided_differences(rock, sea, pose, hydrostatic ? 0.0 : 1.0);
    const double error = (hydrostatic ? 1e-12 : 1e-3) * expected.norm();
    const WaveLoad load = hierarchical_load(rock, sea, pose, hydrostatic ? 1e-7 : 1e-8);
    EXPECT_LT((pose.q_WB * load.force - weight - expected).norm(), load.force_bound + error) << hydrostatic;
    EXPECT_LT(load.force_bound, 1e-3 * expected.norm()) << hydrostatic;
    const WaveLoad exact = exact_surface_load(rock, sea, pose);
    EXPECT_LT((pose.q_WB * exact.force - weight - expected).norm(), 1e-3 * expected.norm()) << hydrostatic;
  }
}

class ClosedFormAtDepth : public ::testing::TestWithParam<double> {};

TEST_P(ClosedFormAtDepth, SubmergedSphereFollowsTheWaterAtItsCentre) {
  const SeaBody sphere(SphereShape{0.8, 60});
  for (const double z : {-0.9, -2.0}) {
    const TestSea sea(tiny_wind_sea(GetParam()), 4'300'000);
    const Pose pose = at(3.0, 4.0, z);
    Vec3 expected = Vec3::Zero();
    for_each_component(sea, pose.p_WB, [&](const Vec3&, double, const Vec3& gradient) {
      expected -= sphere.mesh.volume * gradient;
    });
    const WaveLoad load = hierarchical_load(sphere, sea, pose, 1e-9);
    const Vec3 weight = sphere.mesh.volume * Vec3::UnitZ();
    EXPECT_LT((load.force - weight - expected).norm(), load.force_bound + 1e-3 * expected.norm()) << z;
    EXPECT_LT(load.force_bound, 3e-3 * expected.norm()) << z;
    EXPECT_LT(load.torque.norm(), load.torque_bound + 1e-3 * expected.norm()) << z;
    const WaveLoad exact = exact_surface_load(sphere, sea, pose);
    EXPECT_LT((exact.force - weight - expected).norm(), 1e-3 * expected.norm()) << z;
    EXPECT_LT(exact.torque.norm(), 1e-3 * expected.norm()) << z;
  }
}

TEST_P(ClosedFormAtDepth, SubmergedBoxIsAProductOfSincs) {
  const Vec3 size(1.8, 1.2, 0.9);
  const SeaBody box(BoxShape{{size.x(), size.y(), size.z()}, {24, 16, 12}});
  for (const double heading : {0.0, 0.7}) {
    const TestSea sea(tiny_wind_sea(GetParam()), 4'300'000);
    const Pose pose = at(3.0, 4.0, -0.8, heading);
    Vec3 expected_W = Vec3::Zero();
    for_each_component(sea, pose.p_WB, [&](const Vec3& k_W, double, const Vec3& gradient) {
      const Vec3 half = 0.5 * size.cwiseProduct(pose.q_WB.conjugate() * k_W);
      const double mean =
          sine_ratio(half.x()) * sine_ratio(half.y()) * sinh_ratio(0.5 * k_W.norm() * size.z());
      expected_W -= box.mesh.volume * mean * gradient;
    });
    const Vec3 weight = box.mesh.volume * Vec3::UnitZ();
    const WaveLoad load = hierarchical_load(box, sea, pose, 1e-9);
    EXPECT_LT((pose.q_WB * load.force - weight - expected_W).norm(),
              load.force_bound + 1e-4 * expected_W.norm());
    EXPECT_LT(load.force_bound, 2e-3 * expected_W.norm());
    const WaveLoad exact = exact_surface_load(box, sea, pose);
    EXPECT_LT((pose.q_WB * exact.force - weight - expected_W).norm(), 1e-4 * expected_W.norm());
  }
}

TEST_P(ClosedFormAtDepth, PiercingBoxInTinyWavesIsThatOfItsMeanSurface) {
  // Numbers that float32 holds: the rounding of the tree's would be as large as waves so small.
  const Vec3 size(1.75, 1.25, 1.0);
  constexpr double kDraught = 0.625;
  const SeaBody box(BoxShape{{size.x(), size.y(), size.z()}, {16, 16, 16}});
  const TestSea sea(tiny_wind_sea(GetParam()), 1'700'000);
  const Pose pose = at(3.0, 4.0, 0.5 * size.z() - kDraught, 0.7);
  const Vec3 bottom(3.0, 4.0, -kDraught);
  Vec3 expected_B = size.x() * size.y() * kDraught * Vec3::UnitZ();
  for_each_component(sea, bottom, [&](const Vec3& k_W, double f, const Vec3&) {
    const Vec3 half = 0.5 * size.cwiseProduct(pose.q_WB.conjugate() * k_W);
    expected_B.z() += size.x() * size.y() * sine_ratio(half.x()) * sine_ratio(half.y()) * f;
  });
  // On the sides the integral over the height is that of the vertical derivative over k^2.
  for_each_component(sea, Vec3(3.0, 4.0, 0.0), [&](const Vec3& k_W, double, const Vec3& at_top) {
    const double k = k_W.norm();
    const double depth = GetParam();
    const double columns = std::isinf(depth) ? (1.0 - std::exp(-k * kDraught)) / k
                                             : (std::sinh(k * depth) - std::sinh(k * (depth - kDraught))) /
                                                   (k * std::cosh(k * depth));
    const Vec3 k_B = pose.q_WB.conjugate() * k_W;
    const Vec3 half = 0.5 * size.cwiseProduct(k_B);
    const Vec3 horizontal_B = pose.q_WB.conjugate() * Vec3(at_top.x(), at_top.y(), 0.0);
    expected_B -= size.x() * size.y() * sine_ratio(half.x()) * sine_ratio(half.y()) * columns * horizontal_B;
  });
  const Vec3 weight = size.x() * size.y() * kDraught * Vec3::UnitZ();
  const double waves = (expected_B - weight).norm();
  const WaveLoad load = hierarchical_load(box, sea, pose, 1e-9);
  // The bound is larger than that: it covers the rounding of the tree, which matters in tiny waves only.
  EXPECT_LT((load.force - expected_B).norm(), 1e-3 * waves);
  EXPECT_LT((exact_surface_load(box, sea, pose).force - expected_B).norm(), 1e-3 * waves);
}

INSTANTIATE_TEST_SUITE_P(Depths, ClosedFormAtDepth, ::testing::Values(kInfinity, 3.5),
                         [](const auto& depth) { return std::isinf(depth.param) ? "deep" : "finite"; });

TEST(ClosedForm, SubmergedBoxInHighWavesIsThatOfTheStretchedPressure) {
  constexpr double kA = 0.3;
  constexpr double kK = 0.9;
  constexpr double kPsi = 0.7;
  const Vec3 size(1.8, 1.2, 1.0);
  const Vec3 center(0.0, 0.0, -1.1);
  const SeaBody box(BoxShape{{size.x(), size.y(), size.z()}, {40, 4, 40}});
  for (const double depth : {kInfinity, 2.5}) {
    const TestSea sea(one_wave(kA, kK, kPsi, WavePressure::kWheeler, depth));
    const auto phi = [&](double x, double z) {
      const double eta = kA * std::cos(kK * x - kPsi);
      if (std::isinf(depth)) return -z + eta * std::exp(kK * (z - eta));
      const double stretched = depth * (z - eta) / (depth + eta);
      return -z + eta * std::cosh(kK * (stretched + depth)) / std::cosh(kK * depth);
    };
    const double half_x = 0.5 * size.x();
    const double low = center.z() - 0.5 * size.z();
    const double high = center.z() + 0.5 * size.z();
    const auto sides = [&](double z) { return size.y() * (phi(half_x, z) - phi(-half_x, z)); };
    const auto lids = [&](double x) { return size.y() * (phi(x, high) - phi(x, low)); };
    const Vec3 force(-integral(low, high, sides), 0.0, -integral(-half_x, half_x, lids));
    const double torque_y = -integral(low, high, [&](double z) { return (z - center.z()) * sides(z); }) +
                            integral(-half_x, half_x, [&](double x) { return x * lids(x); });
    const WaveLoad load = hierarchical_load(box, sea, at(0.0, 0.0, center.z()), 1e-6);
    EXPECT_LT((load.force - force).norm(), load.force_bound + 1e-12) << depth;
    EXPECT_LT(std::abs(load.torque.y() - torque_y), load.torque_bound + 1e-12) << depth;
    EXPECT_LT(load.force_bound, 1e-5 * box.mesh.volume) << depth;
    const WaveLoad exact = exact_surface_load(box, sea, at(0.0, 0.0, center.z()));
    EXPECT_LT((exact.force - force).norm(), 1e-6) << depth;
    EXPECT_LT(std::abs(exact.torque.y() - torque_y), 1e-6) << depth;
    EXPECT_NEAR(exact.volume, box.mesh.volume, 1e-6) << depth;
  }
}

// A vertical cylinder of radius R and draught d, in deep water.
class PiercingCylinder : public ::testing::Test {
 protected:
  static constexpr double kR = 0.7;
  static constexpr double kDraught = 0.9;
  static constexpr double kHeight = 2.0;
  static constexpr double kK = 0.6;
  static constexpr std::int32_t kSides = 360;

  // A prism with the area of the circle.
  static double corner_radius() {
    const double angle = 2.0 * kPi / kSides;
    return kR * std::sqrt(angle / std::sin(angle));
  }
  static double bessel(double order, double x) { return std::cyl_bessel_j(order, x); }

  const SeaBody body{CylinderShape{corner_radius(), kHeight, kSides, 40}};
  const Pose pose = at(0.0, 0.0, 0.5 * kHeight - kDraught);
  const Vec3 bottom_B{0.0, 0.0, -0.5 * kHeight};

  void expect_force(const TestSea& sea, const Vec3& force, double tolerance, double error) const {
    const WaveLoad load = hierarchical_load(body, sea, pose, tolerance);
    EXPECT_LT((load.force - force).norm(),
              std::min(load.force_bound, 10.0 * tolerance * body.mesh.volume) + error);
    EXPECT_LT((exact_surface_load(body, sea, pose).force - force).norm(), error);
  }
};

TEST_F(PiercingCylinder, HydrostaticForceHasAClosedForm) {
  constexpr double kA = 0.25;
  for (const double psi : {0.4, 1.9, -2.5}) {
    const TestSea sea(one_wave(kA, kK, psi, WavePressure::kHydrostatic));
    const double first = bessel(1, kK * kR);
    const Vec3 force(-kPi * kR *
                         (2.0 * kA * kDraught * first * std::sin(psi) +
                          0.5 * kA * kA * bessel(1, 2.0 * kK * kR) * std::sin(2.0 * psi)),
                     0.0, kPi * kR * kR * kDraught + 2.0 * kPi * kA * kR * first / kK * std::cos(psi));
    expect_force(sea, force, 1e-5, 1e-5);
  }
}

TEST_F(PiercingCylinder, WheelerForceIsAnIntegralOverTheAngle) {
  constexpr double kA = 0.25;
  for (const double psi : {0.4, 1.9, -2.5}) {
    const TestSea sea(one_wave(kA, kK, psi, WavePressure::kWheeler));
    const auto eta = [psi](double x) { return kA * std::cos(kK * x - psi); };
    const double side = -kR * integral(0.0, 2.0 * kPi, [&](double angle) {
      const double e = eta(kR * std::cos(angle));
      const double column = e * (1.0 - std::exp(-kK * (kDraught + e))) / kK - e * (kDraught + e) +
                            0.5 * (kDraught + e) * (kDraught + e);
      return std::cos(angle) * column;
    });
    // Over the bottom in strips x = R sin(angle) of length 2 R cos(angle).
    const double bottom = integral(-0.5 * kPi, 0.5 * kPi, [&](double angle) {
      const double e = eta(kR * std::sin(angle));
      const double strip = 2.0 * kR * kR * std::cos(angle) * std::cos(angle);
      return strip * (kDraught + e * std::exp(-kK * (kDraught + e)));
    });
    expect_force(sea, {side, 0.0, bottom}, 1e-5, 1e-5);
  }
}

TEST_F(PiercingCylinder, LinearForceAndMomentAreBesselFunctions) {
  constexpr double kA = 2e-4;
  constexpr double kPsi = 0.8;
  const TestSea sea(one_wave(kA, kK, kPsi, WavePressure::kWheeler));
  const double decay = std::exp(-kK * kDraught);
  const double ring = 2.0 * kPi * kA * kR * bessel(1, kK * kR) / kK;
  const Vec3 force(-ring * std::sin(kPsi) * (1.0 - decay), 0.0,
                   kPi * kR * kR * kDraught + ring * decay * std::cos(kPsi));
  expect_force(sea, force, 1e-9, 2e-4 * ring);
  // About the bottom's centre: sides with their levers, and the bottom.
  const double torque_y = -ring * std::sin(kPsi) * (kDraught - (1.0 - decay) / kK) -
                          2.0 * kPi * kA * kR * kR * bessel(2, kK * kR) / kK * decay * std::sin(kPsi);
  const WaveLoad load = hierarchical_load(body, sea, pose, 1e-9, bottom_B);
  EXPECT_LT(std::abs(load.torque.y() - torque_y), 5e-4 * std::abs(torque_y));
  EXPECT_LT(std::abs(exact_surface_load(body, sea, pose, bottom_B).torque.y() - torque_y),
            5e-4 * std::abs(torque_y));
}

}  // namespace
}  // namespace buoyancy
