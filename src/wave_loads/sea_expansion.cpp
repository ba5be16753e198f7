#include "wave_loads/sea_expansion.h"

#include <cmath>

namespace buoyancy {
namespace {

// The real part of i^m e^(i theta) is one of cos, -sin, -cos, sin.
bool is_sine(int m) {
  return m % 2 != 0;
}
double sign(int m) {
  return m % 4 == 1 || m % 4 == 2 ? -1.0 : 1.0;
}

double factorial(int n) {
  return std::tgamma(n + 1.0);
}

}  // namespace

Weight weight_of_harmonic(int l, int m) {
  const bool odd = (l + m) % 2 != 0;
  if (is_sine(m)) return odd ? Weight::kSineOdd : Weight::kSineEven;
  return odd ? Weight::kCosineOdd : Weight::kCosineEven;
}

Weight weight_of_monomial(int l) {
  return is_sine(l) ? Weight::kSineEven : Weight::kCosineEven;
}

SeaExpansion::SeaExpansion(const Sea& sea)
    : components(sea.prepared().size()), k_max(sea.max_wave_number()), amplitude(sea.prepared().amplitude) {
  const PreparedComponents& prepared = sea.prepared();
  constexpr std::size_t kHarmonics = harmonics_to(kNormDegree);
  constexpr std::size_t kMonomials = monomials_to(kNormDegree);
  double_precision.harmonics.resize(kHarmonics * components);
  double_precision.monomials.resize(kMonomials * components);
  double_precision.tail.resize(components);
  for (std::size_t i = 0; i < components; ++i) {
    k.push_back(prepared.wave_number[i] / k_max);
    k1.push_back(prepared.k1[i] / k_max);
    k2.push_back(prepared.k2[i] / k_max);
    twice_depth.push_back(2.0 * prepared.wave_number[i] * sea.depth());
    const double angle = std::atan2(prepared.k2[i], prepared.k1[i]);
    double power = 1.0;  // (k / k_max)^l
    for (int l = 0; l <= kNormDegree; ++l, power *= k[i]) {
      for (int m = 0; m <= l; ++m) {
        const double factor = (m == 0 ? 1.0 : 2.0) * power * sign(m);
        double_precision.harmonics[cosine_place(l, m) * components + i] = factor * std::cos(m * angle);
        if (m > 0) {
          double_precision.harmonics[sine_place(l, m) * components + i] = factor * std::sin(m * angle);
        }
      }
      for (int q = 0; q <= l; ++q) {
        const int p = l - q;
        double_precision.monomials[monomial_place(p, q) * components + i] =
            sign(l) * std::pow(k1[i], p) * std::pow(k2[i], q) / (factorial(p) * factorial(q));
      }
    }
    double_precision.tail[i] = power;
    const double next = std::pow(k[i], kDegree + 1) / factorial(kDegree + 1);
    typical_norm = std::hypot(typical_norm, amplitude[i] * next);
    tail += amplitude[i] * power / factorial(kNormDegree + 1);
    amplitude_sums[0] += amplitude[i];
    amplitude_sums[1] += amplitude[i] * prepared.wave_number[i];
    amplitude_sums[2] += amplitude[i] * prepared.wave_number[i] * prepared.wave_number[i];
  }
  const auto narrowed = [](const std::vector<double>& numbers) {
    return std::vector<float>(numbers.begin(), numbers.end());
  };
  single_precision.harmonics = narrowed(double_precision.harmonics);
  single_precision.monomials = narrowed(double_precision.monomials);
  single_precision.tail = narrowed(double_precision.tail);
}

double SeaExpansion::reach_within(double error) const {
  constexpr double kShortest = 0.1;
  constexpr double kFactor = 0.9;
  double reach = 4.0;
  for (; reach > kShortest; reach *= kFactor) {
    const double ratio = 1.0 / (1.0 - reach / (kNormDegree + 2));
    const double left_out = typical_norm * std::pow(reach, kDegree + 1) * (1.0 + 0.2 * reach) +
                            tail * std::pow(reach, kNormDegree + 1) * ratio;
    if (left_out <= error) break;
  }
  return reach;
}

}  // namespace buoyancy
