// Rows of a run of any length in bounded memory, with the extremes kept.
//
// Up to the bound all rows are kept. Beyond it time is cut into equal numbers of rows, and of each cut the
// first row is kept and, for every watched column, those with its least and its largest number; the very last
// row as well. So what is left is a subset of the rows as they were, and no peak of a watched column is lost,
// however short. When the cuts become too many, neighbours are joined, two and two.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "view/report/run.h"

namespace buoyancy {

inline constexpr std::array kExtremaColumns{kHeave, kRoll, kPitch, kForce, kTorque, kEnergy, kRoundTrip};

class DecimatedRows {
 public:
  // At most so many rows are left, and no fewer than 32 where there are as many. Memory: twice that.
  explicit DecimatedRows(std::size_t max_rows);

  // number: place among all rows; rows may come a little out of that order.
  void add(std::int64_t number, const Row& row);

  std::vector<Row> rows() const;  // in order of their numbers
  std::int64_t added() const { return added_; }

 private:
  struct Numbered {
    std::int64_t number = 0;
    Row row{};
  };
  // The first row and two of each watched column, least and largest; index 0 is the first.
  static constexpr std::size_t kKeptOfCut = 1 + 2 * kExtremaColumns.size();
  using Cut = std::array<Numbered, kKeptOfCut>;

  static Cut cut_of(const Numbered& row);
  static void join(Cut& cut, const Cut& other);
  void add_to_cuts(const Numbered& row);

  std::size_t max_rows_;
  std::size_t max_cuts_;       // even
  std::vector<Numbered> all_;  // while they are few
  std::vector<Cut> cuts_;      // then
  std::int64_t rows_of_cut_ = 0;
  std::int64_t rows_in_last_cut_ = 0;
  std::int64_t added_ = 0;
  Numbered last_;
};

}  // namespace buoyancy
