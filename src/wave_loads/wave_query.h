// Internal to wave_load.cpp and its descents: what all instruction sets share.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/vec3.h"
#include "wave_loads/patch_tree.h"
#include "wave_loads/sea_expansion.h"
#include "wave_loads/wave_load.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {

// The caps on the work of a query.
inline constexpr std::size_t kMaxPatches = 20'000;
inline constexpr std::size_t kMaxCells = 2'048;    // of the surface, and of the volume, before a round
inline constexpr std::size_t kMaxPlaces = 4'096;   // in the cells' grid, as well
inline constexpr std::size_t kMaxGroups = 20'000;  // of a round; a result that is replaced may add some more
// The number of components up to which these caps hold. Beyond, cells and groups are as many fewer: the
// expansion of a cell, which a group may need, sums over all components.
inline constexpr std::size_t kCappedComponents = 256;

// No group, cell or model.
inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// The rounding error of an expansion, over the sum of its terms' absolute values and the unit roundoff.
inline constexpr double kRoundingFactor = 100.0;

// Cells are boxes of the same size, all but the highest ones twice as high. Lengths over 1 / k_max,
// horizontally from the body's centre, heights z' over the level.
struct CellGrid {
  std::array<double, 3> edge{1.0, 1.0, 1.0};
  std::array<double, 3> origin{};  // a corner of cells in x1 and x2, the top of cells in z
};

struct WaveQuery {
  const PatchTree* tree = nullptr;
  const SeaExpansion* expansion = nullptr;  // of the components
  const SeaSnapshot* sea = nullptr;
  double k_max = 1.0;  // [rad/m]: lengths in the sea are in units of its inverse
  // [m], what counts as the level: added to that of the water at rest.
  double mean_elevation = 0.0;
  double max_elevation = 0.0;  // [m], A_0: no crest is higher and no trough deeper
  double max_slope = 0.0;      // bound on the slope of the surface
  Vec3 e1_B = Vec3::UnitX(), e2_B = Vec3::UnitY(), up_B = Vec3::UnitZ();
  Vec3 reference = Vec3::Zero();                           // [m], B axes, from c
  double x1 = 0.0, x2 = 0.0;                               // [m], of c, along the horizontal axes
  double zeta = 0.0;                                       // [m], height of c over what counts as the level
  double depth = std::numeric_limits<double>::infinity();  // [m]
  bool hydrostatic = false;
  bool submerged = false;
  double usual_elevation = 0.0;  // [m], twice the root mean square, which waves seldom exceed
  // About the error of a wet patch over its mu3 [1/m^2], and the rate at which it falls with the depth [1/m].
  double usual_wet_error = 0.0, usual_decay = 0.0;
  double displacement = 0.0;  // [m], of the tree's surface from the body's
  double max_lever = 1.0;     // [m], L_r
  double budget = 0.0;        // [m^3]
  CellGrid grid;

  bool deep_water() const { return std::isinf(depth); }
  // Of the caps that hold for up to kCappedComponents.
  std::size_t cap_on(std::size_t most) const {
    const std::size_t components = expansion == nullptr ? 0 : expansion->filled_components;
    return most * kCappedComponents / std::max(kCappedComponents, components);
  }
};

// The load by a descent through the patches, with the best instruction set of this processor. One source
// each, so that they compile at the same time.
WaveLoad descend_in_single_precision(const WaveQuery& query);
WaveLoad descend_in_double_precision(const WaveQuery& query);
// The same in a sea on grids.
WaveLoad descend_on_spline_in_single_precision(const WaveQuery& query);
WaveLoad descend_on_spline_in_double_precision(const WaveQuery& query);

}  // namespace buoyancy
