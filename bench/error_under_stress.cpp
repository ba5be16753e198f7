// Error of each method under numerical stress: sweeps over tilt, water level, scale, the position of the mesh
// in its own frame, and the wet share. CSV on standard output, one row per sweep, step and method: the
// largest error of the force over a few poses, relative to the whole displacement.
//
// The six methods are compared with what many simulators do: single precision in the world's frame. That
// method exists only here. The tests' oracle encloses the true value in ball arithmetic.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "geometry/shapes.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/triangle_clip.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/truth/ball.h"
#include "tests/truth/exact_oracle.h"
#include "tests/truth/rational.h"
#include "unit_water.h"

namespace buoyancy::bench {
namespace {

struct Sample {
  Pose pose;
  Water water = kUnitWater;
};

// Pressure force on the wet parts of the triangles, summed sequentially [m^3], in W.
Vec3 float32_force(const TriangleMesh& mesh, const Pose& pose, const Water& water) {
  using Vec3f = Vec3T<float>;
  const Mat3T<float> R_WB = pose.q_WB.normalized().toRotationMatrix().cast<float>();
  const Vec3f p_WB = pose.p_WB.cast<float>();
  const auto level = static_cast<float>(water.level);
  std::vector<ClipVertex<float>> corners;
  corners.reserve(mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3f x_W = R_WB * mesh.vertex(static_cast<std::int32_t>(i)).cast<float>() + p_WB;
    corners.push_back({Point<float>::from(x_W), x_W.z() - level});
  }
  Vec3f force = Vec3f::Zero();
  const auto add = [&](const ClipVertex<float>& a, const ClipVertex<float>& b, const ClipVertex<float>& c) {
    force += (a.z + b.z + c.z) / 6.0F * cross(b.y - a.y, c.y - a.y).vec3();
  };
  for (const Triangle& triangle : mesh.triangles) {
    const auto corner = [&](std::size_t n) { return corners[static_cast<std::size_t>(triangle[n])]; };
    const int wet = int(corner(0).wet()) + int(corner(1).wet()) + int(corner(2).wet());
    if (wet == 3) {
      add(corner(0), corner(1), corner(2));
    } else if (wet != 0) {
      for_each_wet_triangle(corner(0), corner(1), corner(2), add);
    }
  }
  return force.cast<double>();
}

double distance(const Ball& truth, double value) {
  return static_cast<double>(truth.distance(value));
}
double distance(const Rational& truth, double value) {
  return std::abs(Rational(truth - Rational(value)).convert_to<double>());
}

// Prints a row per method with the largest error over the samples. x: the swept quantity. Number: arithmetic
// of the true values.
template <typename Number = Ball>
void print_rows(const std::string& sweep, double x, const TriangleMesh& source,
                const std::vector<Sample>& samples) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh({source, {}});
  std::vector<Number> truth;
  truth.reserve(samples.size());
  for (const Sample& sample : samples)
    truth.push_back(exact_displacement<Number>(source, sample.pose, sample.water).volume);
  const auto print = [&](const std::string& method, const auto& force_of) {
    double max_error = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Vec3 force_W = force_of(samples[i]);
      const double error = std::hypot(distance(truth[i], force_W.z()), force_W.head<2>().norm());
      max_error = std::max(max_error, error / mesh.volume);
    }
    std::printf("%s,%.6g,%s,%.6g\n", sweep.c_str(), x, method.c_str(), max_error);
  };
  for (const Method method : kAllMethods) {
    const Solver solver(mesh, method);
    print(std::string(to_string(method)), [&](const Sample& sample) {
      return buoyancy(solver, sample.pose, sample.water, mesh.center_B).force_W;
    });
  }
  print("float32_in_world",
        [&](const Sample& sample) { return float32_force(source, sample.pose, sample.water); });
}

// Random rotations, the same ones in every sweep.
std::vector<Eigen::Quaterniond> rotations(int count) {
  RandomPoses random(1);
  std::vector<Eigen::Quaterniond> result;
  for (int i = 0; i < count; ++i) result.push_back(random.rotation());
  return result;
}

// Heights of the body's centre over the water, in radii: slightly, half and mostly submerged.
constexpr std::array kHeights{0.6, 0.05, -0.4};
constexpr int kPerDecade = 4;

