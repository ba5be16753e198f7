// Rational numbers for the exact oracle, which never rounds.
//
// A thin class over GMP whose functions are compiled once: the headers of a general number library would
// dominate the time to compile a test source.
#pragma once

#include <compare>
#include <iosfwd>
#include <utility>

#include <Eigen/Core>
#include <gmp.h>

namespace buoyancy {

class Rational {
 public:
  Rational();
  // Implicit, so that expressions may mix types: every finite double and every int is a rational number.
  Rational(double number);  // NOLINT(google-explicit-constructor)
  Rational(int number);     // NOLINT(google-explicit-constructor)
  Rational(int numerator, int denominator);
  Rational(const Rational& other);
  Rational(Rational&& other) noexcept : value_(other.value_) { other.value_._mp_den._mp_d = nullptr; }
  Rational& operator=(const Rational& other) { return *this = Rational(other); }
  Rational& operator=(Rational&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Rational();

  // T: double. Rounds towards zero.
  template <typename T>
  T convert_to() const;

  int sign() const;  // -1, 0 or 1

  Rational& operator+=(const Rational& b);
  Rational& operator-=(const Rational& b);
  Rational& operator*=(const Rational& b);
  Rational& operator/=(const Rational& b);
  friend Rational operator-(const Rational& a);
  friend Rational operator+(const Rational& a, const Rational& b);
  friend Rational operator-(const Rational& a, const Rational& b);
  friend Rational operator*(const Rational& a, const Rational& b);
  friend Rational operator/(const Rational& a, const Rational& b);
  friend Rational abs(const Rational& a);
  friend bool operator==(const Rational& a, const Rational& b);
  friend std::strong_ordering operator<=>(const Rational& a, const Rational& b);
  friend std::ostream& operator<<(std::ostream& out, const Rational& a);

 private:
  __mpq_struct value_;  // has no denominator in a moved-from object
};

template <>
double Rational::convert_to<double>() const;

}  // namespace buoyancy

// The names are Eigen's.
// NOLINTBEGIN(readability-identifier-naming)
template <>
struct Eigen::NumTraits<buoyancy::Rational> : Eigen::GenericNumTraits<double> {
  using Real = buoyancy::Rational;
  using NonInteger = buoyancy::Rational;
  using Nested = buoyancy::Rational;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 10,
    AddCost = 100,
    MulCost = 100
  };
};
// NOLINTEND(readability-identifier-naming)
