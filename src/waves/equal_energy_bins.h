// Splits a density into bins of equal energy, for spectra over the frequency and over the direction.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace buoyancy {

class EqualEnergyBins {
 public:
  // The energy-weighted mean that represents a bin. The root mean square keeps the density's second moment.
  enum class Mean { kArithmetic, kRootMeanSquare };

  // density: positive almost everywhere, and smooth between neighbours of the ascending boundaries. It is
  // integrated with five points of Gauss-Legendre quadrature between neighbours.
  EqualEnergyBins(std::function<double(double)> density, std::span<const double> boundaries, Mean mean);

  double energy() const { return integral_below_.back().energy; }  // the integral of the density
  // Returns the means of `bins` bins of equal energy, ascending.
  std::vector<double> means(std::size_t bins) const;

 private:
  struct Integral {
    double energy = 0.0;  // of the density
    double moment = 0.0;  // of the density times the variable or its square
  };

  Integral integrate(double begin, double end) const;
  // Returns the integral up to the value of the variable below which there is this energy.
  Integral integral_to(double energy) const;

  std::function<double(double)> density_;
  Mean mean_;
  std::vector<double> boundaries_;
  std::vector<Integral> integral_below_;  // one entry per boundary
};

}  // namespace buoyancy
