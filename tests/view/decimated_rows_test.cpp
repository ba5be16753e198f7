#include "view/report/decimated_rows.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace buoyancy::view {
namespace {

RunRow make_row(double time, double heave, double energy = kUnknown) {
  RunRow row;
  row.fill(kUnknown);
  row[kTime] = time;
  row[kHeave] = heave;
  row[kEnergy] = energy;
  return row;
}

template <typename RowAt>
std::vector<RunRow> make_rows(int count, RowAt row_at) {
  std::vector<RunRow> rows(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) rows[static_cast<std::size_t>(i)] = row_at(i);
  return rows;
}

DecimatedRows decimate(std::size_t max_rows, const std::vector<RunRow>& rows) {
  DecimatedRows kept(max_rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    kept.add({.number = static_cast<std::int64_t>(i), .values = rows[i], .loads = nullptr});
  }
  return kept;
}

std::vector<RunRow> rows_of(const DecimatedRows& decimated) {
  std::vector<RunRow> rows;
  for (const KeptRow& kept : decimated.rows()) rows.push_back(kept.values);
  return rows;
}

// Equality that treats NaN, the value of most columns, as equal to itself.
bool same_numbers(const RunRow& a, const RunRow& b) {
  return std::ranges::equal(a, b,
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

TEST(DecimatedRows, KeepsAllRowsUpToLimit) {
  const std::vector<RunRow> rows = make_rows(100, [](int i) { return make_row(i, std::sin(i)); });
  const std::vector<RunRow> kept = rows_of(decimate(100, rows));
  EXPECT_TRUE(std::ranges::equal(kept, rows, same_numbers));
}

TEST(DecimatedRows, KeepsPeakOfSingleRow) {
  const std::vector<RunRow> rows = make_rows(1'000'000, [](int i) {
    return make_row(i, i == 333'333 ? 7.0 : i == 777'777 ? -9.0 : std::sin(1e-4 * i));
  });
  const DecimatedRows all = decimate(500, rows);
  const std::vector<RunRow> kept = rows_of(all);
  EXPECT_EQ(all.added(), 1'000'000);
  EXPECT_LE(kept.size(), 500);
  EXPECT_GE(kept.size(), 30);
  const auto has = [&kept](double time, double heave) {
    return std::ranges::any_of(kept,
                               [&](const RunRow& row) { return row[kTime] == time && row[kHeave] == heave; });
  };
  EXPECT_TRUE(has(333'333, 7.0));
  EXPECT_TRUE(has(777'777, -9.0));
  EXPECT_TRUE(has(0, 0.0)) << "the first row";
  EXPECT_TRUE(has(999'999, std::sin(1e-4 * 999'999))) << "the last row";
}

TEST(DecimatedRows, KeepsExtremesOfMostlyUnknownColumn) {
  const std::vector<RunRow> rows = make_rows(10'000, [](int i) {
    return make_row(i, 0.0, i == 5'000 ? 1.5 : i == 6'000 ? 2.5 : kUnknown);
  });
  const std::vector<RunRow> kept = rows_of(decimate(64, rows));
  for (const double energy : {1.5, 2.5}) {
    EXPECT_TRUE(std::ranges::any_of(kept, [energy](const RunRow& row) { return row[kEnergy] == energy; }))
        << energy;
  }
}

RC_GTEST_PROP(DecimatedRows, KeepsOrderedSubsetWithExtremes, ()) {
  const auto max_rows = *rc::gen::inRange<std::size_t>(32, 400);
  const auto count = *rc::gen::inRange(1, 5'000);
  const std::vector<RunRow> rows =
      make_rows(count, [](int i) { return make_row(i, *rc::gen::inRange(-1'000, 1'000)); });
  const std::vector<RunRow> kept = rows_of(decimate(max_rows, rows));
  RC_ASSERT(kept.size() <= max_rows);
  RC_ASSERT(std::ranges::is_sorted(kept, {}, [](const RunRow& row) { return row[kTime]; }));
  for (const RunRow& row : kept) RC_ASSERT(same_numbers(row, rows[static_cast<std::size_t>(row[kTime])]));
  const auto heave = [](const RunRow& row) { return row[kHeave]; };
  const auto [min, max] = std::ranges::minmax(rows, {}, heave);
  const auto [kept_min, kept_max] = std::ranges::minmax(kept, {}, heave);
  RC_ASSERT(kept_min[kHeave] == min[kHeave]);
  RC_ASSERT(kept_max[kHeave] == max[kHeave]);
}

}  // namespace
}  // namespace buoyancy::view
