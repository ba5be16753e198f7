// The patches of a round in a sea that is known on grids: the spline at their centroids and its bounds over
// them, with SIMD (docs/wave_mathematics.md, "Surfaces on a grid"). Lengths are in metres: k_max is 1.
// Included once per instruction set.
#if defined(BUOYANCY_WAVE_SPLINE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_SPLINE_INL_H
#undef BUOYANCY_WAVE_SPLINE_INL_H
#else
#define BUOYANCY_WAVE_SPLINE_INL_H
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "wave_loads/wave_models-inl.h"
#include "wave_loads/wave_query.h"
#include "wave_loads/wave_round-inl.h"
#include "waves/elevation_spline.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// A spline about the body's centre, whatever the precision of the patches in double.
class SplineAtBody {
 public:
  using D = LanesOf<double>;
  using V = VectorOf<double>;

  // x1, x2: [m], of the body's centre.
  void start(const ElevationBlend::Part& part, double x1, double x2) {
    spline_ = part.spline;
    share_ = part.share;
    const std::array<double, 2> center{x1, x2};
    for (std::size_t n = 0; n < 2; ++n) {
      const ElevationSpline::Axis& axis = spline_->axis(n);
      const double position = axis.position(center[n]);
      const double whole = std::floor(position);
      along_[n] = {position - whole, axis.periodic ? axis.cell_of(whole) : whole, axis.per_spacing,
                   static_cast<double>(axis.cells), axis.periodic};
    }
  }

  // Of kLanes points, by rows.
  struct Results {
    std::array<double*, 6> derivatives;  // value, gradient, Hessian: 11, 12, 22
    double* third;
  };

  // Adds value, derivatives and a bound on the third ones at points x1, x2 from the body's centre, over
  // their discs of this radius [m], times the share of the spline.
  HWY_INLINE void add(const V& x1, const V& x2, const V& radius, const Results& results) const {
    const D d;
    const Lanes along_1 = lanes_of(along_[0], x1, radius);
    const Lanes along_2 = lanes_of(along_[1], x2, radius);
    add_derivatives(along_1, along_2, results.derivatives);
    alignas(64) std::array<std::array<double, kLanes<double>>, 4> ends;
    hn::Store(along_1.first, d, ends[0].data());
    hn::Store(along_2.first, d, ends[1].data());
    hn::Store(along_1.last, d, ends[2].data());
    hn::Store(along_2.last, d, ends[3].data());
    for (std::size_t lane = 0; lane < kLanes<double>; ++lane) {
      const auto end = [&](std::size_t n) { return static_cast<std::int32_t>(ends[n][lane]); };
      float third = 0.0F;
      spline_->for_each_block({{end(0), end(1)}, {end(2), end(3)}}, kFiner,
                              [&](const ElevationBounds& block) { third = std::max(third, block.third); });
      results.third[lane] += share_ * static_cast<double>(third);
    }
  }

 private:
  static constexpr std::size_t kFiner = 0;  // chosen for the least time

  // The body's centre along an axis: its cell and the position in it, in spacings.
  struct Along {
    double rest, whole;
    double per_spacing;
    double cells;
    bool periodic;
  };
  // Points and their discs along an axis.
  struct Lanes {
    V cell, t;      // t: the position in the cell
    V first, last;  // the cells of the disc
  };

  // A cell that exists, of a whole number.
  static HWY_INLINE V inside(const Along& along, const V& cell) {
    V within = cell;
    if (along.periodic) {
      const V periods = hn::Floor((cell + set<double>(0.5)) * set<double>(1.0 / along.cells));
      within = hn::NegMulAdd(periods, set<double>(along.cells), cell);
    }
    return hn::Min(hn::Max(within, set<double>(0.0)), set<double>(along.cells - 1.0));
  }

