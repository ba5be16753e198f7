// From the components of the sea to their sums over a cell: the phases at the body's centre, and the sums of
// the terms of an expansion about a point, with SIMD (docs/wave_mathematics.md, "Expansions");
// wave_field-inl.h makes the polynomials of the sums. Included once per instruction set, after highway.h.
//
// Lengths within a cell are in units of 1 / k_max. Coefficients are summed with neighbouring terms in the
// lanes, so that a cell costs the same whether it is built alone or with others.
#if defined(BUOYANCY_WAVE_SUMS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_SUMS_INL_H
#undef BUOYANCY_WAVE_SUMS_INL_H
#else
#define BUOYANCY_WAVE_SUMS_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "base/simd-inl.h"
#include "wave_loads/sea_expansion.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_query.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

inline constexpr double kTurn = 6.283185307179586;             // 2 pi, rounded
inline constexpr double kRestOfTurn = 2.4492935982947064e-16;  // what the rounding took

// The rest of an angle [rad] within half a turn of 0.
HWY_INLINE VectorOf<double> within_turn(const VectorOf<double>& angle) {
  const VectorOf<double> turns = hn::Round(angle * set<double>(1.0 / kTurn));
  const auto whole = two_product(turns, set<double>(kTurn));
  const VectorOf<double> rest = (angle - whole.hi) - whole.lo;
  return rest - turns * set<double>(kRestOfTurn);
}

// The same to the rounding of the angle itself: enough where the angle was rounded as well.
HWY_INLINE VectorOf<double> near_zero(const VectorOf<double>& angle) {
  const VectorOf<double> turns = hn::Round(angle * set<double>(1.0 / kTurn));
  return hn::NegMulAdd(turns, set<double>(kTurn), angle);
}

// Sets the phase of each place's component at the body's centre [rad], within a few turns of 0; any where
// there is none. Exact to 1e-14 of a turn out to 1e9 wavelengths, as SeaSnapshot is.
HWY_INLINE void set_phases(const WaveQuery& query, std::vector<double>& phases) {
  const LanesOf<double> d;
  const SeaExpansion& sea = *query.expansion;
  if (phases.size() < sea.filled_components) phases.resize(sea.filled_components);
  const double* const of_components = query.sea->phases().data();
  const VectorOf<double> x1 = set<double>(query.x1);
  const VectorOf<double> x2 = set<double>(query.x2);
  for (std::size_t i = 0; i < sea.filled_components; i += kLanes<double>) {
    const auto along1 = two_product(hn::LoadU(d, &sea.k1_W[i]), x1);
    const auto along2 = two_product(hn::LoadU(d, &sea.k2_W[i]), x2);
    const auto along = two_sum(along1.hi, along2.hi);
    const VectorOf<double> small = hn::LoadU(d, &sea.k1_rest[i]) * x1 + hn::LoadU(d, &sea.k2_rest[i]) * x2 +
                                   ((along1.lo + along2.lo) + along.lo);
    const VectorOf<double> own = hn::GatherIndex(
        d, of_components, hn::LoadU(hn::RebindToSigned<LanesOf<double>>(), &sea.component_of_place[i]));
    const VectorOf<double> phase = within_turn(along.hi) + small + own;
    hn::StoreU(phase, d, &phases[i]);
  }
}

// A vector is stored at the place of its first number; the numbers behind it are overwritten by the next.
inline constexpr std::size_t kOverhang = 15;

// The degree of the third derivatives that are evaluated. The rest of them is bounded.
inline constexpr int kThirdDegree = 4;

// Bounds on what an expansion leaves out and on its derivatives, from the norms sigma_l of its degrees.
template <typename Number>
struct CellBounds {
  std::array<Number, kNormDegree + 1> sigma;  // [m]
  Number tail;  // [m], sum of a (k / k_max)^(kNormDegree + 1) / (kNormDegree + 1)!
};

