#include "tests/truth/reference_sea.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#define HWY_BROKEN_EMU128 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/truth/reference_sea.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "tests/truth/reference_sea-inl.h"

#if HWY_ONCE
namespace buoyancy {
namespace {

HWY_EXPORT(evaluate_sea);

constexpr std::size_t kMaxLanes = 8;
constexpr long double kPi = 3.141592653589793238462643383279502884L;
constexpr long double kExtendedEpsilon = std::numeric_limits<long double>::epsilon();

using Extended3 = std::array<long double, 3>;

Extended3 extended(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
Vec3 narrowed(const Extended3& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}
long double dot(const Extended3& a, const Extended3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Extended3 cross(const Extended3& a, const Extended3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

using ExtendedMatrix = std::array<Extended3, 3>;  // rows

ExtendedMatrix rotation(const Eigen::Quaterniond& q) {
  const long double w = q.w();
  const long double x = q.x();
  const long double y = q.y();
  const long double z = q.z();
  const long double s = 2.0L / (w * w + x * x + y * y + z * z);
  return {{{1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)},
           {s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)},
           {s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)}}};
}
// R^T v
Extended3 turned_back(const ExtendedMatrix& R, const Extended3& v) {
  return {R[0][0] * v[0] + R[1][0] * v[1] + R[2][0] * v[2], R[0][1] * v[0] + R[1][1] * v[1] + R[2][1] * v[2],
          R[0][2] * v[0] + R[1][2] * v[1] + R[2][2] * v[2]};
}

// k of w^2 = g k tanh kh, by Newton's method.
long double wave_number_of(long double w, long double g, long double h) {
  const long double deep = w * w / g;
  if (std::isinf(h)) return deep;
  long double k = deep / std::sqrt(std::tanh(deep * h));
  for (int i = 0; i < 50; ++i) {
    const long double t = std::tanh(k * h);
    const long double next = k - (k * t - deep) / (t + k * h * (1 - t * t));
    if (std::abs(next - k) <= 2 * kExtendedEpsilon * k) return next;
    k = next;
  }
  return k;
}

long double radians(double degrees) {
  return std::remainder(static_cast<long double>(degrees), 360.0L) * (kPi / 180.0L);
}

double amplitude_factor(long double t, double ramp) {
  if (ramp == 0.0 || t >= ramp) return 1.0;
  return t <= 0 ? 0.0 : static_cast<double>((1 - std::cos(kPi * t / ramp)) / 2);
}

double typical_sum(const std::vector<double>& amplitude, const std::vector<double>& k, int power) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < k.size(); ++i) {
    const double term = amplitude[i] * std::pow(k[i], power);
    sum += term;
    squares += 0.5 * term * term;
  }
  return std::min(sum, 4.0 * std::sqrt(squares));
}

}  // namespace

void SeaPoints::clear() {
  x.clear();
  y.clear();
  z.clear();
}

void SeaPoints::add(const Vec3& p) {
  x.push_back(p.x());
  y.push_back(p.y());
  z.push_back(p.z());
}

