// The clipped leaves of a round, with SIMD. Included once per instruction set.
#if defined(BUOYANCY_WAVE_CLIPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_CLIPS_INL_H
#undef BUOYANCY_WAVE_CLIPS_INL_H
#else
#define BUOYANCY_WAVE_CLIPS_INL_H
#endif

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_kept_models-inl.h"
#include "wave_loads/wave_results-inl.h"
#include "wave_loads/wave_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Leaves of the tree that the surface of the water crosses, clipped with the models that were kept of them.
// Triangles of all leaves of a round are clipped together.
template <typename Number>
class Clips {
 public:
  using V = VectorOf<Number>;

  // kept: the models to clip with; must outlive the query.
  void start(const KeptModels<Number>& kept) {
    kept_ = &kept;
    leaves_.clear();
    tasks_.clear();
  }

  // Notes a leaf that is to be clipped, which has been removed from the results.
  void add(const QueryPatches& patches, const PatchBlock& block, std::size_t place, const KeptModel& model,
           std::size_t result) {
    for (std::uint32_t b = 0; b < block.triangle_blocks[place]; ++b) {
      for (std::uint32_t first = 0; first < kSiblings; first += kUnit<Number>) {
        tasks_.push_back({block.child[place] + b, first, model, result});
      }
      // They are read after the other patches of the round have been evaluated.
      const TriangleBlock& triangles = patches.triangles(block.child[place] + b);
      for (std::size_t row = 0; row < triangles.corners.size(); row += 4) {
        hwy::Prefetch(triangles.corners[row].data());
      }
    }
    leaves_.push_back({model, result});
  }

  // Clips what was noted and puts it in the place of the results.
  void finish(const QueryPatches& patches, const PatchQuery<Number>& query, Results<Number>& results) {
    for (const Leaf& leaf : leaves_) {
      results.add_errors(leaf.result, kept_->remainder(leaf.model), kept_->torque_remainder(leaf.model),
                         kept_->volume_remainder_of(leaf.model));
    }
    for (std::size_t n = 0; n < tasks_.size(); n += kUnitsPerVector<Number>) {
      const std::size_t count = std::min(kUnitsPerVector<Number>, tasks_.size() - n);
      clip(patches, query, &tasks_[n], count, results);
    }
    for (const Leaf& leaf : leaves_) results.finish(leaf.result);
    leaves_.clear();
    tasks_.clear();
  }

 private:
  struct Leaf {
    KeptModel model;
    std::size_t result;
  };
  // kUnit triangles of a leaf.
  struct Task {
    std::uint32_t triangle_block;
    std::uint32_t first;  // lane of the block
    KeptModel model;
    std::size_t result;
  };

  HWY_NOINLINE void clip(const QueryPatches& patches, const PatchQuery<Number>& query, const Task* tasks,
                         std::size_t count, Results<Number>& results) const {
    const auto task = [&](std::size_t n) -> const Task& { return tasks[n < count ? n : 0]; };
    const auto corner = [&](std::size_t row) HWY_ATTR {
      return gather_units<Number>([&](std::size_t n) {
        return patches.triangles(task(n).triangle_block).corners[row].data() + task(n).first;
      });
    };
    // Most often all triangles are of one leaf.
    bool of_one = true;
    for (std::size_t n = 1; n < count; ++n) of_one &= tasks[n].result == tasks[0].result;
    const KeptModelLanes<Number> kept = kept_->template lanes<KeptModelLanes<Number>::kRowsForClips>(
        of_one, [&](std::size_t n) -> const KeptModel& { return task(n).model; });
    TriangleLanes<Number> t;
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 3; ++i) t.corners[i] = {corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
    t.phi = kept.phi();
    t.s = kept.s();
    t.curvature = kept.curvature();
    const PatchIntegrals<Number> integrals = to_patch<Number>(integrate<Number>(query, t), kept.lever(),
                                                              kept.center(), kept.radius(), kept.certificate_factor());
    add_sums(integrals, tasks, count, results);
  }

  // Adds the sums over the lanes of each unit to the unit's result.
  static HWY_INLINE void add_sums(const PatchIntegrals<Number>& integrals, const Task* tasks,
                                  std::size_t count, Results<Number>& results) {
    constexpr std::size_t kRows = Results<Number>::kRows;
    const std::array<V, kRows> all{integrals.force.x,     integrals.force.y,     integrals.force.z,
                                   integrals.torque.x,    integrals.torque.y,    integrals.torque.z,
                                   integrals.moment.x,    integrals.moment.y,    integrals.moment.z,
                                   integrals.volume,      integrals.force_error, integrals.torque_error,
                                   integrals.volume_error};
    alignas(64) std::array<std::array<Number, kLanes<Number>>, kRows> numbers;
    for (std::size_t row = 0; row < kRows; ++row) {
      hn::Store(sums_of_units<Number>(all[row]), LanesOf<Number>(), numbers[row].data());
    }
    for (std::size_t n = 0; n < count; ++n) {
      results.add_to(tasks[n].result, &numbers[0][n * kUnit<Number>], kLanes<Number>);
    }
  }

  const KeptModels<Number>* kept_ = nullptr;
  std::vector<Leaf> leaves_;
  std::vector<Task> tasks_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_CLIPS_INL_H