template <typename Number>
struct alignas(64) SurfaceCell {
  std::array<Number, monomials_to(kDegree) + kOverhang> eta;
  std::array<Number, monomials_to(kDegree - 1) + kOverhang> eta_1, eta_2;
  std::array<Number, monomials_to(kDegree - 2) + kOverhang> eta_11, eta_12, eta_22;
  std::array<Number, monomials_to(kThirdDegree) + kOverhang> eta_111, eta_112, eta_122, eta_222;
  CellBounds<Number> bounds;
};

template <typename Number>
struct alignas(64) VolumeCell {
  std::array<Number, harmonics_to(kDegree) + kOverhang> f;
  std::array<Number, harmonics_to(kDegree - 1) + kOverhang> f_1, f_2, f_3;
  std::array<Number, harmonics_to(kDegree - 2) + kOverhang> f_11, f_12, f_13, f_23, f_33;
  std::array<Number, harmonics_to(kThirdDegree) + kOverhang> f_111, f_112, f_113, f_123, f_133, f_233, f_333;
  CellBounds<Number> bounds;
};

struct CellCenter {
  double x1, x2, z;  // over 1 / k_max, from the body's centre and the level
};

// As many cells are built in one go, at most.
inline constexpr std::size_t kCellsTogether = 16;

// Sums over the components of each lane of a block, of a weight times a power of k.
template <typename Number>
struct alignas(64) LaneSums {
  std::array<std::array<Number, kLanesOfStep>, kNormDegree + 1> of_degree{};
  std::array<Number, kLanesOfStep> unused{};  // a vector may start in any lane
};

// The weights whose products are summed: of even powers of k, and of odd ones.
struct PowerWeights {
  Weight of_even, of_odd;
};

// Two numbers of every component, and one of all, set when they are first asked for. Those of the first cells
// are kept for all cells that share them; the others' last until the cells of the same batch are built.
template <typename Number>
class ComponentRows {
 public:
  struct Row {
    const Number* first;
    const Number* second;
    Number sum;
  };

  void start(std::size_t components) {
    components_ = components;
    known_.fill(false);
  }

  // in_batch: the number of the cell in its batch. set(first, second): sets row n and returns its sum.
  template <typename Set>
  Row get(std::size_t n, std::size_t in_batch, const Set& set) {
    const std::size_t place = n < kKept ? n : kKept + in_batch;
    std::vector<Number>& numbers = rows_[place];
    if (numbers.size() < 2 * components_) numbers.resize(2 * components_);
    if (!known_[place]) sums_[place] = set(numbers.data(), numbers.data() + components_);
    known_[place] = place < kKept;
    return {numbers.data(), numbers.data() + components_, sums_[place]};
  }

 private:
  static constexpr std::size_t kKept = 64;
  static constexpr std::size_t kRows = kKept + kCellsTogether;
  std::size_t components_ = 0;
  std::array<std::vector<Number>, kRows> rows_;
  std::array<Number, kRows> sums_{};
  std::array<bool, kRows> known_{};
};

// The two factors of a weight, by component.
template <typename Number>
struct WeightFactors {
  const Number* turns;
  const Number* amplitudes;
};

// The factors of all weights at a cell's centre: cosines and sines of the phases, and amplitudes of even and
// of odd derivatives along z, whose sum is the cell's tail.
template <typename Number>
struct CellFactors {
  typename ComponentRows<Number>::Row turns, amplitudes;

  WeightFactors<Number> of(Weight weight) const {
    const bool cosine = weight == Weight::kCosineEven || weight == Weight::kCosineOdd;
    const bool even = weight == Weight::kCosineEven || weight == Weight::kSineEven;
    return {cosine ? turns.first : turns.second, even ? amplitudes.first : amplitudes.second};
  }
};

