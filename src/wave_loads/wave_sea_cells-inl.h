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

  std::uint32_t find_or_add(std::int32_t i, std::int32_t j, std::int32_t k) {
    std::uint32_t hash = static_cast<std::uint32_t>(i) * 73856093U ^
                         static_cast<std::uint32_t>(j) * 19349663U ^
                         static_cast<std::uint32_t>(k) * 83492791U;
    hash ^= hash >> 15U;
    for (;; ++hash) {
      Slot& slot = slots_[hash % kSlots];
      if (slot.generation != generation_) {
        slot = {generation_, i, j, k, count_};
        return count_++;
      }
      if (slot.i == i && slot.j == j && slot.k == k) return slot.number;
    }
  }

 private:
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

// Cells are found, which gives a new one its number and centre, and built before they are read.
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
    surfaces_built_ = volumes_built_ = 0;
    work_.reserve(query.expansion->filled_components);
    set_phases(query, work_.phases);
  }

  std::uint32_t find_surface(double x1, double x2) {
    const std::int32_t i = place(x1, 0);
    const std::int32_t j = place(x2, 1);
    const std::uint32_t cell = surface_index_.find_or_add(i, j, 0);
    if (cell == surface_centers_.size()) {
      surface_centers_.push_back({center_of(i, 0), center_of(j, 1), 0.0});
    }
    return cell;
  }
  // Below or above a cell of the surface; z: z' over 1 / k_max.
  std::uint32_t find_volume(std::uint32_t surface_cell, double z) {
    // The highest cells reach up to the highest patches. All others are twice as high: short waves, which
    // limit the size of a cell, do not reach down to them.
    const std::int32_t depth = std::max(-1 - place(z, 2), 0);
    const std::int32_t k = (depth + 1) / 2;
    const std::uint32_t cell = volume_index_.find_or_add(static_cast<std::int32_t>(surface_cell), 0, k);
    if (cell == volume_centers_.size()) {
      const CellCenter& above = surface_centers_[surface_cell];
      const double center = k == 0 ? 0.5 : 2.0 * k;  // in edges, below the top
      volume_centers_.push_back({above.x1, above.x2, query_->grid.origin[2] - center * query_->grid.edge[2]});
      column_of_volume_.push_back(surface_cell);
    }
    return cell;
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

  // Builds the cells from number `built` on.
  template <bool kSurface, typename Row, typename Cell>
  void build(const std::vector<CellCenter>& centers, const std::vector<Row>& rows,
             const std::array<ColumnRange, kWeights>& of_weight, std::vector<Cell>& cells,
             std::size_t& built) {
    if (cells.size() < centers.size()) cells.resize(centers.size());
    const bool deep_water = query_->deep_water();
    while (built < centers.size()) {
      const std::size_t count = std::min(centers.size() - built, kCellsTogether);
      for (std::size_t n = 0; n < count; ++n) {
        set_weights<kSurface, Number>(*query_->expansion, table(), query_->sea->amplitude_factor(),
                                      deep_water, centers[built + n], n, work_);
      }
      accumulate<Number>(rows, of_weight, deep_water, count, work_);
      for (std::size_t n = 0; n < count; ++n) {
        finish<Number>(work_.sums[n].columns, work_.tails[n], cells[built + n]);
      }
      built += count;
    }
  }

  const WaveQuery* query_ = nullptr;
  CellIndex surface_index_, volume_index_;
  std::vector<CellCenter> surface_centers_, volume_centers_;
  std::vector<std::uint32_t> column_of_volume_;
  std::vector<SurfaceCell<Number>> surfaces_;
  std::vector<VolumeCell<Number>> volumes_;
  std::size_t surfaces_built_ = 0, volumes_built_ = 0;
  CellWorkspace<Number> work_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_SEA_CELLS_INL_H
