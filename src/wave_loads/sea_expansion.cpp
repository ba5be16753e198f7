#include "wave_loads/sea_expansion.h"

#include <cassert>
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

Weight weight_of_harmonic(int l, int m) {
  const bool odd = (l + m) % 2 != 0;
  if (is_sine(m)) return odd ? Weight::kSineOdd : Weight::kSineEven;
  return odd ? Weight::kCosineOdd : Weight::kCosineEven;
}

Weight weight_of_monomial(int l) {
  return is_sine(l) ? Weight::kSineEven : Weight::kCosineEven;
}

// Hands out the columns of each weight in their order.
class ColumnCounter {
 public:
  explicit ColumnCounter(const std::array<ColumnRange, kWeights>& of_weight) : of_weight_(of_weight) {}

  std::size_t next(Weight weight) {
    const auto w = static_cast<std::size_t>(weight);
    const std::size_t column = of_weight_[w].begin + used_[w]++;
    assert(column < of_weight_[w].end);
    return column;
  }

 private:
  const std::array<ColumnRange, kWeights>& of_weight_;
  std::array<std::size_t, kWeights> used_{};
};

template <std::size_t kColumns>
std::vector<ExpansionRow<float, kColumns>> narrowed(const std::vector<ExpansionRow<double, kColumns>>& rows) {
  std::vector<ExpansionRow<float, kColumns>> result(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      result[i].columns[c] = static_cast<float>(rows[i].columns[c]);
    }
  }
  return result;
}

std::vector<float> narrowed(const std::vector<double>& numbers) {
  std::vector<float> result;
  result.reserve(numbers.size());
  for (const double number : numbers) result.push_back(static_cast<float>(number));
  return result;
}

}  // namespace

const HarmonicColumns& harmonic_columns() {
  static const HarmonicColumns columns = [] {
    HarmonicColumns all{};
    ColumnCounter counter(kHarmonicColumnsOfWeight);
    for (int l = 0; l <= kNormDegree; ++l) {
      for (int m = 0; m <= l; ++m) {
        all[cosine_place(l, m)] = counter.next(weight_of_harmonic(l, m));
        if (m > 0) all[sine_place(l, m)] = counter.next(weight_of_harmonic(l, m));
      }
    }
    return all;
  }();
  return columns;
}

const MonomialColumns& monomial_columns() {
  static const MonomialColumns columns = [] {
    MonomialColumns all{};
    ColumnCounter counter(kMonomialColumnsOfWeight);
    for (int l = 0; l <= kNormDegree; ++l) {
      for (int q = 0; q <= l; ++q) all[monomial_place(l - q, q)] = counter.next(weight_of_monomial(l));
    }
    return all;
  }();
  return columns;
}

namespace {

// The entries of a component's harmonics and monomials of degree l are the power l of its k / k_max times a
// factor of its direction.
// That of C_l0 is taken twice, as the derivatives of the coefficients are simpler then.
double harmonic_factor(int m) {
  return 2.0 * sign(m);
}
double monomial_factor(int p, int q, double cosine, double sine) {
  return sign(p + q) * std::pow(cosine, p) * std::pow(sine, q) / (factorial(p) * factorial(q));
}

// k: over k_max; b: direction [rad].
void fill_rows(double k, double b, ExpansionRow<double, kHarmonicColumns>& harmonics,
               ExpansionRow<double, kMonomialColumns>& monomials) {
  double power = 1.0;
  for (int l = 0; l <= kNormDegree; ++l, power *= k) {
    for (int m = 0; m <= l; ++m) {
      const double factor = power * harmonic_factor(m);
      harmonics.columns[harmonic_columns()[cosine_place(l, m)]] = factor * std::cos(m * b);
      if (m > 0) harmonics.columns[harmonic_columns()[sine_place(l, m)]] = factor * std::sin(m * b);
    }
    for (int q = 0; q <= l; ++q) {
      monomials.columns[monomial_columns()[monomial_place(l - q, q)]] =
          power * monomial_factor(l - q, q, std::cos(b), std::sin(b));
    }
  }
}

SlotFactors<double> slot_factors(double b) {
  SlotFactors<double> slot;
  for (int m = 0; m <= kNormDegree; ++m) {
    slot.cosines[static_cast<std::size_t>(m)] = harmonic_factor(m) * std::cos(m * b);
    slot.sines[static_cast<std::size_t>(m)] = harmonic_factor(m) * std::sin(m * b);
  }
  for (int l = 0; l <= kNormDegree; ++l) {
    for (int q = 0; q <= l; ++q) {
      slot.monomials[static_cast<std::size_t>(l)][static_cast<std::size_t>(q)] =
          monomial_factor(l - q, q, std::cos(b), std::sin(b));
    }
  }
  return slot;
}

void set_powers(double k, std::size_t lane, StepPowers<double>& powers) {
  double power = 1.0;
  for (auto& of_degree : powers.of_degree) {
    of_degree[lane] = power;
    power *= k;
  }
}

ExpansionTable<float> narrowed(const ExpansionTable<double>& table) {
  ExpansionTable<float> result;
  result.harmonics = narrowed(table.harmonics);
  result.monomials = narrowed(table.monomials);
  const auto narrow = [](const auto& from, auto& to) {
    for (std::size_t i = 0; i < from.size(); ++i) to[i] = static_cast<float>(from[i]);
  };
  result.slots.resize(table.slots.size());
  for (std::size_t n = 0; n < table.slots.size(); ++n) {
    narrow(table.slots[n].cosines, result.slots[n].cosines);
    narrow(table.slots[n].sines, result.slots[n].sines);
    for (std::size_t l = 0; l <= kNormDegree; ++l) {
      narrow(table.slots[n].monomials[l], result.slots[n].monomials[l]);
    }
  }
  result.powers.resize(table.powers.size());
  for (std::size_t n = 0; n < table.powers.size(); ++n) {
    for (std::size_t l = 0; l <= kNormDegree; ++l) {
      narrow(table.powers[n].of_degree[l], result.powers[n].of_degree[l]);
    }
  }
  result.amplitude = narrowed(table.amplitude);
  result.amplitude_in_f = narrowed(table.amplitude_in_f);
  result.k = narrowed(table.k);
  result.minus_twice_kh = narrowed(table.minus_twice_kh);
  result.tail = narrowed(table.tail);
  return result;
}

}  // namespace

