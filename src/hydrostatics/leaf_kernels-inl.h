// The SIMD kernels for the leaves of the moment tree: the wet part of a leaf's triangles, many at a time.
// Included once per instruction set (wet_tree_sum.cpp), after highway.h.
#if defined(BUOYANCY_LEAF_KERNELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_LEAF_KERNELS_INL_H
#undef BUOYANCY_LEAF_KERNELS_INL_H
#else
#define BUOYANCY_LEAF_KERNELS_INL_H
#endif

#include <hwy/highway.h>

#include "hydrostatics/wet_tree_sum.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Reals = hn::CappedTag<double, 8>;
using RealVector = hn::Vec<Reals>;

// 16 numbers of a leaf's vertices, looked up by index.
struct VertexTable {
  HWY_ALIGN std::array<double, kLeafVertices> values;
};

// A triangle of a leaf as one word: the indices of its corners p, q, r in its lowest three bytes. Of a cut
// triangle p is the corner that lies alone on its side of the water.
using Corners = std::uint32_t;

// What there is to compute of a leaf that the water crosses. Of a triangle with two wet corners the whole
// counts less its dry corner, of one with one wet corner that corner alone. Where most of the leaf is wet,
// the leaf's moments are added and what is not wet is taken off.
struct LeafWork {
  static constexpr std::size_t kRoom = 2 * std::size_t{kLeafTriangles};  // whole vectors are written and read
  HWY_ALIGN std::array<Corners, kRoom> whole, cut;
  std::size_t wholes, cuts;
  bool less_than_leaf;  // the whole triangles are those to take off
};

#if HWY_TARGET == HWY_SCALAR

// Corners of triangle t, p first.
HWY_INLINE Corners rotated_corners(const TreeLeaf& leaf, std::size_t t, std::size_t p) {
  const std::array<Corners, 5> around{leaf.a[t], leaf.b[t], leaf.c[t], leaf.a[t], leaf.b[t]};
  return around[p] | around[p + 1] << 8U | around[p + 2] << 16U;
}

// wet: one bit per vertex.
HWY_INLINE void find_work(const TreeLeaf& leaf, std::uint32_t wet, LeafWork& work) {
  // By which of p, q and r are wet, in the lowest three bits.
  constexpr std::array<std::uint8_t, 8> kOddOneOut{0, 0, 1, 2, 2, 1, 0, 0};
  constexpr std::array<std::uint8_t, 8> kMostlyWet{0, 0, 0, 1, 0, 1, 1, 1};
  constexpr std::array<std::uint8_t, 8> kCut{0, 1, 1, 1, 1, 1, 1, 0};
  std::array<std::uint8_t, kLeafVertices> is_wet;
  for (std::size_t i = 0; i < kLeafVertices; ++i) is_wet[i] = static_cast<std::uint8_t>(wet >> i & 1U);
  std::array<std::array<std::uint8_t, kLeafTriangles>, 2> by_side;  // mostly dry, mostly wet
  std::array<std::uint8_t, kLeafTriangles> cut;
  std::array<std::uint8_t, kLeafTriangles> cases;
  std::array<std::size_t, 2> count{};
  work.cuts = 0;
  for (std::size_t t = 0; t < leaf.triangles; ++t) {
    const std::size_t which = is_wet[leaf.a[t]] + 2U * is_wet[leaf.b[t]] + 4U * is_wet[leaf.c[t]];
    cases[t] = static_cast<std::uint8_t>(which);
    cut[work.cuts] = static_cast<std::uint8_t>(t);
    work.cuts += kCut[which];
    by_side[0][count[0]] = static_cast<std::uint8_t>(t);
    by_side[1][count[1]] = static_cast<std::uint8_t>(t);
    count[0] += 1U - kMostlyWet[which];
    count[1] += kMostlyWet[which];
  }
  for (std::size_t i = 0; i < work.cuts; ++i) {
    work.cut[i] = rotated_corners(leaf, cut[i], kOddOneOut[cases[cut[i]]]);
  }
  work.less_than_leaf = count[1] > count[0];
  const std::size_t side = work.less_than_leaf ? 0 : 1;
  work.wholes = count[side];
  for (std::size_t i = 0; i < work.wholes; ++i) work.whole[i] = rotated_corners(leaf, by_side[side][i], 0);
}

