// Elementary functions that return the same bits with every compiler, C library and processor.
//
// The functions of the C library differ in the last bit between versions, and between processors with and
// without fused multiply-add. These are computed with 113 bits in software and rounded once, in some
// microseconds, which suffices because a sea is prepared once per scene.
#pragma once

namespace buoyancy::portable {

double exp(double x);
double log(double x);
double tanh(double x);

struct SinCos {
  double sin = 0.0;
  double sin_rest = 0.0;  // the rounding error: sin + sin_rest has more than 100 bits
  double cos = 1.0;
  double cos_rest = 0.0;
};
// The result is exact at multiples of 90 degrees. degrees: finite.
SinCos sin_cos_of_degrees(double degrees);

}  // namespace buoyancy::portable
