// Internal to wave_load.cpp: what its instruction sets share.
#pragma once

#include <cstddef>
#include <limits>

#include "base/vec3.h"
#include "wave_loads/patch_tree.h"
#include "wave_loads/sea_expansion.h"

namespace buoyancy {

// The caps on the work of a query.
inline constexpr std::size_t kMaxPatches = 20'000;
inline constexpr std::size_t kMaxCells = 4'096;

// The sea as one query sees it: phases at the body's centre, amplitudes now.
struct QueryPhases {
  std::vector<double> phase;  // [rad], per component, within a turn
  double amplitude_factor = 1.0;
};

struct WaveQuery {
  const PatchTree* tree = nullptr;
  const SeaExpansion* expansion = nullptr;
  QueryPhases phases;
  Vec3 e1_B = Vec3::UnitX(), e2_B = Vec3::UnitY(), up_B = Vec3::UnitZ();
  Vec3 reference = Vec3::Zero();                           // [m], B axes, from c
  double zeta = 0.0;                                       // [m], height of c over the level
  double depth = std::numeric_limits<double>::infinity();  // [m]
  bool hydrostatic = false;
  bool submerged = false;
  double max_lever = 1.0;  // [m], L_r
  double budget = 0.0;     // [m^3]
  double cell = 1.0;       // edge of a cell, over 1 / k_max
};

}  // namespace buoyancy
