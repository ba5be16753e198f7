// What a person reads of the measurements: tables of time and error, and each thing that was promised of
// `hierarchical` beside what came out.
//
// A heading, a table and a few sentences per request, as Markdown: the same text stands in the documents.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "measurement.h"

namespace buoyancy::bench {

// What the moment tree of a mesh costs.
struct TreeCost {
  std::string mesh;
  std::size_t triangles = 0;
  double build_ns = 0.0;  // per triangle
  double bytes = 0.0;     // per triangle
};

struct BenchmarkResults {
  std::vector<Measurement> rows;
  std::vector<TreeCost> trees;
};

// The exponent e of time = c triangles^e that fits best in the least squares of the logarithms. At least two
// different numbers of triangles.
double fitted_exponent(const std::vector<const Measurement*>& rows);

void print_report(std::FILE* file, const BenchmarkResults& measured);

}  // namespace buoyancy::bench
