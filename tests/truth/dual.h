// Dual numbers: a value and its derivatives with respect to six parameters, propagated through every
// operation by the rules of differentiation (forward mode). They differentiate a templated kernel exactly.
#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

namespace buoyancy {

struct Dual {
  double value = 0.0;
  std::array<double, 6> slope{};

  Dual() = default;
  explicit Dual(double number) : value(number) {}
  static Dual parameter(std::size_t which, double number = 0.0) {
    Dual dual(number);
    dual.slope[which] = 1.0;
    return dual;
  }

  friend Dual operator-(Dual a) {
    a.value = -a.value;
    for (double& s : a.slope) s = -s;
    return a;
  }
  friend Dual operator+(const Dual& a, const Dual& b) { return combine(a.value + b.value, a, 1.0, b, 1.0); }
  friend Dual operator-(const Dual& a, const Dual& b) { return combine(a.value - b.value, a, 1.0, b, -1.0); }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return combine(a.value * b.value, a, b.value, b, a.value);
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double quotient = a.value / b.value;
    return combine(quotient, a, 1.0 / b.value, b, -quotient / b.value);
  }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  friend bool operator<(const Dual& a, const Dual& b) { return a.value < b.value; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value && a.slope == b.slope; }

 private:
  static Dual combine(double value, const Dual& a, double by_a, const Dual& b, double by_b) {
    Dual result(value);
    for (std::size_t i = 0; i < 6; ++i) result.slope[i] = by_a * a.slope[i] + by_b * b.slope[i];
    return result;
  }
};

}  // namespace buoyancy

// The names are Eigen's.
// NOLINTBEGIN(readability-identifier-naming)
template <>
struct Eigen::NumTraits<buoyancy::Dual> : Eigen::GenericNumTraits<double> {
  using Real = buoyancy::Dual;
  using NonInteger = buoyancy::Dual;
  using Nested = buoyancy::Dual;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 7,
    AddCost = 7,
    MulCost = 20
  };
};
// NOLINTEND(readability-identifier-naming)
