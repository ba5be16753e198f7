// Measurements, one per mesh, method, tolerance, instruction set and regime, and their CSV format.
//
//   mesh,triangles,method,tolerance,target,regime,median_ns,force_error,torque_error,bound
//
// method      one of the six; `plain`: the paper's exact method in plain C++ (plain_exact.h); `read`: the
// time
//             to read vertices and indices once
// tolerance   of the solver; 0: exact, or a method without a tolerance
// target      the instruction set of `hierarchical` and `exact`; -: another method, on the best one
// regime      independent: 100 poses from almost dry to almost submerged with random rotations;
//             coherent: 100 steps of a floating body's trajectory; both with the caches as the method's own
//             queries leave them;
//             cold: every fourth pose of `independent`, with the caches flushed before every query; only
//             `read`, `plain`, `exact` and `hierarchical` at tolerance 0 on the best instruction set
// median_ns   median time of a whole query over the poses
// *_error     largest error over the poses, relative to the whole: of force to rho g V_T, of torque to rho g
//             V_T L; nan for `read`
// bound       largest published force error bound over rho g V_T; nan for `read` and `plain`
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "reference_results.h"

namespace buoyancy::bench {

inline constexpr const char* kMemoryReadRow = "read";
inline constexpr const char* kPlainRow = "plain";
inline constexpr const char* kNoTarget = "-";

inline constexpr const char* kIndependentRegime = "independent";
inline constexpr const char* kCoherentRegime = "coherent";
inline constexpr const char* kColdRegime = "cold";

struct Measurement {
  std::string mesh;
  std::size_t triangles = 0;
  std::string method;
  double tolerance = 0.0;
  std::string target = kNoTarget;
  std::string regime;
  double median_ns = 0.0;
  SolverErrors errors;
};

void write_csv(std::FILE* file, const std::vector<Measurement>& measurements);

// Returns the matching measurement, or nullptr. target "": the first one, which is the best instruction set.
const Measurement* find_measurement(const std::vector<Measurement>& measurements, const std::string& mesh,
                                    std::size_t triangles, const std::string& method, double tolerance,
                                    const std::string& target, const std::string& regime);

}  // namespace buoyancy::bench
