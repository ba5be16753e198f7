#include "hydrostatics/wet_tree_sum.h"

#include <algorithm>
#include <cassert>
#include <cmath>

// This file is compiled once per instruction set; the name is how it includes itself.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "hydrostatics/wet_tree_sum.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Bounds = hn::CappedTag<float, kTreeWidth>;
using Reals = hn::CappedTag<double, 8>;
using RealVector = hn::Vec<Reals>;
using RealMask = hn::Mask<Reals>;
using Indices = hn::RebindToSigned<Reals>;

// Which children of a node lie wholly below the water, and which are cut by it or too close to tell.
struct ChildMasks {
  std::uint32_t wet, crossing;
};

struct BoundsQuery {
  float kx, ky, kz, h, margin;
};

HWY_INLINE ChildMasks test_children(const TreeNode& node, const BoundsQuery& query) {
  const Bounds d;
  const auto kx = hn::Set(d, query.kx);
  const auto ky = hn::Set(d, query.ky);
  const auto kz = hn::Set(d, query.kz);
  const auto h = hn::Set(d, query.h);
  const auto margin = hn::Set(d, query.margin);
  std::uint32_t wet = 0;
  std::uint32_t dry = 0;
  for (std::size_t i = 0; i < kTreeWidth; i += hn::Lanes(d)) {
    const auto center = hn::Sub(hn::MulAdd(kx, hn::Load(d, node.center_x.data() + i),
                                           hn::MulAdd(ky, hn::Load(d, node.center_y.data() + i),
                                                      hn::Mul(kz, hn::Load(d, node.center_z.data() + i)))),
                                h);
    const auto reach =
        hn::MulAdd(hn::Abs(kx), hn::Load(d, node.half_x.data() + i),
                   hn::MulAdd(hn::Abs(ky), hn::Load(d, node.half_y.data() + i),
                              hn::MulAdd(hn::Abs(kz), hn::Load(d, node.half_z.data() + i), margin)));
    std::array<std::uint8_t, 8> bits{};
    hn::StoreMaskBits(d, hn::Lt(hn::Add(center, reach), hn::Zero(d)), bits.data());
    wet |= static_cast<std::uint32_t>(bits[0]) << i;
    hn::StoreMaskBits(d, hn::Gt(hn::Sub(center, reach), hn::Zero(d)), bits.data());
    dry |= static_cast<std::uint32_t>(bits[0]) << i;
  }
  const std::uint32_t present = (1U << node.children) - 1U;
  return {wet & present, ~(wet | dry) & present};
}

// 16 numbers of a leaf's vertices, looked up by index.
struct VertexTable {
  HWY_ALIGN std::array<double, kLeafVertices> values;
};

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
// Both halves in registers: one instruction per eight look-ups.
HWY_INLINE RealVector look_up(const VertexTable& table, hn::Vec<Indices> index) {
  const Reals d;
  const auto low = hn::Load(d, table.values.data());
  const auto high = hn::Load(d, table.values.data() + 8);
  return RealVector{_mm512_permutex2var_pd(low.raw, index.raw, high.raw)};
}
#else
HWY_INLINE RealVector look_up(const VertexTable& table, hn::Vec<Indices> index) {
  return hn::GatherIndex(Reals(), table.values.data(), index);
}
#endif

HWY_INLINE hn::Vec<Indices> load_indices(const std::uint8_t* from) {
  const hn::Rebind<std::uint8_t, Reals> bytes;
  const hn::Rebind<std::int32_t, Reals> words;
  return hn::PromoteTo(Indices(), hn::PromoteTo(words, hn::LoadU(bytes, from)));
}

class LeafSums {
 public:
  // Written out: an implicit constructor would be compiled without the target's instructions.
  HWY_INLINE LeafSums()
      : volume6_(hn::Zero(Reals())),
        moment_u24_(hn::Zero(Reals())),
        moment_v24_(hn::Zero(Reals())),
        height24_(hn::Zero(Reals())) {}