SeaExpansion::SeaExpansion(const Sea& sea)
    : slots(component_slots(sea.prepared().direction)), k_max(sea.max_wave_number()) {
  const PreparedComponents& prepared = sea.prepared();
  const std::size_t components = prepared.size();
  filled_components = (slots.place_count() + kColumnUnit - 1) / kColumnUnit * kColumnUnit;
  const auto filled = [this](const std::vector<double>& numbers) {
    std::vector<double> result(filled_components, 0.0);
    for (std::size_t i = 0; i < numbers.size(); ++i) result[slots.places[i]] = numbers[i];
    return result;
  };
  k1_W = filled(prepared.k1);
  k1_rest = filled(prepared.k1_rest);
  k2_W = filled(prepared.k2);
  k2_rest = filled(prepared.k2_rest);
  ExpansionTable<double>& table = double_precision;
  if (slots.any()) {
    table.slots.resize(slots.count);
    table.powers.resize(slots.blocks * slots.steps);
  } else {
    table.harmonics.resize(filled_components);
    table.monomials.resize(filled_components);
  }
  for (std::vector<double>* row :
       {&k1, &k2, &table.amplitude, &table.amplitude_in_f, &table.k, &table.minus_twice_kh, &table.tail}) {
    row->resize(filled_components, 0.0);
  }
  component_of_place.resize(filled_components, 0);
  double squares = 0.0;
  double thirds = 0.0;
  for (std::size_t i = 0; i < components; ++i) {
    const std::size_t place = slots.places[i];
    component_of_place[place] = static_cast<std::int64_t>(i);
    const double amplitude = prepared.amplitude[i];
    const double k = prepared.wave_number[i] / k_max;
    k1[place] = prepared.k1[i] / k_max;
    k2[place] = prepared.k2[i] / k_max;
    table.k[place] = k;
    table.minus_twice_kh[place] = -2.0 * prepared.wave_number[i] * sea.depth();
    table.amplitude[place] = k_max * amplitude;
    table.amplitude_in_f[place] = table.amplitude[place] / (1.0 + std::exp(table.minus_twice_kh[place]));
    const double angle = std::atan2(prepared.k2[i], prepared.k1[i]);
    if (slots.any()) {
      if (slots.begins_slot(place)) table.slots[slots.slot_of(place)] = slot_factors(angle);
      set_powers(k, place % kLanesOfStep, table.powers[place / kLanesOfStep]);
    } else {
      fill_rows(k, angle, table.harmonics[place], table.monomials[place]);
    }
    table.tail[place] = std::pow(k, kNormDegree + 1) / factorial(kNormDegree + 1);
    const double next = std::pow(k, kDegree + 1) / factorial(kDegree + 1);
    typical_norm = std::hypot(typical_norm, amplitude * next);
    tail += amplitude * table.tail[place];
    squares += 0.5 * amplitude * amplitude;
    const double third = 0.5 * amplitude * amplitude * std::pow(k, 6);
    thirds += third;
    typical_decay += third * k;
    amplitude_sums[0] += amplitude;
    amplitude_sums[1] += amplitude * prepared.wave_number[i];
    amplitude_sums[2] += amplitude * prepared.wave_number[i] * prepared.wave_number[i];
  }
  typical_elevation = std::sqrt(squares);
  typical_third = std::sqrt(thirds);
  if (thirds > 0.0) typical_decay /= thirds;
  single_precision = narrowed(table);
}

double SeaExpansion::reach_within(double error) const {
  constexpr double kShortest = 0.1;
  constexpr double kFactor = 0.9;
  const auto power = [](double x, int n) {
    double product = 1.0;
    for (int i = 0; i < n; ++i) product *= x;
    return product;
  };
  double reach = 4.0;
  for (; reach > kShortest; reach *= kFactor) {
    const double ratio = 1.0 / (1.0 - reach / (kNormDegree + 2));
    const double next = power(reach, kDegree + 1);
    const double left_out =
        typical_norm * next * (1.0 + 0.2 * reach) + tail * next * power(reach, kNormDegree - kDegree) * ratio;
    if (left_out <= error) break;
  }
  return reach;
}

}  // namespace buoyancy
