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
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_clips-inl.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_load.h"
#include "wave_loads/wave_pieces-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_refinement-inl.h"
#include "wave_loads/wave_results-inl.h"
#include "wave_loads/wave_sea_cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// The places of a unit's patches over 1 / k_max, and the elevation of the surface there.
template <typename Number>
struct UnitPlace {
  std::array<Number, kUnit<Number>> x1, x2, zeta;
  std::array<Number, kUnit<Number>> eta, eta_1, eta_2, eta_11, eta_12, eta_22, eta_third;
};

template <typename Number>
struct DescentWorkspace {
  SeaCells<Number> cells;
  std::vector<Unit> units;                // of this round
  std::vector<UnitPlace<Number>> places;  // of each
  std::vector<std::uint32_t> heads;       // the first unit of each cell
  Results<Number> results;
  std::vector<Number> roots;  // of the results' expected errors
  Pieces<Number> pieces;
  Clips<Number> clips;
  std::vector<std::uint32_t> level, next_level;  // blocks
};

template <typename Number>
class Descent {
 public:
  using V = VectorOf<Number>;

  Descent(const WaveQuery& query, DescentWorkspace<Number>& work)
      : query_(query), work_(work), patch_(patch_query_of<Number>(query)) {
    work_.cells.start(query);
    work_.results.start(query.max_lever);
    work_.pieces.clear();
    work_.clips.clear();
    work_.units.clear();
  }

  WaveLoad run() {
    add_first_level();
    evaluate_round();
    constexpr int kMaxRounds = 24;
    bool capped = false;
    for (int round = 0; round < kMaxRounds && work_.results.total() > query_.budget; ++round) {
      capped = patches_ > kMaxPatches || work_.cells.surface_count() > kMaxCells / 2 ||
               work_.cells.volume_count() > kMaxCells / 2;
      if (capped) break;
      if (!refine()) break;
      evaluate_round();
    }
    WaveLoad load = work_.results.sum();
    load.capped = capped;
    load.too_steep = too_steep_;
    load.patches = static_cast<std::int32_t>(patches_);
    load.cells = static_cast<std::int32_t>(work_.cells.surface_count() + work_.cells.volume_count());
    return load;
  }

 private:
  // A batch of units. Where there are too few, the first repeats, and only `count` results are used.
  struct Batch {
    std::array<std::uint32_t, kUnitsPerVector<Number>> units{};
    std::size_t count = 0;
  };

  // The blocks of the first level that has at least kFirst of them.
  void add_first_level() {
    constexpr std::size_t kFirst = 16;
    std::vector<std::uint32_t>& level = work_.level;
    level.assign(1, 0);
    while (level.size() < kFirst) {
      work_.next_level.clear();
      bool all_inner = true;
      for (const std::uint32_t b : level) {
        const PatchBlock& block = query_.tree->blocks[b];
        for (std::size_t lane = 0; lane < block.patches; ++lane) {
          if (block.triangle_blocks[lane] > 0) all_inner = false;
          work_.next_level.push_back(block.child[lane]);
        }
      }
      if (!all_inner) break;
      level.swap(work_.next_level);
    }
    for (const std::uint32_t b : level) {
      const PatchBlock& block = query_.tree->blocks[b];
      // A model of a leaf that is too large would be of no use.
      bool large = false;
      for (std::size_t lane = 0; lane < block.patches; ++lane) {
        large |= block.triangle_blocks[lane] > 0 && static_cast<double>(block.radius[lane]) > largest_piece();
      }
      if (!large) {
        add_block(b);
        continue;
      }
      for (std::size_t lane = 0; lane < block.patches; ++lane) {
        if (block.triangle_blocks[lane] > 0) {
          work_.pieces.add_triangles(*query_.tree, block, lane, largest_piece());
        } else {
          add_block(block.child[lane]);
        }
      }
    }
  }

  // The radius of pieces [m] at which their models begin to be of use; more where there would be too many.
  double largest_piece() const {
    constexpr double kMaxPieceReach = 1.1;
    constexpr double kFirstPieces = 1000.0;
    return std::max(kMaxPieceReach / patch_.k_max, std::sqrt(query_.tree->area / kFirstPieces));
  }

  void add_block(std::uint32_t block) {
    for (std::uint32_t first = 0; first < kSiblings; first += kUnit<Number>) {
      if (first < query_.tree->blocks[block].patches) {
        Unit unit;
        unit.block = block;
        unit.first = first;
        work_.units.push_back(unit);
      }
    }
  }

