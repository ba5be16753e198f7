// The patches of a round: where they are, in which cells of the sea, and the elevation of its surface there,
// with SIMD. Included once per instruction set.
#if defined(BUOYANCY_WAVE_ROUND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_ROUND_INL_H
#undef BUOYANCY_WAVE_ROUND_INL_H
#else
#define BUOYANCY_WAVE_ROUND_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_load_sum-inl.h"
#include "wave_loads/wave_models-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_sea_cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// The places of a group's patches over 1 / k_max, and the elevation of the surface there.
template <typename Number>
struct GroupPlace {
  std::array<Number, kGroup<Number>> x1, x2, zeta;
  std::array<Number, kGroup<Number>> eta, eta_1, eta_2, eta_11, eta_12, eta_22, eta_third;
};

// The mean place of a group's patches over 1 / k_max; z: z', known once the elevation is.
template <typename Number>
struct GroupMean {
  Number x1, x2, z;
};

// Of a round and of one cell. Where there are too few, the first repeats, and only `count` results are used.
template <typename Number>
struct Batch {
  std::array<std::uint32_t, kGroupsPerVector<Number>> groups{};
  std::size_t count = 0;
};

// What the patches of a round have in every sea: their places, and room for the elevation there.
template <typename Number>
class PlacedPatches {
 public:
  using V = VectorOf<Number>;

  std::size_t count() const { return groups_.size(); }
  void clear() { groups_.clear(); }

  void add_block(std::uint32_t block) {
    prefetch_places(patches_->block(block));
    for_each_group<Number>(patches_->block(block), [&](std::uint32_t first) {
      PatchGroup group;
      group.block = block;
      group.first = first;
      groups_.push_back(group);
    });
  }

  using GroupNumbers = std::array<Number, kGroup<Number>>;
  HWY_INLINE V read(const Batch<Number>& batch, GroupNumbers GroupPlace<Number>::*row) const {
    return gather_groups<Number>([&](std::size_t n) { return (places_[batch.groups[n]].*row).data(); });
  }
  GroupsOfVector<Number> groups_of(const Batch<Number>& batch) const {
    GroupsOfVector<Number> groups;
    for (std::size_t n = 0; n < groups.size(); ++n) groups[n] = groups_[batch.groups[n]];
    return groups;
  }

 protected:
  void start(const QueryPatches& patches, const PatchQuery<Number>& patch) {
    patches_ = &patches;
    patch_ = &patch;
    groups_.clear();
  }

  // Calls take(batch, place) for all groups.
  template <typename Take>
  HWY_INLINE void place_groups(const Take& take) {
    if (places_.size() < groups_.size()) places_.resize(groups_.size());
    Batch<Number> batch;
    for (std::size_t first = 0; first < groups_.size(); first += batch.count) {
      batch.count = std::min(kGroupsPerVector<Number>, groups_.size() - first);
      for (std::size_t n = 0; n < kGroupsPerVector<Number>; ++n) {
        batch.groups[n] = static_cast<std::uint32_t>(first + (n < batch.count ? n : 0));
      }
      const Place<Number> place = place_of<Number>(*patch_, centers_of(batch));
      write(batch, place.x1, &GroupPlace<Number>::x1);
      write(batch, place.x2, &GroupPlace<Number>::x2);
      write(batch, place.zeta, &GroupPlace<Number>::zeta);
      take(batch, place);
    }
  }

  HWY_INLINE void write(const Batch<Number>& batch, const SurfaceValues<Number>& values) {
    write(batch, values.eta, &GroupPlace<Number>::eta);
    write(batch, values.eta_1, &GroupPlace<Number>::eta_1);
    write(batch, values.eta_2, &GroupPlace<Number>::eta_2);
    write(batch, values.eta_11, &GroupPlace<Number>::eta_11);
    write(batch, values.eta_12, &GroupPlace<Number>::eta_12);
    write(batch, values.eta_22, &GroupPlace<Number>::eta_22);
    write(batch, values.third, &GroupPlace<Number>::eta_third);
  }

