// Finds which of a leaf's triangles the water cuts, which count whole, and their corners: one implementation
// for each kind of instruction set, since each has its own byte shuffles. Included once per instruction set
// (wetted_tree_sum.cpp and waterline_sum.cpp), after highway.h.
#if defined(BUOYANCY_LEAF_CORNERS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_LEAF_CORNERS_INL_H
#undef BUOYANCY_LEAF_CORNERS_INL_H
#else
#define BUOYANCY_LEAF_CORNERS_INL_H
#endif

#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "hydrostatics/triangle_clip.h"
#include "hydrostatics/wetted_tree_sum.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

using Reals = hn::CappedTag<double, 8>;
using RealVector = hn::Vec<Reals>;

// One number for each of a leaf's vertices, looked up by the vertex's index.
struct alignas(64) VertexTable {
  std::array<double, kLeafVertices> values;
};

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
// A triangle as one word: see LeafCorners, with the corners p, q, r in place of a, b, c. The highest bit is
// undefined.
using CornerWord = std::uint16_t;
#else
// A triangle as one word: the indices of its corners p, q, r in its lowest three bytes.
using CornerWord = std::uint32_t;
#endif

// The triangles to evaluate in a leaf that the water crosses. In a cut triangle p is the corner that lies
// alone on its side of the water. A triangle with two wet corners counts whole, less its dry corner's part;
// of one with one wet corner only that corner's part counts. Where most of the leaf is wet, the leaf's
// moments are added and the dry parts are subtracted.
struct LeafWork {
  static constexpr std::size_t kCapacity = std::size_t{kLeafTriangles} + 8;  // padded to whole vectors
  HWY_ALIGN std::array<CornerWord, kCapacity> whole, cut;
  std::size_t num_whole, num_cut;
  bool subtract_from_leaf;  // true if the whole triangles are to be subtracted from the leaf's moments
};

// A bit mask of a leaf's triangles.
HWY_INLINE std::uint32_t present_triangles(const LeafPatch& leaf) {
  return (1U << leaf.triangles) - 1U;
}

// Sets subtract_from_leaf and returns the triangles that count whole. It has no branch, since the condition
// cannot be predicted.
HWY_INLINE std::uint32_t choose_whole(const LeafPatch& leaf, std::uint32_t mostly_wet, LeafWork& work) {
  work.subtract_from_leaf = 2 * __builtin_popcount(mostly_wet) > leaf.triangles;
  return mostly_wet ^ (present_triangles(leaf) & (0U - static_cast<std::uint32_t>(work.subtract_from_leaf)));
}

#if HWY_TARGET == HWY_SCALAR

HWY_INLINE void find_work(const LeafPatch& leaf, std::uint32_t wet, LeafWork& work) {
  // Index: the lowest three bits tell which of a, b and c are wet.
  constexpr std::array<std::uint8_t, 8> kMostlyWet{0, 0, 0, 1, 0, 1, 1, 1};
  constexpr std::array<std::uint8_t, 8> kCut{0, 1, 1, 1, 1, 1, 1, 0};
  std::uint32_t mostly_wet = 0;
  work.num_cut = 0;
  for (std::size_t t = 0; t < leaf.triangles; ++t) {
    const LeafCorners corners = leaf.corners[t];
    const std::array<CornerWord, 5> around{
        static_cast<CornerWord>(corners.a()), static_cast<CornerWord>(corners.b()),
        static_cast<CornerWord>(corners.c()), static_cast<CornerWord>(corners.a()),
        static_cast<CornerWord>(corners.b())};
    const std::size_t which =
        (wet >> around[0] & 1U) | (wet >> around[1] & 1U) << 1U | (wet >> around[2] & 1U) << 2U;
    const std::size_t p = kOddOneOut[which];
    mostly_wet |= static_cast<std::uint32_t>(kMostlyWet[which]) << t;
    work.cut[work.num_cut] = around[p] | around[p + 1] << 8U | around[p + 2] << 16U;
    work.num_cut += kCut[which];
  }
  const std::uint32_t whole = choose_whole(leaf, mostly_wet, work);
  work.num_whole = 0;
  for (std::size_t t = 0; t < leaf.triangles; ++t) {
    const LeafCorners corners = leaf.corners[t];
    work.whole[work.num_whole] =
        static_cast<CornerWord>(corners.a() | corners.b() << 8U | corners.c() << 16U);
    work.num_whole += whole >> t & 1U;
  }
}

