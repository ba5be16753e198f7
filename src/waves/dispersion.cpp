#include "waves/dispersion.h"

#include <cmath>

#include "waves/portable_math.h"

namespace buoyancy {

double wave_number(double angular_frequency, double gravity, double depth) {
  const double deep = angular_frequency * angular_frequency / gravity;
  const double y = deep * depth;
  // From k depth = 20 on, tanh(k depth) is 1 to the last bit.
  if (!(y < 20.0)) return deep;
  // The equation x tanh(x) = y for x = k depth. The start, accurate to a thousandth, is that of J. N. Hunt,
  // "Direct solution of wave dispersion equation", Journal of the Waterway, Port, Coastal and Ocean Division
  // 105 (1979). Each step of Newton's method squares the error.
  const double series =
      1.0 + y * (0.6666666666 +
                 y * (0.3555555555 +
                      y * (0.1608465608 + y * (0.0632098765 + y * (0.0217540484 + y * 0.0065407983)))));
  double x = std::sqrt(y * (y + 1.0 / series));
  constexpr int kSteps = 3;
  for (int step = 0; step < kSteps; ++step) {
    const double t = portable::tanh(x);
    x -= (x * t - y) / (t + x * (1.0 - t * t));
  }
  return x / depth;
}

}  // namespace buoyancy
