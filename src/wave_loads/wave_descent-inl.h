// The descent through a body's patches: rounds of evaluation and refinement, with SIMD
// (docs/wave_mathematics.md, "Refinement"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_DESCENT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_DESCENT_INL_H
#undef BUOYANCY_WAVE_DESCENT_INL_H
#else
#define BUOYANCY_WAVE_DESCENT_INL_H
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <hwy/highway.h>

#include "base/thread_workspace.h"
#include "wave_loads/wave_clips-inl.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_load.h"
#include "wave_loads/wave_load_sum-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_round-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Round: what the patches of a round need of the sea, such as PatchesInCells.
template <typename Number, typename Round>
struct DescentWorkspace {
  QueryPatches patches;
  Round round;
  LoadSum<Number> sum;
  std::vector<Number> roots;  // of the results' expected errors
  ModelCache<Number> cache;
  ClippedLeaves<Number> clips;
  InheritingPatches<Number> inherited;
  std::vector<std::uint32_t> first;    // blocks
  std::vector<std::uint32_t> refined;  // results
};

template <typename Number, typename Round>
class Descent {
 public:
  using V = VectorOf<Number>;

  Descent(const WaveQuery& query, DescentWorkspace<Number, Round>& work)
      : query_(query), work_(work), patch_(patch_query_of<Number>(query)) {
    work_.patches.start(*query.tree);
    work_.round.start(query_, work_.patches, patch_);
    work_.sum.start(query.max_lever);
    work_.cache.clear();
    work_.clips.start(work_.cache);
    work_.inherited.start(work_.cache);
  }

  WaveLoad run() {
    add_first_level();
    evaluate_round();
    constexpr int kMaxRounds = 24;
    for (int round = 0; round < kMaxRounds && work_.sum.total() > query_.budget; ++round) {
      if (patches_ > kMaxPatches || work_.round.full() || !refine()) break;
      evaluate_round();
    }
    WaveLoad load = work_.sum.load();
    load.capped = work_.sum.total() > query_.budget;
    load.too_steep = too_steep_;
    load.patches = static_cast<std::int32_t>(patches_);
    load.cells = static_cast<std::int32_t>(work_.round.cell_count());
    return load;
  }

 private:
  // The descent begins with about as many blocks at most.
  static constexpr std::size_t kMaxFirst = 1'000;
  // Children inherit a model that leaves out at most this share of the limit: chosen for the least time.
  static constexpr double kInheritedShare = 0.3;

  // Whether none of a block's patches is a leaf.
  static bool all_inner(const PatchBlock& block) {
    bool inner = true;
    for (std::size_t lane = 0; lane < block.patches; ++lane) inner &= block.triangle_blocks[lane] == 0;
    return inner;
  }

  // The blocks with which the descent begins: those whose patches are not likely to be refined.
  void add_first_level() {
    std::vector<std::uint32_t>& first = work_.first;
    first.assign(1, 0);
    for (std::size_t n = 0; n < first.size();) {
      const PatchBlock& block = work_.patches.block(first[n]);
      if (!all_inner(block) || first.size() > kMaxFirst || !is_too_large(block)) {
        ++n;
        continue;
      }
      for (std::size_t lane = 0; lane < block.patches; ++lane) {
        prefetch_places(work_.patches.block(block.child[lane]));
        prefetch_sizes(work_.patches.block(block.child[lane]));
      }
      first[n] = block.child[0];
      for (std::size_t lane = 1; lane < block.patches; ++lane) first.push_back(block.child[lane]);
    }
    for (const std::uint32_t b : first) work_.round.add_block(b);
  }

