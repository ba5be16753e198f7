// Finds which of a leaf's triangles the water cuts, which count whole, and their corners: one implementation
// for each kind of instruction set, since each has its own byte shuffles. Included once per instruction set
// (wetted_tree_sum.cpp), after highway.h.
#if defined(BUOYANCY_LEAF_CORNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_LEAF_CORNERS_INL_H
#undef BUOYANCY_LEAF_CORNERS_INL_H
#else
#define BUOYANCY_LEAF_CORNERS_INL_H
#endif

#include <hwy/highway.h>

#include "hydrostatics/wetted_tree_sum.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Reals = hn::CappedTag<double, 8>;
using RealVector = hn::Vec<Reals>;

// 16 numbers of a leaf's vertices, 64 B aligned, looked up by index.
using VertexTable = std::array<double, kLeafVertices>;

// A triangle of a leaf as one word: the indices of its corners p, q, r in its lowest three digits, which have
// four bits each if vectors hold eight numbers and eight bits otherwise. In a cut triangle p is the corner
// that lies alone on its side of the water.
using Corners = std::uint32_t;

// The triangles to evaluate in a leaf that the water crosses. A triangle with two wet corners counts whole,
// less its dry corner's part; of one with one wet corner only that corner's part counts. Where most of the
// leaf is wet, the leaf's moments are added and the dry parts are subtracted.
struct LeafWork {
  static constexpr std::size_t kCapacity = std::size_t{kLeafTriangles} + 8;  // padded to whole vectors
  HWY_ALIGN std::array<Corners, kCapacity> whole, cut;
  std::size_t num_whole, num_cut;  // num_whole is not set where a vector of eight holds them all
  bool subtract_from_leaf;         // true if the whole triangles are to be subtracted from the leaf's moments
};

#if HWY_TARGET == HWY_SCALAR

// The corners of triangle t, with p first.
HWY_INLINE Corners rotated_corners(const TreeLeaf& leaf, std::size_t t, std::size_t p) {
  const std::array<Corners, 5> around{leaf.a[t], leaf.b[t], leaf.c[t], leaf.a[t], leaf.b[t]};
  return around[p] | around[p + 1] << 8U | around[p + 2] << 16U;
}

// wet: one bit per vertex.
HWY_INLINE void find_work(const TreeLeaf& leaf, std::uint32_t wet, LeafWork& work) {
  // Index: the lowest three bits tell which of a, b and c are wet.
  constexpr std::array<std::uint8_t, 8> kOddOneOut{0, 0, 1, 2, 2, 1, 0, 0};
  constexpr std::array<std::uint8_t, 8> kMostlyWet{0, 0, 0, 1, 0, 1, 1, 1};
  constexpr std::array<std::uint8_t, 8> kCut{0, 1, 1, 1, 1, 1, 1, 0};
  std::array<std::uint8_t, kLeafVertices> is_wet;
  for (std::size_t i = 0; i < kLeafVertices; ++i) is_wet[i] = static_cast<std::uint8_t>(wet >> i & 1U);
  std::array<std::array<std::uint8_t, kLeafTriangles>, 2> by_side;  // mostly dry, mostly wet
  std::array<std::uint8_t, kLeafTriangles> cut;
  std::array<std::uint8_t, kLeafTriangles> cases;
  std::array<std::size_t, 2> count{};
  work.num_cut = 0;
  for (std::size_t t = 0; t < leaf.triangles; ++t) {
    const std::size_t which = is_wet[leaf.a[t]] + 2U * is_wet[leaf.b[t]] + 4U * is_wet[leaf.c[t]];
    cases[t] = static_cast<std::uint8_t>(which);
    cut[work.num_cut] = static_cast<std::uint8_t>(t);
    work.num_cut += kCut[which];
    by_side[0][count[0]] = static_cast<std::uint8_t>(t);
    by_side[1][count[1]] = static_cast<std::uint8_t>(t);
    count[0] += 1U - kMostlyWet[which];
    count[1] += kMostlyWet[which];
  }
  for (std::size_t i = 0; i < work.num_cut; ++i) {
    work.cut[i] = rotated_corners(leaf, cut[i], kOddOneOut[cases[cut[i]]]);
  }
  work.subtract_from_leaf = count[1] > count[0];
  const std::size_t side = work.subtract_from_leaf ? 0 : 1;
  work.num_whole = count[side];
  for (std::size_t i = 0; i < work.num_whole; ++i) work.whole[i] = rotated_corners(leaf, by_side[side][i], 0);
}