  static HWY_INLINE Lanes lanes_of(const Along& along, const V& x, const V& radius) {
    const V position = hn::MulAdd(x, set<double>(along.per_spacing), set<double>(along.rest));
    const V whole = hn::Floor(position);
    const V base = set<double>(along.whole);
    Lanes lanes;
    lanes.cell = inside(along, base + whole);
    lanes.t = position - (along.periodic ? whole : lanes.cell - base);
    // Wider than by rounding.
    const V reach = hn::MulAdd(radius, set<double>(along.per_spacing * (1.0 + 1e-9)), set<double>(1e-9));
    const V low = hn::Floor(position - reach);
    const V high = hn::Floor(position + reach);
    lanes.first = inside(along, base + low);
    lanes.last = inside(along, base + high);
    if (along.periodic) {
      const auto all = hn::Ge(high - low, set<double>(along.cells - 1.0));
      lanes.first = hn::IfThenZeroElse(all, lanes.first);
      lanes.last = hn::IfThenElse(all, set<double>(along.cells - 1.0), lanes.last);
    }
    return lanes;
  }

  struct Weights {
    std::array<V, 4> value, first, second;
  };
  static HWY_INLINE Weights weights_at(const V& t) {
    const V one = set<double>(1.0);
    const V two = set<double>(2.0);
    const V three = set<double>(3.0);
    const V half = set<double>(0.5);
    const V sixth = set<double>(1.0 / 6.0);
    const V u = one - t;
    const V tt = t * t;
    const V uu = u * u;
    const auto inner = [&](const V& at, const V& squared) HWY_ATTR {
      return hn::MulAdd(squared, hn::MulSub(half, at, one), set<double>(2.0 / 3.0));
    };
    Weights w;
    w.value = {sixth * uu * u, inner(t, tt), inner(u, uu), sixth * tt * t};
    w.first = {hn::Neg(half * uu), t * hn::MulSub(set<double>(1.5), t, two),
               u * hn::NegMulAdd(set<double>(1.5), u, two), half * tt};
    w.second = {u, hn::MulSub(three, t, two), hn::MulSub(three, u, two), t};
    return w;
  }

  HWY_INLINE void add_derivatives(const Lanes& along_1, const Lanes& along_2,
                                  const std::array<double*, 6>& results) const {
    const D d;
    const hn::RebindToSigned<D> di;
    const auto stride = static_cast<double>(spline_->stride());
    const auto index = hn::ConvertTo(di, hn::MulAdd(along_2.cell, set<double>(stride), along_1.cell));
    const Weights of_1 = weights_at(along_1.t);
    const Weights of_2 = weights_at(along_2.t);
    const V zero = hn::Zero(d);
    std::array<V, 6> sums{zero, zero, zero, zero, zero, zero};
#pragma GCC unroll 4
    for (std::size_t n = 0; n < 4; ++n) {
      const double* const row = spline_->coefficients() + n * spline_->stride();
      V value = zero;
      V first = zero;
      V second = zero;
#pragma GCC unroll 4
      for (std::size_t m = 0; m < 4; ++m) {
        const V c = hn::GatherIndex(d, row + m, index);
        value = hn::MulAdd(of_1.value[m], c, value);
        first = hn::MulAdd(of_1.first[m], c, first);
        second = hn::MulAdd(of_1.second[m], c, second);
      }
      sums[0] = hn::MulAdd(of_2.value[n], value, sums[0]);
      sums[1] = hn::MulAdd(of_2.value[n], first, sums[1]);
      sums[2] = hn::MulAdd(of_2.first[n], value, sums[2]);
      sums[3] = hn::MulAdd(of_2.value[n], second, sums[3]);
      sums[4] = hn::MulAdd(of_2.first[n], first, sums[4]);
      sums[5] = hn::MulAdd(of_2.second[n], value, sums[5]);
    }
    const double g1 = along_[0].per_spacing;
    const double g2 = along_[1].per_spacing;
    const std::array<double, 6> scales{1.0, g1, g2, g1 * g1, g1 * g2, g2 * g2};
    for (std::size_t row = 0; row < 6; ++row) {
      const V scaled_sum = set<double>(share_ * scales[row]) * sums[row];
      hn::Store(hn::Load(d, results[row]) + scaled_sum, d, results[row]);
    }
  }

