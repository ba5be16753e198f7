#include "waves/equal_energy_bins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace buoyancy {
namespace {

struct Node {
  double position;  // in [-1, 1]
  double weight;
};
constexpr std::array<Node, 5> kGaussLegendre{{{-0.9061798459386640, 0.2369268850561891},
                                              {-0.5384693101056831, 0.4786286704993665},
                                              {0.0, 0.5688888888888889},
                                              {0.5384693101056831, 0.4786286704993665},
                                              {0.9061798459386640, 0.2369268850561891}}};

}  // namespace

EqualEnergyBins::EqualEnergyBins(std::function<double(double)> density, std::span<const double> boundaries,
                                 Mean mean)
    : density_(std::move(density)), mean_(mean), boundaries_(boundaries.begin(), boundaries.end()) {
  Integral below;
  integral_below_.push_back(below);
  for (std::size_t i = 1; i < boundaries_.size(); ++i) {
    const Integral between = integrate(boundaries_[i - 1], boundaries_[i]);
    below.energy += between.energy;
    below.moment += between.moment;
    integral_below_.push_back(below);
  }
}

EqualEnergyBins::Integral EqualEnergyBins::integrate(double begin, double end) const {
  const double middle = 0.5 * (begin + end);
  const double half = 0.5 * (end - begin);
  Integral integral;
  for (const Node& node : kGaussLegendre) {
    const double x = middle + half * node.position;
    const double weighted = half * node.weight * density_(x);
    integral.energy += weighted;
    integral.moment += weighted * (mean_ == Mean::kArithmetic ? x : x * x);
  }
  return integral;
}

EqualEnergyBins::Integral EqualEnergyBins::integral_to(double energy) const {
  const auto after =
      std::upper_bound(integral_below_.begin() + 1, integral_below_.end() - 1, energy,
                       [](double wanted, const Integral& below) { return wanted < below.energy; });
  const auto i = static_cast<std::size_t>(after - integral_below_.begin());
  const double begin = boundaries_[i - 1];
  const double end = boundaries_[i];
  const Integral& below = integral_below_[i - 1];
  const double wanted = energy - below.energy;
  double place = begin + (end - begin) * wanted / (integral_below_[i].energy - below.energy);
  Integral part = integrate(begin, place);
  // Each step of Newton's method squares the error, which is a hundredth of the interval at first.
  constexpr int kSteps = 3;
  for (int step = 0; step < kSteps; ++step) {
    place = std::clamp(place + (wanted - part.energy) / density_(place), begin, end);
    part = integrate(begin, place);
  }
  return {energy, below.moment + part.moment};
}

std::vector<double> EqualEnergyBins::means(std::size_t bins) const {
  const double per_bin = energy() / static_cast<double>(bins);
  std::vector<double> means;
  means.reserve(bins);
  double moment_below = 0.0;
  for (std::size_t bin = 1; bin <= bins; ++bin) {
    const double moment_to =
        bin < bins ? integral_to(per_bin * static_cast<double>(bin)).moment : integral_below_.back().moment;
    const double mean = (moment_to - moment_below) / per_bin;
    means.push_back(mean_ == Mean::kArithmetic ? mean : std::sqrt(mean));
    moment_below = moment_to;
  }
  return means;
}

}  // namespace buoyancy
