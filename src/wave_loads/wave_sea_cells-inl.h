// The cells of one query: those that its patches have touched so far. Included once per instruction set.
#if defined(BUOYANCY_WAVE_SEA_CELLS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_SEA_CELLS_INL_H
#undef BUOYANCY_WAVE_SEA_CELLS_INL_H
#else
#define BUOYANCY_WAVE_SEA_CELLS_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_field-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_sums-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// The places in a grid that have been asked for, numbered in the order of their first use, and the cell at
// each: kNone until one is put there.
class GridPlaces {
 public:
  struct Indices {
    std::int32_t i, j, k;
    bool operator==(const Indices&) const = default;
  };

  void clear() {
    ++generation_;
    indices_.clear();
    cells_.clear();
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(indices_.size()); }

  // Numbers a place that has not been asked for.
  std::uint32_t number_of(const Indices& at) {
    Slot& slot = slots_[slot_of(at)];
    if (slot.generation != generation_) {
      slot = {generation_, count()};
      indices_.push_back(at);
      cells_.push_back(kNone);
    }
    return slot.number;
  }
  const Indices& indices(std::uint32_t number) const { return indices_[number]; }
  std::uint32_t cell(std::uint32_t number) const { return cells_[number]; }
  std::uint32_t cell_at(const Indices& at) const {
    const Slot& slot = slots_[slot_of(at)];
    return slot.generation == generation_ ? cells_[slot.number] : kNone;
  }
  void put(std::uint32_t number, std::uint32_t cell) { cells_[number] = cell; }

 private:
  // The slot that holds a place, or would hold it.
  std::uint32_t slot_of(const Indices& at) const {
    const std::uint32_t product = static_cast<std::uint32_t>(at.i) * 73856093U ^
                                  static_cast<std::uint32_t>(at.j) * 19349663U ^
                                  static_cast<std::uint32_t>(at.k) * 83492791U;
    std::uint32_t slot = (product ^ product >> 15U) % kSlots;
    while (slots_[slot].generation == generation_ && indices_[slots_[slot].number] != at) {
      slot = (slot + 1) % kSlots;
    }
    return slot;
  }

  // More than there can be places: kMaxPlaces before a round, and one for each group of a round.
  static constexpr std::size_t kSlots = 32'768;
  static_assert(kSlots > kMaxPlaces + kMaxGroups + 4'096);
  struct Slot {
    std::uint32_t generation = 0;
    std::uint32_t number = 0;
  };
  std::uint32_t generation_ = 0;
  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
  std::vector<Indices> indices_;
  std::vector<std::uint32_t> cells_;
};

// A place in the grid is asked for, which numbers it; a cell is put there or a neighbour is used, and cells
// are built before they are read. A patch need not be in the cell that it is given: bounds depend on its
// distance from the centre.
template <typename Number>
class SeaCells {
 public:
  void start(const WaveQuery& query) {
    query_ = &query;
    surface_places_.clear();
    volume_places_.clear();
    surface_centers_.clear();
    volume_centers_.clear();
    column_of_volume_.clear();
    level_of_volume_.clear();
    surfaces_built_ = volumes_built_ = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) per_edge_[axis] = 1.0 / query.grid.edge[axis];
    reach_ = kReach * std::hypot(query.grid.edge[0], query.grid.edge[1], query.grid.edge[2]);
    work_.start(*query.expansion);
    set_phases(query, work_.phases);
  }

  const GridPlaces& surface_places() const { return surface_places_; }
  const GridPlaces& volume_places() const { return volume_places_; }

  std::uint32_t surface_place(double x1, double x2) {
    return surface_places_.number_of({place(x1, 0), place(x2, 1), 0});
  }
  // Below or above a cell of the surface; z: z' over 1 / k_max.
  std::uint32_t volume_place(std::uint32_t surface_cell, double z) {
    // The highest cells reach up to the highest patches. All others are twice as high: short waves, which
    // limit the size of a cell, do not reach down to them.
    const std::int32_t depth = std::max(-1 - place(z, 2), 0);
    return volume_places_.number_of({static_cast<std::int32_t>(surface_cell), 0, (depth + 1) / 2});
  }