  // Replaces results above a threshold by those of their children, or clips them. Returns whether there are
  // any.
  bool refine() {
    const double limit =
        refinement_limit(work_.results.errors(), work_.results.expected(), work_.roots, query_.budget);
    const std::size_t count = work_.results.errors().size();
    bool any = false;
    for (std::size_t n = 0; n < count; ++n) {
      const double error = static_cast<double>(work_.results.errors()[n]);
      if (!(error > limit)) continue;
      any = true;
      // What one round adds is capped as well: it may reach a new cell with each of its units.
      if (units_of_next_round() > kMaxUnits) break;
      const Unit unit = work_.results.unit_of(n);
      const std::size_t lane = unit.first + n % kUnit<Number>;
      const std::uint32_t models = work_.results.clip_models(n);
      // Where children are expected to be above the limit as well.
      const bool grandchildren = static_cast<double>(work_.results.expected()[n]) > kChildrenAbove * limit;
      work_.results.remove(n);
      if (unit.of_pieces) {
        work_.pieces.quarter(unit, lane);
        continue;
      }
      const PatchBlock& block = query_.tree->blocks[unit.block];
      if (block.triangle_blocks[lane] == 0) {
        add_children(block.child[lane], grandchildren);
      } else if (models != kNone &&
                 static_cast<double>(work_.clips.remainder(models, n % kLanes<Number>)) < limit) {
        work_.clips.add(block, lane, models, n);
      } else {
        work_.pieces.add_triangles(*query_.tree, block, lane, largest_piece());
      }
    }
    return any;
  }

  std::size_t units_of_next_round() const {
    return work_.units.size() + work_.pieces.new_count() / kUnit<Number>;
  }

  void add_children(std::uint32_t b, bool grandchildren) {
    const PatchBlock& block = query_.tree->blocks[b];
    bool all_inner = true;
    for (std::size_t lane = 0; lane < block.patches; ++lane) all_inner &= block.triangle_blocks[lane] == 0;
    if (!grandchildren || !all_inner) {
      add_block(b);
      return;
    }
    for (std::size_t lane = 0; lane < block.patches; ++lane) add_block(block.child[lane]);
  }

  // Evaluates the units of the round and appends their results.
  void evaluate_round() {
    work_.pieces.take_new([this](const Unit& unit) { work_.units.push_back(unit); });
    if (work_.places.size() < work_.units.size()) work_.places.resize(work_.units.size());
    place_units();
    link_units(work_.cells.surface_count(), &Unit::surface_cell);
    evaluate_surface();
    if (query_.hydrostatic) {
      link_units(work_.cells.surface_count(), &Unit::surface_cell);
      for_each_batch([this](const Batch& batch, std::size_t cell) { evaluate_batch(batch, cell, 0); });
    } else {
      find_volume_cells();
      link_units(work_.cells.volume_count(), &Unit::volume_cell);
      for_each_batch([this](const Batch& batch, std::size_t cell) {
        evaluate_batch(batch, work_.cells.column_of_volume(cell), cell);
      });
    }
    work_.clips.finish(*query_.tree, patch_, work_.results);
    work_.units.clear();
  }

  static double mean_of(const std::array<Number, kUnit<Number>>& numbers) {
    double sum = 0.0;
    for (const Number number : numbers) sum += static_cast<double>(number);
    return sum / static_cast<double>(kUnit<Number>);
  }

  void place_units() {
    Batch batch;
    for (std::size_t first = 0; first < work_.units.size(); first += batch.count) {
      const bool pieces = work_.units[first].of_pieces;
      batch.count = 0;
      while (batch.count < kUnitsPerVector<Number> && first + batch.count < work_.units.size() &&
             work_.units[first + batch.count].of_pieces == pieces) {
        ++batch.count;
      }
      for (std::size_t n = 0; n < kUnitsPerVector<Number>; ++n) {
        batch.units[n] = static_cast<std::uint32_t>(first + (n < batch.count ? n : 0));
      }
      const Place<Number> place = place_of<Number>(patch_, centers_of(batch));
      write(batch, place.x1, &UnitPlace<Number>::x1);
      write(batch, place.x2, &UnitPlace<Number>::x2);
      write(batch, place.zeta, &UnitPlace<Number>::zeta);
      for (std::size_t n = 0; n < batch.count; ++n) {
        const UnitPlace<Number>& of_unit = work_.places[first + n];
        work_.units[first + n].surface_cell =
            work_.cells.find_surface(mean_of(of_unit.x1), mean_of(of_unit.x2));
      }
    }
    work_.cells.build_surface();
  }

  UnitsOfVector<Number> units_of(const Batch& batch) const {
    UnitsOfVector<Number> units;
    for (std::size_t n = 0; n < units.size(); ++n) units[n] = work_.units[batch.units[n]];
    return units;
  }

