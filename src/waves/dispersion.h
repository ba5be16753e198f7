// The dispersion relation of linear waves: angular_frequency^2 = g k tanh(k depth).
#pragma once

namespace buoyancy {

// Returns k [rad/m], with a relative error below 1e-15, the same bits on every machine. angular_frequency:
// [rad/s], > 0; gravity: [m/s^2], > 0; depth: [m], > 0, may be infinite.
double wave_number(double angular_frequency, double gravity, double depth);

}  // namespace buoyancy
