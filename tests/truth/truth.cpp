#include "tests/truth/truth.h"

#include <optional>
#include <utility>

#include "tests/truth/ball.h"

namespace buoyancy {
namespace {

// A ball's radius counts as error. The largest radius for which a ball is used, relative to the limit.
constexpr double kMaxRelativeRadius = 0.01;

// [N], [N m], and [m^3] in each component of the third.
template <typename T>
struct TrueResult {
  Vec3T<T> force_W, torque_W, volume;
};

}  // namespace

struct Truth::Exact {
  std::vector<const TriangleMesh*> sources_B;
  Pose pose;
  Water water;
  Vec3 reference_B;
  std::optional<TrueResult<Ball>> balls;
  std::optional<TrueResult<Rational>> rationals;

  template <typename T>
  TrueResult<T> result() const {
    const T weight = T(water.density) * T(water.gravity);
    TrueResult<T> sum{Vec3T<T>::Constant(T(0)), Vec3T<T>::Constant(T(0)), Vec3T<T>::Constant(T(0))};
    for (const TriangleMesh* const source : sources_B) {
      const auto displaced = exact_displacement<T>(*source, pose, water);
      sum.volume += Vec3T<T>::Constant(displaced.volume);
      sum.force_W += water.up_W.template cast<T>() * T(weight * displaced.volume);
      sum.torque_W += exactly_in_world<T>(pose, displaced.torque(reference_B)) * weight;
    }
    return sum;
  }

  // Of the first `components`.
  double error(const Vec3& found, int components, double limit, Vec3T<Ball> TrueResult<Ball>::*in_balls,
               Vec3T<Rational> TrueResult<Rational>::*in_rationals) {
    Vec3 error = Vec3::Zero();
    if (limit > 0.0) {
      if (!balls) balls = result<Ball>();
      Vec3 radius = Vec3::Zero();
      for (int i = 0; i < components; ++i) {
        const Ball& ball = ((*balls).*in_balls)[i];
        error[i] = static_cast<double>(ball.distance(found[i]));
        radius[i] = static_cast<double>(ball.rad);
      }
      if (error.norm() <= limit && radius.norm() <= kMaxRelativeRadius * limit) return error.norm();
    }
    if (!rationals) rationals = result<Rational>();
    for (int i = 0; i < components; ++i) {
      error[i] = Rational(Rational(found[i]) - ((*rationals).*in_rationals)[i]).convert_to<double>();
    }
    return error.norm();
  }
};

Truth::Truth(std::vector<const TriangleMesh*> sources_B, const Pose& pose, const Water& water,
             const Vec3& reference_B)
    : exact_(new Exact{std::move(sources_B), pose, water, reference_B, {}, {}}) {}

Truth::~Truth() = default;

double Truth::volume_error(double volume, double limit) const {
  return exact_->error(Vec3::Constant(volume), 1, limit, &TrueResult<Ball>::volume,
                       &TrueResult<Rational>::volume);
}

double Truth::force_error(const Vec3& force_W, double limit) const {
  return exact_->error(force_W, 3, limit, &TrueResult<Ball>::force_W, &TrueResult<Rational>::force_W);
}

double Truth::torque_error(const Vec3& torque_W, double limit) const {
  return exact_->error(torque_W, 3, limit, &TrueResult<Ball>::torque_W, &TrueResult<Rational>::torque_W);
}

}  // namespace buoyancy