  const ElevationSpline* spline_ = nullptr;
  double share_ = 0.0;
  std::array<Along, 2> along_{};
};

// With what the rounding errors of the spline add up to.
template <typename Number>
struct SplineField : SurfaceField<Number> {
  VectorOf<Number> rounding;  // [m]
};

template <typename Number>
HWY_INLINE SurfaceRange<Number> range_of(const PatchQuery<Number>& query, const VectorOf<Number>& zeta,
                                         const VectorOf<Number>& r, const SurfaceValues<Number>& surface,
                                         const VectorOf<Number>& rounding) {
  const VectorOf<Number> zero = set<Number>(0.0);
  SurfaceRange<Number> range;
  range.above = {zero, zero, surface.third, zero, zero, zero, zero};
  range.L3 = surface.third;
  // Third derivatives jump.
  range.L4 = set<Number>(kNoBound);
  range.third_rest = zero;
  set_variation<Number>(zeta, r, surface, range);
  const VectorOf<Number> size =
      hn::MulAdd(r, hn::MulAdd(r, range.L2_at_point, hn::Abs(surface.eta_1) + hn::Abs(surface.eta_2)),
                 hn::Abs(surface.eta));
  range.rounded = hn::MulAdd(set<Number>(4.0 * query.unit_roundoff), size, rounding);
  range.epsilon = hn::MulAdd(set<Number>(query.rounding()), hn::Abs(zeta), range.rounded);
  range.low = range.low - range.epsilon;
  range.high = range.high + range.epsilon;
  return range;
}

template <typename Number>
HWY_INLINE PatchModel<Number> model_of(const PatchQuery<Number>& query, const SplineField<Number>& field) {
  PatchSurface<Number> surface;
  surface.range = range_of<Number>(query, field.place.zeta, field.r, field.surface, field.rounding);
  surface.mean_truncation = set<Number>(0.0);
  surface.wet = hn::Or(hn::Lt(surface.range.high, set<Number>(0.0)), set_mask<Number>(query.submerged));
  PatchModel<Number> model;
  set_height_model<Number>(query, field, surface.range, model);
  choose_model<Number>(query, field, surface, hydrostatic_pressure<Number>(query, field, surface), model);
  return model;
}

// The patches of a round.
template <typename Number>
class PatchesOnSpline : public PlacedPatches<Number> {
 public:
  using Base = PlacedPatches<Number>;
  using V = VectorOf<Number>;
  using Field = SplineField<Number>;

  // The arguments must outlive the query.
  void start(const WaveQuery& query, const QueryPatches& patches, const PatchQuery<Number>& patch) {
    Base::start(patches, patch);
    const ElevationBlend& surface = query.sea->surface();
    count_ = surface.count;
    mean_elevation_ = query.mean_elevation - surface.rise;
    rounding_ = growth_ = 0.0;
    for (std::size_t n = 0; n < count_; ++n) {
      const ElevationSpline& spline = *surface.parts[n].spline;
      splines_[n].start(surface.parts[n], query.x1, query.x2);
      const double largest = query.max_elevation + std::abs(query.mean_elevation);
      rounding_ = std::max(rounding_, spline.rounding(largest, 0.0));
      growth_ = std::max(growth_, ElevationSpline::kGrowth / spline.min_spacing());
    }
    rounding_ += 0x1p-50 * std::abs(surface.rise);
  }

  bool full() const { return false; }
  std::size_t cell_count() const { return 0; }

  // Finds what is known of the groups of the round from the surface alone.
  void evaluate_surface() {
    this->place_groups([this](const Batch<Number>& batch, const Place<Number>& place) HWY_ATTR {
      const V radius = this->radii_of(batch);
      const SurfaceValues<Number> values = evaluate(place, radius);
      this->write(batch, values);
      this->note_dry(batch,
                     range_of<Number>(*patch_, place.zeta, radius, values, rounding_within(radius)).low);
    });
  }

