// The results of a descent, and where they came from. Included once per instruction set.
#if defined(BUOYANCY_WAVE_RESULTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BUOYANCY_WAVE_RESULTS_INL_H
#undef BUOYANCY_WAVE_RESULTS_INL_H
#else
#define BUOYANCY_WAVE_RESULTS_INL_H
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <hwy/highway.h>

#include "wave_loads/wave_integrals-inl.h"
#include "wave_loads/wave_lanes-inl.h"
#include "wave_loads/wave_load.h"

HWY_BEFORE_NAMESPACE();
namespace buoyancy {
namespace HWY_NAMESPACE {

inline constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// What is evaluated together: kUnit patches of a block of the tree, or as many pieces of triangles.
struct Unit {
  std::uint32_t block = 0;  // of the tree, or of the pieces
  std::uint32_t first = 0;  // lane of the block
  bool of_pieces = false;
  std::uint32_t surface_cell = 0, volume_cell = 0;
  std::uint32_t next = kNone;  // in the same cell
};

template <typename Number>
using UnitsOfVector = std::array<Unit, kUnitsPerVector<Number>>;

// The integrals of all patches so far, batch by batch, and the bounds on their errors. Results are numbered
// by their lanes.
template <typename Number>
class Results {
 public:
  void clear() {
    batches_.clear();
    units_.clear();
    errors_.clear();
    finished_ = 0;
    total_ = 0.0;
  }

  // Returns the number of the first result. The first `count` units are in use.
  std::size_t add(const UnitsOfVector<Number>& units, const PatchIntegrals<Number>& integrals) {
    const LanesOf<Number> d;
    batches_.emplace_back();
    auto& rows = batches_.back().rows;
    const std::array<VectorOf<Number>, kRows> all{
        integrals.force.x,  integrals.force.y,  integrals.force.z,     integrals.torque.x,
        integrals.torque.y, integrals.torque.z, integrals.moment.x,    integrals.moment.y,
        integrals.moment.z, integrals.volume,   integrals.force_error, integrals.torque_error};
    for (std::size_t row = 0; row < kRows; ++row) hn::Store(all[row], d, rows[row].data());
    units_.insert(units_.end(), units.begin(), units.end());
    return (batches_.size() - 1) * kLanes<Number>;
  }

  // Adds kRows numbers to a result, in the order of add().
  void add_to(std::size_t result, const Number* numbers, std::size_t stride) {
    auto& rows = batches_[result / kLanes<Number>].rows;
    for (std::size_t row = 0; row < kRows; ++row) rows[row][result % kLanes<Number>] += numbers[row * stride];
  }

  // Sets the errors of the results that were added since the last call.
  void finish_round(double max_lever) {
    const LanesOf<Number> d;
    errors_.resize(batches_.size() * kLanes<Number>);
    const VectorOf<Number> per_lever = set<Number>(1.0 / max_lever);
    for (; finished_ < batches_.size(); ++finished_) {
      const auto& rows = batches_[finished_].rows;
      const VectorOf<Number> error =
          hn::Max(hn::Load(d, rows[kForceError].data()), per_lever * hn::Load(d, rows[kTorqueError].data()));
      hn::StoreU(error, d, &errors_[finished_ * kLanes<Number>]);
      for (std::size_t lane = 0; lane < kLanes<Number>; ++lane) {
        total_ += static_cast<double>(errors_[finished_ * kLanes<Number> + lane]);
      }
    }
  }

  void remove(std::size_t result) {
    total_ -= static_cast<double>(errors_[result]);
    errors_[result] = Number{0};
    for (auto& row : batches_[result / kLanes<Number>].rows) row[result % kLanes<Number>] = Number{0};
  }

  // Per result [m^3], the larger of the bound on the force and of that on the torque / L_r.
  const std::vector<Number>& errors() const { return errors_; }
  double total() const { return total_; }
  const Unit& unit_of(std::size_t result) const { return units_[result / kUnit<Number>]; }

  WaveLoad sum() const {
    const LanesOf<double> d;
    std::array<VectorOf<double>, kRows> sums;
    for (auto& of_row : sums) of_row = hn::Zero(d);
    for (const BatchRows& batch : batches_) {
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
    return load;
  }

  static constexpr std::size_t kRows = 12;

 private:
  static constexpr std::size_t kForceError = 10;
  static constexpr std::size_t kTorqueError = 11;
  struct BatchRows {
    alignas(64) std::array<std::array<Number, kLanes<Number>>, kRows> rows;
  };
  std::vector<BatchRows> batches_;
  std::vector<Unit> units_;  // kUnitsPerVector of each batch
  std::vector<Number> errors_;
  std::size_t finished_ = 0;  // batches with errors
  double total_ = 0.0;        // of the errors
};

}  // namespace HWY_NAMESPACE
}  // namespace buoyancy
HWY_AFTER_NAMESPACE();

#endif  // BUOYANCY_WAVE_RESULTS_INL_H