#elif HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

// Writes the chosen corners in order, followed by zeros, which are a triangle of one corner.
HWY_INLINE void compress(__m512i corners, std::uint32_t chosen, Corners* to) {
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(chosen), corners));
}

// wet: one bit per vertex.
HWY_INLINE void find_work(const TreeLeaf& leaf, std::uint32_t wet, LeafWork& work) {
  static_assert(kLeafTriangles == 16 && kLeafVertices == 16);
  const __m128i is_wet = _mm_movm_epi8(static_cast<__mmask16>(wet));
  const auto wet_corners = [&](const std::array<std::uint8_t, kLeafTriangles>& corner) {
    const __m128i index = _mm_loadu_si128(reinterpret_cast<const __m128i*>(corner.data()));
    return static_cast<std::uint32_t>(_mm_movepi8_mask(_mm_shuffle_epi8(is_wet, index)));
  };
  const std::uint32_t a = wet_corners(leaf.a);
  const std::uint32_t b = wet_corners(leaf.b);
  const std::uint32_t c = wet_corners(leaf.c);
  const std::uint32_t present = (1U << leaf.triangles) - 1U;
  const std::uint32_t cut = (a | b | c) & ~(a & b & c) & present;
  const std::uint32_t mostly_wet = ((a & b) | (c & (a | b))) & present;
  // Corners a, b, c, a, b, c; p is one of the first three.
  const __m512i once =
      _mm512_cvtepu16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(leaf.corners.data())));
  const __m512i twice = _mm512_or_si512(once, _mm512_slli_epi32(once, 12));
  const __m512i from_b = _mm512_mask_srli_epi32(twice, static_cast<__mmask16>((a ^ b) & (b ^ c)), twice, 4);
  const __m512i from_p = _mm512_mask_srli_epi32(from_b, static_cast<__mmask16>((a ^ c) & (b ^ c)), twice, 8);

  work.subtract_from_leaf = 2 * __builtin_popcount(mostly_wet) > leaf.triangles;
  // Branch-free, since the condition cannot be predicted.
  const std::uint32_t whole =
      mostly_wet ^ (present & (0U - static_cast<std::uint32_t>(work.subtract_from_leaf)));
  work.num_cut = static_cast<std::size_t>(__builtin_popcount(cut));
  compress(twice, whole, work.whole.data());
  compress(from_p, cut, work.cut.data());
}

#else

// The corners of sixteen triangles, four words per vector, in registers: loading as a whole what was stored
// in parts would wait for the stores.
using Words = hn::FixedTag<Corners, 4>;
struct LeafCorners {
  hn::Vec<Words> part[4];
};

// Source indices of the bytes of the chosen words of four, indexed by the bit mask of the choice. Highway's
// own Compress has such a table too, but GCC 12 copies it to the stack at every use.
struct alignas(16) WordShuffle {
  std::array<std::uint8_t, 16> bytes;
};
constexpr std::array<WordShuffle, 16> make_word_shuffles() {
  std::array<WordShuffle, 16> shuffles{};
  for (std::size_t chosen = 0; chosen < 16; ++chosen) {
    std::size_t to = 0;
    for (std::size_t word = 0; word < 4; ++word) {
      if ((chosen >> word & 1U) == 0) continue;
      for (std::size_t byte = 0; byte < 4; ++byte) {
        shuffles[chosen].bytes[to++] = static_cast<std::uint8_t>(4 * word + byte);
      }
    }
  }
  return shuffles;
}
inline constexpr std::array<WordShuffle, 16> kWordShuffles = make_word_shuffles();

