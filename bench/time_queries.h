// Times all methods on one mesh, interleaved sweep by sweep and method by method, so that disturbances of the
// machine affect all methods and their ratios stay meaningful.
//
// The time of a pose is that of one whole query, buoyancy(), between two readings of a steady clock minus the
// cost of the clock. A sweep evaluates every pose once, so that all other poses lie between two evaluations
// of the same pose. A method's turn is an untimed sweep and a timed one, so that the caches hold its own data
// and not those of the method before. The time of a pose is the minimum over the sweeps, whose number is the
// same for every method; the time of a row is the median over its poses.
//
// In the regime `cold` the caches are flushed before every query instead, outside of the timed part.
#pragma once

#include <array>
#include <vector>

#include "cache_flush.h"
#include "measurement.h"

namespace buoyancy::bench {

inline constexpr std::array kMeasuredTolerances{0.0, 1e-6, 1e-4, 1e-3, 1e-2};

// Rows: `read`; `plain`; the five methods of the paper and `hierarchical` at each tolerance on the best
// instruction set; `exact`, and `hierarchical` at tolerance 0, on each of the others. The results of all are
// checked before anything is timed. Errors: those of measure_errors().
Expected<std::vector<Measurement>> time_queries(const BenchmarkMesh& model, const PoseSet& set, int sweeps);

// Rows: `read`, `plain`, `exact` and `hierarchical` at tolerance 0. Errors: as above.
Expected<std::vector<Measurement>> time_cold_queries(const BenchmarkMesh& model, const PoseSet& set,
                                                     int sweeps, CacheFlush& flush);

}  // namespace buoyancy::bench
