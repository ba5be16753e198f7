#include "scene/id_index.h"

#include <algorithm>
#include <climits>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace buoyancy {
namespace {

std::optional<std::size_t> search(const std::vector<std::int32_t>& ids, std::int32_t id) {
  const auto found = std::ranges::find(ids, id);
  if (found == ids.end()) return std::nullopt;
  return static_cast<std::size_t>(found - ids.begin());
}

RC_GTEST_PROP(IdIndex, FindsSamePositionAsSearch, (std::int32_t base)) {
  // From ids one after the other to ids all over the range.
  const std::int64_t step = *rc::gen::element<std::int64_t>(1, 2, 5, 1000, INT_MAX);
  std::vector<std::int32_t> ids;
  for (const int multiple : *rc::gen::unique<std::vector<int>>(rc::gen::inRange(-20, 20))) {
    const std::int64_t id = base + step * multiple;
    ids.push_back(static_cast<std::int32_t>(id));  // wraps around, and may then occur twice
  }
  std::ranges::sort(ids);
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  if (*rc::gen::arbitrary<bool>()) std::ranges::reverse(ids);
  const IdIndex index(ids);
  std::vector<std::int32_t> wanted = ids;
  wanted.insert(wanted.end(), {base, base + (base < INT_MAX ? 1 : 0), INT_MIN, INT_MAX, 0});
  for (const std::int32_t id : wanted) {
    for (const std::size_t likely : {std::size_t{0}, ids.size() / 2, ids.size(), std::size_t{1'000'000}}) {
      RC_ASSERT(index.find(id, likely) == search(ids, id));
    }
  }
}

TEST(IdIndex, FindsNothingWithoutIds) {
  EXPECT_EQ(IdIndex().find(0), std::nullopt);
  EXPECT_EQ(IdIndex(std::vector<std::int32_t>{}).find(7), std::nullopt);
}

TEST(IdIndex, HoldsSmallestAndLargestId) {
  const IdIndex index({INT_MAX, INT_MIN});
  EXPECT_EQ(index.find(INT_MAX), 0U);
  EXPECT_EQ(index.find(INT_MIN), 1U);
  EXPECT_EQ(index.find(0), std::nullopt);
}

}  // namespace
}  // namespace buoyancy