#else

// Sixteen triangles' corners, four words each, in registers: what is stored in parts and loaded whole waits
// for the stores.
using Words = hn::FixedTag<Corners, 4>;
struct LeafCorners {
  hn::Vec<Words> part[4];
};

// Writes the chosen ones to `to`, in order, and zeros behind them to fill a vector of Reals: a triangle of
// one corner.
#if HWY_MAX_BYTES >= 64

HWY_INLINE std::size_t compress(const LeafCorners& corners, std::uint32_t chosen, Corners* to) {
  const hn::FixedTag<Corners, 8> d8;
  const hn::FixedTag<Corners, 16> d16;
  const auto& part = corners.part;
  const auto all = hn::Combine(d16, hn::Combine(d8, part[3], part[2]), hn::Combine(d8, part[1], part[0]));
  const auto count = static_cast<std::size_t>(__builtin_popcount(chosen));
  const auto mask = hn::LoadMaskBits(d16, reinterpret_cast<const std::uint8_t*>(&chosen));
  hn::Store(hn::IfThenElseZero(hn::FirstN(d16, count), hn::Compress(all, mask)), d16, to);
  return count;
}

#else

// Where the bytes of the chosen words of four come from, by which are chosen. Highway's own Compress has such
// a table too, which GCC 12 copies to the stack at every use.
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

#endif

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
  // 0xFF for a wet vertex.
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
  work.less_than_leaf = 2 * __builtin_popcount(mostly_wet) > leaf.triangles;
  work.wholes =
      compress(corners, work.less_than_leaf ? present & ~mostly_wet : mostly_wet, work.whole.data());
  work.cuts = compress(corners, bits_of(cut) & present, work.cut.data());
}

#endif

// The indices of corners p, q, r of as many triangles as there are lanes, for look_up.
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

struct CornerIndices {
  hn::Vec<hn::RebindToSigned<Reals>> p, q, r;
};

HWY_INLINE CornerIndices corner_indices(const Corners* from) {
  const hn::RebindToSigned<Reals> d;
  const hn::Rebind<std::int32_t, Reals> words;
  const auto corners = hn::PromoteTo(d, hn::Load(words, reinterpret_cast<const std::int32_t*>(from)));
  // Only the lowest four bits of an index are looked at.
  return {corners, hn::ShiftRight<8>(corners), hn::ShiftRight<16>(corners)};
}

// Both halves in registers: one instruction per eight look-ups.
HWY_INLINE RealVector look_up(const VertexTable& table, hn::Vec<hn::RebindToSigned<Reals>> index) {
  const Reals d;
  const auto low = hn::Load(d, table.values.data());
  const auto high = hn::Load(d, table.values.data() + 8);
  return RealVector{_mm512_permutex2var_pd(low.raw, index.raw, high.raw)};
}

#else

// One by one: on these processors that is no slower than their own gathering. Bytes are counted from the
// lowest.
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

enum class LeafOutcome { kAdded, kAddLeaf };  // kAddLeaf: the caller adds the leaf's moments

class LeafSums {
 public:
  // Written out: an implicit constructor would be compiled without the target's instructions.
  HWY_INLINE LeafSums()
      : volume6_(hn::Zero(Reals())),
        moment_u24_(hn::Zero(Reals())),
        moment_v24_(hn::Zero(Reals())),
        height24_(hn::Zero(Reals())) {}