#elif HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

// Writes the chosen words in order, followed by zeros, which are a triangle of one corner.
HWY_INLINE void compress(__m512i words, std::uint32_t chosen, CornerWord* to) {
#if HWY_TARGET <= HWY_AVX3_DL
  _mm512_storeu_si512(to, _mm512_maskz_compress_epi16(static_cast<__mmask32>(chosen), words));
#else
  const auto compress_half = [](__m256i half, std::uint32_t which) {
    return _mm512_cvtepi32_epi16(
        _mm512_maskz_compress_epi32(static_cast<__mmask16>(which), _mm512_cvtepu16_epi32(half)));
  };
  const std::uint32_t low = chosen & 0xFFFFU;
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), compress_half(_mm512_castsi512_si256(words), low));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to + __builtin_popcount(low)),
                      compress_half(_mm512_extracti64x4_epi64(words, 1), chosen >> 16U));
#endif
}

// wet: one bit per vertex.
HWY_INLINE void find_work(const LeafPatch& leaf, std::uint32_t wet, LeafWork& work) {
  static_assert(kLeafTriangles == 24 && kLeafVertices <= 32 && LeafCorners::kBits == 5);
  static_assert(LeafWork::kCapacity >= 32);
  const __m512i words = _mm512_maskz_loadu_epi16(0xFFFFFFU, leaf.corners.data());
  const __m512i is_wet = _mm512_movm_epi16(static_cast<__mmask32>(wet));
  // The look-up reads only the lowest five bits of an index.
  const auto wet_corners = [&](__m512i index) {
    return static_cast<std::uint32_t>(_mm512_movepi16_mask(_mm512_permutexvar_epi16(index, is_wet)));
  };
  const __m512i from_b = _mm512_srli_epi16(words, 5);
  const __m512i from_c = _mm512_srli_epi16(words, 10);
  const std::uint32_t a = wet_corners(words);
  const std::uint32_t b = wet_corners(from_b);
  const std::uint32_t c = wet_corners(from_c);
  const std::uint32_t present = present_triangles(leaf);
  const std::uint32_t cut = (a | b | c) & ~(a & b & c) & present;
  const std::uint32_t mostly_wet = ((a & b) | (c & (a | b))) & present;
  // These are the words of the corners in the orders b, c, a and c, a, b.
  const __m512i b_first = _mm512_or_si512(from_b, _mm512_slli_epi16(words, 10));
  const __m512i c_first = _mm512_or_si512(from_c, _mm512_slli_epi16(words, 5));
  const __m512i a_or_b = _mm512_mask_mov_epi16(words, static_cast<__mmask32>((a ^ b) & (b ^ c)), b_first);
  const __m512i p_first = _mm512_mask_mov_epi16(a_or_b, static_cast<__mmask32>((a ^ c) & (b ^ c)), c_first);

  const std::uint32_t whole = choose_whole(leaf, mostly_wet, work);
  work.num_whole = static_cast<std::size_t>(__builtin_popcount(whole));
  work.num_cut = static_cast<std::size_t>(__builtin_popcount(cut));
  compress(words, whole, work.whole.data());
  compress(p_first, cut, work.cut.data());
}

#else

