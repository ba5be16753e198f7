// The results of a descent, and where they came from. Included once per instruction set.
#if defined(BUOYANCY_WAVE_RESULTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_RESULTS_INL_H
#undef BUOYANCY_WAVE_RESULTS_INL_H
#else
#define BUOYANCY_WAVE_RESULTS_INL_H
#endif

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_load.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

// The errors of a patch's children together, and the error of a patch once it is clipped, over its own error:
// typical values of small patches.
inline constexpr double kErrorOfChildren = 0.15;
inline constexpr double kErrorOfClipping = 0.02;

// What is evaluated together: kUnit patches of a block of the tree.
struct Unit {
  std::uint32_t block = 0;
  std::uint32_t first = 0;  // lane of the block
  bool dry = false;         // all of its patches are
  std::uint32_t surface_cell = 0, volume_cell = 0;
  std::uint32_t next = kNone;  // in the same cell
};

template <typename Number>
using UnitsOfVector = std::array<Unit, kUnitsPerVector<Number>>;

// The patches of a batch whose models are kept.
struct KeptOfBatch {
  std::uint32_t lanes = 0;   // bits
  std::uint32_t leaves = 0;  // those of them whose triangles can be clipped
  std::uint32_t models = kNone;
};

// The integrals of all patches so far, batch by batch, and the bounds on their errors. Results are numbered
// by their lanes.
template <typename Number>
class Results {
 public:
  // max_lever: [m], L_r.
  void start(double max_lever) {
    per_lever_ = 1.0 / max_lever;
    batch_count_ = 0;
    total_ = settled_ = 0.0;
  }

  // Returns the number of the first result.
  std::size_t add(const UnitsOfVector<Number>& units, const PatchIntegrals<Number>& integrals,
                  const KeptOfBatch& kept) {
    const LanesOf<Number> d;
    const std::size_t first = batch_count_ * kLanes<Number>;
    if (batch_count_ == batches_.size()) {
      batches_.emplace_back();
      errors_.resize(first + kLanes<Number>);
      expected_.resize(first + kLanes<Number>);
    }
    BatchResults& batch = batches_[batch_count_++];
    batch.units = units;
    batch.kept = kept;
    std::size_t row = 0;
    const auto put = [&](const auto&... numbers)
                         HWY_ATTR { (hn::Store(numbers, d, batch.rows[row++].data()), ...); };
    put(integrals.force.x, integrals.force.y, integrals.force.z);
    put(integrals.torque.x, integrals.torque.y, integrals.torque.z);
    put(integrals.moment.x, integrals.moment.y, integrals.moment.z);
    put(integrals.volume, integrals.force_error, integrals.torque_error, integrals.volume_error);
    const VectorOf<Number> error =
        hn::Max(integrals.force_error, set<Number>(per_lever_) * integrals.torque_error);
    // As much less than the error as the force's is.
    const VectorOf<Number> share = integrals.expected / hn::Max(integrals.force_error, set<Number>(1e-30));
    hn::StoreU(error, d, &errors_[first]);
    hn::StoreU(error * share, d, &expected_[first]);
    total_ += static_cast<double>(hn::GetLane(hn::SumOfLanes(d, error)));
    for (std::uint32_t lanes = kept.leaves; lanes != 0; lanes &= lanes - 1) {
      const auto n = first + static_cast<std::size_t>(std::countr_zero(lanes));
      expected_[n] = errors_[n] * static_cast<Number>(kErrorOfClipping);
    }
    return first;
  }

  // Adds kRows numbers to a result, in the order of add().
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
  std::uint32_t kept_models(std::size_t result) const {
    const KeptOfBatch& of_batch = batches_[result / kLanes<Number>].kept;
    return (of_batch.lanes >> (result % kLanes<Number>)&1U) != 0 ? of_batch.models : kNone;
  }
  const Unit& unit_of(std::size_t result) const {
    return batches_[result / kLanes<Number>].units[result % kLanes<Number> / kUnit<Number>];
  }

  WaveLoad sum() const {
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
    for (std::size_t row = 0; row < kRows; ++row) total[row] = hn::GetLane(hn::SumOfLanes(d, sums[row]));
    WaveLoad load;
    load.force = {total[0], total[1], total[2]};
    load.torque = {total[3], total[4], total[5]};
    load.moment = {total[6], total[7], total[8]};
    load.volume = total[9];
    load.force_bound = total[kForceError];
    load.torque_bound = total[kTorqueError];
    load.volume_bound = total[kVolumeError];
    return load;
  }

  static constexpr std::size_t kRows = 13;

 private:
  static constexpr std::size_t kForceError = 10;
  static constexpr std::size_t kTorqueError = 11;
  static constexpr std::size_t kVolumeError = 12;
  struct BatchResults {
    alignas(64) std::array<std::array<Number, kLanes<Number>>, kRows> rows;
    UnitsOfVector<Number> units;
    KeptOfBatch kept;
  };

  std::size_t count() const { return batch_count_ * kLanes<Number>; }

  // Kept from query to query, so that nothing is set to zero before it is written.
  std::vector<BatchResults> batches_;
  std::size_t batch_count_ = 0;
  std::vector<Number> errors_, expected_;
  double per_lever_ = 1.0;
  double total_ = 0.0, settled_ = 0.0;
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_RESULTS_INL_H
