#include "tests/wave_loads/brute_force.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

namespace buoyancy {
namespace {

struct Point {
  double height;    // over the surface
  double pressure;  // over rho g, whether wet or not
};

// The sea at a point, written from the formulas alone.
Point sea_at(const SeaSnapshot& snapshot, const Vec3& p_W) {
  const Sea& sea = snapshot.sea();
  const PreparedComponents& waves = sea.prepared();
  const double x1 = sea.axes().e1_W.dot(p_W);
  const double x2 = sea.axes().e2_W.dot(p_W);
  const double zeta = sea.water().up_W.dot(p_W) - sea.water().level;
  thread_local std::vector<double> cosines;
  cosines.resize(waves.size());
  double eta = 0.0;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    cosines[i] = snapshot.amplitude_factor() * waves.amplitude[i] *
                 std::cos(waves.k1[i] * x1 + waves.k2[i] * x2 + snapshot.phases()[i]);
    eta += cosines[i];
  }
  const double s = zeta - eta;
  if (sea.pressure() == WavePressure::kHydrostatic) return {s, -s};
  const double h = sea.depth();
  const double free = std::isinf(h) ? s : h * s / (h + eta);
  const double z = h + eta > 0.0 ? std::max(free, -h) : -h;
  double f = 0.0;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const double k = waves.wave_number[i];
    f += cosines[i] * (std::isinf(h) ? std::exp(k * z) : std::cosh(k * (z + h)) / std::cosh(k * h));
  }
  return {s, f - zeta};
}

class Integrator {
 public:
  Integrator(const SeaSnapshot& sea, const Pose& pose, const Vec3& center_B, const Vec3& reference_B)
      : sea_(sea),
        R_WB_(pose.q_WB.normalized().toRotationMatrix()),
        p_WB_(pose.p_WB),
        center_B_(center_B),
        reference_B_(reference_B),
        up_B_(R_WB_.transpose() * sea.sea().water().up_W) {}

  BruteForceLoad load;

  void add_triangle(const Vec3& a, const Vec3& b, const Vec3& c, int cuts) {
    const Vec3 area_vector = 0.5 * (b - a).cross(c - a) / (static_cast<double>(cuts) * cuts);
    area_ = area_vector.norm();
    if (area_ == 0.0) return;
    normal_ = area_vector / area_;
    const auto at = [&](int i, int j) {
      return Vec3(a + (b - a) * (static_cast<double>(i) / cuts) + (c - a) * (static_cast<double>(j) / cuts));
    };
    const auto height = [&](int i, int j) { return sea_at(sea_, in_world(at(i, j))).height; };
    std::vector<double> row(static_cast<std::size_t>(cuts) + 1);
    std::vector<double> next(row.size());
    const auto n = [](int j) { return static_cast<std::size_t>(j); };
    for (int j = 0; j <= cuts; ++j) row[n(j)] = height(0, j);
    for (int i = 0; i < cuts; ++i) {
      for (int j = 0; j <= cuts - i - 1; ++j) next[n(j)] = height(i + 1, j);
      for (int j = 0; j < cuts - i; ++j) {
        add_part({at(i, j), at(i + 1, j), at(i, j + 1)}, {row[n(j)], next[n(j)], row[n(j + 1)]});
        if (j < cuts - i - 1) {
          add_part({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)},
                   {next[n(j)], next[n(j + 1)], row[n(j + 1)]});
        }
      }
      row.swap(next);
    }
  }

 private:
  Vec3 in_world(const Vec3& y) const { return p_WB_ + R_WB_ * (y + center_B_); }

  // Three points, exact for quadratic functions.
  void integrate(const Vec3& p, const Vec3& q, const Vec3& r, double area) {
    for (const Vec3& x :
         {Vec3((4.0 * p + q + r) / 6.0), Vec3((p + 4.0 * q + r) / 6.0), Vec3((p + q + 4.0 * r) / 6.0)}) {
      const Point point = sea_at(sea_, in_world(x));
      const Vec3 force = -(area / 3.0) * point.pressure * normal_;
      load.force += force;
      load.torque += (x + center_B_ - reference_B_).cross(force);
      load.volume += (area / 3.0) * point.height * normal_.dot(up_B_);
    }
  }

  void add_part(const std::array<Vec3, 3>& corners, const std::array<double, 3>& heights) {
    const int wet = (heights[0] < 0.0) + (heights[1] < 0.0) + (heights[2] < 0.0);
    if (wet == 0) return;
    if (wet == 3) return integrate(corners[0], corners[1], corners[2], area_);
    std::size_t lone = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if ((heights[i] < 0.0) == (wet == 1)) lone = i;
    }
    const std::size_t second = (lone + 1) % 3;
    const std::size_t third = (lone + 2) % 3;
    const double s = heights[lone] / (heights[lone] - heights[second]);
    const double t = heights[lone] / (heights[lone] - heights[third]);
    const Vec3 on_second = corners[lone] + s * (corners[second] - corners[lone]);
    const Vec3 on_third = corners[lone] + t * (corners[third] - corners[lone]);
    if (wet == 1) return integrate(corners[lone], on_second, on_third, area_ * s * t);
    integrate(on_second, corners[second], corners[third], area_ * (1.0 - s));
    integrate(on_second, corners[third], on_third, area_ * s * (1.0 - t));
  }

  const SeaSnapshot& sea_;
  Mat3 R_WB_;
  Vec3 p_WB_, center_B_, reference_B_, up_B_;
  Vec3 normal_ = Vec3::Zero();
  double area_ = 0.0;
};

BruteForceLoad integrate(const TriangleMesh& surface, const Vec3& center_B, const SeaSnapshot& sea,
                         const Pose& pose, const Vec3& reference_B, int cuts) {
  Integrator integrator(sea, pose, center_B, reference_B);
  for (const Triangle& triangle : surface.triangles) {
    integrator.add_triangle(surface.vertex(triangle[0]), surface.vertex(triangle[1]),
                            surface.vertex(triangle[2]), cuts);
  }
  return integrator.load;
}

}  // namespace

BruteForceLoad brute_force_load(const TriangleMesh& surface, const Vec3& center_B, const SeaSnapshot& sea,
                                const Pose& pose, const Vec3& reference_B, int cuts) {
  BruteForceLoad load = integrate(surface, center_B, sea, pose, reference_B, cuts);
  const BruteForceLoad coarse = integrate(surface, center_B, sea, pose, reference_B, cuts / 2);
  load.force_error = (load.force - coarse.force).norm();
  load.torque_error = (load.torque - coarse.torque).norm();
  load.volume_error = std::abs(load.volume - coarse.volume);
  return load;
}

}  // namespace buoyancy
