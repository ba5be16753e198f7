#include "wave_loads/wave_load.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#define HWY_BROKEN_EMU128 1
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "wave_loads/wave_load.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "wave_loads/wave_cells-inl.h"
#include "wave_loads/wave_field-inl.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Lanes that come from one block: siblings, or the triangles of a block.
template <typename Number>
inline constexpr std::size_t kUnit = std::min<std::size_t>(kLanes<Number>, kSiblings);
template <typename Number>
inline constexpr std::size_t kUnitsPerVector = kLanes<Number> / kUnit<Number>;

// Reads kUnit numbers at each of kUnitsPerVector places into one vector.
template <typename Number, typename Stored>
HWY_INLINE VectorOf<Number> gather_units(const Stored* const* places) {
  const LanesOf<Number> d;
  alignas(64) std::array<Number, kLanes<Number>> numbers;
  for (std::size_t unit = 0; unit < kUnitsPerVector<Number>; ++unit) {
    for (std::size_t lane = 0; lane < kUnit<Number>; ++lane) {
      numbers[unit * kUnit<Number> + lane] = static_cast<Number>(places[unit][lane]);
    }
  }
  return hn::Load(d, numbers.data());
}

// A batch of units. Where there are too few, the first repeats, and only `count` results are used.
template <typename Number>
struct Batch {
  std::array<std::uint32_t, kUnitsPerVector<Number>> units;
  std::size_t count = 0;
};

// Cells by their place in a grid.
class CellIndex {
 public:
  void clear() {
    ++generation_;
    count_ = 0;
  }
  std::uint32_t count() const { return count_; }

  // Returns the number of the cell at a place; cells are numbered in the order of their first use.
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
  static constexpr std::size_t kSlots = 4 * kMaxCells;
  struct Slot {
    std::uint32_t generation = 0;
    std::int32_t i = 0, j = 0, k = 0;
    std::uint32_t number = 0;
  };
  std::uint32_t generation_ = 0;
  std::uint32_t count_ = 0;
  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
};

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// What is evaluated together: kUnit patches of a block of the tree, or as many triangles.
struct Unit {
  std::uint32_t block = kNone;  // of the tree; kNone for triangles
  std::uint32_t first = 0;      // the first lane of the block; the first of the triangles
  std::uint32_t surface_cell = 0, volume_cell = 0;
  std::uint32_t next = kNone;  // in the same cell
};

// A patch with its result; its children take its place if its bound is too large.
template <typename Number>
struct Item {
  std::uint32_t block = kNone;
  std::uint32_t place = 0;  // the lane of the block; the number of the triangle
  float error = 0.0F;       // [m^3], the larger of force_error and torque_error / L_r; negative: replaced
  Number force_error = 0, torque_error = 0;
  std::array<Number, 3> force{}, torque{}, moment{};
  Number volume = 0;
};

// A triangle, or a part of one, relative to c.
template <typename Number>
struct Piece {
  std::array<std::array<Number, 3>, 3> corners;
};

// Triangles of a leaf that the surface crosses, with the model of their leaf.
template <typename Number>
struct ClipTask {
  std::uint32_t triangle_block;
  std::uint32_t first;  // lane
  std::uint32_t model;  // index of the leaf's model
  std::uint32_t item;
};

template <typename Number>
struct StoredModel {
  std::array<Number, 10> phi, s;  // value, gradient, Hessian
  Number curvature, radius;
  std::array<Number, 3> lever;  // centroid from the reference point
  std::array<Number, 3> center;
  Number remainder, local;  // of the bounds on force and torque: what clipping does not change
};

template <typename Number>
struct Workspace {
  std::vector<SurfaceCells<Number>> surface_cells;
  std::vector<VolumeCells<Number>> volume_cells;
  std::vector<CellCenter> surface_centers, volume_centers;
  std::vector<std::uint32_t> surface_of_volume;
  CellIndex surface_index, volume_index;
  CellWeights<Number> weights;
  std::vector<Unit> units;
  std::vector<std::uint32_t> heads;
  std::vector<Item<Number>> items;
  std::vector<Piece<Number>> pieces;
  std::vector<ClipTask<Number>> clips;
  std::vector<StoredModel<Number>> models;
  std::vector<std::uint32_t> level, next_level;  // blocks
  // Per lane of the units of a round.
  std::vector<Number> x1, x2, zeta, eta, eta_1, eta_2, eta_11, eta_12, eta_22;
};

template <typename Number>
class Descent {
 public:
  using V = VectorOf<Number>;

  Descent(const WaveQuery& query, Workspace<Number>& work) : query_(query), work_(work) {
    const auto narrow = [](const Vec3& v) {
      return std::array<Number, 3>{static_cast<Number>(v.x()), static_cast<Number>(v.y()),
                                   static_cast<Number>(v.z())};
    };
    patch_.e1_B = narrow(query.e1_B);
    patch_.e2_B = narrow(query.e2_B);
    patch_.up_B = narrow(query.up_B);
    patch_.reference = narrow(query.reference);
    patch_.k_max = query.expansion->k_max;
    patch_.zeta = query.zeta;
    patch_.per_depth = std::isinf(query.depth) ? 0.0 : 1.0 / (patch_.k_max * query.depth);
    patch_.hydrostatic = query.hydrostatic;
    patch_.submerged = query.submerged;
    patch_.amplitude = query.phases.amplitude_factor * query.expansion->amplitude_sums[0] * patch_.k_max;
    patch_.slope = query.phases.amplitude_factor * query.expansion->amplitude_sums[1];
    patch_.unit_roundoff = 0.5 * std::numeric_limits<Number>::epsilon();
    work_.surface_index.clear();
    work_.volume_index.clear();
    work_.surface_centers.clear();
    work_.volume_centers.clear();
    work_.surface_of_volume.clear();
    work_.weights.reserve(query.expansion->components);
    work_.items.clear();
    work_.pieces.clear();
    work_.units.clear();
  }

