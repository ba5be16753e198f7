#include "view/report/decimated_rows.h"

#include <algorithm>
#include <cmath>

namespace buoyancy::view {
namespace {

constexpr std::size_t kMinRows = 32;

}  // namespace

DecimatedRows::DecimatedRows(std::size_t max_rows)
    : max_rows_(std::max(max_rows, kMinRows)), max_bins_((max_rows_ - 1) / kRowsPerBin / 2 * 2) {}

DecimatedRows::Bin DecimatedRows::make_bin(const KeptRow& row) {
  Bin bin;
  bin.fill(row);
  return bin;
}

void DecimatedRows::merge(Bin& bin, const Bin& other) {
  for (std::size_t i = 0; i < kExtremaColumns.size(); ++i) {
    const RunColumn column = kExtremaColumns[i];
    KeptRow& min = bin[1 + 2 * i];
    KeptRow& max = bin[2 + 2 * i];
    const KeptRow& other_min = other[1 + 2 * i];
    const KeptRow& other_max = other[2 + 2 * i];
    // Any number replaces a NaN, and a NaN replaces nothing but a NaN.
    if (other_min.values[column] < min.values[column] || std::isnan(min.values[column])) min = other_min;
    if (other_max.values[column] > max.values[column] || std::isnan(max.values[column])) max = other_max;
  }
}

void DecimatedRows::add(KeptRow row) {
  last_ = std::move(row);
  ++added_;
  if (!bins_.empty()) {
    add_to_bins(last_);
    return;
  }
  all_.push_back(last_);
  if (all_.size() <= max_rows_) return;
  bin_size_ = static_cast<std::int64_t>((all_.size() + max_bins_ - 1) / max_bins_);
  last_bin_size_ = bin_size_;
  for (const KeptRow& kept : all_) add_to_bins(kept);
  all_ = {};
}

void DecimatedRows::add_to_bins(const KeptRow& row) {
  if (last_bin_size_ < bin_size_) {
    merge(bins_.back(), make_bin(row));
    ++last_bin_size_;
    return;
  }
  if (bins_.size() == max_bins_) {
    for (std::size_t i = 0; i < max_bins_ / 2; ++i) {
      Bin merged = bins_[2 * i];
      merge(merged, bins_[2 * i + 1]);
      bins_[i] = merged;
    }
    bins_.resize(max_bins_ / 2);
    bin_size_ *= 2;
  }
  bins_.push_back(make_bin(row));
  last_bin_size_ = 1;
}

std::vector<KeptRow> DecimatedRows::rows() const {
  std::vector<KeptRow> kept = all_;
  for (const Bin& bin : bins_) kept.insert(kept.end(), bin.begin(), bin.end());
  if (!bins_.empty()) kept.push_back(last_);
  std::ranges::sort(kept, {}, &KeptRow::number);
  const auto same_row = [](const KeptRow& a, const KeptRow& b) { return a.number == b.number; };
  kept.erase(std::unique(kept.begin(), kept.end(), same_row), kept.end());
  return kept;
}

}  // namespace buoyancy::view
