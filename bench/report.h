// Report of the measurements: tables of time and error, and the goals of `hierarchical` with the measured
// values.
//
// Each section has a heading, a table and a few sentences, as Markdown. The documentation contains the same
// text.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "measurement.h"

namespace buoyancy::bench {

// Build time and memory of the moment tree of a mesh.
struct TreeCost {
  std::string mesh;
  std::size_t triangles = 0;
  double build_ns = 0.0;  // per triangle
  double bytes = 0.0;     // per triangle
};

struct BenchmarkResults {
  std::vector<Measurement> measurements;
  std::vector<TreeCost> trees;
};

// Exponent e of time = c triangles^e by a least-squares fit of the logarithms. Precondition: at least two
// different numbers of triangles.
double fitted_exponent(const std::vector<const Measurement*>& measurements);

void print_report(std::FILE* file, const BenchmarkResults& results);

}  // namespace buoyancy::bench