  // Whether patches of a block can be expected to be refined: by the third derivative that the sea usually
  // has at their depth where they are wet, and as crossing ones where they are near the surface.
  HWY_INLINE bool is_too_large(const PatchBlock& block) const {
    const GroupTag<float> d;
    using F = hn::Vec<GroupTag<float>>;
    const auto number = [&](double x) HWY_ATTR { return hn::Set(d, static_cast<float>(x)); };
    // Chosen for the least time on meshes of 5,000 triangles and more.
    constexpr double kCrossing = 0.01;
    constexpr double kShare = 0.1;
    const F one = number(1.0);
    F sum = hn::Zero(d);
    for (std::size_t lane = 0; lane < kSiblings; lane += hn::MaxLanes(d)) {
      const auto load = [&](const FourFloats& row) HWY_ATTR { return hn::LoadU(d, row.data() + lane); };
      const F zeta = hn::MulAdd(
          load(block.center[0]), number(query_.up_B.x()),
          hn::MulAdd(load(block.center[1]), number(query_.up_B.y()),
                     hn::MulAdd(load(block.center[2]), number(query_.up_B.z()), number(query_.zeta))));
      const F depth = number(query_.usual_decay) * hn::Max(hn::Neg(zeta), hn::Zero(d));
      const F decay = hn::MulAdd(depth, hn::MulAdd(depth, number(0.5), one), one);  // about an exponential
      const F wet = number(query_.usual_wet_error) * load(block.mu3) / decay;
      const F crossing = number(kCrossing) * load(block.area) * load(block.radius);
      const F reach = load(block.radius) + number(query_.usual_elevation);
      const F error = wet + hn::IfThenElseZero(hn::Gt(zeta, hn::Neg(reach)), crossing);
      sum = sum + hn::IfThenElseZero(hn::Lt(zeta, reach), error);
    }
    return static_cast<double>(sum_of_lanes(sum)) > kShare * query_.budget;
  }

  // Replaces results above a threshold by those of their children, or clips them. Returns whether there are
  // any.
  bool refine() {
    for (;;) {
      // Once triangles that cannot be refined have most of the budget, the others need not have much less.
      const double budget = std::max(query_.budget - work_.sum.settled(), 0.5 * work_.sum.settled());
      const double limit =
          refinement_limit<Number>(work_.sum.errors(), work_.sum.expected(), work_.roots, budget);
      find_results_above(limit);
      if (work_.refined.empty()) return false;
      if (refine_found(limit)) return true;
    }
  }

  // Returns whether any could be refined.
  bool refine_found(double limit) {
    bool refined = false;
    const std::size_t max_groups = query_.cap_on(kMaxGroups);
    for (const std::uint32_t n : work_.refined) {
      // What one round adds is capped as well: it may reach a new cell with each of its groups.
      if (groups_of_next_round() > max_groups) break;
      const PatchGroup group = work_.sum.group_of(n);
      const std::size_t lane = group.first + n % kGroup<Number>;
      const PatchBlock& block = work_.patches.block(group.block);
      const CachedModel kept{work_.sum.cached_models(n), static_cast<std::uint32_t>(n % kLanes<Number>)};
      const double remainder =
          kept.models == kNone
              ? std::numeric_limits<double>::infinity()
              : static_cast<double>(work_.cache.number(kept, CachedModelLanes<Number>::kForceRemainder));
      if (block.triangle_blocks[lane] > 0) {
        refined |= refine_leaf(n, group.block, lane, kept, remainder < limit);
        continue;
      }
      refined = true;
      const bool grandchildren = reaches_grandchildren(n, limit);
      work_.sum.remove(n);
      add_children(block.child[lane], grandchildren,
                   remainder < kInheritedShare * limit ? kept : CachedModel{});
    }
    return refined;
  }

  // Clips a leaf with the model that was kept of it, or replaces it by its triangles where that model
  // leaves out too much. Returns whether either could be done.
  bool refine_leaf(std::uint32_t n, std::uint32_t block, std::size_t lane, const CachedModel& kept,
                   bool is_good) {
    if (!is_good) {
      const QueryPatches::Blocks triangles = work_.patches.add_triangles_of_leaf(block, lane);
      if (triangles.first != triangles.end) {
        work_.sum.remove(n);
        for (std::uint32_t b = triangles.first; b < triangles.end; ++b) work_.round.add_block(b);
        return true;
      }
      if (kept.models == kNone) {
        work_.sum.settle(n);
        return false;
      }
    }
    work_.sum.remove(n);
    work_.clips.add(work_.patches, work_.patches.block(block), lane, kept, n);
    return true;
  }

