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

#include "wave_loads/wave_cells-inl.h"
#include "wave_loads/wave_coefficients-inl.h"
#include "wave_loads/wave_query.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Numbers of cells by their place in a grid, in the order of their first use.
class CellIndex {
 public:
  void clear() {
    ++generation_;
    count_ = 0;
  }
  std::uint32_t count() const { return count_; }

  // The cell's number; kNone if it has not been used.
  std::uint32_t find(std::int32_t i, std::int32_t j, std::int32_t k) const {
    for (std::uint32_t hash = hash_of(i, j, k);; ++hash) {
      const Slot& slot = slots_[hash % kSlots];
      if (slot.generation != generation_) return kNone;
      if (slot.i == i && slot.j == j && slot.k == k) return slot.number;
    }
  }
  // Numbers a cell that has not been used.
  std::uint32_t add(std::int32_t i, std::int32_t j, std::int32_t k) {
    std::uint32_t hash = hash_of(i, j, k);
    while (slots_[hash % kSlots].generation == generation_) ++hash;
    slots_[hash % kSlots] = {generation_, i, j, k, count_};
    return count_++;
  }

 private:
  static std::uint32_t hash_of(std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::uint32_t hash = static_cast<std::uint32_t>(i) * 73856093U ^
                               static_cast<std::uint32_t>(j) * 19349663U ^
                               static_cast<std::uint32_t>(k) * 83492791U;
    return hash ^ hash >> 15U;
  }

  // More than there can be cells: kMaxCells / 2 before a round, and one for each unit of a round.
  static constexpr std::size_t kSlots = 32'768;
  static_assert(kSlots > kMaxCells / 2 + kMaxUnits + 4'096);
  struct Slot {
    std::uint32_t generation = 0;
    std::int32_t i = 0, j = 0, k = 0;
    std::uint32_t number = 0;
  };
  std::uint32_t generation_ = 0;
  std::uint32_t count_ = 0;
  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
};

// Cells are found, which gives a new one its number and centre, and built before they are read. A patch need
// not be in the cell that it is given: bounds depend on its distance from the centre.
template <typename Number>
class SeaCells {
 public:
  void start(const WaveQuery& query) {
    query_ = &query;
    surface_index_.clear();
    volume_index_.clear();
    surface_centers_.clear();
    volume_centers_.clear();
    column_of_volume_.clear();
    level_of_volume_.clear();
    surfaces_built_ = volumes_built_ = 0;
    reach_ = kReach * std::hypot(query.grid.edge[0], query.grid.edge[1], query.grid.edge[2]);
    work_.start(*query.expansion);
    set_phases(query, work_.phases);
  }

  std::uint32_t find_surface(double x1, double x2) {
    const std::int32_t i = place(x1, 0);
    const std::int32_t j = place(x2, 1);
    std::uint32_t cell = surface_index_.find(i, j, 0);
    if (cell != kNone) return cell;
    const std::int32_t next_i = x1 < center_of(i, 0) ? i - 1 : i + 1;
    const std::int32_t next_j = x2 < center_of(j, 1) ? j - 1 : j + 1;
    const auto reaches = [&](std::uint32_t other) {
      return other != kNone && within_reach(x1 - surface_centers_[other].x1, x2 - surface_centers_[other].x2);
    };
    cell = surface_index_.find(next_i, j, 0);
    if (reaches(cell)) return cell;
    cell = surface_index_.find(i, next_j, 0);
    if (reaches(cell)) return cell;
    surface_centers_.push_back({center_of(i, 0), center_of(j, 1), 0.0});
    return surface_index_.add(i, j, 0);
  }
  // Below or above a cell of the surface; z: z' over 1 / k_max.
  std::uint32_t find_volume(std::uint32_t surface_cell, double x1, double x2, double z) {
    // The highest cells reach up to the highest patches. All others are twice as high: short waves, which
    // limit the size of a cell, do not reach down to them.
    const std::int32_t depth = std::max(-1 - place(z, 2), 0);
    const std::int32_t k = (depth + 1) / 2;
    const auto column = static_cast<std::int32_t>(surface_cell);
    std::uint32_t cell = volume_index_.find(column, 0, k);
    if (cell != kNone) return cell;
    const CellCenter& above = surface_centers_[surface_cell];
    const double height = query_->grid.origin[2] - (k == 0 ? 0.5 : 2.0 * k) * query_->grid.edge[2];
    cell = volume_index_.find(column, 0, z < height ? k + 1 : k - 1);
    if (cell != kNone && within_reach(x1 - above.x1, x2 - above.x2, z - volume_centers_[cell].z)) {
      return cell;
    }
    volume_centers_.push_back({above.x1, above.x2, height});
    column_of_volume_.push_back(surface_cell);
    level_of_volume_.push_back(static_cast<std::uint32_t>(k));
    return volume_index_.add(column, 0, k);
  }

