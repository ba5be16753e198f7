// Measurements of loads in waves, one per mesh, pressure, number of components, method and tolerance, and
// their CSV format and tables.
//
//   mesh,triangles,pressure,components,method,tolerance,median_ns,force_error,torque_error,force_bound,
//   torque_bound,capped
//
// method     hierarchical, exact_surface or fast_surface
// tolerance  of hierarchical; 0: a method without a tolerance
// median_ns  median time of a whole query over the poses
// *_error    largest error over the poses, relative to the whole: of force to rho g V_T, of torque to rho g
//            V_T L
// *_bound    largest published bound, likewise; inf: a method that does not know its error
// capped     number of poses where the work reached its cap
#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace buoyancy::bench {

struct WaveMeasurement {
  std::string mesh;
  std::size_t triangles = 0;
  std::string pressure;  // as in the scene file
  int components = 0;
  std::string method;
  double tolerance = 0.0;
  double median_ns = 0.0;
  double force_error = 0.0, torque_error = 0.0;
  double force_bound = 0.0, torque_bound = 0.0;
  int capped = 0;
};

void write_csv(std::FILE* file, const std::vector<WaveMeasurement>& measurements);

// Prints Markdown: the meshes at `components`, then all numbers of components on the largest mesh that was
// measured with each of them.
void print_wave_report(std::FILE* file, const std::vector<WaveMeasurement>& measurements, int components);

}  // namespace buoyancy::bench