  // Whether a result's children are expected to be above the limit as well.
  bool reaches_grandchildren(std::size_t n, double limit) const {
    return static_cast<double>(work_.sum.expected()[n]) > kChildrenAbove * limit;
  }

  // Finds the results that are refined, and fetches what is read of the tree before their children are.
  void find_results_above(double limit) {
    const LanesOf<Number> d;
    const std::span<const Number> errors = work_.sum.errors();
    work_.refined.clear();
    for (std::size_t first = 0; first < errors.size(); first += kLanes<Number>) {
      const auto above = hn::Gt(hn::LoadU(d, &errors[first]), set<Number>(limit));
      for (std::uint32_t lanes = bits_of<Number>(above); lanes != 0; lanes &= lanes - 1) {
        const auto n =
            static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(std::countr_zero(lanes));
        work_.refined.push_back(n);
        if (!reaches_grandchildren(n, limit)) continue;
        const PatchGroup& group = work_.sum.group_of(n);
        const PatchBlock& block = work_.patches.block(group.block);
        const std::size_t lane = group.first + n % kGroup<Number>;
        if (block.triangle_blocks[lane] == 0) prefetch_sizes(work_.patches.block(block.child[lane]));
      }
    }
  }

  std::size_t groups_of_next_round() const { return work_.round.count() + work_.inherited.count(); }

  // kept: the model that they inherit, or none.
  void add_children(std::uint32_t b, bool grandchildren, const CachedModel& kept) {
    const auto add = [&](std::uint32_t of_children) {
      if (kept.models != kNone) {
        work_.inherited.add_block(work_.patches, of_children, kept);
      } else {
        work_.round.add_block(of_children);
      }
    };
    const PatchBlock& block = work_.patches.block(b);
    if (!grandchildren || !all_inner(block)) {
      add(b);
      return;
    }
    for (std::size_t lane = 0; lane < block.patches; ++lane) add(block.child[lane]);
  }

  // Evaluates the groups of the round and appends their results.
  void evaluate_round() {
    work_.round.evaluate_surface();
    work_.round.for_each_batch(
        [this](const Batch<Number>& batch, std::size_t surface_cell, std::size_t volume_cell) {
          evaluate_batch(batch, surface_cell, volume_cell);
        });
    work_.clips.finish(work_.patches, patch_, work_.sum);
    patches_ += work_.inherited.finish(work_.patches, patch_, work_.sum);
    work_.round.clear();
  }

  HWY_NOINLINE void evaluate_batch(const Batch<Number>& batch, std::size_t surface_cell,
                                   std::size_t volume_cell) {
    typename Round::Field field = work_.round.field_of(batch, surface_cell, volume_cell);
    const auto in_use = hn::FirstN(LanesOf<Number>(), batch.count * kGroup<Number>);
    const GroupsOfVector<Number> groups = work_.round.groups_of(batch);
    const PatchMoments<Number> moments = read_moments<Number>(work_.patches, groups);
    field.r = moments.radius * set<Number>(patch_.k_max);
    field.spread = spread_of<Number>(moments);
    const PatchModel<Number> model = model_of<Number>(patch_, field);
    too_steep_ |= !hn::AllFalse(LanesOf<Number>(), model.too_steep);
    const auto counts = hn::AndNot(model.dry, in_use);
    PatchIntegrals<Number> integrals = integrate<Number>(patch_, moments, model);
    const CachedOfBatch kept = work_.cache.keep_crossing(
        work_.patches, groups, hn::AndNot(model.whole, counts), patch_, moments, model, moments.center);
    patches_ += hn::CountTrue(LanesOf<Number>(), counts);
    clear_where<Number>(hn::Not(counts), integrals);
    work_.sum.add(groups, integrals, kept);
  }

  const WaveQuery& query_;
  DescentWorkspace<Number, Round>& work_;
  PatchQuery<Number> patch_;
  bool too_steep_ = false;
  std::size_t patches_ = 0;
};

template <typename Number, template <typename> typename Round>
WaveLoad run_descent(const WaveQuery& query) {
  auto& workspace = thread_workspace<DescentWorkspace<Number, Round<Number>>>();
  return Descent<Number, Round<Number>>(query, workspace).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_DESCENT_INL_H