  WaveLoad run() {
    add_first_level();
    double total = evaluate_round();
    constexpr int kMaxRounds = 24;
    for (int round = 0; round < kMaxRounds && total > query_.budget; ++round) {
      if (!refine(total)) break;
      total += evaluate_round();
    }
    return sum();
  }

 private:
  std::size_t lanes() const { return work_.units.size() * kUnit<Number>; }

  void add_block(std::uint32_t block) {
    for (std::uint32_t first = 0; first < kSiblings; first += kUnit<Number>) {
      if (first < query_.tree->blocks[block].patches) work_.units.push_back({block, first, 0, 0, kNone});
    }
  }

  // The blocks of the first level that has at least kFirst of them.
  void add_first_level() {
    constexpr std::size_t kFirst = 4;
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
    for (const std::uint32_t b : level) add_block(b);
  }

  // Evaluates the units, appends their items and returns the sum of the items' errors.
  double evaluate_round() {
    pad_pieces();
    place_units();
    assign_surface_cells();
    evaluate_surface();
    const std::size_t first_item = work_.items.size();
    work_.clips.clear();
    work_.models.clear();
    if (query_.hydrostatic) {
      evaluate_hydrostatic();
    } else {
      assign_volume_cells();
      evaluate_volume();
    }
    clip_leaves();
    double total = 0.0;
    for (std::size_t i = first_item; i < work_.items.size(); ++i) {
      Item<Number>& item = work_.items[i];
      item.error = static_cast<float>(
          std::max<double>(item.force_error, static_cast<double>(item.torque_error) / query_.max_lever));
      total += item.error;
    }
    patches_ += static_cast<std::int32_t>(work_.items.size() - first_item);
    work_.units.clear();
    return total;
  }

  void pad_pieces() {
    for (std::size_t i = new_pieces_; i < work_.pieces.size(); i += kUnit<Number>) {
      work_.units.push_back({kNone, static_cast<std::uint32_t>(i), 0, 0, kNone});
    }
    while (work_.pieces.size() % kUnit<Number> != 0) {
      // A point: nothing is integrated over it.
      Piece<Number> point = work_.pieces.back();
      point.corners[1] = point.corners[2] = point.corners[0];
      work_.pieces.push_back(point);
    }
    new_pieces_ = work_.pieces.size();
  }