template <typename Number>
struct CellWorkspace {
  std::vector<double> phases;  // at the body's centre, filled up
  // By column of cells: the cosines and the sines of the components' phases at its centre.
  ComponentRows<Number> turns;
  // Of the surface, then by level of cells: the components' amplitudes, of even and of odd derivatives along
  // z; their sum is the tail of the cells.
  ComponentRows<Number> amplitudes;
  std::array<CellFactors<Number>, kCellsTogether> factors;  // by cell
  // Of a sea without slots, by cell, weight and component.
  std::array<std::array<std::vector<Number>, kWeights>, kCellsTogether> weights;
  // Of a sea with slots, by cell, weights and block.
  std::vector<LaneSums<Number>> lane_sums;
  struct alignas(64) Sums {
    std::array<Number, kHarmonicColumns> columns;
  };
  std::array<Sums, kCellsTogether> sums;

  void start(const SeaExpansion& sea) {
    const std::size_t components = sea.filled_components;
    turns.start(components);
    amplitudes.start(components);
    if (!sea.slots.any()) {
      for (auto& of_cell : weights) {
        for (auto& of_weight : of_cell) of_weight.resize(components);
      }
    }
    lane_sums.resize(kCellsTogether * 2 * sea.slots.blocks);
  }
};

// phases: at the body's centre.
template <typename Number>
HWY_NOINLINE void set_turns(const SeaExpansion& sea, const std::vector<double>& phases,
                            const CellCenter& center, Number* cosines, Number* sines) {
  const LanesOf<double> dd;
  Number* const angles = cosines;
  for (std::size_t i = 0; i < sea.filled_components; i += kLanes<double>) {
    const VectorOf<double> along = hn::MulAdd(hn::LoadU(dd, &sea.k1[i]), set<double>(center.x1),
                                              hn::LoadU(dd, &sea.k2[i]) * set<double>(center.x2));
    const VectorOf<double> phase = near_zero(hn::LoadU(dd, &phases[i]) + along);
    if constexpr (sizeof(Number) == sizeof(double)) {
      hn::StoreU(phase, dd, angles + i);
    } else {
      const hn::Rebind<float, LanesOf<double>> df;
      hn::StoreU(hn::DemoteTo(df, phase), df, angles + i);
    }
  }
  const LanesOf<Number> d;
  for (std::size_t i = 0; i < sea.filled_components; i += kLanes<Number>) {
    const VectorOf<Number> angle = hn::LoadU(d, angles + i);
    hn::StoreU(hn::Sin(d, angle), d, sines + i);
    hn::StoreU(hn::Cos(d, angle), d, cosines + i);
  }
}

// The amplitudes of the elevation; there are no derivatives along z. Returns the tail of its cells.
template <typename Number>
HWY_NOINLINE Number set_amplitudes(const ExpansionTable<Number>& table, double factor, Number* even) {
  const LanesOf<Number> d;
  VectorOf<Number> tail = hn::Zero(d);
  for (std::size_t i = 0; i < table.amplitude.size(); i += kLanes<Number>) {
    const VectorOf<Number> amplitude = set<Number>(factor) * hn::LoadU(d, &table.amplitude[i]);
    hn::StoreU(amplitude, d, even + i);
    tail = hn::MulAdd(amplitude, hn::LoadU(d, &table.tail[i]), tail);
  }
  return sum_of_lanes(tail);
}