ReferenceSea::ReferenceSea(const Sea& sea, std::int64_t utime, double lead_time, const Pose& pose,
                           const Vec3& center_B)
    : depth_(sea.depth()), hydrostatic_(sea.pressure() == WavePressure::kHydrostatic) {
  const Water& water = sea.water();
  const Extended3 up = extended(water.up_W);
  const Extended3 axis = std::abs(water.up_W.x()) > 0.9 ? Extended3{0, 1, 0} : Extended3{1, 0, 0};
  Extended3 e1;
  for (std::size_t i = 0; i < 3; ++i) e1[i] = axis[i] - dot(up, axis) * up[i];
  const long double norm = std::sqrt(dot(e1, e1));
  for (long double& entry : e1) entry /= norm;
  const Extended3 e2 = cross(up, e1);
  const ExtendedMatrix R = rotation(pose.q_WB);
  const Extended3 c_B = extended(center_B);
  Extended3 c_W = extended(pose.p_WB);
  for (std::size_t i = 0; i < 3; ++i) c_W[i] += dot(R[i], c_B);
  e1_B_ = narrowed(turned_back(R, e1));
  e2_B_ = narrowed(turned_back(R, e2));
  up_B_ = narrowed(turned_back(R, up));
  zeta_ = static_cast<double>(dot(up, c_W) - water.level);

  const long double t =
      (static_cast<long double>(utime) - static_cast<long double>(sea.time_origin())) / 1e6L + lead_time;
  const long double x1 = dot(e1, c_W);
  const long double x2 = dot(e2, c_W);
  const double factor = amplitude_factor(t, sea.ramp());
  const WaveComponents& waves = sea.components();
  std::vector<std::size_t> order(waves.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return waves[a].angular_frequency > waves[b].angular_frequency;
  });
  for (const std::size_t i : order) {
    const WaveComponent& wave = waves[i];
    if (!(factor * wave.amplitude > 0.0)) continue;
    const long double k = wave_number_of(wave.angular_frequency, water.gravity, depth_);
    const long double direction = radians(wave.direction);
    const long double k1 = k * std::cos(direction);
    const long double k2 = k * std::sin(direction);
    const long double turns = static_cast<long double>(wave.angular_frequency) * t;
    const long double theta = k1 * x1 + k2 * x2 - turns + radians(wave.phase);
    amplitude_.push_back(factor * wave.amplitude);
    theta_.push_back(static_cast<double>(std::remainder(theta, 2 * kPi)));
    k_.push_back(static_cast<double>(k));
    k1_.push_back(static_cast<double>(k1));
    k2_.push_back(static_cast<double>(k2));
    twice_depth_.push_back(static_cast<double>(2 * k * depth_));
    finite_scale_.push_back(1.0 / (1.0 + std::exp(-twice_depth_.back())));
    const long double along = k * (std::abs(x1) + std::abs(x2));
    error_ += amplitude_.back() * static_cast<double>(4 * kExtendedEpsilon * (along + std::abs(turns) + 10) +
                                                      1e-15L * along + 2e-15L);
    max_elevation_ += amplitude_.back();
    max_slope_ += amplitude_.back() * k_.back();
  }
  curvature_ = typical_sum(amplitude_, k_, 2);
  third_derivative_ = typical_sum(amplitude_, k_, 3);
}

double ReferenceSea::resolved_wave_number(double depth, double negligible) const {
  // Stretching moves points up where the surface is high.
  if (!std::isinf(depth_)) depth = std::min(depth, depth_) * depth_ / (depth_ + max_elevation_);
  double slope = 0.0;
  if (!hydrostatic_) {
    for (std::size_t i = 0; i < k_.size(); ++i) slope += amplitude_[i] * k_[i] * std::exp(-k_[i] * depth);
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < k_.size(); ++i) {
    const double decay = hydrostatic_ || depth <= 0.0 ? 1.0 : std::min(1.0, 2.0 * std::exp(-k_[i] * depth));
    sum += amplitude_[i] * std::min(1.0, decay + slope);
    if (sum > negligible) return k_[i];
  }
  return 0.0;
}

ReferenceSea::View ReferenceSea::view() const {
  const auto array = [](const Vec3& v) { return std::array<double, 3>{v.x(), v.y(), v.z()}; };
  return {k_.size(),    amplitude_.data(), theta_.data(),        k_.data(),
          k1_.data(),   k2_.data(),        finite_scale_.data(), twice_depth_.data(),
          array(e1_B_), array(e2_B_),      array(up_B_),         zeta_,
          depth_,       hydrostatic_};
}

namespace {

// Pads the points, so that every vector is full.
void pad(SeaPoints& points) {
  const std::size_t count = points.size();
  const std::size_t padded = (count + kMaxLanes - 1) / kMaxLanes * kMaxLanes;
  for (auto* row : {&points.x, &points.y, &points.z}) row->resize(padded, 0.0);
  points.height.resize(padded);
  points.pressure.resize(padded);
}

void unpad(SeaPoints& points, std::size_t count) {
  for (auto* row : {&points.x, &points.y, &points.z, &points.height, &points.pressure}) row->resize(count);
}

}  // namespace

void ReferenceSea::set_heights(SeaPoints& points) const {
  const std::size_t count = points.size();
  pad(points);
  HWY_DYNAMIC_DISPATCH(evaluate_sea)
  (view(), points.size(), points.x.data(), points.y.data(), points.z.data(), points.height.data(), nullptr);
  unpad(points, count);
}

void ReferenceSea::set_pressures(SeaPoints& points) const {
  const std::size_t count = points.size();
  pad(points);
  HWY_DYNAMIC_DISPATCH(evaluate_sea)
  (view(), points.size(), points.x.data(), points.y.data(), points.z.data(), points.height.data(),
   points.pressure.data());
  unpad(points, count);
}

}  // namespace buoyancy
#endif  // HWY_ONCE
