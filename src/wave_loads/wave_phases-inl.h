// The phases of all components at a body's centre, with SIMD. Included once per instruction set.
#if defined(BUOYANCY_WAVE_PHASES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_PHASES_INL_H
#undef BUOYANCY_WAVE_PHASES_INL_H
#else
#define BUOYANCY_WAVE_PHASES_INL_H
#endif

#include <algorithm>
#include <cstddef>
#include <vector>

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_query.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

inline constexpr double kTurn = 6.283185307179586;             // 2 pi, rounded
inline constexpr double kRestOfTurn = 2.4492935982947064e-16;  // what the rounding took

// The rest of an angle [rad] within half a turn of 0.
HWY_INLINE VectorOf<double> within_turn(const VectorOf<double>& angle) {
  const VectorOf<double> turns = hn::Round(angle * set<double>(1.0 / kTurn));
  const auto whole = two_product(turns, set<double>(kTurn));
  const VectorOf<double> rest = (angle - whole.hi) - whole.lo;
  return rest - turns * set<double>(kRestOfTurn);
}

// The same to the rounding of the angle itself: enough where the angle was rounded as well.
HWY_INLINE VectorOf<double> near_zero(const VectorOf<double>& angle) {
  const VectorOf<double> turns = hn::Round(angle * set<double>(1.0 / kTurn));
  return hn::NegMulAdd(turns, set<double>(kTurn), angle);
}

// Sets the phase of each place's component at the body's centre [rad], within a few turns of 0; any where
// there is none. Exact to 1e-14 of a turn out to 1e9 wavelengths, as SeaSnapshot is.
HWY_INLINE void set_phases(const WaveQuery& query, std::vector<double>& phases) {
  const LanesOf<double> d;
  const SeaExpansion& sea = *query.expansion;
  if (phases.size() < sea.filled_components) phases.resize(sea.filled_components);
  const double* const of_components = query.sea->phases().data();
  const VectorOf<double> x1 = set<double>(query.x1);
  const VectorOf<double> x2 = set<double>(query.x2);
  for (std::size_t i = 0; i < sea.filled_components; i += kLanes<double>) {
    const auto along1 = two_product(hn::LoadU(d, &sea.k1_W[i]), x1);
    const auto along2 = two_product(hn::LoadU(d, &sea.k2_W[i]), x2);
    const auto along = two_sum(along1.hi, along2.hi);
    const VectorOf<double> small = hn::LoadU(d, &sea.k1_rest[i]) * x1 + hn::LoadU(d, &sea.k2_rest[i]) * x2 +
                                   ((along1.lo + along2.lo) + along.lo);
    const VectorOf<double> own = hn::GatherIndex(
        d, of_components, hn::LoadU(hn::RebindToSigned<LanesOf<double>>(), &sea.component_of_place[i]));
    const VectorOf<double> phase = within_turn(along.hi) + small + own;
    hn::StoreU(phase, d, &phases[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_PHASES_INL_H
