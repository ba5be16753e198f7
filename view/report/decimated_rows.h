// Decimates the rows of a run of any length to bounded memory and keeps the extremes.
//
// Up to max_rows all rows are kept. Beyond that, the rows are divided into bins of equally many. Of each bin
// the first row is kept and, for every column of kExtremaColumns, the rows with its minimum and its maximum;
// the very last row is kept as well. The result is therefore a subset of the original rows, and no peak of
// these columns is lost, however short. When there are too many bins, adjacent pairs are merged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "view/report/run.h"

namespace buoyancy::view {

inline constexpr std::array kExtremaColumns{kHeave, kRoll, kPitch, kForce, kTorque, kEnergy, kRoundTrip};

struct KeptRow {
  std::int64_t number = 0;  // the position among all rows
  RunRow values{};
  std::shared_ptr<RowLoads> loads;  // nullptr: the body has none
  // nullptr: the body has neither compartments nor tanks, or their condition is unknown.
  std::shared_ptr<const BodyCondition> condition = nullptr;
};

class DecimatedRows {
 public:
  // Keeps at most max(max_rows, 32) rows; uses memory for up to twice as many.
  explicit DecimatedRows(std::size_t max_rows);

  // Rows may arrive slightly out of order of their numbers.
  void add(KeptRow row);

  std::vector<KeptRow> rows() const;  // in order of their numbers
  std::int64_t added() const { return added_; }

 private:
  // The first row, then the rows with the minimum and the maximum of each column of kExtremaColumns.
  static constexpr std::size_t kRowsPerBin = 1 + 2 * kExtremaColumns.size();
  using Bin = std::array<KeptRow, kRowsPerBin>;

  static Bin make_bin(const KeptRow& row);
  static void merge(Bin& bin, const Bin& other);
  void add_to_bins(const KeptRow& row);

  std::size_t max_rows_;
  std::size_t max_bins_;       // even
  std::vector<KeptRow> all_;   // all rows, up to max_rows_
  std::vector<Bin> bins_;      // afterwards
  std::int64_t bin_size_ = 0;  // rows per bin
  std::int64_t last_bin_size_ = 0;
  std::int64_t added_ = 0;
  KeptRow last_;
};

}  // namespace buoyancy::view
