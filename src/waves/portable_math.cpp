#include "waves/portable_math.h"

#include <cmath>

#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

namespace buoyancy::portable {
namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

double rounded(const Quad& x) {
  return x.convert_to<double>();
}

}  // namespace

double exp(double x) {
  return rounded(boost::multiprecision::exp(Quad(x)));
}

double log(double x) {
  return rounded(boost::multiprecision::log(Quad(x)));
}

double tanh(double x) {
  return rounded(boost::multiprecision::tanh(Quad(x)));
}

SinCos sin_cos_of_degrees(double degrees) {
  // The nearest multiple of 90 degrees and the angle from it are both exact.
  const double within_turn = std::remainder(degrees, 360.0);
  const double quarters = std::nearbyint(within_turn / 90.0);
  const Quad angle = (Quad(within_turn) - Quad(90.0 * quarters)) * (boost::math::constants::pi<Quad>() / 180);
  const Quad s = boost::multiprecision::sin(angle);
  const Quad c = boost::multiprecision::cos(angle);
  Quad sine = s;
  Quad cosine = c;
  switch (static_cast<int>(quarters)) {
    case 1:
      sine = c;
      cosine = -s;
      break;
    case -1:
      sine = -c;
      cosine = s;
      break;
    case 2:
    case -2:
      sine = -s;
      cosine = -c;
      break;
    default:
      break;
  }
  SinCos result;
  result.sin = rounded(sine);
  result.sin_rest = rounded(sine - result.sin);
  result.cos = rounded(cosine);
  result.cos_rest = rounded(cosine - result.cos);
  return result;
}

}  // namespace buoyancy::portable