  // Adds the wet part of the leaf's triangles; false: the leaf turned out wholly wet, nothing was added.
  HWY_INLINE bool add(const TreeLeaf& leaf, const TreeQuery& query) {
    const Reals d;
    const auto& c = leaf.center;
    // Exact: whole multiples of grid 2^-26 below 2^51 of them (TreeQuery).
    const double z_high =
        query.k_high[0] * c[0] + query.k_high[1] * c[1] + query.k_high[2] * c[2] - query.h_high;
    const double z_low = query.k_low[0] * c[0] + query.k_low[1] * c[1] + query.k_low[2] * c[2] - query.h_low;
    const auto z0 = hn::Set(d, z_high + z_low);
    const auto u0 = hn::Set(d, query.u[0] * c[0] + query.u[1] * c[1] + query.u[2] * c[2]);
    const auto v0 = hn::Set(d, query.v[0] * c[0] + query.v[1] * c[1] + query.v[2] * c[2]);

    VertexTable u;
    VertexTable v;
    VertexTable z;
    const std::size_t vertices = leaf.vertices;
    std::size_t wet_vertices = 0;
    for (std::size_t i = 0; i < kLeafVertices; i += hn::Lanes(d)) {
      if (i >= vertices) break;
      const auto x_B = hn::Load(d, leaf.x.data() + i);
      const auto y_B = hn::Load(d, leaf.y.data() + i);
      const auto z_B = hn::Load(d, leaf.z.data() + i);
      const auto along = [&](const std::array<double, 3>& axis, RealVector start) {
        return hn::MulAdd(hn::Set(d, axis[0]), x_B,
                          hn::MulAdd(hn::Set(d, axis[1]), y_B, hn::MulAdd(hn::Set(d, axis[2]), z_B, start)));
      };
      const auto height = along(query.k, z0);
      hn::Store(height, d, z.values.data() + i);
      hn::Store(along(query.u, u0), d, u.values.data() + i);
      hn::Store(along(query.v, v0), d, v.values.data() + i);
      wet_vertices += hn::CountTrue(d, hn::Lt(height, hn::Zero(d)));
    }
    const std::size_t padded = (vertices + hn::Lanes(d) - 1) / hn::Lanes(d) * hn::Lanes(d);
    if (wet_vertices == 0) return true;
    if (wet_vertices == padded) return false;
    for (std::size_t i = 0; i < leaf.triangles; i += hn::Lanes(d)) add_group(leaf, i, u, v, z);
    return true;
  }

  HWY_INLINE void finish(WetTreeSum& sum) const {
    const Reals d;
    sum.volume6 = hn::GetLane(hn::SumOfLanes(d, volume6_));
    sum.moment_u24 = hn::GetLane(hn::SumOfLanes(d, moment_u24_));
    sum.moment_v24 = hn::GetLane(hn::SumOfLanes(d, moment_v24_));
    sum.height24 = hn::GetLane(hn::SumOfLanes(d, height24_));
  }

