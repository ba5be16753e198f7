// The sum over all patches of a descent with the bounds on their errors, and which of them are refined
// (docs/wave_mathematics.md, "Refinement"). Included once per instruction set.
#if defined(BUOYANCY_WAVE_LOAD_SUM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_LOAD_SUM_INL_H
#undef BUOYANCY_WAVE_LOAD_SUM_INL_H
#else
#define BUOYANCY_WAVE_LOAD_SUM_INL_H
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_load.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// The errors of a patch's children together, and the error of a patch once it is clipped, over its own error:
// typical values of small patches.
inline constexpr double kErrorOfChildren = 0.15;
inline constexpr double kErrorOfClipping = 0.02;

// The patches of a batch whose models are kept.
struct CachedOfBatch {
  std::uint32_t lanes = 0;   // bits
  std::uint32_t leaves = 0;  // those of them whose triangles can be clipped
  std::uint32_t models = kNone;
};

// The integrals of all patches so far, batch by batch, and the bounds on their errors. Results are numbered
// by their lanes.
template <typename Number>
class LoadSum {
 public:
  // max_lever: [m], L_r.
  void start(double max_lever) {
    per_lever_ = 1.0 / max_lever;
    batch_count_ = 0;
    total_ = settled_ = 0.0;
  }

  void add(const GroupsOfVector<Number>& groups, const PatchIntegrals<Number>& integrals,
           const CachedOfBatch& kept) {
    const LanesOf<Number> d;
    const std::size_t first = batch_count_ * kLanes<Number>;
    if (batch_count_ == batches_.size()) {
      batches_.emplace_back();
      errors_.resize(first + kLanes<Number>);
      expected_.resize(first + kLanes<Number>);
    }
    BatchResults& batch = batches_[batch_count_++];
    batch.groups = groups;
    batch.kept = kept;
    const std::array<VectorOf<Number>, kRows> rows = rows_of(integrals);
    for (std::size_t row = 0; row < kRows; ++row) hn::Store(rows[row], d, batch.rows[row].data());
    const VectorOf<Number> error =
        hn::Max(integrals.force_error, set<Number>(per_lever_) * integrals.torque_error);
    // As much less than the error as the force's is.
    const VectorOf<Number> share = integrals.expected / hn::Max(integrals.force_error, set<Number>(1e-30));
    hn::StoreU(error, d, &errors_[first]);
    hn::StoreU(error * share, d, &expected_[first]);
    total_ += static_cast<double>(sum_of_lanes(error));
    for (std::uint32_t lanes = kept.leaves; lanes != 0; lanes &= lanes - 1) {
      const auto n = first + static_cast<std::size_t>(std::countr_zero(lanes));
      expected_[n] = errors_[n] * static_cast<Number>(kErrorOfClipping);
    }
  }

  // Adds kRows numbers to a result, in the order of rows_of().
  void add_to(std::size_t result, const Number* numbers, std::size_t stride) {
    auto& rows = batches_[result / kLanes<Number>].rows;
    for (std::size_t row = 0; row < kRows; ++row) rows[row][result % kLanes<Number>] += numbers[row * stride];
  }

  void add_errors(std::size_t result, Number force_error, Number torque_error, Number volume_error) {
    auto& rows = batches_[result / kLanes<Number>].rows;
    rows[kForceError][result % kLanes<Number>] += force_error;
    rows[kTorqueError][result % kLanes<Number>] += torque_error;
    rows[kVolumeError][result % kLanes<Number>] += volume_error;
  }

  // Sets the error of a result that has been replaced.
  void finish(std::size_t result) {
    const auto& rows = batches_[result / kLanes<Number>].rows;
    const std::size_t lane = result % kLanes<Number>;
    const Number error =
        std::max(rows[kForceError][lane], rows[kTorqueError][lane] * static_cast<Number>(per_lever_));
    errors_[result] = error;
    expected_[result] = error * static_cast<Number>(kErrorOfChildren);
    total_ += static_cast<double>(error);
  }

  void remove(std::size_t result) {
    total_ -= static_cast<double>(errors_[result]);
    errors_[result] = Number{0};
    expected_[result] = Number{0};
    BatchResults& batch = batches_[result / kLanes<Number>];
    batch.kept.lanes &= ~(std::uint32_t{1} << (result % kLanes<Number>));
    for (auto& row : batch.rows) row[result % kLanes<Number>] = Number{0};
  }

  // Keeps a result that cannot be refined: its error is no longer one of errors().
  void settle(std::size_t result) {
    settled_ += static_cast<double>(errors_[result]);
    errors_[result] = Number{0};
    expected_[result] = Number{0};
  }

  // Per result [m^3], the larger of the bound on the force and of that on the torque / L_r.
  std::span<const Number> errors() const { return {errors_.data(), count()}; }
  // What the errors of a patch's children, or that of the patch once it is clipped, are expected to add up
  // to.
  std::span<const Number> expected() const { return {expected_.data(), count()}; }
  double total() const { return total_; }      // of the errors, with those that are settled
  double settled() const { return settled_; }  // of those that are settled
  // The models that were kept of the patch; kNone if there are none.
  std::uint32_t cached_models(std::size_t result) const {
    const CachedOfBatch& of_batch = batches_[result / kLanes<Number>].kept;
    return (of_batch.lanes >> (result % kLanes<Number>)&1U) != 0 ? of_batch.models : kNone;
  }
  const PatchGroup& group_of(std::size_t result) const {
    return batches_[result / kLanes<Number>].groups[result % kLanes<Number> / kGroup<Number>];
  }