// The amplitudes of f at a height z over 1 / k_max. In deep water those of odd derivatives are the same and
// are not set. Returns the tail of cells at that height.
template <typename Number>
HWY_NOINLINE Number set_amplitudes(const ExpansionTable<Number>& table, double factor, bool deep_water,
                                   double z, Number* even, Number* odd) {
  const LanesOf<Number> d;
  VectorOf<Number> tail = hn::Zero(d);
  for (std::size_t i = 0; i < table.k.size(); i += kLanes<Number>) {
    const VectorOf<Number> amplitude = set<Number>(factor) * hn::LoadU(d, &table.amplitude_in_f[i]);
    const VectorOf<Number> exponent = hn::LoadU(d, &table.k[i]) * set<Number>(z);
    const VectorOf<Number> down = amplitude * hn::Exp(d, exponent);
    VectorOf<Number> of_even = down;
    if (!deep_water) {
      // cosh k(z + h) / cosh kh and sinh k(z + h) / cosh kh by exponentials that do not overflow.
      const VectorOf<Number> up = amplitude * hn::Exp(d, hn::LoadU(d, &table.minus_twice_kh[i]) - exponent);
      of_even = down + up;
      hn::StoreU(down - up, d, odd + i);
    }
    hn::StoreU(of_even, d, even + i);
    tail = hn::MulAdd(of_even, hn::LoadU(d, &table.tail[i]), tail);
  }
  return sum_of_lanes(tail);
}

// Sets the weights of all components at a cell's centre. same: whether odd derivatives have the amplitudes of
// even ones.
template <typename Number>
HWY_NOINLINE void set_weights(const SeaExpansion& sea, bool same, std::size_t cell,
                              CellWorkspace<Number>& work) {
  const LanesOf<Number> d;
  const auto set_weight = [&](Weight weight) HWY_ATTR {
    const auto [turns, amplitudes] = work.factors[cell].of(weight);
    Number* const products = work.weights[cell][static_cast<std::size_t>(weight)].data();
    for (std::size_t i = 0; i < sea.filled_components; i += kLanes<Number>) {
      hn::StoreU(hn::LoadU(d, amplitudes + i) * hn::LoadU(d, turns + i), d, products + i);
    }
  };
  set_weight(Weight::kCosineEven);
  set_weight(Weight::kSineEven);
  if (same) return;
  set_weight(Weight::kCosineOdd);
  set_weight(Weight::kSineOdd);
}

// Adds to sums the products of columns [kBegin, kEnd) of the components' rows with the weights of kCells
// cells.
template <std::size_t kCells, std::size_t kVectors, typename Number, std::size_t kColumns>
HWY_INLINE void add_products(const ExpansionRow<Number, kColumns>* rows, std::size_t first_column,
                             const std::array<const Number*, kCells>& weights, std::size_t begin,
                             std::size_t end, const std::array<Number*, kCells>& sums) {
  const LanesOf<Number> d;
  std::array<std::array<VectorOf<Number>, kVectors>, kCells> sum;
  for (auto& of_cell : sum) {
    for (auto& vector : of_cell) vector = hn::Zero(d);
  }
  for (std::size_t i = begin; i < end; ++i) {
    const Number* const row = rows[i].columns.data() + first_column;
    std::array<VectorOf<Number>, kCells> weight;
    for (std::size_t c = 0; c < kCells; ++c) weight[c] = hn::Set(d, weights[c][i]);
    for (std::size_t v = 0; v < kVectors; ++v) {
      const VectorOf<Number> entries = hn::Load(d, row + v * kLanes<Number>);
      for (std::size_t c = 0; c < kCells; ++c) sum[c][v] = hn::MulAdd(weight[c], entries, sum[c][v]);
    }
  }
  for (std::size_t c = 0; c < kCells; ++c) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      Number* const place = sums[c] + first_column + v * kLanes<Number>;
      hn::Store(hn::Load(d, place) + sum[c][v], d, place);
    }
  }
}

// The same for all columns of one weight.
template <std::size_t kCells, typename Number, std::size_t kColumns>
HWY_INLINE void add_products(const ExpansionRow<Number, kColumns>* rows, const ColumnRange& columns,
                             const std::array<const Number*, kCells>& weights, std::size_t begin,
                             std::size_t end, const std::array<Number*, kCells>& sums) {
  // Enough sums at a time to hide the latency of an addition, and few enough for the registers.
  constexpr std::size_t kLong = 3;
  constexpr std::size_t kShort = 2;
  std::size_t column = columns.begin;
  for (; (columns.end - column) % (kShort * kLanes<Number>) != 0; column += kLong * kLanes<Number>) {
    add_products<kCells, kLong>(rows, column, weights, begin, end, sums);
  }
  for (; column < columns.end; column += kShort * kLanes<Number>) {
    add_products<kCells, kShort>(rows, column, weights, begin, end, sums);
  }
}