 private:
  HWY_INLINE void add_group(const TreeLeaf& leaf, std::size_t first, const VertexTable& u,
                            const VertexTable& v, const VertexTable& z) {
    const Reals d;
    const auto zero = hn::Zero(d);
    const auto a = load_indices(leaf.a.data() + first);
    const auto b = load_indices(leaf.b.data() + first);
    const auto c = load_indices(leaf.c.data() + first);
    const auto za = look_up(z, a);
    const auto zb = look_up(z, b);
    const auto zc = look_up(z, c);
    const auto a_wet = hn::Lt(za, zero);
    const auto b_wet = hn::Lt(zb, zero);
    const auto c_wet = hn::Lt(zc, zero);
    const auto some_wet = hn::Or(hn::Or(a_wet, b_wet), c_wet);
    if (hn::AllFalse(d, some_wet)) return;
    const auto all_wet = hn::And(hn::And(a_wet, b_wet), c_wet);

    const auto ua = look_up(u, a);
    const auto ub = look_up(u, b);
    const auto uc = look_up(u, c);
    const auto va = look_up(v, a);
    const auto vb = look_up(v, b);
    const auto vc = look_up(v, c);
    // Twice the triangle's area projected on the water, n_k dA.
    const auto w =
        hn::Sub(hn::Mul(hn::Sub(ub, ua), hn::Sub(vc, va)), hn::Mul(hn::Sub(uc, ua), hn::Sub(vb, va)));

    const auto cut = hn::AndNot(all_wet, some_wet);
    const bool any_cut = !hn::AllFalse(d, cut);
    // Two corners wet: the whole triangle less its dry corner. One: its wet corner alone.
    const auto two_wet = hn::Or(hn::Or(hn::And(a_wet, b_wet), hn::And(b_wet, c_wet)), hn::And(c_wet, a_wet));
    if (!hn::AllFalse(d, two_wet)) {
      const auto whole = hn::IfThenElseZero(two_wet, w);
      const auto z_sum = hn::Add(hn::Add(za, zb), zc);
      volume6_ = hn::MulAdd(whole, z_sum, volume6_);
      const auto moment = [&](RealVector pa, RealVector pb, RealVector pc) {
        return hn::MulAdd(hn::Add(z_sum, za), pa,
                          hn::MulAdd(hn::Add(z_sum, zb), pb, hn::Mul(hn::Add(z_sum, zc), pc)));
      };
      moment_u24_ = hn::MulAdd(whole, moment(ua, ub, uc), moment_u24_);
      moment_v24_ = hn::MulAdd(whole, moment(va, vb, vc), moment_v24_);
      const auto squares =
          hn::MulAdd(za, hn::Add(za, zb), hn::MulAdd(zb, hn::Add(zb, zc), hn::Mul(zc, hn::Add(zc, za))));
      height24_ = hn::MulAdd(whole, squares, height24_);
    }
    if (!any_cut) return;

    // Rotate so that p is the corner that differs from the two others.
    const auto p_is_b = hn::And(cut, hn::And(hn::Xor(a_wet, b_wet), hn::Xor(b_wet, c_wet)));
    const auto p_is_c = hn::And(cut, hn::And(hn::Xor(a_wet, c_wet), hn::Xor(b_wet, c_wet)));
    const auto rotate = [&](RealVector& p, RealVector& q, RealVector& r) {
      const auto pa = p;
      const auto pb = q;
      const auto pc = r;
      p = hn::IfThenElse(p_is_b, pb, hn::IfThenElse(p_is_c, pc, pa));
      q = hn::IfThenElse(p_is_b, pc, hn::IfThenElse(p_is_c, pa, pb));
      r = hn::IfThenElse(p_is_b, pa, hn::IfThenElse(p_is_c, pb, pc));
    };
    auto zp = za;
    auto zq = zb;
    auto zr = zc;
    auto up = ua;
    auto uq = ub;
    auto ur = uc;
    auto vp = va;
    auto vq = vb;
    auto vr = vc;
    rotate(zp, zq, zr);
    rotate(up, uq, ur);
    rotate(vp, vq, vr);
    // Shares of the edges p-q and p-r that belong to p's corner; lanes that are not cut divide by 1.
    const auto one = hn::Set(d, 1.0);
    const auto to_q = hn::Div(zp, hn::IfThenElse(cut, hn::Sub(zp, zq), one));
    const auto to_r = hn::Div(zp, hn::IfThenElse(cut, hn::Sub(zp, zr), one));
    const auto signed_w = hn::IfThenElse(two_wet, hn::Neg(w), w);
    const auto corner = hn::IfThenElseZero(cut, hn::Mul(signed_w, hn::Mul(to_q, to_r)));
    const auto weighted = hn::Mul(corner, zp);
    volume6_ = hn::Add(volume6_, weighted);
    const auto four = hn::Set(d, 4.0);
    const auto moment = [&](RealVector pp, RealVector pq, RealVector pr) {
      return hn::MulAdd(to_q, hn::Sub(pq, pp), hn::MulAdd(to_r, hn::Sub(pr, pp), hn::Mul(four, pp)));
    };
    moment_u24_ = hn::MulAdd(weighted, moment(up, uq, ur), moment_u24_);
    moment_v24_ = hn::MulAdd(weighted, moment(vp, vq, vr), moment_v24_);
    height24_ = hn::MulAdd(weighted, zp, height24_);
  }

  RealVector volume6_;
  RealVector moment_u24_;
  RealVector moment_v24_;
  RealVector height24_;
};

// Sums of node moments: plain within a block of 16, compensated from block to block.
class NodeSums {
 public:
  HWY_INLINE void add(const NodeMoments& moments) {
    const Reals d;
    for (std::size_t i = 0; i < NodeMoments::kCount; i += hn::Lanes(d)) {
      hn::Store(hn::Add(hn::Load(d, block_.values.data() + i), hn::Load(d, moments.values.data() + i)), d,
                block_.values.data() + i);
    }
    if (++in_block_ == 16) close_block();
  }

  HWY_INLINE void finish(WetTreeSum& sum) {
    close_block();
    for (std::size_t i = 0; i < NodeMoments::kCount; ++i) {
      sum.wet_nodes.values[i] = total_.values[i] + rest_.values[i];
    }
  }

 private:
  HWY_INLINE void close_block() {
    const Reals d;
    for (std::size_t i = 0; i < NodeMoments::kCount; i += hn::Lanes(d)) {
      const auto block = hn::Load(d, block_.values.data() + i);
      const auto total = hn::Load(d, total_.values.data() + i);
      const auto sum = hn::Add(total, block);
      const auto block_part = hn::Sub(sum, total);
      const auto error = hn::Add(hn::Sub(total, hn::Sub(sum, block_part)), hn::Sub(block, block_part));
      hn::Store(sum, d, total_.values.data() + i);
      hn::Store(hn::Add(hn::Load(d, rest_.values.data() + i), error), d, rest_.values.data() + i);
    }
    block_ = {};
    in_block_ = 0;
  }

  NodeMoments block_, total_, rest_;
  int in_block_ = 0;
};