std::vector<double> decades(int from, int to) {
  std::vector<double> steps;
  for (int i = from * kPerDecade; i <= to * kPerDecade; ++i)
    steps.push_back(std::pow(10.0, static_cast<double>(i) / kPerDecade));
  return steps;
}

TriangleMesh rock() {
  return make_shape(RockShape{.radius = 1.0, .frequency = 8, .roughness = 0.3, .seed = 1});
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& by_B, double scale) {
  for (double& x : mesh.x) x = scale * x + by_B.x();
  for (double& y : mesh.y) y = scale * y + by_B.y();
  for (double& z : mesh.z) z = scale * z + by_B.z();
  return mesh;
}

// A box of 1,200 triangles with an increasing tilt.
void sweep_tilt() {
  const TriangleMesh box = make_shape(BoxShape{.size = {2, 2, 1}, .segments = {10, 10, 10}});
  for (const double tilt : decades(-12, 0)) {
    std::vector<Sample> samples;
    for (const double height : {0.32, 0.03, -0.27}) {
      const Eigen::Quaterniond q_WB(Eigen::AngleAxisd(tilt, Vec3(0.6, 0.8, 0.0)));
      samples.push_back({{Vec3(0, 0, height), q_WB}});
    }
    print_rows("tilt", tilt, box, samples);
  }
}

// The water level and the body's position rise together.
void sweep_level() {
  const TriangleMesh mesh = rock();
  for (const double level : decades(0, 9)) {
    std::vector<Sample> samples;
    for (const Eigen::Quaterniond& q_WB : rotations(3)) {
      for (const double height : kHeights) {
        Sample sample{{Vec3(0, 0, level + height), q_WB}};
        sample.water.level = level;
        samples.push_back(sample);
      }
    }
    print_rows("level", level, mesh, samples);
  }
}

void sweep_scale() {
  for (const double scale : decades(-6, 6)) {
    std::vector<Sample> samples;
    for (const Eigen::Quaterniond& q_WB : rotations(3)) {
      for (const double height : kHeights) samples.push_back({{Vec3(0, 0, scale * height), q_WB}});
    }
    print_rows("scale", scale, moved(rock(), Vec3::Zero(), scale), samples);
  }
}

// The mesh moves away from B's origin, and B's origin the same distance from W's origin.
void sweep_origin() {
  for (const double distance : decades(0, 7)) {
    const Vec3 offset_B = distance * Vec3(0.6, -0.48, 0.64);
    std::vector<Sample> samples;
    for (const Eigen::Quaterniond& q_WB : rotations(3)) {
      for (const double height : kHeights) samples.push_back({{Vec3(0, 0, height) - q_WB * offset_B, q_WB}});
    }
    print_rows("origin", distance, moved(rock(), offset_B, 1.0), samples);
  }
}

// The wet share decreases: each pose is lowered until the requested share is submerged. The true values are
// exact rationals, because the errors are smaller than the radii of ball arithmetic.
void sweep_wet_share() {
  const TriangleMesh mesh = rock();
  const HydrostaticMesh prepared = make_hydrostatic_mesh({mesh, {}});
  const Solver solver(prepared, Method::kHierarchical);
  for (const double share : decades(-9, 0)) {
    std::vector<Sample> samples;
    for (const Eigen::Quaterniond& q_WB : rotations(3)) {
      double dry = 2.0;
      double wet = -2.0;
      for (int step = 0; step < 60; ++step) {
        const double height = 0.5 * (dry + wet);
        const double volume = buoyancy(solver, {Vec3(0, 0, height), q_WB}, kUnitWater, Vec3::Zero()).volume;
        (volume < 0.999999999 * share * prepared.volume ? dry : wet) = height;
      }
      samples.push_back({{Vec3(0, 0, wet), q_WB}});
    }
    print_rows<Rational>("wet_share", share, mesh, samples);
  }
}

}  // namespace
}  // namespace buoyancy::bench

int main() {
  std::printf("sweep,x,method,error_of_whole\n");
  buoyancy::bench::sweep_tilt();
  buoyancy::bench::sweep_level();
  buoyancy::bench::sweep_scale();
  buoyancy::bench::sweep_origin();
  buoyancy::bench::sweep_wet_share();
}