// Sets the sums of all columns for `count` cells from their weights. same: as in set_weights().
template <typename Number, std::size_t kColumns>
HWY_NOINLINE void accumulate(const std::vector<ExpansionRow<Number, kColumns>>& rows,
                             const std::array<ColumnRange, kWeights>& of_weight, bool same, std::size_t count,
                             CellWorkspace<Number>& work) {
  for (std::size_t cell = 0; cell < count; ++cell) work.sums[cell].columns.fill(Number{0});
  // The rows of a block of components stay in the nearest cache while all cells pass. It also keeps the
  // chains of additions short.
  constexpr std::size_t kBlock = 48;
  for (std::size_t begin = 0; begin < rows.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, rows.size());
    const auto add = [&]<std::size_t kCells>(std::size_t first,
                                             std::integral_constant<std::size_t, kCells> /*number*/) {
      for (std::size_t w = 0; w < kWeights; ++w) {
        const bool odd = w >= static_cast<std::size_t>(Weight::kCosineOdd);
        const std::size_t from = odd && same ? w - 2 : w;
        std::array<const Number*, kCells> weights;
        std::array<Number*, kCells> sums;
        for (std::size_t c = 0; c < kCells; ++c) {
          weights[c] = work.weights[first + c][from].data();
          sums[c] = work.sums[first + c].columns.data();
        }
        add_products<kCells>(rows.data(), of_weight[w], weights, begin, end, sums);
      }
    };
    std::size_t cell = 0;
    for (; cell + 4 <= count; cell += 4) add(cell, std::integral_constant<std::size_t, 4>());
    for (; cell + 2 <= count; cell += 2) add(cell, std::integral_constant<std::size_t, 2>());
    for (; cell < count; ++cell) add(cell, std::integral_constant<std::size_t, 1>());
  }
}

// Adds to the sums of a block what the steps from `begin` to `end` have, from lane `part` on, for kSums sums;
// sets them if `first`. weights: of even and of odd powers; the same of both if kOneWeight.
template <bool kOneWeight, std::size_t kSums, typename Number>
HWY_INLINE void add_steps(const StepPowers<Number>* powers,
                          const std::array<std::array<WeightFactors<Number>, 2>, kSums>& weights,
                          std::size_t part, std::size_t begin, std::size_t end, bool first,
                          const std::array<LaneSums<Number>*, kSums>& sums) {
  constexpr std::size_t kPowers = kNormDegree + 1;
  const LanesOf<Number> d;
  std::array<std::array<VectorOf<Number>, kPowers>, kSums> sum;
  for (auto& of_sum : sum) {
    for (auto& of_power : of_sum) of_power = hn::Zero(d);
  }
  for (std::size_t step = begin; step < end; ++step) {
    const std::size_t at = kLanesOfStep * step + part;
    std::array<std::array<VectorOf<Number>, 2>, kSums> weight;
    for (std::size_t n = 0; n < kSums; ++n) {
      const auto product = [&](const WeightFactors<Number>& factors) HWY_ATTR {
        return hn::LoadU(d, factors.amplitudes + at) * hn::LoadU(d, factors.turns + at);
      };
      weight[n][0] = product(weights[n][0]);
      weight[n][1] = kOneWeight ? weight[n][0] : product(weights[n][1]);
    }
#pragma GCC unroll 16
    for (std::size_t l = 0; l < kPowers; ++l) {
      const VectorOf<Number> power = hn::Load(d, powers[step].of_degree[l].data() + part);
      for (std::size_t n = 0; n < kSums; ++n) sum[n][l] = hn::MulAdd(weight[n][l % 2], power, sum[n][l]);
    }
  }
  for (std::size_t n = 0; n < kSums; ++n) {
    for (std::size_t l = 0; l < kPowers; ++l) {
      Number* const place = sums[n]->of_degree[l].data() + part;
      hn::Store(first ? sum[n][l] : hn::Load(d, place) + sum[n][l], d, place);
    }
  }
}

