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

#include "wave_loads/wave_clips-inl.h"
#include "wave_loads/wave_inherited-inl.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_kept_models-inl.h"
#include "wave_loads/wave_load.h"
#include "wave_loads/wave_patches-inl.h"
#include "wave_loads/wave_pieces-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_refinement-inl.h"
#include "wave_loads/wave_results-inl.h"
#include "wave_loads/wave_units-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

template <typename Number>
struct DescentWorkspace {
  RoundUnits<Number> units;
  Results<Number> results;
  std::vector<Number> roots;  // of the results' expected errors
  Pieces<Number> pieces;
  KeptModels<Number> kept;
  Clips<Number> clips;
  InheritedUnits<Number> inherited;
  std::vector<std::uint32_t> first;    // blocks
  std::vector<std::uint32_t> refined;  // results
};

template <typename Number>
class Descent {
 public:
  using V = VectorOf<Number>;

  Descent(const WaveQuery& query, DescentWorkspace<Number>& work)
      : query_(query), work_(work), patch_(patch_query_of<Number>(query)) {
    work_.units.start(query_, patch_, work_.pieces);
    work_.results.start(query.max_lever);
    work_.pieces.clear();
    work_.kept.clear();
    work_.clips.start(work_.kept);
    work_.inherited.start(work_.kept);
  }

  WaveLoad run() {
    add_first_level();
    evaluate_round();
    constexpr int kMaxRounds = 24;
    bool capped = false;
    for (int round = 0; round < kMaxRounds && work_.results.total() > query_.budget; ++round) {
      capped = patches_ > kMaxPatches || cells().full();
      if (capped) break;
      if (!refine()) break;
      evaluate_round();
    }
    WaveLoad load = work_.results.sum();
    load.capped = capped;
    load.too_steep = too_steep_;
    load.patches = static_cast<std::int32_t>(patches_);
    load.cells = static_cast<std::int32_t>(cells().surface_count() + cells().volume_count());
    return load;
  }

 private:
  // The descent begins with about as many blocks at most.
  static constexpr std::size_t kMaxFirst = 1'000;
  // Children inherit a model that leaves out at most this share of the limit: chosen for the least time.
  static constexpr double kInheritedShare = 0.3;

