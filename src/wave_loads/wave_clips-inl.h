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
#include "wave_loads/wave_results-inl.h"
#include "wave_loads/wave_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// Reads the moments of the patches of a vector of units.
template <typename Number>
HWY_INLINE PatchMoments<Number> read_moments(const PatchTree& tree, const UnitsOfVector<Number>& units) {
  std::array<const PatchBlock*, kUnitsPerVector<Number>> blocks;
  for (std::size_t n = 0; n < blocks.size(); ++n) blocks[n] = &tree.blocks[units[n].block];
  const auto get = [&](const auto& member) HWY_ATTR {
    return gather_units<Number>([&](std::size_t n) { return member(*blocks[n]).data() + units[n].first; });
  };
  PatchMoments<Number> m;
  m.center = {get([](const PatchBlock& b) -> const FourFloats& { return b.center[0]; }),
              get([](const PatchBlock& b) -> const FourFloats& { return b.center[1]; }),
              get([](const PatchBlock& b) -> const FourFloats& { return b.center[2]; })};
  m.radius = get([](const PatchBlock& b) -> const FourFloats& { return b.radius; });
  m.area = get([](const PatchBlock& b) -> const FourFloats& { return b.area; });
  m.mu2 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu2; });
  m.mu3 = get([](const PatchBlock& b) -> const FourFloats& { return b.mu3; });
  m.nu3 = get([](const PatchBlock& b) -> const FourFloats& { return b.nu3; });
#pragma GCC unroll 3
  for (std::size_t i = 0; i < 3; ++i) {
    m.S[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.S[i]; });
  }
#pragma GCC unroll 9
  for (std::size_t i = 0; i < 9; ++i) {
    m.N[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.N[i]; });
  }
#pragma GCC unroll 18
  for (std::size_t i = 0; i < 18; ++i) {
    m.P[i] = get([i](const PatchBlock& b) -> const FourFloats& { return b.P[i]; });
  }
  return m;
}

// Which patches of a vector of units are leaves.
template <typename Number>
HWY_INLINE hn::Mask<LanesOf<Number>> leaves(const PatchTree& tree, const UnitsOfVector<Number>& units) {
  alignas(64) std::array<Number, kLanes<Number>> blocks;
  for (std::size_t lane = 0; lane < kLanes<Number>; ++lane) {
    const Unit& unit = units[lane / kUnit<Number>];
    blocks[lane] =
        static_cast<Number>(tree.blocks[unit.block].triangle_blocks[unit.first + lane % kUnit<Number>]);
  }
  return hn::Gt(hn::Load(LanesOf<Number>(), blocks.data()), set<Number>(0.0));
}

// Leaves of the tree that the surface of the water crosses, with the models that their triangles can be
// clipped with. Triangles of all leaves of a round are clipped together.
template <typename Number>
class Clips {
 public:
  using V = VectorOf<Number>;

  void clear() {
    models_.clear();
    leaves_.clear();
    tasks_.clear();
  }

  // Keeps the models of a batch and returns their number.
  HWY_INLINE std::uint32_t keep(const PatchQuery<Number>& query, const PatchMoments<Number>& moments,
                                const PatchModel<Number>& model) {
    const Vectors3<Number> lever = moments.center - axis_of<Number>(query.reference);
    const V sixth = set<Number>(1.0 / 6.0);
    const V mu1 = hn::Sqrt(moments.area * moments.mu2);
    const V remainder = hn::MulAdd(model.third * moments.mu3, sixth, model.delta * moments.area);
    const V local = hn::MulAdd(model.delta, mu1, sixth * model.third * moments.mu3 * moments.radius);
    const V of_volume = volume_remainder<Number>(moments.area, distance_moments<Number>(moments), model);
    const std::array<V, kModelRows> all{model.phi.value,
                                        model.phi.gradient.x,
                                        model.phi.gradient.y,
                                        model.phi.gradient.z,
                                        model.phi.hessian[0],
                                        model.phi.hessian[1],
                                        model.phi.hessian[2],
                                        model.phi.hessian[3],
                                        model.phi.hessian[4],
                                        model.phi.hessian[5],
                                        model.s.value,
                                        model.s.gradient.x,
                                        model.s.gradient.y,
                                        model.s.gradient.z,
                                        model.s.hessian[0],
                                        model.s.hessian[1],
                                        model.s.hessian[2],
                                        model.s.hessian[3],
                                        model.s.hessian[4],
                                        model.s.hessian[5],
                                        model.curvature,
                                        moments.radius,
                                        lever.x,
                                        lever.y,
                                        lever.z,
                                        moments.center.x,
                                        moments.center.y,
                                        moments.center.z,
                                        remainder,
                                        hn::MulAdd(hn::Sqrt(dot<Number>(lever, lever)), remainder, local),
                                        hn::MulAdd(model.s_per_phi, remainder, of_volume),
                                        model.s_per_phi};
    models_.emplace_back();
    for (std::size_t row = 0; row < kModelRows; ++row) {
      hn::Store(all[row], LanesOf<Number>(), models_.back().rows[row].data());
    }
    return static_cast<std::uint32_t>(models_.size() - 1);
  }

  // What clipping does not change of the bound on the force [m^3].
  Number remainder(std::uint32_t models, std::size_t lane) const {
    return models_[models].rows[kRemainder][lane];
  }