// Writes the chosen corners to `to`, in order, followed by zeros to fill a vector of Reals; zeros are a
// triangle of one corner.
HWY_INLINE std::size_t compress(const LeafCorners& corners, std::uint32_t chosen, Corners* to) {
  const Words d;
  const hn::FixedTag<std::uint8_t, 16> bytes;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const std::uint32_t here = chosen >> (4 * i) & 0xFU;
    const auto shuffle = hn::BitCast(d, hn::Load(bytes, kWordShuffles[here].bytes.data()));
    hn::StoreU(hn::TableLookupBytes(corners.part[i], shuffle), d, to + count);
    count += static_cast<std::size_t>(__builtin_popcount(here));
  }
  hn::StoreU(hn::Zero(d), d, to + count);
  return count;
}

// wet: one bit per vertex.
HWY_INLINE void find_work(const TreeLeaf& leaf, std::uint32_t wet, LeafWork& work) {
  const hn::FixedTag<std::uint8_t, 16> d;
  const hn::FixedTag<std::uint16_t, 8> d16;
  static_assert(kLeafTriangles == 16 && kLeafVertices == 16);
  alignas(16) static constexpr std::array<std::uint8_t, 16> kByte{0, 0, 0, 0, 0, 0, 0, 0,
                                                                  1, 1, 1, 1, 1, 1, 1, 1};
  alignas(16) static constexpr std::array<std::uint8_t, 16> kBit{1, 2, 4, 8, 16, 32, 64, 128,
                                                                 1, 2, 4, 8, 16, 32, 64, 128};
  const auto bits = hn::BitCast(d, hn::Set(d16, static_cast<std::uint16_t>(wet)));
  const auto bit = hn::Load(d, kBit.data());
  // 0xFF for a wet vertex, 0 for a dry one.
  const auto is_wet =
      hn::VecFromMask(d, hn::Eq(hn::And(hn::TableLookupBytes(bits, hn::Load(d, kByte.data())), bit), bit));
  const auto a = hn::Load(d, leaf.a.data());
  const auto b = hn::Load(d, leaf.b.data());
  const auto c = hn::Load(d, leaf.c.data());
  const auto a_wet = hn::TableLookupBytes(is_wet, a);
  const auto b_wet = hn::TableLookupBytes(is_wet, b);
  const auto c_wet = hn::TableLookupBytes(is_wet, c);
  const auto some = hn::Or(hn::Or(a_wet, b_wet), c_wet);
  const auto all = hn::And(hn::And(a_wet, b_wet), c_wet);
  const auto mostly = hn::Or(hn::And(a_wet, b_wet), hn::And(c_wet, hn::Or(a_wet, b_wet)));
  const auto cut = hn::AndNot(all, some);
  const auto p_is_b = hn::MaskFromVec(hn::And(cut, hn::And(hn::Xor(a_wet, b_wet), hn::Xor(b_wet, c_wet))));
  const auto p_is_c = hn::MaskFromVec(hn::And(cut, hn::And(hn::Xor(a_wet, c_wet), hn::Xor(b_wet, c_wet))));
  const auto p = hn::IfThenElse(p_is_b, b, hn::IfThenElse(p_is_c, c, a));
  const auto q = hn::IfThenElse(p_is_b, c, hn::IfThenElse(p_is_c, a, b));
  const auto r = hn::IfThenElse(p_is_b, a, hn::IfThenElse(p_is_c, b, c));

  const auto pq_low = hn::BitCast(d16, hn::InterleaveLower(d, p, q));
  const auto pq_high = hn::BitCast(d16, hn::InterleaveUpper(d, p, q));
  const auto r_low = hn::BitCast(d16, hn::InterleaveLower(d, r, hn::Zero(d)));
  const auto r_high = hn::BitCast(d16, hn::InterleaveUpper(d, r, hn::Zero(d)));
  const LeafCorners corners{{hn::BitCast(Words(), hn::InterleaveLower(d16, pq_low, r_low)),
                             hn::BitCast(Words(), hn::InterleaveUpper(d16, pq_low, r_low)),
                             hn::BitCast(Words(), hn::InterleaveLower(d16, pq_high, r_high)),
                             hn::BitCast(Words(), hn::InterleaveUpper(d16, pq_high, r_high))}};

  const auto bits_of = [&](auto bytes) {
    std::array<std::uint8_t, 8> stored{};
    hn::StoreMaskBits(d, hn::MaskFromVec(bytes), stored.data());
    return static_cast<std::uint32_t>(stored[0]) | static_cast<std::uint32_t>(stored[1]) << 8U;
  };
  const std::uint32_t present = (1U << leaf.triangles) - 1U;
  const std::uint32_t mostly_wet = bits_of(mostly) & present;
  work.subtract_from_leaf = 2 * __builtin_popcount(mostly_wet) > leaf.triangles;
  work.num_whole =
      compress(corners, work.subtract_from_leaf ? present & ~mostly_wet : mostly_wet, work.whole.data());
  work.num_cut = compress(corners, bits_of(cut) & present, work.cut.data());
}

