// Error-free sums and products, sums of lanes, and the bits of masks, which the SIMD kernels of several
// folders share. This file is included once per instruction set, after highway.h.
#if defined(BUOYANCY_SIMD_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_SIMD_INL_H
#undef BUOYANCY_SIMD_INL_H
#else
#define BUOYANCY_SIMD_INL_H
#endif

#include <array>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename V>
HWY_INLINE V all(double value) {
  return hn::Set(hn::DFromV<V>(), value);
}

// The functions below apply those of double_double.h to each lane of a vector. Processors with a fused
// multiply-add compute the error of a product in one instruction; this error has the same bits unless it
// underflows.
template <typename V>
struct DoubleDoubles {
  V hi, lo;
};

template <typename V>
HWY_INLINE DoubleDoubles<V> two_sum(V a, V b) {
  const V sum = hn::Add(a, b);
  const V b_part = hn::Sub(sum, a);
  return {sum, hn::Add(hn::Sub(a, hn::Sub(sum, b_part)), hn::Sub(b, b_part))};
}

template <typename V>
HWY_INLINE DoubleDoubles<V> quick_two_sum(V a, V b) {
  const V sum = hn::Add(a, b);
  return {sum, hn::Sub(b, hn::Sub(sum, a))};
}

template <typename V>
HWY_INLINE DoubleDoubles<V> two_product(V a, V b) {
  const V product = hn::Mul(a, b);
#if HWY_NATIVE_FMA
  return {product, hn::MulSub(a, b, product)};
#else
  const V split = all<V>(134217729.0);  // 2^27 + 1
  const V a_scaled = hn::Mul(split, a);
  const V a_hi = hn::Sub(a_scaled, hn::Sub(a_scaled, a));
  const V a_lo = hn::Sub(a, a_hi);
  const V b_scaled = hn::Mul(split, b);
  const V b_hi = hn::Sub(b_scaled, hn::Sub(b_scaled, b));
  const V b_lo = hn::Sub(b, b_hi);
  V rest = hn::Sub(hn::Mul(a_hi, b_hi), product);
  rest = hn::Add(hn::Add(rest, hn::Mul(a_hi, b_lo)), hn::Mul(a_lo, b_hi));
  return {product, hn::Add(rest, hn::Mul(a_lo, b_lo))};
#endif
}

// Returns the sum of the lanes: as long as there are several, the upper half is added to the lower half. The
// order of Highway's SumOfLanes() depends on its version and on the instruction set.
template <typename V>
HWY_INLINE hn::TFromV<V> sum_of_lanes(V lanes) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(hn::DFromV<V>()) > 1) {
    const hn::Half<hn::DFromV<V>> half;
    return sum_of_lanes(hn::Add(hn::LowerHalf(half, lanes), hn::UpperHalf(half, lanes)));
  }
#endif
  return hn::GetLane(lanes);
}

// Returns the lanes of a mask as bits, the first lane in the lowest bit. Requires at most 16 lanes.
template <class D>
HWY_INLINE std::uint32_t mask_bits(D d, hn::Mask<D> mask) {
  static_assert(hn::MaxLanes(D()) <= 16);
  std::array<std::uint8_t, 8> bits{};
  hn::StoreMaskBits(d, mask, bits.data());
  return hn::MaxLanes(D()) <= 8 ? bits[0] : bits[0] + 256U * bits[1];
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_SIMD_INL_H
