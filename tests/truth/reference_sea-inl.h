// The sum over the components of a ReferenceSea at many points, with SIMD. Included once per instruction set,
// after highway.h.
#if defined(BUOYANCY_REFERENCE_SEA_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_REFERENCE_SEA_INL_H
#undef BUOYANCY_REFERENCE_SEA_INL_H
#else
#define BUOYANCY_REFERENCE_SEA_INL_H
#endif

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "tests/truth/reference_sea.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// points: a multiple of kMaxLanes of them. pressure: null for heights alone.
void evaluate_sea(const ReferenceSea::View& sea, std::size_t points, const double* x, const double* y,
                  const double* z, double* height, double* pressure) {
  const hn::CappedTag<double, 8> d;
  using V = hn::Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  thread_local std::vector<double> cosines;
  cosines.resize(sea.components * lanes);
  const V zero = hn::Zero(d);
  const V h = hn::Set(d, sea.depth);
  const bool deep = std::isinf(sea.depth);
  for (std::size_t p = 0; p < points; p += lanes) {
    const V at_x = hn::LoadU(d, x + p);
    const V at_y = hn::LoadU(d, y + p);
    const V at_z = hn::LoadU(d, z + p);
    const auto along = [&](const std::array<double, 3>& axis) {
      return hn::MulAdd(at_x, hn::Set(d, axis[0]),
                        hn::MulAdd(at_y, hn::Set(d, axis[1]), at_z * hn::Set(d, axis[2])));
    };
    const V x1 = along(sea.e1_B);
    const V x2 = along(sea.e2_B);
    const V zeta = along(sea.up_B) + hn::Set(d, sea.zeta);
    V eta = zero;
    for (std::size_t i = 0; i < sea.components; ++i) {
      const V theta = hn::MulAdd(hn::Set(d, sea.k1[i]), x1,
                                 hn::MulAdd(hn::Set(d, sea.k2[i]), x2, hn::Set(d, sea.theta[i])));
      const V of_component = hn::Set(d, sea.amplitude[i]) * hn::Cos(d, theta);
      hn::StoreU(of_component, d, cosines.data() + i * lanes);
      eta = eta + of_component;
    }
    const V s = zeta - eta;
    hn::StoreU(s, d, height + p);
    if (pressure == nullptr) continue;
    if (sea.hydrostatic) {
      hn::StoreU(hn::Neg(s), d, pressure + p);
      continue;
    }
    V stretched = s;
    if (!deep) {
      // Held at the bed, below it and where a trough uncovers it.
      const V column = h + eta;
      const V free = hn::Max(h * s / column, hn::Neg(h));
      stretched = hn::IfThenElse(hn::Gt(column, zero), free, hn::Neg(h));
    }
    V f = zero;
    for (std::size_t i = 0; i < sea.components; ++i) {
      const V exponent = hn::Set(d, sea.k[i]) * stretched;
      V decay = hn::Exp(d, exponent);
      if (!deep) {
        // cosh k(z' + h) / cosh kh by exponentials that do not overflow.
        decay = (decay + hn::Exp(d, hn::Neg(exponent) - hn::Set(d, sea.twice_depth[i]))) *
                hn::Set(d, sea.finite_scale[i]);
      }
      f = hn::MulAdd(hn::LoadU(d, cosines.data() + i * lanes), decay, f);
    }
    hn::StoreU(f - zeta, d, pressure + p);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_REFERENCE_SEA_INL_H