// The corner words of all triangles, four per vector, in registers: loading as a whole what was stored in
// parts would wait for the stores.
using Words = hn::FixedTag<CornerWord, 4>;
constexpr std::size_t kParts = kLeafTriangles / 4;
struct LeafWords {
  hn::Vec<Words> part[kParts];
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

// Writes the chosen words to `to`, in order, followed by zeros to fill a vector of Reals; zeros are a
// triangle of one corner.
HWY_INLINE std::size_t compress(const LeafWords& words, std::uint32_t chosen, CornerWord* to) {
  const Words d;
  const hn::FixedTag<std::uint8_t, 16> bytes;
  std::size_t count = 0;
  for (std::size_t i = 0; i < kParts; ++i) {
    const std::uint32_t here = chosen >> (4 * i) & 0xFU;
    const auto shuffle = hn::BitCast(d, hn::Load(bytes, kWordShuffles[here].bytes.data()));
    hn::StoreU(hn::TableLookupBytes(words.part[i], shuffle), d, to + count);
    count += static_cast<std::size_t>(__builtin_popcount(here));
  }
  hn::StoreU(hn::Zero(d), d, to + count);
  return count;
}

// wet: one bit per vertex.
HWY_INLINE void find_work(const LeafPatch& leaf, std::uint32_t wet, LeafWork& work) {
  const hn::FixedTag<std::uint8_t, 16> bytes;
  const hn::FixedTag<std::uint16_t, 8> d;
  const hn::FixedTag<std::uint16_t, 4> half;
  const Words words;
  static_assert(kLeafTriangles % 8 == 0 && kLeafVertices <= 32 && LeafCorners::kBits == 5);
  alignas(16) static constexpr std::array<std::uint8_t, 16> kBit{1, 2, 4, 8, 16, 32, 64, 128,
                                                                 1, 2, 4, 8, 16, 32, 64, 128};
  const auto wet_bytes = hn::BitCast(bytes, hn::Set(words, wet));
  const auto bit_of = hn::Load(bytes, kBit.data());
  const auto five_bits = hn::Set(d, std::uint16_t{LeafCorners::kMask});
  const auto byte = hn::Set(d, std::uint16_t{0xFF});
  // True for a wet vertex. The look-ups are valid in the lower byte of each index.
  const auto is_wet = [&](hn::Vec<decltype(d)> index) {
    const auto wet_byte = hn::TableLookupBytes(wet_bytes, hn::BitCast(bytes, hn::ShiftRight<3>(index)));
    const auto place = hn::BitCast(bytes, hn::And(index, hn::Set(d, std::uint16_t{7})));
    const auto bit = hn::And(hn::BitCast(d, hn::TableLookupBytes(bit_of, place)), byte);
    return hn::VecFromMask(d, hn::Eq(hn::And(hn::BitCast(d, wet_byte), bit), bit));
  };
  const auto bits_of = [&](hn::Vec<decltype(d)> mask) {
    std::array<std::uint8_t, 8> stored{};
    hn::StoreMaskBits(d, hn::MaskFromVec(mask), stored.data());
    return static_cast<std::uint32_t>(stored[0]);
  };
  // Spreads the three indices of five bits in each word over three bytes.
  const auto spread = [&](hn::Vec<decltype(half)> corners) {
    const auto wide = hn::PromoteTo(words, corners);
    return hn::Or(hn::And(wide, hn::Set(words, 0x1FU)),
                  hn::Or(hn::And(hn::ShiftLeft<3>(wide), hn::Set(words, 0x1F00U)),
                         hn::And(hn::ShiftLeft<6>(wide), hn::Set(words, 0x1F0000U))));
  };

  LeafWords p_first;
  std::uint32_t mostly_wet = 0;
  std::uint32_t cut = 0;
  for (std::size_t i = 0; i < kLeafTriangles / 8; ++i) {
    const auto corners = hn::LoadU(d, &leaf.corners[8 * i].word);
    const auto from_b = hn::ShiftRight<5>(corners);
    const auto from_c = hn::ShiftRight<10>(corners);
    const auto a_wet = is_wet(hn::And(corners, five_bits));
    const auto b_wet = is_wet(hn::And(from_b, five_bits));
    const auto c_wet = is_wet(hn::And(from_c, five_bits));
    const auto some = hn::Or(hn::Or(a_wet, b_wet), c_wet);
    const auto all = hn::And(hn::And(a_wet, b_wet), c_wet);
    mostly_wet |= bits_of(hn::Or(hn::And(a_wet, b_wet), hn::And(c_wet, hn::Or(a_wet, b_wet)))) << 8 * i;
    cut |= bits_of(hn::AndNot(all, some)) << 8 * i;
    const auto p_is_b = hn::MaskFromVec(hn::And(hn::Xor(a_wet, b_wet), hn::Xor(b_wet, c_wet)));
    const auto p_is_c = hn::MaskFromVec(hn::And(hn::Xor(a_wet, c_wet), hn::Xor(b_wet, c_wet)));
    const auto b_first = hn::Or(from_b, hn::ShiftLeft<10>(corners));
    const auto c_first = hn::Or(from_c, hn::ShiftLeft<5>(corners));
    const auto rotated = hn::IfThenElse(p_is_b, b_first, hn::IfThenElse(p_is_c, c_first, corners));
    p_first.part[2 * i] = spread(hn::LowerHalf(half, rotated));
    p_first.part[2 * i + 1] = spread(hn::UpperHalf(half, rotated));
  }
  const std::uint32_t present = present_triangles(leaf);
  work.num_whole = compress(p_first, choose_whole(leaf, mostly_wet & present, work), work.whole.data());
  work.num_cut = compress(p_first, cut & present, work.cut.data());
}

#endif

// The indices of corners p, q, r of one triangle per lane, for look_up.
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

struct CornerIndex {
  __m512i index;
  __mmask8 beyond_16;
};

struct CornerIndices {
  CornerIndex p, q, r;
};

HWY_INLINE CornerIndices corner_indices(const CornerWord* from) {
  const auto index_of = [](__m512i corners) {
    return CornerIndex{corners, _mm512_test_epi64_mask(corners, _mm512_set1_epi64(16))};
  };
  const __m512i corners = _mm512_cvtepu16_epi64(_mm_load_si128(reinterpret_cast<const __m128i*>(from)));
  return {index_of(corners), index_of(_mm512_srli_epi64(corners, 5)),
          index_of(_mm512_srli_epi64(corners, 10))};
}

// The whole table is in registers, and two instructions do eight look-ups. They read only the lowest bits of
// an index.
HWY_INLINE RealVector look_up(const VertexTable& table, const CornerIndex& at) {
  static_assert(kLeafVertices == 24);
  const __m512d low = _mm512_load_pd(table.values.data());
  const __m512d middle = _mm512_load_pd(table.values.data() + 8);
  const __m512d high = _mm512_load_pd(table.values.data() + 16);
  const __m512d below_16 = _mm512_permutex2var_pd(low, at.index, middle);
  return RealVector{_mm512_mask_permutexvar_pd(below_16, at.beyond_16, at.index, high)};
}

#else

// Looks corners up one by one: on these processors that is no slower than their gather instructions. Byte 0
// is the lowest.
template <std::size_t kByte>
struct CornerIndex {
  const CornerWord* from;
  std::size_t operator[](std::size_t lane) const {
    return reinterpret_cast<const std::uint8_t*>(from + lane)[kByte];
  }
};

struct CornerIndices {
  CornerIndex<0> p;
  CornerIndex<1> q;
  CornerIndex<2> r;
};

HWY_INLINE CornerIndices corner_indices(const CornerWord* from) {
  return {{from}, {from}, {from}};
}

template <std::size_t kByte>
HWY_INLINE RealVector look_up(const VertexTable& table, CornerIndex<kByte> index) {
  const auto& v = table.values;
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