#endif

// The indices of corners p, q, r of one triangle per lane, for look_up.
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

struct CornerIndices {
  hn::Vec<hn::RebindToSigned<Reals>> p, q, r;
};

HWY_INLINE CornerIndices corner_indices(const Corners* from) {
  const hn::RebindToSigned<Reals> d;
  const hn::Rebind<std::int32_t, Reals> words;
  const auto corners = hn::PromoteTo(d, hn::Load(words, reinterpret_cast<const std::int32_t*>(from)));
  // look_up reads only the lowest four bits of an index.
  return {corners, hn::ShiftRight<4>(corners), hn::ShiftRight<8>(corners)};
}

// Both halves of the table are in registers: one instruction does eight look-ups.
HWY_INLINE RealVector look_up(const VertexTable& table, hn::Vec<hn::RebindToSigned<Reals>> index) {
  const Reals d;
  const auto low = hn::Load(d, table.data());
  const auto high = hn::Load(d, table.data() + 8);
  return RealVector{_mm512_permutex2var_pd(low.raw, index.raw, high.raw)};
}

#else

// Looks corners up one by one: on these processors that is no slower than their gather instructions. Byte 0
// is the lowest.
template <std::size_t kByte>
struct CornerIndex {
  const Corners* from;
  std::size_t operator[](std::size_t lane) const {
    return reinterpret_cast<const std::uint8_t*>(from + lane)[kByte];
  }
};

struct CornerIndices {
  CornerIndex<0> p;
  CornerIndex<1> q;
  CornerIndex<2> r;
};

HWY_INLINE CornerIndices corner_indices(const Corners* from) {
  return {{from}, {from}, {from}};
}

template <std::size_t kByte>
HWY_INLINE RealVector look_up(const VertexTable& v, CornerIndex<kByte> index) {
#if HWY_TARGET == HWY_SCALAR
  return hn::Set(Reals(), v[index[0]]);
#elif HWY_ARCH_X86 && HWY_TARGET == HWY_AVX2
  return RealVector{_mm256_set_pd(v[index[3]], v[index[2]], v[index[1]], v[index[0]])};
#elif HWY_ARCH_X86 && HWY_TARGET <= HWY_SSSE3
  return RealVector{_mm_set_pd(v[index[1]], v[index[0]])};
#else
  const Reals d;
  HWY_ALIGN std::array<double, 8> lanes;
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) lanes[i] = v[index[i]];
  return hn::Load(d, lanes.data());
#endif
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // per target