  Vectors3<Number> centers_of(const Batch& batch) const {
    const UnitsOfVector<Number> units = units_of(batch);
    if (units[0].of_pieces) return work_.pieces.lanes(units).center;
    const auto axis = [&](std::size_t i) HWY_ATTR {
      return gather_units<Number>(
          [&](std::size_t n) { return &query_.tree->blocks[units[n].block].center[i][units[n].first]; });
    };
    return {axis(0), axis(1), axis(2)};
  }

  void find_volume_cells() {
    for (std::size_t n = 0; n < work_.units.size(); ++n) {
      Unit& unit = work_.units[n];
      if (unit.dry) continue;
      const UnitPlace<Number>& place = work_.places[n];
      double z = 0.0;
      for (std::size_t lane = 0; lane < kUnit<Number>; ++lane) {
        const double eta = static_cast<double>(place.eta[lane]);
        z += (static_cast<double>(place.zeta[lane]) - eta) / (1.0 + eta * patch_.per_depth);
      }
      unit.volume_cell = work_.cells.find_volume(unit.surface_cell, z / static_cast<double>(kUnit<Number>));
    }
    work_.cells.build_volume();
  }

  void link_units(std::size_t cells, std::uint32_t Unit::*cell) {
    work_.heads.assign(cells, kNone);
    for (std::size_t n = work_.units.size(); n-- > 0;) {
      Unit& unit = work_.units[n];
      if (unit.dry) continue;
      std::uint32_t& head = work_.heads[unit.*cell];
      unit.next = head;
      head = static_cast<std::uint32_t>(n);
    }
  }

  // Calls work(batch, cell) for the linked units.
  template <typename Work>
  HWY_INLINE void for_each_batch(const Work& work) {
    for (std::size_t cell = 0; cell < work_.heads.size(); ++cell) {
      for (std::uint32_t n = work_.heads[cell]; n != kNone;) {
        // A batch holds patches of the tree, or triangles.
        Batch batch;
        const bool pieces = work_.units[n].of_pieces;
        while (n != kNone && batch.count < kUnitsPerVector<Number> && work_.units[n].of_pieces == pieces) {
          batch.units[batch.count++] = n;
          n = work_.units[n].next;
        }
        for (std::size_t i = batch.count; i < kUnitsPerVector<Number>; ++i) {
          batch.units[i] = batch.units[0];
        }
        work(batch, cell);
      }
    }
  }

  using UnitNumbers = std::array<Number, kUnit<Number>>;
  HWY_INLINE V read(const Batch& batch, UnitNumbers UnitPlace<Number>::*row) const {
    return gather_units<Number>([&](std::size_t n) { return (work_.places[batch.units[n]].*row).data(); });
  }
  HWY_INLINE void write(const Batch& batch, const V& vector, UnitNumbers UnitPlace<Number>::*row) {
    alignas(64) std::array<Number, kLanes<Number>> numbers;
    hn::Store(vector, LanesOf<Number>(), numbers.data());
    for (std::size_t n = 0; n < batch.count; ++n) {
      std::copy_n(numbers.data() + n * kUnit<Number>, kUnit<Number>,
                  (work_.places[batch.units[n]].*row).data());
    }
  }

  void evaluate_surface() {
    for_each_batch([this](const Batch& batch, std::size_t cell) HWY_ATTR {
      const CellCenter& center = work_.cells.surface_center(cell);
      const V x1 = read(batch, &UnitPlace<Number>::x1) - set<Number>(center.x1);
      const V x2 = read(batch, &UnitPlace<Number>::x2) - set<Number>(center.x2);
      const SurfaceValues<Number> values = evaluate<Number>(work_.cells.surface(cell), x1, x2);
      write(batch, values.eta, &UnitPlace<Number>::eta);
      write(batch, values.eta_1, &UnitPlace<Number>::eta_1);
      write(batch, values.eta_2, &UnitPlace<Number>::eta_2);
      write(batch, values.eta_11, &UnitPlace<Number>::eta_11);
      write(batch, values.eta_12, &UnitPlace<Number>::eta_12);
      write(batch, values.eta_22, &UnitPlace<Number>::eta_22);
      write(batch, values.third, &UnitPlace<Number>::eta_third);
      note_dry(batch, cell, x1, x2, values);
    });
  }