  // The cell beside a place whose expansion reaches a point of it; kNone if there is none.
  std::uint32_t surface_beside(std::uint32_t place, double x1, double x2) const {
    const auto [i, j, k] = surface_places_.indices(place);
    const auto reaches = [&](std::uint32_t cell) {
      return cell != kNone && within_reach(x1 - surface_centers_[cell].x1, x2 - surface_centers_[cell].x2);
    };
    std::uint32_t cell = surface_places_.cell_at({x1 < center_of(i, 0) ? i - 1 : i + 1, j, k});
    if (reaches(cell)) return cell;
    cell = surface_places_.cell_at({i, x2 < center_of(j, 1) ? j - 1 : j + 1, k});
    return reaches(cell) ? cell : kNone;
  }
  std::uint32_t volume_beside(std::uint32_t place, double x1, double x2, double z) const {
    const auto [column, zero, level] = volume_places_.indices(place);
    const std::uint32_t cell =
        volume_places_.cell_at({column, zero, z < height_of(level) ? level + 1 : level - 1});
    if (cell == kNone) return kNone;
    const CellCenter& center = volume_centers_[cell];
    return within_reach(x1 - center.x1, x2 - center.x2, z - center.z) ? cell : kNone;
  }

  std::uint32_t put_surface(std::uint32_t place) {
    const auto [i, j, k] = surface_places_.indices(place);
    const auto cell = static_cast<std::uint32_t>(surface_centers_.size());
    surface_centers_.push_back({center_of(i, 0), center_of(j, 1), 0.0});
    surface_places_.put(place, cell);
    return cell;
  }
  std::uint32_t put_volume(std::uint32_t place) {
    const auto [column, zero, level] = volume_places_.indices(place);
    const auto cell = static_cast<std::uint32_t>(volume_centers_.size());
    const CellCenter& above = surface_centers_[static_cast<std::size_t>(column)];
    volume_centers_.push_back({above.x1, above.x2, height_of(level)});
    column_of_volume_.push_back(static_cast<std::uint32_t>(column));
    level_of_volume_.push_back(static_cast<std::uint32_t>(level));
    volume_places_.put(place, cell);
    return cell;
  }

  void build_surface() {
    build<true>(surface_centers_, table().monomials, kMonomialColumnsOfWeight, surfaces_, surfaces_built_);
  }
  void build_volume() {
    build<false>(volume_centers_, table().harmonics, kHarmonicColumnsOfWeight, volumes_, volumes_built_);
  }

  // Whether no round may add any.
  bool full() const {
    return std::max(surface_count(), volume_count()) > query_->cap_on(kMaxCells) ||
           std::max(surface_places_.count(), volume_places_.count()) > kMaxPlaces;
  }
  std::size_t surface_count() const { return surface_centers_.size(); }
  std::size_t volume_count() const { return volume_centers_.size(); }
  const SurfaceCell<Number>& surface(std::size_t cell) const { return surfaces_[cell]; }
  const VolumeCell<Number>& volume(std::size_t cell) const { return volumes_[cell]; }
  const CellCenter& surface_center(std::size_t cell) const { return surface_centers_[cell]; }
  const CellCenter& volume_center(std::size_t cell) const { return volume_centers_[cell]; }
  std::uint32_t column_of_volume(std::size_t cell) const { return column_of_volume_[cell]; }

 private:
  // The share of a cell's diagonal within which a neighbour's expansion is used: a new cell costs more than
  // what the neighbour's leaves out there.
  static constexpr double kReach = 0.475;

  bool within_reach(double x1, double x2, double z = 0.0) const {
    return x1 * x1 + x2 * x2 + z * z <= reach_ * reach_;
  }
  std::int32_t place(double x, std::size_t axis) const {
    constexpr double kFarthest = 1e9;
    const CellGrid& grid = query_->grid;
    return static_cast<std::int32_t>(
        std::clamp(std::floor((x - grid.origin[axis]) * per_edge_[axis]), -kFarthest, kFarthest));
  }
  double center_of(std::int32_t cell, std::size_t axis) const {
    return query_->grid.origin[axis] + (cell + 0.5) * query_->grid.edge[axis];
  }
  double height_of(std::int32_t level) const {
    return query_->grid.origin[2] - (level == 0 ? 0.5 : 2.0 * level) * query_->grid.edge[2];
  }

  const ExpansionTable<Number>& table() const {
    if constexpr (sizeof(Number) == sizeof(float)) {
      return query_->expansion->single_precision;
    } else {
      return query_->expansion->double_precision;
    }
  }

