// Models of patches that the surface of the water crosses, kept so that the patches can be refined without
// the sea: their triangles are clipped with them, or their children take them, with SIMD
// (docs/wave_mathematics.md, "What a patch contributes"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_KEPT_MODELS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_KEPT_MODELS_INL_H
#undef BUOYANCY_WAVE_KEPT_MODELS_INL_H
#else
#define BUOYANCY_WAVE_KEPT_MODELS_INL_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_models-inl.h"
#include "wave_loads/wave_patches-inl.h"
#include "wave_loads/wave_results-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Where a kept model is.
struct KeptModel {
  std::uint32_t models = kNone;
  std::uint32_t lane = 0;

  bool operator==(const KeptModel&) const = default;
};

// Kept models in lanes, in rows.
template <typename Number>
struct KeptModelLanes {
  using V = VectorOf<Number>;

  static constexpr std::size_t kRowsForClips = 32;
  static constexpr std::size_t kRows = 40;

  std::array<V, kRows> rows;

  // About the patch's centroid.
  HWY_INLINE Quadratic<Number> phi() const { return quadratic(0); }
  HWY_INLINE Quadratic<Number> s() const { return quadratic(10); }
  HWY_INLINE const V& curvature() const { return rows[20]; }
  HWY_INLINE const V& radius() const { return rows[21]; }
  HWY_INLINE Vectors3<Number> lever() const { return vector(22); }
  HWY_INLINE Vectors3<Number> center() const { return vector(25); }
  // Rows 28 to 30: what neither clipping nor an inherited model changes of the bounds of the force, the
  // torque and the volume.
  static constexpr std::size_t kRemainder = 28;
  HWY_INLINE const V& certificate_factor() const { return rows[31]; }
  HWY_INLINE const V& third() const { return rows[32]; }
  HWY_INLINE const V& delta() const { return rows[33]; }
  HWY_INLINE const V& s_third() const { return rows[34]; }
  HWY_INLINE const V& s_delta() const { return rows[35]; }
  HWY_INLINE const V& s_curvature() const { return rows[36]; }
  // The point about which the Taylor polynomials were made.
  HWY_INLINE Vectors3<Number> origin() const { return vector(37); }

 private:
  HWY_INLINE Vectors3<Number> vector(std::size_t row) const {
    return {rows[row], rows[row + 1], rows[row + 2]};
  }
  HWY_INLINE Quadratic<Number> quadratic(std::size_t row) const {
    return {rows[row],
            vector(row + 1),
            {rows[row + 4], rows[row + 5], rows[row + 6], rows[row + 7], rows[row + 8], rows[row + 9]}};
  }
};

template <typename Number>
class KeptModels {
 public:
  using V = VectorOf<Number>;

  void clear() { count_ = 0; }

  // Keeps the models of a batch of units if the surface may cross a patch of theirs. origin: as in
  // KeptModelLanes.
  HWY_INLINE KeptOfBatch keep_crossing(const QueryPatches& patches, const UnitsOfVector<Number>& units,
                                       const hn::Mask<LanesOf<Number>>& crossing,
                                       const PatchQuery<Number>& query, const PatchMoments<Number>& moments,
                                       const PatchModel<Number>& model, const Vectors3<Number>& origin) {
    KeptOfBatch kept;
    kept.lanes = bits_of<Number>(crossing);
    if (kept.lanes == 0) return kept;
    kept.leaves = kept.lanes & leaves<Number>(patches, units);
    kept.models = keep(query, moments, model, origin);
    return kept;
  }

  // Of the force [m^3].
  Number remainder(const KeptModel& at) const { return models_[at.models].rows[kRemainder][at.lane]; }
  Number torque_remainder(const KeptModel& at) const {
    return models_[at.models].rows[kRemainder + 1][at.lane];
  }
  Number volume_remainder_of(const KeptModel& at) const {
    return models_[at.models].rows[kRemainder + 2][at.lane];
  }

  // The model at(n) in all lanes of the n-th unit, its first kCount rows. of_one: at(n) is the same for all
  // n.
  template <std::size_t kCount, typename At>
  HWY_INLINE KeptModelLanes<Number> lanes(bool of_one, const At& at) const {
    KeptModelLanes<Number> kept;
    for (std::size_t row = 0; row < kCount; ++row) {
      const auto place = [&](std::size_t n) { return &models_[at(n).models].rows[row][at(n).lane]; };
      kept.rows[row] = of_one ? hn::Set(LanesOf<Number>(), *place(0)) : spread_units<Number>(place);
    }
    return kept;
  }

 private:
  static constexpr std::size_t kRows = KeptModelLanes<Number>::kRows;
  static constexpr std::size_t kRemainder = KeptModelLanes<Number>::kRemainder;
  struct Models {
    alignas(64) std::array<std::array<Number, kLanes<Number>>, kRows> rows;
  };

  // Keeps the models of a batch and returns their number.
  HWY_INLINE std::uint32_t keep(const PatchQuery<Number>& query, const PatchMoments<Number>& moments,
                                const PatchModel<Number>& model, const Vectors3<Number>& origin) {
    const Vectors3<Number> lever = moments.center - axis_of<Number>(query.reference);
    const V sixth = set<Number>(1.0 / 6.0);
    const V mu1 = hn::Sqrt(moments.area * moments.mu2);
    const V remainder = hn::MulAdd(model.third * moments.mu3, sixth, model.mean_delta * moments.area);
    const V local = hn::MulAdd(model.delta, mu1, sixth * model.third * moments.mu3 * moments.radius);
    const V of_volume = volume_remainder<Number>(moments.area, distance_moments<Number>(moments), model);
    if (count_ == models_.size()) models_.emplace_back();
    auto& rows = models_[count_].rows;
    std::size_t row = 0;
    const auto put = [&](const auto&... numbers)
                         HWY_ATTR { (hn::Store(numbers, LanesOf<Number>(), rows[row++].data()), ...); };
    const auto put_quadratic = [&](const Quadratic<Number>& q) HWY_ATTR {
      put(q.value, q.gradient.x, q.gradient.y, q.gradient.z, q.hessian[0], q.hessian[1], q.hessian[2],
          q.hessian[3], q.hessian[4], q.hessian[5]);
    };
    put_quadratic(model.phi);
    put_quadratic(model.s);
    put(model.curvature, moments.radius, lever.x, lever.y, lever.z, moments.center.x, moments.center.y,
        moments.center.z, remainder, hn::MulAdd(hn::Sqrt(dot<Number>(lever, lever)), remainder, local),
        hn::MulAdd(model.certificate_factor, remainder, of_volume), model.certificate_factor, model.third, model.delta,
        model.s_third, model.s_delta, model.s_curvature, origin.x, origin.y, origin.z);
    return static_cast<std::uint32_t>(count_++);
  }

  // Kept from query to query, so that no models are set to zero before they are written.
  std::vector<Models> models_;
  std::size_t count_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_KEPT_MODELS_INL_H