  // Finds the units that are dry as a whole: there is nothing else to be computed of them.
  HWY_INLINE void note_dry(const Batch& batch, std::size_t cell, const V& x1, const V& x2,
                           const SurfaceValues<Number>& values) {
    const UnitsOfVector<Number> units = units_of(batch);
    const V radius =
        units[0].of_pieces ? work_.pieces.lanes(units).radius : gather_units<Number>([&](std::size_t n) {
          return &query_.tree->blocks[units[n].block].radius[units[n].first];
        });
    const SurfaceRange<Number> range =
        range_of<Number>(read(batch, &UnitPlace<Number>::zeta), radius * set<Number>(patch_.k_max), values,
                         work_.cells.surface(cell).bounds, hn::Sqrt(hn::MulAdd(x1, x1, x2 * x2)),
                         set<Number>(patch_.rounding()));
    const std::uint32_t dry = bits_of<Number>(hn::Gt(range.low, set<Number>(0.0)));
    constexpr std::uint32_t kAll = (std::uint32_t{1} << kUnit<Number>)-1;
    for (std::size_t n = 0; n < batch.count; ++n) {
      work_.units[batch.units[n]].dry = (dry >> (n * kUnit<Number>)&kAll) == kAll;
    }
  }

  void evaluate_batch(const Batch& batch, std::size_t surface_cell, std::size_t volume_cell) {
    if (work_.units[batch.units[0]].of_pieces) {
      evaluate_batch<true>(batch, surface_cell, volume_cell);
    } else {
      evaluate_batch<false>(batch, surface_cell, volume_cell);
    }
  }

  template <bool kPieces>
  HWY_NOINLINE void evaluate_batch(const Batch& batch, std::size_t surface_cell, std::size_t volume_cell) {
    const V zero = set<Number>(0.0);
    const Place<Number> place{read(batch, &UnitPlace<Number>::x1), read(batch, &UnitPlace<Number>::x2),
                              read(batch, &UnitPlace<Number>::zeta)};
    const SurfaceValues<Number> surface{
        read(batch, &UnitPlace<Number>::eta),      read(batch, &UnitPlace<Number>::eta_1),
        read(batch, &UnitPlace<Number>::eta_2),    read(batch, &UnitPlace<Number>::eta_11),
        read(batch, &UnitPlace<Number>::eta_12),   read(batch, &UnitPlace<Number>::eta_22),
        read(batch, &UnitPlace<Number>::eta_third)};
    const CellCenter& above = work_.cells.surface_center(surface_cell);
    const V x1 = place.x1 - set<Number>(above.x1);
    const V x2 = place.x2 - set<Number>(above.x2);
    const V horizontal = hn::MulAdd(x1, x1, x2 * x2);
    const CellBounds<Number>& surface_bounds = work_.cells.surface(surface_cell).bounds;
    VolumeValues<Number> f{zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
    V volume_reach = zero;
    const CellBounds<Number>* volume_bounds = &surface_bounds;
    if (!query_.hydrostatic) {
      const VolumeCell<Number>& cell = work_.cells.volume(volume_cell);
      const V z = stretched<Number>(patch_, place, surface.eta) -
                  set<Number>(work_.cells.volume_center(volume_cell).z);
      f = evaluate<Number>(cell, x1, x2, z);
      volume_reach = hn::Sqrt(hn::MulAdd(z, z, horizontal));
      volume_bounds = &cell.bounds;
    }
    const auto in_use = hn::FirstN(LanesOf<Number>(), batch.count * kUnit<Number>);
    const UnitsOfVector<Number> units = units_of(batch);
    PatchIntegrals<Number> integrals;
    Clippable clippable;
    hn::Mask<LanesOf<Number>> counts;
    if constexpr (kPieces) {
      const PieceLanes<Number> piece = work_.pieces.lanes(units);
      const PatchModel<Number> model =
          model_of<Number>(patch_, place, piece.radius, surface, surface_bounds, hn::Sqrt(horizontal), f,
                           *volume_bounds, volume_reach);
      too_steep_ |= !hn::AllFalse(LanesOf<Number>(), model.too_steep);
      counts = hn::AndNot(model.dry, in_use);
      integrals = integrate<Number>(patch_, piece, model);
    } else {
      const PatchMoments<Number> moments = read_moments<Number>(*query_.tree, units);
      const PatchModel<Number> model =
          model_of<Number>(patch_, place, moments.radius, surface, surface_bounds, hn::Sqrt(horizontal), f,
                           *volume_bounds, volume_reach);
      too_steep_ |= !hn::AllFalse(LanesOf<Number>(), model.too_steep);
      counts = hn::AndNot(model.dry, in_use);
      integrals = integrate<Number>(patch_, moments, model);
      const auto crossing = hn::AndNot(model.whole, counts);
      if (!hn::AllFalse(LanesOf<Number>(), crossing)) {
        clippable.lanes = bits_of<Number>(hn::And(crossing, leaves<Number>(*query_.tree, units)));
        if (clippable.lanes != 0) clippable.models = work_.clips.keep(patch_, moments, model);
      }
    }
    patches_ += hn::CountTrue(LanesOf<Number>(), counts);
    clear_where<Number>(hn::Not(counts), integrals);
    work_.results.add(units, integrals, clippable);
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