  WaveLoad load() const {
    const LanesOf<double> d;
    std::array<VectorOf<double>, kRows> sums;
    for (auto& of_row : sums) of_row = hn::Zero(d);
    for (std::size_t b = 0; b < batch_count_; ++b) {
      const BatchResults& batch = batches_[b];
      for (std::size_t row = 0; row < kRows; ++row) {
        for (std::size_t lane = 0; lane < kLanes<Number>; lane += kLanes<double>) {
          const Number* const numbers = &batch.rows[row][lane];
          if constexpr (sizeof(Number) == sizeof(double)) {
            sums[row] = sums[row] + hn::Load(d, numbers);
          } else {
            sums[row] = sums[row] + hn::PromoteTo(d, hn::Load(hn::Rebind<float, LanesOf<double>>(), numbers));
          }
        }
      }
    }
    std::array<double, kRows> total;
    for (std::size_t row = 0; row < kRows; ++row) total[row] = sum_of_lanes(sums[row]);
    WaveLoad load;
    const auto vector = [&](std::size_t row) { return Vec3(total[row], total[row + 1], total[row + 2]); };
    load.force = vector(kForce);
    load.torque = vector(kTorque);
    load.moment = vector(kMoment);
    load.volume = total[kVolume];
    load.force_bound = total[kForceError];
    load.torque_bound = total[kTorqueError];
    load.volume_bound = total[kVolumeError];
    return load;
  }

  // The places of what is summed up; vectors take three.
  enum Row : std::size_t {
    kForce = 0,
    kTorque = kForce + 3,
    kMoment = kTorque + 3,
    kVolume = kMoment + 3,
    kForceError,
    kTorqueError,
    kVolumeError,
    kRows
  };
  static HWY_INLINE std::array<VectorOf<Number>, kRows> rows_of(const PatchIntegrals<Number>& integrals) {
    return {integrals.force.x,     integrals.force.y,  integrals.force.z,     integrals.torque.x,
            integrals.torque.y,    integrals.torque.z, integrals.moment.x,    integrals.moment.y,
            integrals.moment.z,    integrals.volume,   integrals.force_error, integrals.torque_error,
            integrals.volume_error};
  }

 private:
  struct BatchResults {
    alignas(64) std::array<std::array<Number, kLanes<Number>>, kRows> rows;
    GroupsOfVector<Number> groups;
    CachedOfBatch kept;
  };

  std::size_t count() const { return batch_count_ * kLanes<Number>; }

  // Kept from query to query, so that nothing is set to zero before it is written.
  std::vector<BatchResults> batches_;
  std::size_t batch_count_ = 0;
  std::vector<Number> errors_, expected_;
  double per_lever_ = 1.0;
  double total_ = 0.0, settled_ = 0.0;
};

// A child's error is about the sum of its siblings' and its own over this.
inline constexpr double kChildrenAbove = 4.0;

// The sum of the errors that can be expected once all above `limit` are refined as often as needed. Where
// patches are small the error of each falls with the third to fifth power of their size, and the sum over
// them with the second or third: about as the square root of each one's. A prediction that is too low costs
// another round, of few patches; one that is too high refines all of them too far, which costs more. roots:
// of the expected errors.
template <typename Number>
HWY_INLINE double predicted(std::span<const Number> errors, std::span<const Number> expected,
                            std::span<const Number> roots, Number limit) {
  const LanesOf<Number> d;
  constexpr double kShare = 0.25;
  const VectorOf<Number> root_of_limit =
      set<Number>(kShare) * hn::Sqrt(hn::Set(d, limit) * set<Number>(kChildrenAbove));
  VectorOf<Number> sum = hn::Zero(d);
  for (std::size_t n = 0; n < errors.size(); n += kLanes<Number>) {
    const VectorOf<Number> error = hn::LoadU(d, &errors[n]);
    const VectorOf<Number> left =
        hn::Min(hn::LoadU(d, &expected[n]), hn::LoadU(d, &roots[n]) * root_of_limit);
    sum = sum + hn::IfThenElse(hn::Gt(error, hn::Set(d, limit)), left, error);
  }
  return static_cast<double>(sum_of_lanes(sum));
}

// The error above which patches are refined, so that the sum of the errors can be expected to fit the budget.
// roots: room for as many numbers.
template <typename Number>
double refinement_limit(std::span<const Number> errors, std::span<const Number> expected,
                        std::vector<Number>& roots, double budget) {
  const LanesOf<Number> d;
  if (roots.size() < errors.size()) roots.resize(errors.size());
  VectorOf<Number> most = hn::Zero(d);
  for (std::size_t n = 0; n < errors.size(); n += kLanes<Number>) {
    most = hn::Max(hn::LoadU(d, &errors[n]), most);  // `most` where an error is not a number
    hn::StoreU(hn::Sqrt(hn::LoadU(d, &expected[n])), d, &roots[n]);
  }
  const Number largest = hn::GetLane(hn::MaxOfLanes(d, most));
  Number low = static_cast<Number>(1e-12) * largest;
  Number high = static_cast<Number>(0.999) * largest;
  constexpr double kMargin = 0.95;
  for (int step = 0; step < 12; ++step) {
    const Number middle = std::sqrt(low * high);
    (predicted<Number>(errors, expected, roots, middle) <= kMargin * budget ? low : high) = middle;
  }
  return static_cast<double>(low);
}

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_LOAD_SUM_INL_H