  // Adds the wet part of the leaf's triangles, or what makes it together with the leaf's moments.
  HWY_INLINE LeafOutcome add(const TreeLeaf& leaf, const TreeQuery& query) {
    const auto& c = leaf.center;
    // Exact: whole multiples of grid 2^-26 below 2^51 of them (TreeQuery).
    const double z_high =
        query.k_high[0] * c[0] + query.k_high[1] * c[1] + query.k_high[2] * c[2] - query.h_high;
    const double z_low = query.k_low[0] * c[0] + query.k_low[1] * c[1] + query.k_low[2] * c[2] - query.h_low;
    VertexTable z;
    const std::uint32_t vertices = (1U << leaf.vertices) - 1U;
    project(leaf, query.k, z_high + z_low, z);
    const std::uint32_t wet = wet_vertices(leaf, z) & vertices;
    if (wet == 0) return LeafOutcome::kAdded;
    if (wet == vertices) return LeafOutcome::kAddLeaf;

    rounding_ += static_cast<double>(leaf.rounding);
    VertexTable u;
    VertexTable v;
    project(leaf, query.u, query.u[0] * c[0] + query.u[1] * c[1] + query.u[2] * c[2], u);
    project(leaf, query.v, query.v[0] * c[0] + query.v[1] * c[1] + query.v[2] * c[2], v);
    LeafWork work;
    find_work(leaf, wet, work);
    add_whole(work, u, v, z);
    add_cut(work, u, v, z);
    return work.less_than_leaf ? LeafOutcome::kAddLeaf : LeafOutcome::kAdded;
  }

  HWY_INLINE void finish(WetTreeSum& sum) const {
    const Reals d;
    sum.rounding = rounding_;
    sum.volume6 = hn::GetLane(hn::SumOfLanes(d, volume6_));
    sum.moment_u24 = hn::GetLane(hn::SumOfLanes(d, moment_u24_));
    sum.moment_v24 = hn::GetLane(hn::SumOfLanes(d, moment_v24_));
    sum.height24 = hn::GetLane(hn::SumOfLanes(d, height24_));
  }

 private:
  // start + axis . y of the leaf's vertices.
  HWY_INLINE static void project(const TreeLeaf& leaf, const std::array<double, 3>& axis, double start,
                                 VertexTable& table) {
    const Reals d;
    const auto x = hn::Set(d, axis[0]);
    const auto y = hn::Set(d, axis[1]);
    const auto z = hn::Set(d, axis[2]);
    const auto from = hn::Set(d, start);
    const std::size_t vertices = leaf.vertices;
    for (std::size_t i = 0; i < vertices; i += hn::Lanes(d)) {
      const auto value = hn::MulAdd(
          x, hn::Load(d, leaf.x.data() + i),
          hn::MulAdd(y, hn::Load(d, leaf.y.data() + i), hn::MulAdd(z, hn::Load(d, leaf.z.data() + i), from)));
      hn::Store(value, d, table.values.data() + i);
    }
  }

  // One bit for each vertex below the water.
  HWY_INLINE static std::uint32_t wet_vertices(const TreeLeaf& leaf, const VertexTable& z) {
    const Reals d;
    std::uint32_t wet = 0;
    for (std::size_t i = 0; i < kLeafVertices; i += hn::Lanes(d)) {
      if (i >= leaf.vertices) break;
      std::array<std::uint8_t, 8> bits{};
      hn::StoreMaskBits(d, hn::Lt(hn::Load(d, z.values.data() + i), hn::Zero(d)), bits.data());
      wet |= static_cast<std::uint32_t>(bits[0]) << i;
    }
    return wet;
  }

  // Twice a triangle's area projected on the water, n_k dA.
  HWY_INLINE static RealVector twice_area(RealVector up, RealVector uq, RealVector ur, RealVector vp,
                                          RealVector vq, RealVector vr) {
    return hn::Sub(hn::Mul(hn::Sub(uq, up), hn::Sub(vr, vp)), hn::Mul(hn::Sub(ur, up), hn::Sub(vq, vp)));
  }