  // Sets place and surface.
  HWY_INLINE void read_surface(const Batch<Number>& batch, SurfaceField<Number>& field) const {
    field.place = {read(batch, &GroupPlace<Number>::x1), read(batch, &GroupPlace<Number>::x2),
                   read(batch, &GroupPlace<Number>::zeta)};
    field.surface = {read(batch, &GroupPlace<Number>::eta),      read(batch, &GroupPlace<Number>::eta_1),
                     read(batch, &GroupPlace<Number>::eta_2),    read(batch, &GroupPlace<Number>::eta_11),
                     read(batch, &GroupPlace<Number>::eta_12),   read(batch, &GroupPlace<Number>::eta_22),
                     read(batch, &GroupPlace<Number>::eta_third)};
  }

  HWY_INLINE V radii_of(const Batch<Number>& batch) const {
    const V radius = gather_groups<Number>([&](std::size_t n) {
      const PatchGroup& group = groups_[batch.groups[n]];
      return &patches_->block(group.block).radius[group.first];
    });
    return radius * set<Number>(patch_->k_max);
  }

  // Finds the groups that are dry as a whole: there is nothing else to be computed of them. low: of the
  // height over the surface.
  HWY_INLINE void note_dry(const Batch<Number>& batch, const V& low) {
    const std::uint32_t dry = bits_of<Number>(hn::Gt(low, set<Number>(0.0)));
    constexpr std::uint32_t kAll = (std::uint32_t{1} << kGroup<Number>)-1;
    for (std::size_t n = 0; n < batch.count; ++n) {
      PatchGroup& group = groups_[batch.groups[n]];
      group.dry = (dry >> (n * kGroup<Number>)&kAll) == kAll;
      if (!group.dry) prefetch_moments(patches_->block(group.block));
    }
  }

  Vectors3<Number> centers_of(const Batch<Number>& batch) const {
    const GroupsOfVector<Number> groups = groups_of(batch);
    const auto axis = [&](std::size_t i) HWY_ATTR {
      return gather_groups<Number>(
          [&](std::size_t n) { return &patches_->block(groups[n].block).center[i][groups[n].first]; });
    };
    return {axis(0), axis(1), axis(2)};
  }

  HWY_INLINE void write(const Batch<Number>& batch, const V& vector, GroupNumbers GroupPlace<Number>::*row) {
    alignas(64) std::array<Number, kLanes<Number>> numbers;
    hn::Store(vector, LanesOf<Number>(), numbers.data());
    for (std::size_t n = 0; n < batch.count; ++n) {
      std::copy_n(numbers.data() + n * kGroup<Number>, kGroup<Number>,
                  (places_[batch.groups[n]].*row).data());
    }
  }

  const QueryPatches* patches_ = nullptr;
  const PatchQuery<Number>* patch_ = nullptr;
  std::vector<PatchGroup> groups_;
  std::vector<GroupPlace<Number>> places_;  // of each
};

// The patches of a round in a sea of components, with the cells of the sea that they are in.
template <typename Number>
class PatchesInCells : public PlacedPatches<Number> {
 public:
  using Base = PlacedPatches<Number>;
  using V = VectorOf<Number>;
  using Field = PatchField<Number>;

  // The arguments must outlive the query.
  void start(const WaveQuery& query, const QueryPatches& patches, const PatchQuery<Number>& patch) {
    Base::start(patches, patch);
    cells_.start(query);
  }

  bool full() const { return cells_.full(); }
  std::size_t cell_count() const { return cells_.surface_count() + cells_.volume_count(); }

  // Finds what is known of the groups of the round from the surface alone.
  void evaluate_surface() {
    if (means_.size() < groups_.size()) means_.resize(groups_.size());
    this->place_groups([this](const Batch<Number>& batch, const Place<Number>& place) HWY_ATTR {
      write_mean(batch, place.x1, &GroupMean<Number>::x1);
      write_mean(batch, place.x2, &GroupMean<Number>::x2);
    });
    find_surface_cells();
    link_groups(cells_.surface_count(), &PatchGroup::surface_cell);
    evaluate_elevations();
  }