  void build_surface() {
    build<true>(surface_centers_, table().monomials, kMonomialColumnsOfWeight, surfaces_, surfaces_built_);
  }
  void build_volume() {
    build<false>(volume_centers_, table().harmonics, kHarmonicColumnsOfWeight, volumes_, volumes_built_);
  }

  std::size_t surface_count() const { return surface_centers_.size(); }
  std::size_t volume_count() const { return volume_centers_.size(); }
  const SurfaceCell<Number>& surface(std::size_t cell) const { return surfaces_[cell]; }
  const VolumeCell<Number>& volume(std::size_t cell) const { return volumes_[cell]; }
  const CellCenter& surface_center(std::size_t cell) const { return surface_centers_[cell]; }
  const CellCenter& volume_center(std::size_t cell) const { return volume_centers_[cell]; }
  std::uint32_t column_of_volume(std::size_t cell) const { return column_of_volume_[cell]; }

 private:
  // A patch whose own cell has not been built takes a neighbour within this share of a cell's diagonal: a new
  // cell costs more than what the neighbour's expansion leaves out there.
  static constexpr double kReach = 0.475;

  bool within_reach(double x1, double x2, double z = 0.0) const {
    return x1 * x1 + x2 * x2 + z * z <= reach_ * reach_;
  }
  std::int32_t place(double x, std::size_t axis) const {
    constexpr double kFarthest = 1e9;
    const CellGrid& grid = query_->grid;
    return static_cast<std::int32_t>(
        std::clamp(std::floor((x - grid.origin[axis]) / grid.edge[axis]), -kFarthest, kFarthest));
  }
  double center_of(std::int32_t cell, std::size_t axis) const {
    return query_->grid.origin[axis] + (cell + 0.5) * query_->grid.edge[axis];
  }

  const ExpansionTable<Number>& table() const {
    if constexpr (sizeof(Number) == sizeof(float)) {
      return query_->expansion->single_precision;
    } else {
      return query_->expansion->double_precision;
    }
  }

  using ComponentRow = typename ComponentRows<Number>::Row;
  ComponentRow turns_of(std::size_t surface_cell) {
    return work_.turns.get(surface_cell, [&](Number* cosines, Number* sines) {
      set_turns<Number>(*query_->expansion, work_.phases, surface_centers_[surface_cell], cosines, sines);
    });
  }
  ComponentRow amplitudes_of_surface() {
    return work_.amplitudes.get(0, [&](Number* even, Number* /*odd*/) {
      set_amplitudes<Number>(table(), query_->sea->amplitude_factor(), even);
    });
  }
  ComponentRow amplitudes_of(std::size_t volume_cell) {
    return work_.amplitudes.get(1 + level_of_volume_[volume_cell], [&](Number* even, Number* odd) {
      set_amplitudes<Number>(table(), query_->sea->amplitude_factor(), query_->deep_water(),
                             volume_centers_[volume_cell].z, even, odd);
    });
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
        set_weights<Number>(*query_->expansion, table(),
                            turns_of(kSurface ? built + n : column_of_volume_[built + n]),
                            kSurface ? amplitudes_of_surface() : amplitudes_of(built + n), same, n, work_);
      }
      const ComponentSlots& slots = query_->expansion->slots;
      if (slots.any()) {
        accumulate_slots<Number>(slots, table().powers, same, count, work_);
      } else {
        accumulate<Number>(rows, of_weight, same, count, work_);
      }
      for (std::size_t n = 0; n < count; ++n) {
        std::conditional_t<kSurface, MonomialCoefficients<Number>, HarmonicCoefficients<Number>> coefficients;
        if (slots.any()) {
          set_coefficients<Number>(table().slots, &work_.power_sums[n * slots.blocks], coefficients);
        } else {
          set_coefficients<Number>(work_.sums[n].columns, coefficients);
        }
        finish<Number>(coefficients, work_.tails[n], cells[built + n]);
      }
      built += count;
    }
  }

  const WaveQuery* query_ = nullptr;
  CellIndex surface_index_, volume_index_;
  std::vector<CellCenter> surface_centers_, volume_centers_;
  std::vector<std::uint32_t> column_of_volume_, level_of_volume_;
  std::vector<SurfaceCell<Number>> surfaces_;
  std::vector<VolumeCell<Number>> volumes_;
  double reach_ = 0.0;  // of a neighbour's expansion
  std::size_t surfaces_built_ = 0, volumes_built_ = 0;
  CellWorkspace<Number> work_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_SEA_CELLS_INL_H
