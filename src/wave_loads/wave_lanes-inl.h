// Vectors of numbers and of points, one per lane, for the wave loads. Included once per instruction set,
// after highway.h.
#if defined(BUOYANCY_WAVE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_LANES_INL_H
#undef BUOYANCY_WAVE_LANES_INL_H
#else
#define BUOYANCY_WAVE_LANES_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "wave_loads/patch_tree.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

template <typename Number>
using LanesOf = hn::CappedTag<Number, 16>;
template <typename Number>
using VectorOf = hn::Vec<LanesOf<Number>>;
template <typename Number>
inline constexpr std::size_t kLanes = hn::MaxLanes(LanesOf<Number>());

// Lanes that come from one block: siblings, or the triangles of a block.
template <typename Number>
inline constexpr std::size_t kGroup = std::min<std::size_t>(kLanes<Number>, kSiblings);
template <typename Number>
inline constexpr std::size_t kGroupsPerVector = kLanes<Number> / kGroup<Number>;
template <typename Number>
using GroupTag = hn::CappedTag<Number, kGroup<Number>>;

template <typename Number>
HWY_INLINE VectorOf<Number> set(double number) {
  return hn::Set(LanesOf<Number>(), static_cast<Number>(number));
}

// A vector of kGroupsPerVector groups, each made by group(n).
template <typename Number, typename MakeGroup>
HWY_INLINE VectorOf<Number> combine_groups(const MakeGroup& group) {
#if HWY_TARGET == HWY_SCALAR
  return group(0);
#else
  if constexpr (kGroupsPerVector<Number> == 1) {
    return group(0);
  } else {
    const LanesOf<Number> d;
    if constexpr (kGroupsPerVector<Number> == 2) {
      return hn::Combine(d, group(1), group(0));
    } else {
      const hn::Half<LanesOf<Number>> half;
      return hn::Combine(d, hn::Combine(half, group(3), group(2)), hn::Combine(half, group(1), group(0)));
    }
  }
#endif
}

// Reads kGroup numbers at each of kGroupsPerVector places.
template <typename Number, typename Place>
HWY_INLINE VectorOf<Number> gather_groups(const Place& place) {
  return combine_groups<Number>([&](std::size_t n) {
    const GroupTag<Number> d;
    const auto* const numbers = place(n);
    if constexpr (sizeof(*numbers) == sizeof(Number)) {
      return hn::LoadU(d, numbers);
    } else {
      return hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, GroupTag<Number>>(), numbers));
    }
  });
}

// Repeats the number at each of kGroupsPerVector places in all lanes of its group.
template <typename Number, typename Place>
HWY_INLINE VectorOf<Number> spread_groups(const Place& place) {
  return combine_groups<Number>([&](std::size_t n) { return hn::Set(GroupTag<Number>(), *place(n)); });
}

// The sum over the lanes of each group, in all lanes of the group.
template <typename Number>
HWY_INLINE VectorOf<Number> sums_of_groups(VectorOf<Number> numbers) {
  const LanesOf<Number> d;
  if constexpr (kGroup<Number> == 4) numbers = numbers + hn::Reverse4(d, numbers);
  if constexpr (kGroup<Number> >= 2) numbers = numbers + hn::Reverse2(d, numbers);
  return numbers;
}

template <typename Number>
struct Vectors3 {
  VectorOf<Number> x, y, z;
};

template <typename Number>
HWY_INLINE VectorOf<Number> dot(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, a.z * b.z));
}
template <typename Number>
HWY_INLINE Vectors3<Number> cross(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return {hn::MulSub(a.y, b.z, a.z * b.y), hn::MulSub(a.z, b.x, a.x * b.z), hn::MulSub(a.x, b.y, a.y * b.x)};
}
template <typename Number>
HWY_INLINE Vectors3<Number> operator-(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename Number>
HWY_INLINE Vectors3<Number> operator+(const Vectors3<Number>& a, const Vectors3<Number>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename Number>
HWY_INLINE Vectors3<Number> scaled(const VectorOf<Number>& s, const Vectors3<Number>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

// Symmetric 3 x 3 matrices: xx, yy, zz, xy, xz, yz.
template <typename Number>
using Symmetric = std::array<VectorOf<Number>, 6>;

template <typename Number>
HWY_INLINE Vectors3<Number> product(const Symmetric<Number>& h, const Vectors3<Number>& y) {
  return {hn::MulAdd(h[0], y.x, hn::MulAdd(h[3], y.y, h[4] * y.z)),
          hn::MulAdd(h[3], y.x, hn::MulAdd(h[1], y.y, h[5] * y.z)),
          hn::MulAdd(h[4], y.x, hn::MulAdd(h[5], y.y, h[2] * y.z))};
}
template <typename Number>
HWY_INLINE VectorOf<Number> frobenius_squared(const Symmetric<Number>& h) {
  const auto two = set<Number>(2.0);
  const auto off = hn::MulAdd(h[3], h[3], hn::MulAdd(h[4], h[4], h[5] * h[5]));
  return hn::MulAdd(two, off, hn::MulAdd(h[0], h[0], hn::MulAdd(h[1], h[1], h[2] * h[2])));
}

// The lanes of a mask, the first in the lowest bit.
template <typename Number>
HWY_INLINE std::uint32_t bits_of(const hn::Mask<LanesOf<Number>>& mask) {
  return mask_bits(LanesOf<Number>(), mask);
}

template <typename Number>
HWY_INLINE hn::Mask<LanesOf<Number>> set_mask(bool all) {
  return hn::Gt(set<Number>(all ? 1.0 : 0.0), set<Number>(0.0));
}

template <typename Number>
HWY_INLINE Vectors3<Number> axis_of(const std::array<Number, 3>& axis) {
  const LanesOf<Number> d;
  return {hn::Set(d, axis[0]), hn::Set(d, axis[1]), hn::Set(d, axis[2])};
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_LANES_INL_H