  // Calls work(batch, surface cell, volume cell) for the groups that are not dry.
  template <typename Work>
  HWY_INLINE void for_each_batch(const Work& work) {
    if (patch_->hydrostatic) {
      for_each_batch_of_surface([&](const Batch<Number>& batch, std::size_t cell) { work(batch, cell, 0); });
    } else {
      for_each_batch_of_volume([&](const Batch<Number>& batch, std::size_t cell) {
        work(batch, cells_.column_of_volume(cell), cell);
      });
    }
  }

  // All but the radius and its spread.
  HWY_INLINE Field field_of(const Batch<Number>& batch, std::size_t surface_cell,
                            std::size_t volume_cell) const {
    const V zero = set<Number>(0.0);
    Field field;
    this->read_surface(batch, field);
    const CellCenter& above = cells_.surface_center(surface_cell);
    const V x1 = field.place.x1 - set<Number>(above.x1);
    const V x2 = field.place.x2 - set<Number>(above.x2);
    const V horizontal = hn::MulAdd(x1, x1, x2 * x2);
    field.surface_bounds = &cells_.surface(surface_cell).bounds;
    field.surface_reach = hn::Sqrt(horizontal);
    if (patch_->hydrostatic) {
      field.f = {zero, zero, zero, zero, zero, zero, zero, zero, zero, zero};
      field.volume_bounds = field.surface_bounds;
      field.volume_reach = zero;
    } else {
      const VolumeCell<Number>& cell = cells_.volume(volume_cell);
      const V z = stretched<Number>(*patch_, field.place, field.surface.eta) -
                  set<Number>(cells_.volume_center(volume_cell).z);
      field.f = evaluate<Number>(cell, x1, x2, z);
      field.volume_bounds = &cell.bounds;
      field.volume_reach = hn::Sqrt(hn::MulAdd(z, z, horizontal));
    }
    return field;
  }

 private:
  using Base::groups_;
  using Base::patch_;
  using Base::places_;

  void find_surface_cells() {
    for (std::size_t n = 0; n < groups_.size(); ++n) {
      const GroupMean<Number>& mean = means_[n];
      groups_[n].surface_cell = cells_.surface_place(mean.x1, mean.x2);
    }
    take_cells(
        cells_.surface_places(), &PatchGroup::surface_cell,
        [this](std::uint32_t place, std::uint32_t n) {
          return cells_.surface_beside(place, means_[n].x1, means_[n].x2);
        },
        [this](std::uint32_t place) { return cells_.put_surface(place); });
    cells_.build_surface();
  }

  void find_volume_cells() {
    for (std::size_t n = 0; n < groups_.size(); ++n) {
      PatchGroup& group = groups_[n];
      if (!group.dry) group.volume_cell = cells_.volume_place(group.surface_cell, means_[n].z);
    }
    take_cells(
        cells_.volume_places(), &PatchGroup::volume_cell,
        [this](std::uint32_t place, std::uint32_t n) {
          return cells_.volume_beside(place, means_[n].x1, means_[n].x2, means_[n].z);
        },
        [this](std::uint32_t place) { return cells_.put_volume(place); });
    cells_.build_volume();
  }

  // Gives cells to the groups that are not dry. cell: on entry the groups' places. beside(place, group): a
  // neighbour's cell that reaches the group, or kNone; put(place): a new cell.
  template <typename Beside, typename Put>
  void take_cells(const GridPlaces& places, std::uint32_t PatchGroup::*cell, const Beside& beside,
                  const Put& put) {
    link_groups(places.count(), cell);
    // Places that most groups ask for come first, so that their cells serve those of few groups as well.
    wanted_.clear();
    for (std::uint32_t place = 0; place < places.count(); ++place) {
      std::uint32_t count = 0;
      for (std::uint32_t n = heads_[place]; n != kNone; n = groups_[n].next) ++count;
      if (count > 0) wanted_.emplace_back(count, place);
    }
    std::sort(wanted_.begin(), wanted_.end(), [](const auto& a, const auto& b) {
      return a.first > b.first || (a.first == b.first && a.second < b.second);
    });
    for (const auto& [count, place] : wanted_) {
      std::uint32_t of_place = places.cell(place);
      std::uint32_t n = heads_[place];
      if (of_place == kNone) {
        while (n != kNone && (groups_[n].*cell = beside(place, n)) != kNone) n = groups_[n].next;
        if (n != kNone) of_place = put(place);  // some group is out of the neighbours' reach
      }
      if (of_place == kNone) continue;
      for (n = heads_[place]; n != kNone; n = groups_[n].next) groups_[n].*cell = of_place;
    }
  }

