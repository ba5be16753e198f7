#include "tests/truth/rational.h"

#include <ostream>
#include <vector>

namespace buoyancy {

Rational::Rational() {
  mpq_init(&value_);
}

Rational::Rational(double number) : Rational() {
  mpq_set_d(&value_, number);
}

Rational::Rational(int number) : Rational() {
  mpq_set_si(&value_, number, 1);
}

Rational::Rational(int numerator, int denominator) : Rational(numerator) {
  *this /= Rational(denominator);
}

Rational::Rational(const Rational& other) : Rational() {
  mpq_set(&value_, &other.value_);
}

Rational::~Rational() {
  if (value_._mp_den._mp_d != nullptr) mpq_clear(&value_);
}

template <>
double Rational::convert_to<double>() const {
  return mpq_get_d(&value_);
}

int Rational::sign() const {
  return mpq_sgn(&value_);
}

Rational& Rational::operator+=(const Rational& b) {
  mpq_add(&value_, &value_, &b.value_);
  return *this;
}

Rational& Rational::operator-=(const Rational& b) {
  mpq_sub(&value_, &value_, &b.value_);
  return *this;
}

Rational& Rational::operator*=(const Rational& b) {
  mpq_mul(&value_, &value_, &b.value_);
  return *this;
}

Rational& Rational::operator/=(const Rational& b) {
  mpq_div(&value_, &value_, &b.value_);
  return *this;
}

Rational operator-(const Rational& a) {
  Rational result;
  mpq_neg(&result.value_, &a.value_);
  return result;
}

Rational operator+(const Rational& a, const Rational& b) {
  Rational result;
  mpq_add(&result.value_, &a.value_, &b.value_);
  return result;
}

Rational operator-(const Rational& a, const Rational& b) {
  Rational result;
  mpq_sub(&result.value_, &a.value_, &b.value_);
  return result;
}

Rational operator*(const Rational& a, const Rational& b) {
  Rational result;
  mpq_mul(&result.value_, &a.value_, &b.value_);
  return result;
}

Rational operator/(const Rational& a, const Rational& b) {
  Rational result;
  mpq_div(&result.value_, &a.value_, &b.value_);
  return result;
}

Rational abs(const Rational& a) {
  Rational result;
  mpq_abs(&result.value_, &a.value_);
  return result;
}

bool operator==(const Rational& a, const Rational& b) {
  return mpq_equal(&a.value_, &b.value_) != 0;
}

std::strong_ordering operator<=>(const Rational& a, const Rational& b) {
  return mpq_cmp(&a.value_, &b.value_) <=> 0;
}

std::ostream& operator<<(std::ostream& out, const Rational& a) {
  // The size that GMP requires: both numbers' digits, sign, slash and terminating zero.
  std::vector<char> text(mpz_sizeinbase(&a.value_._mp_num, 10) + mpz_sizeinbase(&a.value_._mp_den, 10) + 3);
  return out << mpq_get_str(text.data(), 10, &a.value_);
}

}  // namespace buoyancy
