// Patches of the tree in lanes, with SIMD. Included once per instruction set.
#if defined(BUOYANCY_WAVE_PATCHES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_PATCHES_INL_H
#undef BUOYANCY_WAVE_PATCHES_INL_H
#else
#define BUOYANCY_WAVE_PATCHES_INL_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "wave_loads/patch_tree.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_results-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Fetch what is read of a block later: where its patches are; how large they are and what they hold; all but
// where they are.
inline constexpr std::size_t kCacheLine = 64;
inline void prefetch_places(const PatchBlock& block) {
  static_assert(offsetof(PatchBlock, area) == kCacheLine);
  hwy::Prefetch(&block.center);
}
inline void prefetch_sizes(const PatchBlock& block) {
  static_assert(offsetof(PatchBlock, mu2) == 2 * kCacheLine);
  hwy::Prefetch(&block.area);
}
inline void prefetch_moments(const PatchBlock& block) {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(&block);
  for (std::size_t at = kCacheLine; at < sizeof(PatchBlock); at += kCacheLine) hwy::Prefetch(bytes + at);
}

// Calls take(first lane) for each unit of a block.
template <typename Number, typename Take>
HWY_INLINE void for_each_unit(const PatchBlock& block, const Take& take) {
  take(0U);  // without a look at the block, which may not be in the cache yet
  for (std::uint32_t first = kUnit<Number>; first < kSiblings && first < block.patches;
       first += kUnit<Number>) {
    take(first);
  }
}

// Reads the moments of the patches of a vector of units.
template <typename Number>
HWY_INLINE PatchMoments<Number> read_moments(const QueryPatches& patches,
                                             const UnitsOfVector<Number>& units) {
  std::array<const PatchBlock*, kUnitsPerVector<Number>> blocks;
  for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n] = &patches.block(units[n].block);
  const auto get = [&](const auto& member) HWY_ATTR {
    return gather_units<Number>([&](std::size_t n) { return member(*blocks[n]).data() + units[n].first; });
  };
  PatchMoments<Number> m;
  m.center = {get([](const PatchBlock& b) -> const FourFloats& { return b.center[0]; }),
              get([](const PatchBlock& b) -> const FourFloats& { return b.center[1]; }),
              get([](const PatchBlock& b) -> const FourFloats& { return b.center[2]; })};
  m.radius = get([](const PatchBlock& b) -> const FourFloats& { return b.radius; });
  m.area = get([](const PatchBlock& b) -> const FourFloats& { return b.area; });
  m.mu2 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu2; });
  m.mu3 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu3; });
  m.nu3 = get([](const PatchBlock& b) -> const FourFloats& { return b.nu3; });
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i) {
    m.S[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.S[i]; });
  }
#pragma GCC unroll 9
  for (std::size_t i = 0; i < 9; ++i) {
    m.N[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.N[i]; });
  }
#pragma GCC unroll 18
  for (std::size_t i = 0; i < 18; ++i) {
    m.P[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.P[i]; });
  }
  return m;
}

// The patches of a vector of units that are leaves, as bits.
template <typename Number>
HWY_INLINE std::uint32_t leaves(const QueryPatches& patches, const UnitsOfVector<Number>& units) {
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < kLanes<Number>; ++lane) {
    const Unit& unit = units[lane / kUnit<Number>];
    const bool leaf = patches.block(unit.block).triangle_blocks[unit.first + lane % kUnit<Number>] > 0;
    bits |= std::uint32_t{leaf} << lane;
  }
  return bits;
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_PATCHES_INL_H
