#include "view/report/decimated_rows.h"

#include <algorithm>
#include <cmath>

namespace buoyancy {
namespace {

constexpr std::size_t kMinRows = 32;

}  // namespace

DecimatedRows::DecimatedRows(std::size_t max_rows)
    : max_rows_(std::max(max_rows, kMinRows)), max_cuts_((max_rows_ - 1) / kKeptOfCut / 2 * 2) {}

DecimatedRows::Cut DecimatedRows::cut_of(const Numbered& row) {
  Cut cut;
  cut.fill(row);
  return cut;
}

void DecimatedRows::join(Cut& cut, const Cut& other) {
  for (std::size_t i = 0; i < kExtremaColumns.size(); ++i) {
    const Column column = kExtremaColumns[i];
    Numbered& least = cut[1 + 2 * i];
    Numbered& largest = cut[2 + 2 * i];
    const Numbered& other_least = other[1 + 2 * i];
    const Numbered& other_largest = other[2 + 2 * i];
    // A NaN is passed over and gives way to any number.
    if (other_least.row[column] < least.row[column] || std::isnan(least.row[column])) least = other_least;
    if (other_largest.row[column] > largest.row[column] || std::isnan(largest.row[column]))
      largest = other_largest;
  }
}

void DecimatedRows::add(std::int64_t number, const Row& row) {
  last_ = {number, row};
  ++added_;
  if (!cuts_.empty()) {
    add_to_cuts(last_);
    return;
  }
  all_.push_back(last_);
  if (all_.size() <= max_rows_) return;
  rows_of_cut_ = static_cast<std::int64_t>((all_.size() + max_cuts_ - 1) / max_cuts_);
  rows_in_last_cut_ = rows_of_cut_;
  for (const Numbered& kept : all_) add_to_cuts(kept);
  all_ = {};
}

void DecimatedRows::add_to_cuts(const Numbered& row) {
  if (rows_in_last_cut_ < rows_of_cut_) {
    join(cuts_.back(), cut_of(row));
    ++rows_in_last_cut_;
    return;
  }
  if (cuts_.size() == max_cuts_) {
    for (std::size_t i = 0; i < max_cuts_ / 2; ++i) {
      Cut joined = cuts_[2 * i];
      join(joined, cuts_[2 * i + 1]);
      cuts_[i] = joined;
    }
    cuts_.resize(max_cuts_ / 2);
    rows_of_cut_ *= 2;
  }
  cuts_.push_back(cut_of(row));
  rows_in_last_cut_ = 1;
}

std::vector<Row> DecimatedRows::rows() const {
  std::vector<Numbered> kept = all_;
  for (const Cut& cut : cuts_) kept.insert(kept.end(), cut.begin(), cut.end());
  if (!cuts_.empty()) kept.push_back(last_);
  std::ranges::sort(kept, {}, &Numbered::number);
  const auto same_row = [](const Numbered& a, const Numbered& b) { return a.number == b.number; };
  kept.erase(std::unique(kept.begin(), kept.end(), same_row), kept.end());
  std::vector<Row> rows;
  rows.reserve(kept.size());
  for (const Numbered& numbered : kept) rows.push_back(numbered.row);
  return rows;
}

}  // namespace buoyancy