  HWY_INLINE void add_whole(LeafWork& work, const VertexTable& u, const VertexTable& v,
                            const VertexTable& z) {
    const Reals d;
    const auto sign = hn::Set(d, work.less_than_leaf ? -1.0 : 1.0);
    for (std::size_t i = 0; i < work.wholes; i += hn::Lanes(d)) {
      const CornerIndices at = corner_indices(work.whole.data() + i);
      const auto up = look_up(u, at.p);
      const auto uq = look_up(u, at.q);
      const auto ur = look_up(u, at.r);
      const auto vp = look_up(v, at.p);
      const auto vq = look_up(v, at.q);
      const auto vr = look_up(v, at.r);
      const auto zp = look_up(z, at.p);
      const auto zq = look_up(z, at.q);
      const auto zr = look_up(z, at.r);
      const auto w = hn::Mul(sign, twice_area(up, uq, ur, vp, vq, vr));  // 0 in unused lanes
      const auto z_sum = hn::Add(hn::Add(zp, zq), zr);
      const auto weight_p = hn::Add(z_sum, zp);
      const auto weight_q = hn::Add(z_sum, zq);
      const auto weight_r = hn::Add(z_sum, zr);
      const auto moment = [&](RealVector p, RealVector q, RealVector r) {
        return hn::MulAdd(weight_p, p, hn::MulAdd(weight_q, q, hn::Mul(weight_r, r)));
      };
      volume6_ = hn::MulAdd(w, z_sum, volume6_);
      moment_u24_ = hn::MulAdd(w, moment(up, uq, ur), moment_u24_);
      moment_v24_ = hn::MulAdd(w, moment(vp, vq, vr), moment_v24_);
      // Half of (sum z)^2 + sum z^2 is the sum of squares and products.
      const auto squares = hn::MulAdd(zp, weight_p, hn::MulAdd(zq, weight_q, hn::Mul(zr, weight_r)));
      height24_ = hn::MulAdd(hn::Mul(w, hn::Set(d, 0.5)), squares, height24_);
    }
  }

  HWY_INLINE void add_cut(LeafWork& work, const VertexTable& u, const VertexTable& v, const VertexTable& z) {
    const Reals d;
    const auto four = hn::Set(d, 4.0);
    for (std::size_t i = 0; i < work.cuts; i += hn::Lanes(d)) {
      const CornerIndices at = corner_indices(work.cut.data() + i);
      const auto up = look_up(u, at.p);
      const auto vp = look_up(v, at.p);
      const auto zp = look_up(z, at.p);
      const auto u_pq = hn::Sub(look_up(u, at.q), up);
      const auto u_pr = hn::Sub(look_up(u, at.r), up);
      const auto v_pq = hn::Sub(look_up(v, at.q), vp);
      const auto v_pr = hn::Sub(look_up(v, at.r), vp);
      // Shares of the edges p-q and p-r that belong to p's corner.
      const auto z_pq = hn::Sub(zp, look_up(z, at.q));
      const auto z_pr = hn::Sub(zp, look_up(z, at.r));
      // One division instead of two. The product is 0 in unused lanes, all of one corner, and where heights
      // of less than 1e-154 m underflow in it: there is nothing to add, and nothing to divide by.
      const auto both = hn::Mul(z_pq, z_pr);
      const auto scale = hn::IfThenElseZero(hn::Ne(both, hn::Zero(d)), hn::Div(zp, both));
      const auto to_q = hn::Mul(scale, z_pr);
      const auto to_r = hn::Mul(scale, z_pq);
      const auto w = hn::Sub(hn::Mul(u_pq, v_pr), hn::Mul(u_pr, v_pq));
      // A wet corner counts, a dry one is taken off: with z_p < 0 or not.
      const auto signed_w = hn::IfThenElse(hn::Lt(zp, hn::Zero(d)), w, hn::Neg(w));
      const auto weighted = hn::Mul(hn::Mul(signed_w, zp), hn::Mul(to_q, to_r));
      const auto moment = [&](RealVector p, RealVector pq, RealVector pr) {
        return hn::MulAdd(to_q, pq, hn::MulAdd(to_r, pr, hn::Mul(four, p)));
      };
      volume6_ = hn::Add(volume6_, weighted);
      moment_u24_ = hn::MulAdd(weighted, moment(up, u_pq, u_pr), moment_u24_);
      moment_v24_ = hn::MulAdd(weighted, moment(vp, v_pq, v_pr), moment_v24_);
      height24_ = hn::MulAdd(weighted, zp, height24_);
    }
  }

  RealVector volume6_;
  RealVector moment_u24_;
  RealVector moment_v24_;
  RealVector height24_;
  double rounding_ = 0.0;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // per target