  using ComponentRow = typename ComponentRows<Number>::Row;
  // in_batch: as in ComponentRows::get().
  ComponentRow turns_of(std::size_t surface_cell, std::size_t in_batch) {
    return work_.turns.get(surface_cell, in_batch, [&](Number* cosines, Number* sines) {
      set_turns<Number>(*query_->expansion, work_.phases, surface_centers_[surface_cell], cosines, sines);
      return Number{0};  // not of use
    });
  }
  ComponentRow amplitudes_of_surface() {
    return work_.amplitudes.get(0, 0, [&](Number* even, Number* /*odd*/) {
      return set_amplitudes<Number>(table(), query_->sea->amplitude_factor(), even);
    });
  }
  ComponentRow amplitudes_of(std::size_t volume_cell, std::size_t in_batch) {
    return work_.amplitudes.get(1 + level_of_volume_[volume_cell], in_batch, [&](Number* even, Number* odd) {
      return set_amplitudes<Number>(table(), query_->sea->amplitude_factor(), query_->deep_water(),
                                    volume_centers_[volume_cell].z, even, odd);
    });
  }

  // Sums with the powers k^l, of a sea with slots: for the surface what the terms of degree l have; for the
  // volume the weights of its terms of even orders m, then those of odd m. A weight is of an odd derivative
  // where l + m is odd. same: as in set_weights().
  template <bool kSurface>
  void accumulate_slots(const ComponentSlots& slots, bool same, std::size_t count) {
    using enum Weight;
    const std::vector<StepPowers<Number>>& powers = table().powers;
    if constexpr (kSurface) {
      accumulate_lanes<Number, PowerWeights{kCosineEven, kSineEven}>(slots, powers, count, work_);
    } else if (same) {
      accumulate_lanes<Number, PowerWeights{kCosineEven, kCosineEven}, PowerWeights{kSineEven, kSineEven}>(
          slots, powers, count, work_);
    } else {
      accumulate_lanes<Number, PowerWeights{kCosineEven, kCosineOdd}, PowerWeights{kSineOdd, kSineEven}>(
          slots, powers, count, work_);
    }
  }

  template <bool kSurface>
  auto& coefficients_of() {
    if constexpr (kSurface) {
      return of_surface_;
    } else {
      return of_volume_;
    }
  }

  // Builds the cells from number `built` on.
  template <bool kSurface, typename Row, typename Cell>
  void build(const std::vector<CellCenter>& centers, const std::vector<Row>& rows,
             const std::array<ColumnRange, kWeights>& of_weight, std::vector<Cell>& cells,
             std::size_t& built) {
    if (cells.size() < centers.size()) cells.resize(centers.size());
    const bool same = kSurface || query_->deep_water();
    while (built < centers.size()) {
      const std::size_t count = std::min(centers.size() - built, kCellsTogether);
      for (std::size_t n = 0; n < count; ++n) {
        work_.factors[n] = {turns_of(kSurface ? built + n : column_of_volume_[built + n], n),
                            kSurface ? amplitudes_of_surface() : amplitudes_of(built + n, n)};
      }
      const ComponentSlots& slots = query_->expansion->slots;
      if (slots.any()) {
        accumulate_slots<kSurface>(slots, same, count);
      } else {
        for (std::size_t n = 0; n < count; ++n) set_weights<Number>(*query_->expansion, same, n, work_);
        accumulate<Number>(rows, of_weight, same, count, work_);
      }
      for (std::size_t n = 0; n < count; ++n) {
        auto& coefficients = coefficients_of<kSurface>();
        if (!slots.any()) {
          set_coefficients<Number>(work_.sums[n].columns, coefficients);
        } else if constexpr (kSurface) {
          set_coefficients<Number>(table().slots, &work_.lane_sums[n * slots.blocks], coefficients);
        } else {
          const LaneSums<Number>* const cosines = &work_.lane_sums[2 * n * slots.blocks];
          set_coefficients<Number>(table().slots, cosines, cosines + slots.blocks, coefficients);
        }
        finish<Number>(coefficients, work_.factors[n].amplitudes.sum, cells[built + n]);
      }
      built += count;
    }
  }

  const WaveQuery* query_ = nullptr;
  GridPlaces surface_places_, volume_places_;
  std::vector<CellCenter> surface_centers_, volume_centers_;
  std::vector<std::uint32_t> column_of_volume_, level_of_volume_;
  std::vector<SurfaceCell<Number>> surfaces_;
  std::vector<VolumeCell<Number>> volumes_;
  std::array<double, 3> per_edge_{};
  double reach_ = 0.0;  // of a neighbour's expansion
  std::size_t surfaces_built_ = 0, volumes_built_ = 0;
  CellWorkspace<Number> work_;
  // Of the cell that is being built; kept, so that they are set to zero only once.
  MonomialCoefficients<Number> of_surface_;
  HarmonicCoefficients<Number> of_volume_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_SEA_CELLS_INL_H
