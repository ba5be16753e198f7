// The random search in waves: force, torque and volume that wave_load() gives must be within their own bounds
// of the truth. The sea itself must be that of the formulas at a few points of the body.
//
// Cases are numbered from 0; each depends only on the seed and its number, not on the number of threads or on
// where a run begins. Each mesh has 8 cases. The truth comes from reference_load(), whose own error is
// requested to be a twentieth of the bound; where it is more than a tenth the case is undecided, and counted
// as such.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/random_search/wave_case.h"
#include "tests/wave_loads/reference_load.h"

namespace buoyancy {

inline constexpr std::int64_t kWaveCasesPerMesh = 8;

// How many loads have a ratio of bound to error of this much: per decade 20 bins, from 1 on.
class RatioHistogram {
 public:
  static constexpr std::size_t kBins = 200;
  std::array<std::int64_t, kBins> counts{};

  void add(double ratio);
  RatioHistogram& operator+=(const RatioHistogram& other);
  double median() const;  // 0 if empty
};

struct LargestInWaves {
  double value = 0.0;
  std::int64_t at = -1;  // the case's number
};

// The results of a run, of one kind of sea.
struct WaveFigures {
  std::int64_t cases = 0;
  std::int64_t loads = 0;      // cases times instruction sets
  std::int64_t undecided = 0;  // cases whose truth is not known well enough
  std::int64_t capped = 0;     // cases
  std::int64_t too_steep = 0;
  // Cases whose mean wavelength is above twice the body's diagonal, and those of them whose bound is within
  // the tolerance.
  std::int64_t long_waves = 0, long_within = 0;
  LargestInWaves force, torque, volume;  // error over bound
  RatioHistogram ratios;                 // of forces

  WaveFigures& operator+=(const WaveFigures& other);
};

struct FailedWaveCase {
  std::int64_t number = 0;
  std::string text;  // everything about the case
  std::vector<std::string> violations;
};

// The results of a run; those of several runs can be added.
struct WaveSearchStats {
  std::int64_t failed_cases = 0;
  std::array<WaveFigures, kSeaKinds.size()> figures{};
  std::vector<FailedWaveCase> failures;  // the first hundred

  std::int64_t cases() const;
  WaveFigures total() const;
  WaveSearchStats& operator+=(const WaveSearchStats& other);
};

// wave_load(), or what a test puts in its place.
using EvaluateWaves =
    std::function<WaveLoad(const WaveBody&, const SeaExpansion&, const SeaSnapshot&, const WaveRequest&)>;
WaveLoad product_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                      const WaveRequest& request);

// Runs the cases begin <= number < end; both are multiples of kWaveCasesPerMesh. Instruction sets take turns,
// and every 16th case has all of them; because of force_simd_target(), no other thread may run hierarchical
// solvers meanwhile.
WaveSearchStats search_waves(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads,
                             const EvaluateWaves& evaluate = product_load);

// A single case on every instruction set: its description, results and errors, and its violations.
struct WaveReplay {
  std::string text;
  std::vector<std::string> violations;
};
WaveReplay replay_wave_case(std::uint64_t seed, std::int64_t number,
                            const EvaluateWaves& evaluate = product_load);

}  // namespace buoyancy
