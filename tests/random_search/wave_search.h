// The random search in waves: force, torque and volume that wave_load() gives must be within their own bounds
// of the truth. The sea itself must be that of the formulas at a few points of the body.
//
// Each mesh has 8 cases. The truth comes from reference_load(), whose own error is requested to be a
// twentieth of the bound; where it is more than a tenth the case is undecided, and counted as such.
#pragma once

#include <cstdint>
#include <functional>

#include "tests/random_search/search_engine.h"
#include "tests/random_search/wave_case.h"

namespace buoyancy {

inline constexpr std::int64_t kWaveCasesPerMesh = 8;

// wave_load(), or what a test puts in its place.
using EvaluateWaves =
    std::function<WaveLoad(const WaveBody&, const SeaExpansion&, const SeaSnapshot&, const WaveRequest&)>;
WaveLoad product_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                      const WaveRequest& request);

// Runs the cases begin <= number < end; both are multiples of kWaveCasesPerMesh. Instruction sets take turns,
// and every 16th case has all of them; because of force_simd_target(), no other thread may run hierarchical
// solvers meanwhile.
SearchStats search_waves(std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads,
                         const EvaluateWaves& evaluate);
// The figures of one load: errors over their bounds, "force", "torque" and "volume", where the truth is known
// well enough.
SearchFigures check_wave_load(const WaveSearchBody& mesh, const WaveRequest& request);
// A single case on every instruction set: its description, results and errors, and its violations.
SearchFailure replay_wave_case(std::uint64_t seed, std::int64_t number, const EvaluateWaves& evaluate);

RandomSearch wave_search();

}  // namespace buoyancy
