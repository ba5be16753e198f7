// Times all methods on one mesh, sweep by sweep and method by method, so that what disturbs the machine
// disturbs all of them and their ratios mean something.
//
// The time of a pose is that of one whole query, buoyancy(), between two readings of a steady clock whose own
// cost is subtracted. A sweep asks for every pose once, so that between two visits of a pose lie all others.
// A method's turn is an untimed sweep and a timed one: what its caches hold is its own, not what the method
// before it left. A pose's time is its least over the sweeps, the same number for every method; a row's is
// the median over its poses.
#pragma once

#include <array>
#include <vector>

#include "measurement.h"

namespace buoyancy::bench {

inline constexpr std::array kMeasuredTolerances{0.0, 1e-6, 1e-4, 1e-3, 1e-2};

// Rows: `read`; the five methods of the paper; `hierarchical` at each tolerance on the best instruction set,
// and exact on each of the others. The results of all are checked before anything is timed; errors:
// measure_errors.
Expected<std::vector<Measurement>> time_queries(const BenchmarkMesh& model, const PoseSet& set, int sweeps);

}  // namespace buoyancy::bench
