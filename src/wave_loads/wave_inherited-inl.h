// Patches that take the model of a patch that holds them, with SIMD (docs/wave_mathematics.md, "Inherited
// models"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_INHERITED_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_INHERITED_INL_H
#undef BUOYANCY_WAVE_INHERITED_INL_H
#else
#define BUOYANCY_WAVE_INHERITED_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/patch_tree.h"
#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_kept_models-inl.h"
#include "wave_loads/wave_patches-inl.h"
#include "wave_loads/wave_results-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// The quadratic function about another point, at y from its own.
template <typename Number>
HWY_INLINE Quadratic<Number> moved(const Quadratic<Number>& q, const Vectors3<Number>& y) {
  const Vectors3<Number> change = product<Number>(q.hessian, y);
  Quadratic<Number> result;
  result.value = q.value + dot<Number>(q.gradient, y) + set<Number>(0.5) * dot<Number>(change, y);
  result.gradient = q.gradient + change;
  result.hessian = q.hessian;
  return result;
}

// A bound on what the rounding of moved() adds to the function's value over the patch.
template <typename Number>
HWY_INLINE VectorOf<Number> rounding_of_move(const PatchQuery<Number>& query, const Quadratic<Number>& q,
                                             const VectorOf<Number>& distance, const VectorOf<Number>& radius,
                                             const VectorOf<Number>& curvature) {
  const VectorOf<Number> slope = hn::Sqrt(dot<Number>(q.gradient, q.gradient));
  const VectorOf<Number> reach = distance + radius;
  return set<Number>(query.integral_rounding) *
         hn::MulAdd(hn::MulAdd(curvature, reach, slope), reach, hn::Abs(q.value));
}

// The moments of a patch, and its model made from one that was kept.
template <typename Number>
struct Inherited {
  PatchMoments<Number> moments;  // mu3: a bound on the integral of |x - origin|^3
  PatchModel<Number> model;
};

template <typename Number>
HWY_INLINE Inherited<Number> inherit(const PatchQuery<Number>& query, const PatchMoments<Number>& moments,
                                     const KeptModelLanes<Number>& kept) {
  using V = VectorOf<Number>;
  const V zero = set<Number>(0.0);
  const V half = set<Number>(0.5);
  const V& r = moments.radius;
  const Vectors3<Number> y = moments.center - kept.center();
  const Vectors3<Number> of_origin = moments.center - kept.origin();
  const V from_kept = hn::Sqrt(dot<Number>(y, y));
  const V squared = dot<Number>(of_origin, of_origin);
  const V reach = hn::Sqrt(squared) + r;

  Inherited<Number> result;
  result.moments = moments;
  // The displacement is more than that of a centroid on the grid.
  const V off_centroid = set<Number>(2.0 * query.displacement / query.k_max) * hn::Sqrt(squared);
  result.moments.mu3 =
      set<Number>(1.00001) * reach * hn::MulAdd(squared + off_centroid, moments.area, moments.mu2);

  PatchModel<Number>& model = result.model;
  model.phi = moved<Number>(kept.phi(), y);
  model.s = moved<Number>(kept.s(), y);
  model.third = kept.third();
  model.cubic = {zero, zero, zero};
  model.third_of_children = set<Number>(8.0) * kept.third();  // parts inherit it
  model.curvature = kept.curvature();
  model.delta = kept.delta() + rounding_of_move<Number>(query, kept.phi(), from_kept, r, kept.curvature());
  model.mean_delta = model.delta;
  model.delta_of_children = model.delta;
  model.s_third = kept.s_third();
  model.s_cubic = {zero, zero, zero};
  model.s_curvature = kept.s_curvature();
  model.s_delta =
      kept.s_delta() + rounding_of_move<Number>(query, kept.s(), from_kept, r, kept.s_curvature());

  const V variation =
      r * hn::MulAdd(half * kept.s_curvature(), r,
                     hn::Sqrt(dot<Number>(model.s.gradient, model.s.gradient))) +
      hn::MulAdd(kept.s_third() * set<Number>(1.0 / 6.0), reach * reach * reach, model.s_delta);
  model.dry = hn::Gt(model.s.value - variation, zero);
  model.whole = hn::Lt(model.s.value + variation, zero);
  model.wet = set_mask<Number>(false);  // what it selects is of no use here
  model.certificate_factor = hn::IfThenZeroElse(model.whole, kept.certificate_factor());
  model.too_steep = set_mask<Number>(false);
  return result;
}

// Patches of a round that inherit their models.
template <typename Number>
class InheritedUnits {
 public:
  // kept: the models; must outlive the query.
  void start(KeptModels<Number>& kept) {
    kept_ = &kept;
    tasks_.clear();
  }

  std::size_t count() const { return tasks_.size(); }

  // Adds a block of patches that the patch of the model holds.
  void add_block(const QueryPatches& patches, std::uint32_t block, const KeptModel& model) {
    prefetch_places(patches.block(block));
    prefetch_moments(patches.block(block));
    for_each_unit<Number>(patches.block(block), [&](std::uint32_t first) {
      tasks_.push_back({block, first, model});
    });
  }

  // Evaluates what was added and appends the results. Returns the number of patches that are not dry.
  std::size_t finish(const QueryPatches& patches, const PatchQuery<Number>& query, Results<Number>& results) {
    std::size_t wet = 0;
    for (std::size_t n = 0; n < tasks_.size(); n += kUnitsPerVector<Number>) {
      wet +=
          evaluate(patches, query, &tasks_[n], std::min(kUnitsPerVector<Number>, tasks_.size() - n), results);
    }
    tasks_.clear();
    return wet;
  }

 private:
  // kUnit patches of a block.
  struct Task {
    std::uint32_t block, first;
    KeptModel model;
  };

  HWY_NOINLINE std::size_t evaluate(const QueryPatches& patches, const PatchQuery<Number>& query,
                                    const Task* tasks, std::size_t count, Results<Number>& results) {
    UnitsOfVector<Number> units;
    bool of_one = true;
    for (std::size_t n = 0; n < units.size(); ++n) {
      const Task& task = tasks[n < count ? n : 0];
      units[n].block = task.block;
      units[n].first = task.first;
      of_one &= task.model == tasks[0].model;
    }
    const KeptModelLanes<Number> kept = kept_->template lanes<KeptModelLanes<Number>::kRows>(
        of_one, [&](std::size_t n) -> const KeptModel& { return tasks[n < count ? n : 0].model; });
    const Inherited<Number> inherited = inherit<Number>(query, read_moments<Number>(patches, units), kept);
    const auto counts = hn::AndNot(inherited.model.dry, hn::FirstN(LanesOf<Number>(), count * kUnit<Number>));
    PatchIntegrals<Number> integrals = integrate<Number>(query, inherited.moments, inherited.model);
    clear_where<Number>(hn::Not(counts), integrals);
    results.add(units, integrals,
                kept_->keep_crossing(patches, units, hn::AndNot(inherited.model.whole, counts), query,
                                     inherited.moments, inherited.model, kept.origin()));
    return hn::CountTrue(LanesOf<Number>(), counts);
  }

  KeptModels<Number>* kept_ = nullptr;
  std::vector<Task> tasks_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_INHERITED_INL_H