void sum_wet_tree_on_target(const MomentTree& tree, const TreeQuery& query, WetTreeSum& sum) {
  constexpr std::size_t kQueue = 256;
  constexpr std::size_t kStack = 256;
  // Found nodes and leaves are queued and prefetched, and used when a queue is full: memory is fetched
  // meanwhile.
  std::array<std::uint32_t, kQueue + kTreeWidth> leaf_queue;
  std::array<std::uint32_t, kQueue + kTreeWidth> wet_queue;
  std::array<std::uint32_t, kStack> stack;
  std::size_t leaves = 0;
  std::size_t wets = 0;
  std::size_t depth = 0;

  BoundsQuery bounds{};
  bounds.kx = static_cast<float>(query.k[0]);
  bounds.ky = static_cast<float>(query.k[1]);
  bounds.kz = static_cast<float>(query.k[2]);
  bounds.h = static_cast<float>(query.h_high + query.h_low);
  // float32 rounds k, h, each product and sum: at most 12 half-ulps of 3 reach + |h| together.
  bounds.margin = 1e-6F * (3.0F * tree.reach + std::abs(bounds.h));

  LeafSums leaf_sums;
  NodeSums node_sums;
  const auto drain = [&] {
    for (std::size_t i = 0; i < leaves; ++i) {
      const TreeLeaf& leaf = tree.leaves[leaf_queue[i]];
      if (!leaf_sums.add(leaf, query)) wet_queue[wets++] = leaf.moments;
      if (wets == wet_queue.size()) {
        for (std::size_t j = 0; j < wets; ++j) node_sums.add(tree.moments[wet_queue[j]]);
        wets = 0;
      }
    }
    for (std::size_t j = 0; j < wets; ++j) node_sums.add(tree.moments[wet_queue[j]]);
    leaves = 0;
    wets = 0;
  };

  stack[depth++] = 0;
  while (depth > 0) {
    const TreeNode& node = tree.nodes[stack[--depth]];
    const ChildMasks masks = test_children(node, bounds);
    for (std::uint32_t rest = masks.wet; rest != 0; rest &= rest - 1) {
      const std::uint32_t index = node.first_moments + static_cast<std::uint32_t>(__builtin_ctz(rest));
      const NodeMoments& moments = tree.moments[index];
      for (std::size_t i = 0; i < NodeMoments::kCount; i += 8) __builtin_prefetch(moments.values.data() + i);
      wet_queue[wets++] = index;
    }
    for (std::uint32_t rest = masks.crossing; rest != 0;) {
      const int last = 31 - __builtin_clz(rest);  // from the back: the stack then gives them in order
      rest ^= 1U << last;
      const std::uint32_t child = node.child[static_cast<std::size_t>(last)];
      if ((child & TreeNode::kLeafBit) != 0) {
        const std::uint32_t index = child - TreeNode::kLeafBit;
        const auto* const line = reinterpret_cast<const unsigned char*>(&tree.leaves[index]);
        for (std::size_t byte = 0; byte < sizeof(TreeLeaf); byte += 64) __builtin_prefetch(line + byte);
        leaf_queue[leaves++] = index;
      } else {
        assert(depth < kStack);
        __builtin_prefetch(&tree.nodes[child]);
        stack[depth++] = child;
      }
    }
    sum.nodes_visited += 1;
    if (leaves >= kQueue || wets >= kQueue) {
      sum.leaves_clipped += static_cast<std::int64_t>(leaves);
      sum.nodes_added += static_cast<std::int64_t>(wets);
      drain();
    }
  }
  sum.leaves_clipped += static_cast<std::int64_t>(leaves);
  sum.nodes_added += static_cast<std::int64_t>(wets);
  drain();
  leaf_sums.finish(sum);
  node_sums.finish(sum);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(sum_wet_tree_on_target);

WetTreeSum sum_wet_tree(const MomentTree& tree, const TreeQuery& query) {
  WetTreeSum sum;
  HWY_DYNAMIC_DISPATCH(sum_wet_tree_on_target)(tree, query, sum);
  return sum;
}

std::vector<std::string> simd_targets() {
  std::vector<std::string> names;
  for (const int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

std::string simd_target() {
  const int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);
}

bool force_simd_target(std::string_view name) {
  hwy::SetSupportedTargetsForTest(0);
  bool known = name.empty();
  if (!known) {
    for (const int64_t target : hwy::SupportedAndGeneratedTargets()) {
      if (name == hwy::TargetName(target)) {
        hwy::SetSupportedTargetsForTest(target);
        known = true;
        break;
      }
    }
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return known;
}

}  // namespace buoyancy
#endif  // HWY_ONCE
