// The descent in a sea on grids in single precision, for all instruction sets.
#define HWY_BROKEN_EMU128 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wave_loads/wave_spline_descent_single.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "wave_loads/wave_descent-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_spline-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

WaveLoad descend_on_spline_single(const WaveQuery& query) {
  return run_descent<float, PatchesOnSpline>(query);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(descend_on_spline_single);

WaveLoad descend_on_spline_in_single_precision(const WaveQuery& query) {
  return HWY_DYNAMIC_DISPATCH(descend_on_spline_single)(query);
}

}  // namespace buoyancy
#endif  // HWY_ONCE