  // Calls work(batch, 0, 0) for the groups that are not dry.
  template <typename Work>
  HWY_INLINE void for_each_batch(const Work& work) {
    for (std::size_t n = 0; n < groups_.size();) {
      Batch<Number> batch;
      for (; n < groups_.size() && batch.count < kGroupsPerVector<Number>; ++n) {
        if (!groups_[n].dry) batch.groups[batch.count++] = static_cast<std::uint32_t>(n);
      }
      if (batch.count == 0) break;
      for (std::size_t i = batch.count; i < kGroupsPerVector<Number>; ++i) batch.groups[i] = batch.groups[0];
      work(batch, 0, 0);
    }
  }

  // All but the radius and its spread, and the rounding errors over the radius.
  HWY_INLINE Field field_of(const Batch<Number>& batch, std::size_t /*cell*/, std::size_t /*cell*/) const {
    Field field;
    this->read_surface(batch, field);
    field.rounding = rounding_within(this->radii_of(batch));
    return field;
  }

 private:
  using Base::groups_;
  using Base::patch_;

  HWY_INLINE V rounding_within(const V& radius) const {
    const V growth = hn::MulAdd(set<Number>(growth_), radius, set<Number>(1.0));
    return set<Number>(rounding_) * growth * growth;
  }

  HWY_NOINLINE SurfaceValues<Number> evaluate(const Place<Number>& place, const V& radius) const {
    const LanesOf<Number> d;
    const LanesOf<double> dd;
    using Numbers = std::array<Number, kLanes<Number>>;
    alignas(64) Numbers x1, x2, r;
    hn::Store(place.x1, d, x1.data());
    hn::Store(place.x2, d, x2.data());
    hn::Store(radius, d, r.data());
    constexpr std::size_t kRows = 7;
    alignas(64) std::array<std::array<double, kLanes<Number>>, kRows> sums{};
    sums[0].fill(-mean_elevation_);
    const auto load = [&](const Number* numbers) HWY_ATTR {
      if constexpr (sizeof(Number) == sizeof(double)) {
        return hn::Load(dd, numbers);
      } else {
        return hn::PromoteTo(dd, hn::Load(hn::Rebind<float, LanesOf<double>>(), numbers));
      }
    };
    for (std::size_t n = 0; n < count_; ++n) {
      for (std::size_t lane = 0; lane < kLanes<Number>; lane += kLanes<double>) {
        splines_[n].add(
            load(&x1[lane]), load(&x2[lane]), load(&r[lane]),
            {{&sums[0][lane], &sums[1][lane], &sums[2][lane], &sums[3][lane], &sums[4][lane], &sums[5][lane]},
             &sums[6][lane]});
      }
    }
    const auto row = [&](std::size_t n) HWY_ATTR {
      if constexpr (sizeof(Number) == sizeof(double)) {
        return hn::Load(d, sums[n].data());
      } else {
        alignas(64) Numbers narrow;
        const hn::Rebind<float, LanesOf<double>> df;
        for (std::size_t lane = 0; lane < kLanes<Number>; lane += kLanes<double>) {
          hn::Store(hn::DemoteTo(df, hn::Load(dd, &sums[n][lane])), df, &narrow[lane]);
        }
        return hn::Load(d, narrow.data());
      }
    };
    constexpr double kUpwards = 1.0 + 2.5e-7;  // of float
    return {row(0), row(1), row(2), row(3), row(4), row(5), set<Number>(kUpwards) * row(6)};
  }

  std::array<SplineAtBody, 2> splines_;
  std::size_t count_ = 0;
  double mean_elevation_ = 0.0;  // [m], which is subtracted
  // [m], the rounding error at a point is at most rounding_, and over a radius r (1 + growth_ r)^2 times
  // that.
  double rounding_ = 0.0, growth_ = 0.0;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_SPLINE_INL_H