  // Calls work(batch, cell) for the groups that are not dry, by cells of the surface.
  template <typename Work>
  HWY_INLINE void for_each_batch_of_surface(const Work& work) {
    link_groups(cells_.surface_count(), &PatchGroup::surface_cell);
    for_each_linked_batch(work);
  }
  // The same, by cells of the volume.
  template <typename Work>
  HWY_INLINE void for_each_batch_of_volume(const Work& work) {
    find_volume_cells();
    link_groups(cells_.volume_count(), &PatchGroup::volume_cell);
    for_each_linked_batch(work);
  }

  void link_groups(std::size_t cells, std::uint32_t PatchGroup::*cell) {
    heads_.assign(cells, kNone);
    for (std::size_t n = groups_.size(); n-- > 0;) {
      PatchGroup& group = groups_[n];
      if (group.dry) continue;
      std::uint32_t& head = heads_[group.*cell];
      group.next = head;
      head = static_cast<std::uint32_t>(n);
    }
  }

  // Calls work(batch, cell) for the linked groups.
  template <typename Work>
  HWY_INLINE void for_each_linked_batch(const Work& work) {
    for (std::size_t cell = 0; cell < heads_.size(); ++cell) {
      for (std::uint32_t n = heads_[cell]; n != kNone;) {
        Batch<Number> batch;
        while (n != kNone && batch.count < kGroupsPerVector<Number>) {
          batch.groups[batch.count++] = n;
          n = groups_[n].next;
        }
        for (std::size_t i = batch.count; i < kGroupsPerVector<Number>; ++i) {
          batch.groups[i] = batch.groups[0];
        }
        work(batch, cell);
      }
    }
  }

  // Writes the mean over each group.
  HWY_INLINE void write_mean(const Batch<Number>& batch, const V& vector, Number GroupMean<Number>::*mean) {
    alignas(64) std::array<Number, kLanes<Number>> numbers;
    const V means = sums_of_groups<Number>(vector) * set<Number>(1.0 / kGroup<Number>);
    hn::Store(means, LanesOf<Number>(), numbers.data());
    for (std::size_t n = 0; n < batch.count; ++n) means_[batch.groups[n]].*mean = numbers[n * kGroup<Number>];
  }

  void evaluate_elevations() {
    for_each_linked_batch([this](const Batch<Number>& batch, std::size_t cell) HWY_ATTR {
      const CellCenter& center = cells_.surface_center(cell);
      const V x1 = this->read(batch, &GroupPlace<Number>::x1) - set<Number>(center.x1);
      const V x2 = this->read(batch, &GroupPlace<Number>::x2) - set<Number>(center.x2);
      const V zeta = this->read(batch, &GroupPlace<Number>::zeta);
      const SurfaceValues<Number> values = evaluate<Number>(cells_.surface(cell), x1, x2);
      this->write(batch, values);
      write_mean(batch, stretched<Number>(*patch_, {x1, x2, zeta}, values.eta), &GroupMean<Number>::z);
      const SurfaceRange<Number> range =
          range_of<Number>(zeta, this->radii_of(batch), values, cells_.surface(cell).bounds,
                           hn::Sqrt(hn::MulAdd(x1, x1, x2 * x2)), set<Number>(patch_->rounding()));
      this->note_dry(batch, range.low);
    });
  }

  SeaCells<Number> cells_;
  std::vector<GroupMean<Number>> means_;  // of each group
  std::vector<std::uint32_t> heads_;      // the first group of each cell, or of each place
  std::vector<std::pair<std::uint32_t, std::uint32_t>> wanted_;  // by how many groups, and the place
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_ROUND_INL_H
