// Double-double arithmetic: an unevaluated sum hi + lo of two doubles, |lo| <= ulp(hi)/2, about 32 decimal
// digits.
//
// It is used where large numbers cancel almost completely: to move the water plane to other points of the
// body, and to reduce the phases of waves. Source: T. J. Dekker, "A floating-point technique for extending
// the available precision", Numerische Mathematik 18 (1971). The relative error of each operation is below
// 2^-100 as long as nothing over- or underflows. The same operations on vectors are in base/simd-inl.h and
// hydrostatics/water_plane.cpp.
#pragma once

namespace buoyancy {

struct DoubleDouble {
  double hi = 0.0;
  double lo = 0.0;
};

// Returns a + b exactly.
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b;
  const double b_part = sum - a;
  return {sum, (a - (sum - b_part)) + (b - b_part)};
}

// Returns a + b exactly if |a| >= |b| or a is 0.
inline DoubleDouble quick_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

// Returns a * b exactly if |a|, |b| < 2^996 and the product does not underflow.
inline DoubleDouble two_product(double a, double b) {
  constexpr double kSplit = 134217729.0;  // 2^27 + 1
  const double product = a * b;
  const double a_scaled = kSplit * a;
  const double a_hi = a_scaled - (a_scaled - a);
  const double a_lo = a - a_hi;
  const double b_scaled = kSplit * b;
  const double b_hi = b_scaled - (b_scaled - b);
  const double b_lo = b - b_hi;
  return {product, ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

inline DoubleDouble operator-(DoubleDouble a) {
  return {-a.hi, -a.lo};
}

inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble hi = two_sum(a.hi, b.hi);
  const DoubleDouble lo = two_sum(a.lo, b.lo);
  const DoubleDouble middle = quick_two_sum(hi.hi, hi.lo + lo.hi);
  return quick_two_sum(middle.hi, middle.lo + lo.lo);
}

inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) {
  return a + (-b);
}

inline DoubleDouble operator*(DoubleDouble a, double b) {
  const DoubleDouble product = two_product(a.hi, b);
  return quick_two_sum(product.hi, product.lo + a.lo * b);
}

inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble product = two_product(a.hi, b.hi);
  return quick_two_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

// Returns 1 / a, for finite a other than 0.
inline DoubleDouble reciprocal(DoubleDouble a) {
  const double first = 1.0 / a.hi;
  const DoubleDouble product = two_product(a.hi, first);
  const double rest = ((1.0 - product.hi) - product.lo) - a.lo * first;
  return quick_two_sum(first, rest * first);
}

}  // namespace buoyancy