  Vectors3<Number> piece_corner(const std::uint32_t* first, std::size_t corner) const {
    const LanesOf<Number> d;
    alignas(64) std::array<std::array<Number, kLanes<Number>>, 3> numbers;
    for (std::size_t unit = 0; unit < kUnitsPerVector<Number>; ++unit) {
      for (std::size_t lane = 0; lane < kUnit<Number>; ++lane) {
        const Piece<Number>& piece = work_.pieces[first[unit] + lane];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          numbers[axis][unit * kUnit<Number> + lane] = piece.corners[corner][axis];
        }
      }
    }
    return {hn::Load(d, numbers[0].data()), hn::Load(d, numbers[1].data()), hn::Load(d, numbers[2].data())};
  }

  void place_units() {
    const std::size_t count = (lanes() + kLanes<Number> - 1) / kLanes<Number> * kLanes<Number>;
    for (auto* row : {&work_.x1, &work_.x2, &work_.zeta, &work_.eta, &work_.eta_1, &work_.eta_2,
                      &work_.eta_11, &work_.eta_12, &work_.eta_22}) {
      if (row->size() < count) row->resize(count);
    }
    const LanesOf<Number> d;
    for (std::size_t unit = 0; unit < work_.units.size(); unit += kUnitsPerVector<Number>) {
      alignas(64) std::array<std::array<Number, kLanes<Number>>, 3> center{};
      for (std::size_t n = 0; n < kUnitsPerVector<Number>; ++n) {
        const Unit& u = work_.units[std::min(unit + n, work_.units.size() - 1)];
        for (std::size_t lane = 0; lane < kUnit<Number>; ++lane) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            Number& out = center[axis][n * kUnit<Number> + lane];
            if (u.block != kNone) {
              out = static_cast<Number>(query_.tree->blocks[u.block].center[axis][u.first + lane]);
            } else {
              const auto& corners = work_.pieces[u.first + lane].corners;
              out = (corners[0][axis] + corners[1][axis] + corners[2][axis]) / Number{3};
            }
          }
        }
      }
      const Place<Number> place = place_of<Number>(
          patch_,
          {hn::Load(d, center[0].data()), hn::Load(d, center[1].data()), hn::Load(d, center[2].data())});
      const std::size_t lane = unit * kUnit<Number>;
      hn::StoreU(place.x1, d, &work_.x1[lane]);
      hn::StoreU(place.x2, d, &work_.x2[lane]);
      hn::StoreU(place.zeta, d, &work_.zeta[lane]);
    }
  }

  static double mean_of(const std::vector<Number>& row, std::size_t unit) {
    double sum = 0.0;
    for (std::size_t lane = 0; lane < kUnit<Number>; ++lane) {
      sum += static_cast<double>(row[unit * kUnit<Number> + lane]);
    }
    return sum / static_cast<double>(kUnit<Number>);
  }
  // Cells are cubes. The first one is centred on the body, so that a small body needs no other.
  std::int32_t cell_of(double place) const {
    constexpr double kFarthest = 1e9;
    return static_cast<std::int32_t>(std::clamp(std::nearbyint(place / query_.cell), -kFarthest, kFarthest));
  }
  double center_of(std::int32_t cell) const { return cell * query_.cell; }
  double first_height() const { return std::min(query_.zeta * patch_.k_max, 0.0); }

  void assign_surface_cells() {
    const std::uint32_t built = work_.surface_index.count();
    for (std::size_t unit = 0; unit < work_.units.size(); ++unit) {
      const std::int32_t i = cell_of(mean_of(work_.x1, unit));
      const std::int32_t j = cell_of(mean_of(work_.x2, unit));
      const std::uint32_t cell = work_.surface_index.find_or_add(i, j, 0);
      if (cell == work_.surface_centers.size()) {
        work_.surface_centers.push_back({center_of(i), center_of(j), 0.0});
      }
      work_.units[unit].surface_cell = cell;
    }
    build(built, work_.surface_centers, work_.surface_cells);
    link_units(work_.surface_centers.size(), &Unit::surface_cell);
  }

  void assign_volume_cells() {
    const std::uint32_t built = work_.volume_index.count();
    for (std::size_t unit = 0; unit < work_.units.size(); ++unit) {
      const CellCenter& above = work_.surface_centers[work_.units[unit].surface_cell];
      double z = 0.0;
      for (std::size_t lane = unit * kUnit<Number>; lane < (unit + 1) * kUnit<Number>; ++lane) {
        const double eta = static_cast<double>(work_.eta[lane]);
        z += (static_cast<double>(work_.zeta[lane]) - eta) / (1.0 + eta * patch_.per_depth);
      }
      const std::int32_t k = cell_of(z / static_cast<double>(kUnit<Number>) - first_height());
      const std::uint32_t cell =
          work_.volume_index.find_or_add(static_cast<std::int32_t>(work_.units[unit].surface_cell), 0, k);
      if (cell == work_.volume_centers.size()) {
        work_.volume_centers.push_back({above.x1, above.x2, first_height() + center_of(k)});
        work_.surface_of_volume.push_back(work_.units[unit].surface_cell);
      }
      work_.units[unit].volume_cell = cell;
    }
    build(built, work_.volume_centers, work_.volume_cells);
    link_units(work_.volume_centers.size(), &Unit::volume_cell);
  }

  const ExpansionTable<Number>& table() const {
    if constexpr (sizeof(Number) == sizeof(float)) {
      return query_.expansion->single_precision;
    } else {
      return query_.expansion->double_precision;
    }
  }

  // Builds the cells from number `built` on. Blocks of cells are built as a whole: the last one again if it
  // was not full.
  template <typename Cells>
  void build(std::size_t built, const std::vector<CellCenter>& centers, std::vector<Cells>& cells) {
    if (centers.size() == built) return;
    const std::size_t blocks = (centers.size() + kLanes<Number> - 1) / kLanes<Number>;
    if (cells.size() < blocks) cells.resize(blocks);
    for (std::size_t block = built / kLanes<Number>; block < blocks; ++block) {
      std::array<CellCenter, kLanes<Number>> of_block;
      for (std::size_t i = 0; i < kLanes<Number>; ++i) {
        of_block[i] = centers[std::min(block * kLanes<Number> + i, centers.size() - 1)];
      }
      set_weights<Number>(*query_.expansion, query_.phases, of_block.data(), work_.weights);
      build_cells<Number>(*query_.expansion, table(), work_.weights, cells[block]);
    }
  }

  void link_units(std::size_t cells, std::uint32_t Unit::*cell) {
    work_.heads.assign(cells, kNone);
    for (std::size_t n = work_.units.size(); n-- > 0;) {
      Unit& unit = work_.units[n];
      std::uint32_t& head = work_.heads[unit.*cell];
      unit.next = head;
      head = static_cast<std::uint32_t>(n);
    }
  }

  // Calls work(batch, cell) for the linked units.
  template <typename Work>
  void for_each_batch(const Work& work) {
    for (std::size_t cell = 0; cell < work_.heads.size(); ++cell) {
      for (std::uint32_t n = work_.heads[cell]; n != kNone;) {
        // A batch holds patches of the tree, or triangles.
        Batch<Number> batch;
        const bool triangles = work_.units[n].block == kNone;
        while (n != kNone && batch.count < kUnitsPerVector<Number> &&
               (work_.units[n].block == kNone) == triangles) {
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

  V read(const Batch<Number>& batch, const std::vector<Number>& row) const {
    std::array<const Number*, kUnitsPerVector<Number>> places;
    for (std::size_t i = 0; i < places.size(); ++i) {
      places[i] = row.data() + std::size_t{batch.units[i]} * kUnit<Number>;
    }
    return gather_units<Number>(places.data());
  }
  void write(const Batch<Number>& batch, const V& vector, std::vector<Number>& row) const {
    const LanesOf<Number> d;
    alignas(64) std::array<Number, kLanes<Number>> numbers;
    hn::Store(vector, d, numbers.data());
    for (std::size_t i = 0; i < batch.count; ++i) {
      std::copy_n(numbers.data() + i * kUnit<Number>, kUnit<Number>,
                  row.data() + std::size_t{batch.units[i]} * kUnit<Number>);
    }
  }

  void evaluate_surface() {
    for_each_batch([this](const Batch<Number>& batch, std::size_t cell) {
      const CellCenter& center = work_.surface_centers[cell];
      const V x1 = read(batch, work_.x1) - set<Number>(center.x1);
      const V x2 = read(batch, work_.x2) - set<Number>(center.x2);
      const SurfaceValues<Number> values =
          evaluate<Number>(work_.surface_cells[cell / kLanes<Number>], cell % kLanes<Number>, x1, x2);
      write(batch, values.eta, work_.eta);
      write(batch, values.eta_1, work_.eta_1);
      write(batch, values.eta_2, work_.eta_2);
      write(batch, values.eta_11, work_.eta_11);
      write(batch, values.eta_12, work_.eta_12);
      write(batch, values.eta_22, work_.eta_22);
    });
  }

  void evaluate_hydrostatic() {
    for_each_batch([this](const Batch<Number>& batch, std::size_t cell) { evaluate_batch(batch, cell, 0); });
  }
  void evaluate_volume() {
    for_each_batch([this](const Batch<Number>& batch, std::size_t cell) {
      evaluate_batch(batch, work_.surface_of_volume[cell], cell);
    });
  }

  void evaluate_batch(const Batch<Number>& batch, std::size_t surface_cell, std::size_t volume_cell) {
    const Place<Number> place{read(batch, work_.x1), read(batch, work_.x2), read(batch, work_.zeta)};
    const SurfaceValues<Number> surface{read(batch, work_.eta),    read(batch, work_.eta_1),
                                        read(batch, work_.eta_2),  read(batch, work_.eta_11),
                                        read(batch, work_.eta_12), read(batch, work_.eta_22)};
    const CellCenter& above = work_.surface_centers[surface_cell];
    const V x1 = place.x1 - set<Number>(above.x1);
    const V x2 = place.x2 - set<Number>(above.x2);
    const V horizontal = hn::MulAdd(x1, x1, x2 * x2);
    const V zero = set<Number>(0.0);
    VolumeValues<Number> f{zero, zero, zero, zero, zero, zero, zero, zero, zero};
    V volume_reach = zero;
    const CellBounds<Number>* volume_bounds = &work_.surface_cells[0].bounds;
    if (!query_.hydrostatic) {
      const V z =
          stretched<Number>(patch_, place, surface.eta) - set<Number>(work_.volume_centers[volume_cell].z);
      const VolumeCells<Number>& cells = work_.volume_cells[volume_cell / kLanes<Number>];
      f = evaluate<Number>(cells, volume_cell % kLanes<Number>, x1, x2, z);
      volume_reach = hn::Sqrt(hn::MulAdd(z, z, horizontal));
      volume_bounds = &cells.bounds;
    }
    const bool triangles = work_.units[batch.units[0]].block == kNone;
    const PatchMoments<Number> moments = triangles ? PatchMoments<Number>{} : read_moments(batch);
    TriangleLanes<Number> t;
    V radius = moments.radius;
    Vectors3<Number> center = moments.center;
    if (triangles) {
      std::array<std::uint32_t, kUnitsPerVector<Number>> first;
      for (std::size_t i = 0; i < first.size(); ++i) first[i] = work_.units[batch.units[i]].first;
      for (std::size_t i = 0; i < 3; ++i) t.corners[i] = piece_corner(first.data(), i);
      center = scaled<Number>(set<Number>(1.0 / 3.0), t.corners[0] + t.corners[1] + t.corners[2]);
      V far = zero;
      for (Vectors3<Number>& corner : t.corners) {
        corner = corner - center;
        far = hn::Max(far, dot<Number>(corner, corner));
      }
      radius = hn::Sqrt(far) * set<Number>(1.000001);
    }
    const PatchModel<Number> model = model_of<Number>(
        patch_, place, radius, surface, work_.surface_cells[surface_cell / kLanes<Number>].bounds,
        surface_cell % kLanes<Number>, hn::Sqrt(horizontal), f, *volume_bounds, volume_cell % kLanes<Number>,
        volume_reach);
    if (!hn::AllFalse(LanesOf<Number>(), model.too_steep)) too_steep_ = true;
    if (triangles) {
      integrate_pieces(batch, center, radius, model, t);
    } else {
      integrate_patches(batch, moments, model);
    }
  }

  PatchMoments<Number> read_moments(const Batch<Number>& batch) const {
    std::array<const PatchBlock*, kUnitsPerVector<Number>> blocks;
    std::array<std::size_t, kUnitsPerVector<Number>> first;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
      const Unit& unit = work_.units[batch.units[i]];
      blocks[i] = &query_.tree->blocks[unit.block];
      first[i] = unit.first;
    }
    const auto get = [&](const auto& member) {
      std::array<const float*, kUnitsPerVector<Number>> places;
      for (std::size_t i = 0; i < places.size(); ++i) places[i] = member(*blocks[i]).data() + first[i];
      return gather_units<Number>(places.data());
    };
    PatchMoments<Number> m;
    m.center = {get([](const PatchBlock& b) -> const FourFloats& { return b.center[0]; }),
                get([](const PatchBlock& b) -> const FourFloats& { return b.center[1]; }),
                get([](const PatchBlock& b) -> const FourFloats& { return b.center[2]; })};
    m.radius = get([](const PatchBlock& b) -> const FourFloats& { return b.radius; });
    m.area = get([](const PatchBlock& b) -> const FourFloats& { return b.area; });
    m.mu2 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu2; });
    m.mu3 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu3; });
    for (std::size_t i = 0; i < 3; ++i) {
      m.S[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.S[i]; });
    }
    for (std::size_t i = 0; i < 9; ++i) {
      m.N[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.N[i]; });
    }
    for (std::size_t i = 0; i < 18; ++i) {
      m.P[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.P[i]; });
    }
    return m;
  }

  struct StoredIntegrals {
    alignas(64) std::array<std::array<Number, kLanes<Number>>, 12> rows;
  };

  static void store_integrals(const PatchIntegrals<Number>& integrals, StoredIntegrals& out) {
    const LanesOf<Number> d;
    const std::array<V, 12> all{integrals.force.x,  integrals.force.y,     integrals.force.z,
                                integrals.torque.x, integrals.torque.y,    integrals.torque.z,
                                integrals.moment.x, integrals.moment.y,    integrals.moment.z,
                                integrals.volume,   integrals.force_error, integrals.torque_error};
    for (std::size_t i = 0; i < all.size(); ++i) hn::Store(all[i], d, out.rows[i].data());
  }
  static Item<Number> item_of(const StoredIntegrals& stored, std::size_t lane) {
    Item<Number> item;
    for (std::size_t i = 0; i < 3; ++i) {
      item.force[i] = stored.rows[i][lane];
      item.torque[i] = stored.rows[3 + i][lane];
      item.moment[i] = stored.rows[6 + i][lane];
    }
    item.volume = stored.rows[9][lane];
    item.force_error = stored.rows[10][lane];
    item.torque_error = stored.rows[11][lane];
    return item;
  }

  static std::array<bool, kLanes<Number>> bits_of(const hn::Mask<LanesOf<Number>>& mask) {
    const LanesOf<Number> d;
    alignas(64) std::array<Number, kLanes<Number>> numbers;
    hn::Store(hn::IfThenElseZero(mask, set<Number>(1.0)), d, numbers.data());
    std::array<bool, kLanes<Number>> bits;
    for (std::size_t i = 0; i < kLanes<Number>; ++i) bits[i] = numbers[i] != Number{0};
    return bits;
  }

  void integrate_patches(const Batch<Number>& batch, const PatchMoments<Number>& moments,
                         const PatchModel<Number>& model) {
    StoredIntegrals stored;
    store_integrals(integrate<Number>(patch_, moments, model), stored);
    const auto dry = bits_of(model.dry);
    const auto whole = bits_of(model.whole);
    std::array<StoredModel<Number>, kLanes<Number>> models;
    bool models_stored = false;
    for (std::size_t n = 0; n < batch.count; ++n) {
      const Unit& unit = work_.units[batch.units[n]];
      const PatchBlock& block = query_.tree->blocks[unit.block];
      for (std::size_t i = 0; i < kUnit<Number> && unit.first + i < block.patches; ++i) {
        const std::size_t lane = n * kUnit<Number> + i;
        if (dry[lane]) continue;
        Item<Number> item = item_of(stored, lane);
        item.block = unit.block;
        item.place = static_cast<std::uint32_t>(unit.first + i);
        const std::uint8_t triangle_blocks = block.triangle_blocks[item.place];
        if (!whole[lane] && triangle_blocks > 0) {
          if (!models_stored) store_models(moments, model, models);
          models_stored = true;
          start_clip(item, block, triangle_blocks, models[lane]);
        }
        work_.items.push_back(item);
      }
    }
  }

  void store_models(const PatchMoments<Number>& moments, const PatchModel<Number>& model,
                    std::array<StoredModel<Number>, kLanes<Number>>& out) {
    const LanesOf<Number> d;
    alignas(64) std::array<Number, kLanes<Number>> numbers;
    const auto each = [&](const V& vector, const auto& member) {
      hn::Store(vector, d, numbers.data());
      for (std::size_t lane = 0; lane < kLanes<Number>; ++lane) member(out[lane]) = numbers[lane];
    };
    const auto quadratic = [&](const Quadratic<Number>& q, std::array<Number, 10> StoredModel<Number>::*to) {
      const std::array<V, 10> all{q.value,      q.gradient.x, q.gradient.y, q.gradient.z, q.hessian[0],
                                  q.hessian[1], q.hessian[2], q.hessian[3], q.hessian[4], q.hessian[5]};
      for (std::size_t i = 0; i < all.size(); ++i) {
        each(all[i], [&](StoredModel<Number>& m) -> Number& { return (m.*to)[i]; });
      }
    };
    quadratic(model.phi, &StoredModel<Number>::phi);
    quadratic(model.s, &StoredModel<Number>::s);
    each(model.curvature, [](StoredModel<Number>& m) -> Number& { return m.curvature; });
    each(moments.radius, [](StoredModel<Number>& m) -> Number& { return m.radius; });
    const Vectors3<Number> lever = moments.center - axis_of<Number>(patch_.reference);
    each(lever.x, [](StoredModel<Number>& m) -> Number& { return m.lever[0]; });
    each(lever.y, [](StoredModel<Number>& m) -> Number& { return m.lever[1]; });
    each(lever.z, [](StoredModel<Number>& m) -> Number& { return m.lever[2]; });
    each(moments.center.x, [](StoredModel<Number>& m) -> Number& { return m.center[0]; });
    each(moments.center.y, [](StoredModel<Number>& m) -> Number& { return m.center[1]; });
    each(moments.center.z, [](StoredModel<Number>& m) -> Number& { return m.center[2]; });
    const V mu1 = hn::Sqrt(moments.area * moments.mu2);
    const V remainder =
        hn::MulAdd(model.third * moments.mu3, set<Number>(1.0 / 6.0), model.delta * moments.area);
    each(remainder, [](StoredModel<Number>& m) -> Number& { return m.remainder; });
    each(hn::MulAdd(model.delta, mu1, set<Number>(1.0 / 6.0) * model.third * moments.mu3 * moments.radius),
         [](StoredModel<Number>& m) -> Number& { return m.local; });
  }

  // Replaces an item's integrals by those of its clipped triangles, which clip_leaves() adds.
  void start_clip(Item<Number>& item, const PatchBlock& block, std::uint8_t triangle_blocks,
                  const StoredModel<Number>& stored) {
    Item<Number> empty;
    empty.block = item.block;
    empty.place = item.place;
    empty.force_error = stored.remainder;
    const Number lever = std::hypot(stored.lever[0], stored.lever[1], stored.lever[2]);
    empty.torque_error = lever * stored.remainder + stored.local;
    item = empty;
    const auto model = static_cast<std::uint32_t>(work_.models.size());
    work_.models.push_back(stored);
    for (std::uint32_t b = 0; b < triangle_blocks; ++b) {
      for (std::uint32_t first = 0; first < kSiblings; first += kUnit<Number>) {
        work_.clips.push_back(
            {block.child[item.place] + b, first, model, static_cast<std::uint32_t>(work_.items.size())});
      }
    }
  }

  void clip_leaves() {
    for (std::size_t n = 0; n < work_.clips.size(); n += kUnitsPerVector<Number>) {
      std::array<const ClipTask<Number>*, kUnitsPerVector<Number>> tasks;
      const std::size_t count = std::min(kUnitsPerVector<Number>, work_.clips.size() - n);
      for (std::size_t i = 0; i < tasks.size(); ++i) tasks[i] = &work_.clips[n + std::min(i, count - 1)];
      TriangleLanes<Number> t;
      const auto corner = [&](std::size_t row) {
        std::array<const float*, kUnitsPerVector<Number>> places;
        for (std::size_t i = 0; i < places.size(); ++i) {
          places[i] = query_.tree->triangles[tasks[i]->triangle_block].corners[row].data() + tasks[i]->first;
        }
        return gather_units<Number>(places.data());
      };
      for (std::size_t i = 0; i < 3; ++i)
        t.corners[i] = {corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
      const auto spread = [&](const auto& member) {
        const LanesOf<Number> d;
        alignas(64) std::array<Number, kLanes<Number>> numbers;
        for (std::size_t i = 0; i < tasks.size(); ++i) {
          std::fill_n(numbers.data() + i * kUnit<Number>, kUnit<Number>,
                      member(work_.models[tasks[i]->model]));
        }
        return hn::Load(d, numbers.data());
      };
      const auto quadratic = [&](std::array<Number, 10> StoredModel<Number>::*from) {
        const auto entry = [&](std::size_t i) {
          return spread([&](const StoredModel<Number>& m) { return (m.*from)[i]; });
        };
        Quadratic<Number> q;
        q.value = entry(0);
        q.gradient = {entry(1), entry(2), entry(3)};
        for (std::size_t i = 0; i < 6; ++i) q.hessian[i] = entry(4 + i);
        return q;
      };
      t.phi = quadratic(&StoredModel<Number>::phi);
      t.s = quadratic(&StoredModel<Number>::s);
      t.curvature = spread([](const StoredModel<Number>& m) { return m.curvature; });
      t.whole = set_mask<Number>(false);
      t.none = set_mask<Number>(false);
      const TriangleIntegrals<Number> sums = integrate<Number>(patch_, t);
      PatchIntegrals<Number> result =
          to_patch(sums,
                   {spread([](const StoredModel<Number>& m) { return m.lever[0]; }),
                    spread([](const StoredModel<Number>& m) { return m.lever[1]; }),
                    spread([](const StoredModel<Number>& m) { return m.lever[2]; })},
                   {spread([](const StoredModel<Number>& m) { return m.center[0]; }),
                    spread([](const StoredModel<Number>& m) { return m.center[1]; }),
                    spread([](const StoredModel<Number>& m) { return m.center[2]; })},
                   spread([](const StoredModel<Number>& m) { return m.radius; }));
      StoredIntegrals stored;
      store_integrals(result, stored);
      for (std::size_t i = 0; i < count; ++i) {
        Item<Number>& item = work_.items[tasks[i]->item];
        for (std::size_t lane = i * kUnit<Number>; lane < (i + 1) * kUnit<Number>; ++lane) {
          const Item<Number> part = item_of(stored, lane);
          for (std::size_t axis = 0; axis < 3; ++axis) {
            item.force[axis] += part.force[axis];
            item.torque[axis] += part.torque[axis];
            item.moment[axis] += part.moment[axis];
          }
          item.volume += part.volume;
          item.force_error += part.force_error;
          item.torque_error += part.torque_error;
        }
      }
    }
  }

  PatchIntegrals<Number> to_patch(const TriangleIntegrals<Number>& sums, const Vectors3<Number>& lever,
                                  const Vectors3<Number>& center, const V& radius) const {
    PatchIntegrals<Number> result;
    result.force = {hn::Neg(sums.force.x), hn::Neg(sums.force.y), hn::Neg(sums.force.z)};
    result.torque = cross<Number>(lever, result.force) - sums.offset_torque;
    result.volume = sums.volume;
    result.moment = scaled<Number>(sums.volume, center) + sums.moment;
    result.force_error = sums.strip;
    result.torque_error = hn::MulAdd(hn::Sqrt(dot<Number>(lever, lever)) + radius, sums.strip, sums.cubic);
    return result;
  }

  void integrate_pieces(const Batch<Number>& batch, const Vectors3<Number>& center, const V& radius,
                        const PatchModel<Number>& model, TriangleLanes<Number>& t) {
    t.phi = model.phi;
    t.s = model.s;
    t.curvature = model.curvature;
    t.whole = model.whole;
    t.none = model.dry;
    const TriangleIntegrals<Number> sums = integrate<Number>(patch_, t);
    const Vectors3<Number> lever = center - axis_of<Number>(patch_.reference);
    PatchIntegrals<Number> result = to_patch(sums, lever, center, radius);
    const Vectors3<Number> normal = cross<Number>(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
    const V area = set<Number>(0.500001) * hn::Sqrt(dot<Number>(normal, normal));
    V second = set<Number>(0.0);
    V fourth = second;
    for (const Vectors3<Number>& corner : t.corners) {
      const V squared = dot<Number>(corner, corner);
      second = second + squared;
      fourth = hn::MulAdd(squared, squared, fourth);
    }
    // The means of |y|^2 and |y|^4 over a triangle, about its centroid.
    const V mean2 = second * set<Number>(1.000001 / 12.0);
    const V mean4 = fourth * set<Number>(1.000001 / 30.0);
    const V mean3 = hn::Sqrt(mean2 * mean4);
    const V remainder = area * hn::MulAdd(model.third * mean3, set<Number>(1.0 / 6.0), model.delta);
    const V local = area * hn::MulAdd(model.delta, hn::Sqrt(mean2),
                                      set<Number>(1.0 / 6.0) * model.third * radius * mean3);
    result.force_error = result.force_error + remainder;
    result.torque_error =
        result.torque_error + hn::MulAdd(hn::Sqrt(dot<Number>(lever, lever)), remainder, local);
    clear_where<Number>(model.dry, result);
    StoredIntegrals stored;
    store_integrals(result, stored);
    const auto dry = bits_of(model.dry);
    for (std::size_t n = 0; n < batch.count; ++n) {
      for (std::size_t i = 0; i < kUnit<Number>; ++i) {
        const std::size_t lane = n * kUnit<Number> + i;
        if (dry[lane]) continue;
        Item<Number> item = item_of(stored, lane);
        item.place = static_cast<std::uint32_t>(work_.units[batch.units[n]].first + i);
        work_.items.push_back(item);
      }
    }
  }

  // Children's errors: together a sixth of their parent's, each a twentieth, on wet and crossing patches.
  static constexpr double kTotalDecay = 6.0;
  static constexpr double kEachDecay = 20.0;

  double predicted(double total, double limit) const {
    double sum = total;
    for (const Item<Number>& item : work_.items) {
      if (!(static_cast<double>(item.error) > limit)) continue;
      double error = item.error;
      double each = item.error;
      while (each > limit && error > 1e-30) {
        error /= kTotalDecay;
        each /= kEachDecay;
      }
      sum += error - static_cast<double>(item.error);
    }
    return sum;
  }

  // Replaces the items above a threshold by their children. Returns false, changing nothing, where the work
  // reaches its cap. total: the sum of the errors, which is reduced by those that were replaced.
  bool refine(double& total) {
    float largest = 0.0F;
    for (const Item<Number>& item : work_.items) largest = std::max(largest, item.error);
    double low = std::log(1e-12 * static_cast<double>(largest));
    double high = std::log(static_cast<double>(largest) * 0.999);
    constexpr double kMargin = 0.8;
    for (int step = 0; step < 12; ++step) {
      const double middle = 0.5 * (low + high);
      (predicted(total, std::exp(middle)) <= kMargin * query_.budget ? low : high) = middle;
    }
    const double limit = std::exp(low);
    if (work_.items.size() > kMaxPatches || work_.surface_index.count() > kMaxCells / 2 ||
        work_.volume_index.count() > kMaxCells / 2) {
      capped_ = true;
      return false;
    }
    const std::size_t count = work_.items.size();
    bool any = false;
    for (std::size_t n = 0; n < count; ++n) {
      const Item<Number> item = work_.items[n];
      const double error = item.error;
      if (!(error > limit)) continue;
      total -= error;
      any = true;
      work_.items[n].error = -1.0F;
      if (item.block == kNone) {
        bisect(work_.pieces[item.place], error > kEachDecay * limit ? 2 : 1);
      } else {
        const PatchBlock& block = query_.tree->blocks[item.block];
        if (block.triangle_blocks[item.place] > 0) {
          add_pieces(block, item.place);
        } else {
          add_children(block.child[item.place], error > kEachDecay * limit);
        }
      }
    }
    return any;
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

  void add_pieces(const PatchBlock& block, std::size_t lane) {
    for (std::uint32_t b = 0; b < block.triangle_blocks[lane]; ++b) {
      const TriangleBlock& triangles = query_.tree->triangles[block.child[lane] + b];
      for (std::size_t i = 0; i < kSiblings; ++i) {
        Piece<Number> piece;
        bool point = true;
        for (std::size_t row = 0; row < 9; ++row) {
          const float from_center = triangles.corners[row][i];
          point &= from_center == triangles.corners[row % 3][i];
          piece.corners[row / 3][row % 3] =
              static_cast<Number>(block.center[row % 3][lane]) + static_cast<Number>(from_center);
        }
        if (!point) work_.pieces.push_back(piece);
      }
    }
  }

  // By value: the pieces are appended to the array that it may be in.
  void bisect(Piece<Number> piece, int times) {
    if (times == 0) {
      work_.pieces.push_back(piece);
      return;
    }
    std::size_t longest = 0;
    Number length = -1;
    for (std::size_t i = 0; i < 3; ++i) {
      Number squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const Number difference = piece.corners[(i + 1) % 3][axis] - piece.corners[i][axis];
        squared += difference * difference;
      }
      if (squared > length) {
        length = squared;
        longest = i;
      }
    }
    std::array<Number, 3> middle;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      middle[axis] = Number{0.5} * (piece.corners[longest][axis] + piece.corners[(longest + 1) % 3][axis]);
    }
    Piece<Number> first = piece;
    first.corners[(longest + 1) % 3] = middle;
    Piece<Number> second = piece;
    second.corners[longest] = middle;
    bisect(first, times - 1);
    bisect(second, times - 1);
  }

  WaveLoad sum() const {
    WaveLoad load;
    for (const Item<Number>& item : work_.items) {
      if (item.error < 0.0F) continue;
      for (int i = 0; i < 3; ++i) {
        const auto n = static_cast<std::size_t>(i);
        load.force[i] += static_cast<double>(item.force[n]);
        load.torque[i] += static_cast<double>(item.torque[n]);
        load.moment[i] += static_cast<double>(item.moment[n]);
      }
      load.volume += static_cast<double>(item.volume);
      load.force_bound += static_cast<double>(item.force_error);
      load.torque_bound += static_cast<double>(item.torque_error);
    }
    load.capped = capped_;
    load.too_steep = too_steep_;
    load.patches = patches_;
    load.cells = static_cast<std::int32_t>(work_.surface_index.count() + work_.volume_index.count());
    return load;
  }

  const WaveQuery& query_;
  Workspace<Number>& work_;
  PatchQuery<Number> patch_;
  std::size_t new_pieces_ = 0;
  bool capped_ = false;
  bool too_steep_ = false;
  std::int32_t patches_ = 0;
};

