#include "view/report/decimated_rows.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace buoyancy::view {
namespace {

RunRow row_of(double time, double heave, double energy = kUnknown) {
  RunRow row;
  row.fill(kUnknown);
  row[kTime] = time;
  row[kHeave] = heave;
  row[kEnergy] = energy;
  return row;
}

template <typename MakeRow>
std::vector<RunRow> rows_made(int count, MakeRow make_row) {
  std::vector<RunRow> rows(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) rows[static_cast<std::size_t>(i)] = make_row(i);
  return rows;
}

DecimatedRows decimated(std::size_t max_rows, const std::vector<RunRow>& rows) {
  DecimatedRows kept(max_rows);
  for (std::size_t i = 0; i < rows.size(); ++i) kept.add(static_cast<std::int64_t>(i), rows[i]);
  return kept;
}

// NaN stands in most columns, and is itself nowhere.
bool same_numbers(const RunRow& a, const RunRow& b) {
  return std::ranges::equal(a, b,
                            [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

TEST(DecimatedRows, AreAllRowsUpToTheBound) {
  const std::vector<RunRow> rows = rows_made(100, [](int i) { return row_of(i, std::sin(i)); });
  const std::vector<RunRow> kept = decimated(100, rows).rows();
  EXPECT_TRUE(std::ranges::equal(kept, rows, same_numbers));
}

TEST(DecimatedRows, KeepAPeakThatOneRowAloneHas) {
  const std::vector<RunRow> rows = rows_made(1'000'000, [](int i) {
    return row_of(i, i == 333'333 ? 7.0 : i == 777'777 ? -9.0 : std::sin(1e-4 * i));
  });
  const DecimatedRows all = decimated(500, rows);
  const std::vector<RunRow> kept = all.rows();
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

TEST(DecimatedRows, KeepTheExtremesOfAColumnThatMostRowsDoNotKnow) {
  const std::vector<RunRow> rows = rows_made(10'000, [](int i) {
    return row_of(i, 0.0, i == 5'000 ? 1.5 : i == 6'000 ? 2.5 : kUnknown);
  });
  const std::vector<RunRow> kept = decimated(64, rows).rows();
  for (const double energy : {1.5, 2.5}) {
    EXPECT_TRUE(std::ranges::any_of(kept, [energy](const RunRow& row) { return row[kEnergy] == energy; }))
        << energy;
  }
}

RC_GTEST_PROP(DecimatedRows, AreRowsThatWereAddedInOrderWithTheExtremesOfAll, ()) {
  const auto max_rows = *rc::gen::inRange<std::size_t>(32, 400);
  const auto count = *rc::gen::inRange(1, 5'000);
  const std::vector<RunRow> rows =
      rows_made(count, [](int i) { return row_of(i, *rc::gen::inRange(-1'000, 1'000)); });
  const std::vector<RunRow> kept = decimated(max_rows, rows).rows();
  RC_ASSERT(kept.size() <= max_rows);
  RC_ASSERT(std::ranges::is_sorted(kept, {}, [](const RunRow& row) { return row[kTime]; }));
  for (const RunRow& row : kept) RC_ASSERT(same_numbers(row, rows[static_cast<std::size_t>(row[kTime])]));
  const auto heave = [](const RunRow& row) { return row[kHeave]; };
  const auto [least, most] = std::ranges::minmax(rows, {}, heave);
  const auto [kept_least, kept_most] = std::ranges::minmax(kept, {}, heave);
  RC_ASSERT(kept_least[kHeave] == least[kHeave]);
  RC_ASSERT(kept_most[kHeave] == most[kHeave]);
}

}  // namespace
}  // namespace buoyancy::view