// Adds up the lanes of each slot, in the first row.
template <typename Number>
HWY_INLINE void fold_rows(const ComponentSlots& slots, LaneSums<Number>& sums) {
  const LanesOf<Number> d;
  for (std::size_t rows = slots.rows; rows > 1;) {
    const std::size_t left = (rows + 1) / 2;
    const std::size_t lanes = (rows - left) * slots.count;
    for (auto& of_degree : sums.of_degree) {
      for (std::size_t lane = 0; lane < lanes; lane += kLanes<Number>) {
        const VectorOf<Number> folded = hn::LoadU(d, of_degree.data() + left * slots.count + lane);
        const VectorOf<Number> masked = hn::IfThenElseZero(hn::FirstN(d, lanes - lane), folded);
        hn::Store(hn::Load(d, &of_degree[lane]) + masked, d, &of_degree[lane]);
      }
    }
    rows = left;
  }
}

// Sets the sums of all slots for `count` cells and each of the weights.
template <typename Number, PowerWeights... kOfSums>
HWY_NOINLINE void accumulate_lanes(const ComponentSlots& slots, const std::vector<StepPowers<Number>>& powers,
                                   std::size_t count, CellWorkspace<Number>& work) {
  constexpr std::array kKinds{kOfSums...};
  constexpr bool kOneWeight = ((kOfSums.of_even == kOfSums.of_odd) && ...);
  // As many sums as the registers hold; they share the powers.
  constexpr std::size_t kTogether = kLanes<Number> * sizeof(Number) == 64 ? 2 : 1;
  // The powers of as many steps stay in the nearest cache while all cells pass. It also keeps the chains of
  // additions short.
  constexpr std::size_t kBlock = 24;
  for (std::size_t block = 0; block < slots.blocks; ++block) {
    const std::size_t first_step = block * slots.steps;
    const std::size_t last = first_step + slots.steps;
    for (std::size_t begin = first_step; begin < last; begin += kBlock) {
      const std::size_t end = std::min(begin + kBlock, last);
      const auto add = [&]<std::size_t kSums>(std::size_t first,
                                              std::integral_constant<std::size_t, kSums> /*number*/) {
        std::array<std::array<WeightFactors<Number>, 2>, kSums> weights;
        std::array<LaneSums<Number>*, kSums> sums;
        for (std::size_t n = 0; n < kSums; ++n) {
          const CellFactors<Number>& of_cell = work.factors[(first + n) / kKinds.size()];
          const PowerWeights& kind = kKinds[(first + n) % kKinds.size()];
          weights[n] = {of_cell.of(kind.of_even), of_cell.of(kind.of_odd)};
          sums[n] = &work.lane_sums[(first + n) * slots.blocks + block];
        }
        for (std::size_t part = 0; part < kLanesOfStep; part += kLanes<Number>) {
          add_steps<kOneWeight, kSums>(powers.data(), weights, part, begin, end, begin == first_step, sums);
        }
      };
      std::size_t first = 0;
      for (; first + kTogether <= count * kKinds.size(); first += kTogether) {
        add(first, std::integral_constant<std::size_t, kTogether>());
      }
      for (; first < count * kKinds.size(); ++first) add(first, std::integral_constant<std::size_t, 1>());
    }
  }
  for (std::size_t n = 0; n < count * kKinds.size(); ++n) fold_rows(slots, work.lane_sums[n]);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_SUMS_INL_H