  const SeaCells<Number>& cells() const { return work_.units.cells(); }

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
      const PatchBlock& block = query_.tree->blocks[first[n]];
      if (!all_inner(block) || first.size() > kMaxFirst || !is_too_large(block)) {
        ++n;
        continue;
      }
      for (std::size_t lane = 0; lane < block.patches; ++lane) {
        prefetch_places(query_.tree->blocks[block.child[lane]]);
        prefetch_sizes(query_.tree->blocks[block.child[lane]]);
      }
      first[n] = block.child[0];
      for (std::size_t lane = 1; lane < block.patches; ++lane) first.push_back(block.child[lane]);
    }
    for (const std::uint32_t b : first) {
      const PatchBlock& block = query_.tree->blocks[b];
      // A model of a leaf that is too large would be of no use.
      bool large = false;
      for (std::size_t lane = 0; lane < block.patches; ++lane) {
        large |= block.triangle_blocks[lane] > 0 && static_cast<double>(block.radius[lane]) > largest_piece();
      }
      if (!large) {
        work_.units.add_block(b);
        continue;
      }
      for (std::size_t lane = 0; lane < block.patches; ++lane) {
        if (block.triangle_blocks[lane] > 0) {
          work_.pieces.add_triangles(*query_.tree, block, lane, largest_piece());
        } else {
          work_.units.add_block(block.child[lane]);
        }
      }
    }
  }

  // Whether patches of a block can be expected to be refined: by the third derivative that the sea usually
  // has at their depth where they are wet, and as crossing ones where they are near the surface.
  HWY_INLINE bool is_too_large(const PatchBlock& block) const {
    const UnitOf<float> d;
    using F = hn::Vec<UnitOf<float>>;
    const auto number = [&](double x) HWY_ATTR { return hn::Set(d, static_cast<float>(x)); };
    const SeaExpansion& sea = *query_.expansion;
    const double factor = query_.sea->amplitude_factor();
    const double k = sea.k_max;
    // Chosen for the least time on meshes of 5,000 triangles and more.
    constexpr double kThird = 4.0 / 6.0;
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
      const F depth =
          number(query_.hydrostatic ? 0.0 : k * sea.typical_decay) * hn::Max(hn::Neg(zeta), hn::Zero(d));
      const F decay = hn::MulAdd(depth, hn::MulAdd(depth, number(0.5), one), one);  // about an exponential
      const F wet = number(kThird * factor * sea.typical_third * k * k * k) * load(block.mu3) / decay;
      const F crossing = number(kCrossing) * load(block.area) * load(block.radius);
      const F reach = load(block.radius) + number(query_.usual_elevation);
      const F error = wet + hn::IfThenElseZero(hn::Gt(zeta, hn::Neg(reach)), crossing);
      sum = sum + hn::IfThenElseZero(hn::Lt(zeta, reach), error);
    }
    return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, sum))) > kShare * query_.budget;
  }

  // The radius of pieces [m] at which their models begin to be of use; more where there would be too many.
  double largest_piece() const {
    constexpr double kMaxPieceReach = 1.1;
    constexpr double kFirstPieces = 1000.0;
    return std::max(kMaxPieceReach / patch_.k_max, std::sqrt(query_.tree->area / kFirstPieces));
  }

  // Replaces results above a threshold by those of their children, or clips them. Returns whether there are
  // any.
  bool refine() {
    const double limit = refinement_limit<Number>(work_.results.errors(), work_.results.expected(),
                                                  work_.roots, query_.budget);
    find_results_above(limit);
    for (const std::uint32_t n : work_.refined) {
      // What one round adds is capped as well: it may reach a new cell with each of its units.
      if (units_of_next_round() > kMaxUnits) break;
      const Unit unit = work_.results.unit_of(n);
      const std::size_t lane = unit.first + n % kUnit<Number>;
      const KeptModel kept{work_.results.kept_models(n), static_cast<std::uint32_t>(n % kLanes<Number>)};
      const double remainder = kept.models == kNone ? std::numeric_limits<double>::infinity()
                                                    : static_cast<double>(work_.kept.remainder(kept));
      const bool grandchildren = reaches_grandchildren(n, limit);
      work_.results.remove(n);
      if (unit.of_pieces) {
        work_.pieces.quarter(unit, lane);
        continue;
      }
      const PatchBlock& block = query_.tree->blocks[unit.block];
      if (block.triangle_blocks[lane] == 0) {
        const bool inherit = remainder < kInheritedShare * limit;
        add_children(block.child[lane], grandchildren, inherit ? kept : KeptModel{});
      } else if (remainder < limit) {
        work_.clips.add(*query_.tree, block, lane, kept, n);
      } else {
        work_.pieces.add_triangles(*query_.tree, block, lane, largest_piece());
      }
    }
    return !work_.refined.empty();
  }

  // Whether a result's children are expected to be above the limit as well.
  bool reaches_grandchildren(std::size_t n, double limit) const {
    return static_cast<double>(work_.results.expected()[n]) > kChildrenAbove * limit;
  }

  // Finds the results that are refined, and fetches what is read of the tree before their children are.
  void find_results_above(double limit) {
    const LanesOf<Number> d;
    const std::span<const Number> errors = work_.results.errors();
    work_.refined.clear();
    for (std::size_t first = 0; first < errors.size(); first += kLanes<Number>) {
      const auto above = hn::Gt(hn::LoadU(d, &errors[first]), set<Number>(limit));
      for (std::uint32_t lanes = bits_of<Number>(above); lanes != 0; lanes &= lanes - 1) {
        const auto n =
            static_cast<std::uint32_t>(first) + static_cast<std::uint32_t>(std::countr_zero(lanes));
        work_.refined.push_back(n);
        if (!reaches_grandchildren(n, limit)) continue;
        const Unit& unit = work_.results.unit_of(n);
        if (unit.of_pieces) continue;
        const PatchBlock& block = query_.tree->blocks[unit.block];
        const std::size_t lane = unit.first + n % kUnit<Number>;
        if (block.triangle_blocks[lane] == 0) prefetch_sizes(query_.tree->blocks[block.child[lane]]);
      }
    }
  }

  std::size_t units_of_next_round() const {
    return work_.units.count() + work_.inherited.count() + work_.pieces.new_count() / kUnit<Number>;
  }

  // kept: the model that they inherit, or none.
  void add_children(std::uint32_t b, bool grandchildren, const KeptModel& kept) {
    const auto add = [&](std::uint32_t of_children) {
      if (kept.models != kNone) {
        work_.inherited.add_block(*query_.tree, of_children, kept);
      } else {
        work_.units.add_block(of_children);
      }
    };
    const PatchBlock& block = query_.tree->blocks[b];
    if (!grandchildren || !all_inner(block)) {
      add(b);
      return;
    }
    for (std::size_t lane = 0; lane < block.patches; ++lane) add(block.child[lane]);
  }

  // Evaluates the units of the round and appends their results.
  void evaluate_round() {
    work_.units.evaluate_surface();
    if (query_.hydrostatic) {
      work_.units.for_each_batch_of_surface(
          [this](const Batch<Number>& batch, std::size_t cell) { evaluate_batch(batch, cell, 0); });
    } else {
      work_.units.for_each_batch_of_volume([this](const Batch<Number>& batch, std::size_t cell) {
        evaluate_batch(batch, cells().column_of_volume(cell), cell);
      });
    }
    work_.clips.finish(*query_.tree, patch_, work_.results);
    patches_ += work_.inherited.finish(*query_.tree, patch_, work_.results);
    work_.units.clear();
  }

  void evaluate_batch(const Batch<Number>& batch, std::size_t surface_cell, std::size_t volume_cell) {
    if (work_.units.holds_pieces(batch)) {
      evaluate_batch<true>(batch, surface_cell, volume_cell);
    } else {
      evaluate_batch<false>(batch, surface_cell, volume_cell);
    }
  }

  template <bool kPieces>
  HWY_NOINLINE void evaluate_batch(const Batch<Number>& batch, std::size_t surface_cell,
                                   std::size_t volume_cell) {
    const V zero = set<Number>(0.0);
    const auto read = [&](const Batch<Number>& b, auto row) HWY_ATTR { return work_.units.read(b, row); };
    const Place<Number> place{read(batch, &UnitPlace<Number>::x1), read(batch, &UnitPlace<Number>::x2),
                              read(batch, &UnitPlace<Number>::zeta)};
    const SurfaceValues<Number> surface{
        read(batch, &UnitPlace<Number>::eta),      read(batch, &UnitPlace<Number>::eta_1),
        read(batch, &UnitPlace<Number>::eta_2),    read(batch, &UnitPlace<Number>::eta_11),
        read(batch, &UnitPlace<Number>::eta_12),   read(batch, &UnitPlace<Number>::eta_22),
        read(batch, &UnitPlace<Number>::eta_third)};
    const CellCenter& above = cells().surface_center(surface_cell);
    const V x1 = place.x1 - set<Number>(above.x1);
    const V x2 = place.x2 - set<Number>(above.x2);
    const V horizontal = hn::MulAdd(x1, x1, x2 * x2);
    const CellBounds<Number>& surface_bounds = cells().surface(surface_cell).bounds;
    VolumeValues<Number> f{zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
    V volume_reach = zero;
    const CellBounds<Number>* volume_bounds = &surface_bounds;
    if (!query_.hydrostatic) {
      const VolumeCell<Number>& cell = cells().volume(volume_cell);
      const V z =
          stretched<Number>(patch_, place, surface.eta) - set<Number>(cells().volume_center(volume_cell).z);
      f = evaluate<Number>(cell, x1, x2, z);
      volume_reach = hn::Sqrt(hn::MulAdd(z, z, horizontal));
      volume_bounds = &cell.bounds;
    }
    const auto in_use = hn::FirstN(LanesOf<Number>(), batch.count * kUnit<Number>);
    const UnitsOfVector<Number> units = work_.units.units_of(batch);
    PatchIntegrals<Number> integrals;
    KeptOfBatch kept;
    hn::Mask<LanesOf<Number>> counts;
    if constexpr (kPieces) {
      const PieceLanes<Number> piece = work_.pieces.lanes(units);
      const PatchModel<Number> model =
          model_of<Number>(patch_, place, piece.radius, spread_of<Number>(piece), surface, surface_bounds,
                           hn::Sqrt(horizontal), f, *volume_bounds, volume_reach);
      too_steep_ |= !hn::AllFalse(LanesOf<Number>(), model.too_steep);
      counts = hn::AndNot(model.dry, in_use);
      integrals = integrate<Number>(patch_, piece, model);
    } else {
      const PatchMoments<Number> moments = read_moments<Number>(*query_.tree, units);
      const PatchModel<Number> model =
          model_of<Number>(patch_, place, moments.radius, spread_of<Number>(moments), surface, surface_bounds,
                           hn::Sqrt(horizontal), f, *volume_bounds, volume_reach);
      too_steep_ |= !hn::AllFalse(LanesOf<Number>(), model.too_steep);
      counts = hn::AndNot(model.dry, in_use);
      integrals = integrate<Number>(patch_, moments, model);
      kept = work_.kept.keep_crossing(*query_.tree, units, hn::AndNot(model.whole, counts), patch_, moments,
                                      model, moments.center);
    }
    patches_ += hn::CountTrue(LanesOf<Number>(), counts);
    clear_where<Number>(hn::Not(counts), integrals);
    work_.results.add(units, integrals, kept);
  }

  const WaveQuery& query_;
  DescentWorkspace<Number>& work_;
  PatchQuery<Number> patch_;
  bool too_steep_ = false;
  std::size_t patches_ = 0;
};

template <typename Number>
WaveLoad run_descent(const WaveQuery& query) {
  thread_local DescentWorkspace<Number> work;
  return Descent<Number>(query, work).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_DESCENT_INL_H
