// The random search for motions that gain energy (docs/simulator.md): bodies with drag and added mass in
// water at rest, moved by the simulator with wrenches from the request handler.
//
// A submerged, neutrally buoyant body never gains kinetic energy, that of the added mass included, from one
// step to the next: beyond rounding. The mechanical energy of a body that pierces the surface never exceeds
// its start by more than that of the same body without drag does, or by more than the documented oscillation
// of the integrator within the step limit, as a fraction of the largest kinetic energy of both. Nothing
// becomes non-finite.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/random_search/motion_case.h"

namespace buoyancy {

// Growth of the kinetic energy in a step, as a fraction of itself, that counts as rounding.
inline constexpr double kRoundingGrowth = 1e-10;

// The energy's oscillation at a step times frequency of 0.5, as docs/simulator.md states it.
constexpr double documented_oscillation(Integrator integrator) {
  return integrator == Integrator::kVelocityVerlet ? 0.06 : 0.25;
}

struct LargestRise {
  double value = 0.0;
  std::int64_t at = -1;  // the case's number

  void add(double rise, std::int64_t number) {
    if (rise > value) *this = {rise, number};
  }
};

// The results of cases of one row of the table.
struct MotionFigures {
  std::int64_t cases = 0;
  std::int64_t steps = 0;
  LargestRise rise;            // relative to the kinetic energy before, or to the largest
  LargestRise rise_undamped;   // of the same bodies without drag
  std::int64_t above_own = 0;  // cases whose rise exceeds that without drag

  MotionFigures& operator+=(const MotionFigures& other);
};

struct FailedMotionCase {
  std::int64_t number = 0;
  std::string text;
  std::string violation;
};

struct MotionSearchStats {
  std::array<MotionFigures, 3> figures{};  // submerged; piercing by velocity_verlet, semi_implicit_euler
  std::vector<FailedMotionCase> failures;

  MotionSearchStats& operator+=(const MotionSearchStats& other);
};

// Runs the cases begin <= number < end.
MotionSearchStats search_motions(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads);

// A Markdown table of the figures.
std::string markdown(const MotionSearchStats& stats);

}  // namespace buoyancy