  // Notes a leaf that is to be clipped, which has been removed from the results.
  void add(const PatchTree& tree, const PatchBlock& block, std::size_t place, std::uint32_t models,
           std::size_t result) {
    const auto lane = static_cast<std::uint32_t>(result % kLanes<Number>);
    const TriangleBlock* const triangles = &tree.triangles[block.child[place]];
    for (std::uint32_t b = 0; b < block.triangle_blocks[place]; ++b) {
      for (std::uint32_t first = 0; first < kSiblings; first += kUnit<Number>) {
        tasks_.push_back({block.child[place] + b, first, models, lane, result});
      }
      // They are read after the other patches of the round have been evaluated.
      for (std::size_t row = 0; row < triangles[b].corners.size(); row += 4) {
        hwy::Prefetch(triangles[b].corners[row].data());
      }
    }
    leaves_.push_back({models, lane, result});
  }

  // Clips what was noted and puts it in the place of the results.
  void finish(const PatchTree& tree, const PatchQuery<Number>& query, Results<Number>& results) {
    for (const Leaf& leaf : leaves_) {
      const auto& rows = models_[leaf.models].rows;
      results.add_errors(leaf.result, rows[kRemainder][leaf.lane], rows[kTorqueRemainder][leaf.lane],
                         rows[kVolumeRemainder][leaf.lane]);
    }
    for (std::size_t n = 0; n < tasks_.size(); n += kUnitsPerVector<Number>) {
      const std::size_t count = std::min(kUnitsPerVector<Number>, tasks_.size() - n);
      clip(tree, query, &tasks_[n], count, results);
    }
    for (const Leaf& leaf : leaves_) results.finish(leaf.result);
    leaves_.clear();
    tasks_.clear();
  }

 private:
  static constexpr std::size_t kModelRows = 32;
  static constexpr std::size_t kRemainder = 28;
  static constexpr std::size_t kTorqueRemainder = 29;
  static constexpr std::size_t kVolumeRemainder = 30;
  struct Models {
    alignas(64) std::array<std::array<Number, kLanes<Number>>, kModelRows> rows;
  };
  struct Leaf {
    std::uint32_t models, lane;
    std::size_t result;
  };
  // kUnit triangles of a leaf.
  struct Task {
    std::uint32_t triangle_block;
    std::uint32_t first;  // lane of the block
    std::uint32_t models, lane;
    std::size_t result;
  };

  HWY_NOINLINE void clip(const PatchTree& tree, const PatchQuery<Number>& query, const Task* tasks,
                         std::size_t count, Results<Number>& results) const {
    const auto task = [&](std::size_t n) -> const Task& { return tasks[n < count ? n : 0]; };
    const auto corner = [&](std::size_t row) HWY_ATTR {
      return gather_units<Number>([&](std::size_t n) {
        return tree.triangles[task(n).triangle_block].corners[row].data() + task(n).first;
      });
    };
    // Most often all triangles are of one leaf.
    bool of_one = true;
    for (std::size_t n = 1; n < count; ++n) of_one &= tasks[n].result == tasks[0].result;
    std::array<V, kModelRows> model;
    for (std::size_t row = 0; row < kModelRows; ++row) {
      const auto place = [&](std::size_t n) { return &models_[task(n).models].rows[row][task(n).lane]; };
      model[row] = of_one ? hn::Set(LanesOf<Number>(), *place(0)) : spread_units<Number>(place);
    }
    const auto of_model = [&](std::size_t row) -> const V& { return model[row]; };
    const auto vector = [&](std::size_t row) HWY_ATTR {
      return Vectors3<Number>{of_model(row), of_model(row + 1), of_model(row + 2)};
    };
    const auto quadratic = [&](std::size_t row) HWY_ATTR {
      Quadratic<Number> q;
      q.value = of_model(row);
      q.gradient = vector(row + 1);
#pragma GCC unroll 6
      for (std::size_t i = 0; i < 6; ++i) q.hessian[i] = of_model(row + 4 + i);
      return q;
    };
    TriangleLanes<Number> t;
#pragma GCC unroll 3
    for (std::size_t i = 0; i < 3; ++i) t.corners[i] = {corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
    t.phi = quadratic(0);
    t.s = quadratic(10);
    t.curvature = of_model(20);
    t.whole = set_mask<Number>(false);
    t.none = set_mask<Number>(false);
    const PatchIntegrals<Number> integrals =
        to_patch<Number>(integrate<Number>(query, t), vector(22), vector(25), of_model(21), of_model(31));
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
      V sum = all[row];
      if constexpr (kUnit<Number> == 4) sum = sum + hn::Reverse4(LanesOf<Number>(), sum);
      if constexpr (kUnit < Number >> 1) sum = sum + hn::Reverse2(LanesOf<Number>(), sum);
      hn::Store(sum, LanesOf<Number>(), numbers[row].data());
    }
    for (std::size_t n = 0; n < count; ++n) {
      results.add_to(tasks[n].result, &numbers[0][n * kUnit<Number>], kLanes<Number>);
    }
  }

  std::vector<Models> models_;
  std::vector<Leaf> leaves_;
  std::vector<Task> tasks_;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_CLIPS_INL_H
