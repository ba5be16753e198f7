// Internal to the methods that sum over all components at every point: the components of a sea as one query
// sees them, about the body's centre.
#pragma once

#include <cstdint>
#include <vector>

#include "waves/elevation_spline.h"
#include "waves/sea_snapshot.h"

namespace buoyancy {

// Number: float or double. A component's phase in turns is k1 x1 + k2 x2 + phase, where x1 and x2 are the
// distances from the body's centre along the horizontal axes.
template <typename Number>
struct DirectSea {
  struct Component {
    Number k1, k2;     // [1/m], over 2 pi
    Number phase;      // at the body's centre, within half a turn
    Number amplitude;  // [m], now
  };
  // Consecutive components of one wave number k, such as those of the directions of one frequency, share
  //   E(z') = (2^(rate z') + 2^(-rate z' - twice_depth)) scale = cosh k(z' + h) / cosh kh,
  // and in deep water 2^(rate z').
  struct Group {
    std::uint32_t end;   // its components end before this one
    bool bed_matters;    // otherwise the second term is below the rounding of the first
    Number rate;         // [1/m], k / ln 2
    Number twice_depth;  // 2 k h / ln 2
    Number scale;        // 1 / (1 + exp(-2 k h))
  };
  static constexpr std::size_t kMaxGroup = 64;  // so that the rounding errors of a sum do not add up

  const ElevationBlend* surface = nullptr;  // of a sea on grids, which has no components
  double x1 = 0.0, x2 = 0.0;                // [m], of the body's centre
  std::vector<Component> components;
  std::vector<Group> groups;
  Number per_depth = 0;  // [1/m], 1 / h; 0 in deep water
  Number bed = 0;        // [m], -h; the lowest number in deep water

  // center_x1, center_x2: the body's centre [m]. scratch: phases.
  void prepare(const SeaSnapshot& sea, double center_x1, double center_x2, std::vector<double>& scratch);
};

}  // namespace buoyancy