template <typename Number>
WaveLoad run_descent(const WaveQuery& query) {
  thread_local Workspace<Number> work;
  return Descent<Number>(query, work).run();
}

WaveLoad wave_load_single(const WaveQuery& query) {
  return run_descent<float>(query);
}
WaveLoad wave_load_double(const WaveQuery& query) {
  return run_descent<double>(query);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace buoyancy {

HWY_EXPORT(wave_load_single);
HWY_EXPORT(wave_load_double);

WaveLoad wave_load(const WaveBody& body, const SeaExpansion& expansion, const SeaSnapshot& sea,
                   const Pose& pose, const Vec3& reference_B) {
  const HydrostaticMesh& mesh = *body.mesh;
  const Sea& of_sea = sea.sea();
  const Water& water = of_sea.water();
  const Eigen::Matrix3d R_WB = pose.q_WB.normalized().toRotationMatrix();
  const Vec3 c_W = pose.p_WB + R_WB * mesh.center_B;

  thread_local WaveQuery query;
  query.tree = body.tree;
  query.expansion = &expansion;
  query.e1_B = R_WB.transpose() * of_sea.axes().e1_W;
  query.e2_B = R_WB.transpose() * of_sea.axes().e2_W;
  query.up_B = R_WB.transpose() * water.up_W;
  query.reference = reference_B - mesh.center_B;
  query.zeta = water.up_W.dot(c_W) - water.level;
  query.depth = of_sea.depth();
  query.hydrostatic = of_sea.pressure() == WavePressure::kHydrostatic;
  query.max_lever = mesh.max_lever_arm(reference_B);
  query.budget = body.tolerance * std::abs(mesh.volume);
  query.phases.amplitude_factor = sea.amplitude_factor();
  sea.phases_at(of_sea.axes().e1_W.dot(c_W), of_sea.axes().e2_W.dot(c_W), query.phases.phase);

  const Vec3 extent = (mesh.box_max - mesh.box_min) * 0.5;
  const Vec3 middle = 0.5 * (mesh.box_max + mesh.box_min);
  const double reach = extent.dot(query.up_B.cwiseAbs());
  const double height = query.zeta + query.up_B.dot(middle);
  const double crest = sea.amplitude_factor() * expansion.amplitude_sums[0];
  if (height - reach > crest) return {};
  query.submerged = height + reach < -crest;
  // Truncation over the whole surface takes a small share of the tolerance.
  constexpr double kTruncationShare = 0.04;
  query.cell = 2.0 / std::sqrt(3.0) *
               expansion.reach_within(kTruncationShare * query.budget /
                                      (body.tree->area * query.phases.amplitude_factor));
  const bool single = body.tolerance >= 1e-4;
  WaveLoad load =
      single ? HWY_DYNAMIC_DISPATCH(wave_load_single)(query) : HWY_DYNAMIC_DISPATCH(wave_load_double)(query);
  if (query.submerged) {
    load.force += mesh.volume * query.up_B;
    const Vec3 lever = mesh.centroid - query.reference;
    load.torque += lever.cross(mesh.volume * query.up_B);
  }
  return load;
}

}  // namespace buoyancy
#endif  // HWY_ONCE
