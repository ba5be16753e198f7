#include "base/spelling_suggestion.h"

#include <algorithm>
#include <array>
#include <string>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace buoyancy {
namespace {

TEST(EditDistance, CountsInsertionsDeletionsReplacementsSwaps) {
  EXPECT_EQ(edit_distance("mass", "mass"), 0U);
  EXPECT_EQ(edit_distance("mas", "mass"), 1U);
  EXPECT_EQ(edit_distance("masss", "mass"), 1U);
  EXPECT_EQ(edit_distance("mass", "mess"), 1U);
  EXPECT_EQ(edit_distance("amss", "mass"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "mass"), 4U);
}

TEST(NearestWord, ReturnsIntendedKey) {
  constexpr std::array<std::string_view, 4> kKeys{"mesh", "mass", "method", "density"};
  EXPECT_EQ(nearest_word("desnity", kKeys), "density");
  EXPECT_EQ(nearest_word("metod", kKeys), "method");
  EXPECT_EQ(nearest_word("Mass", kKeys), "mass");
}

TEST(NearestWord, ReturnsFirstOfATie) {
  constexpr std::array<std::string_view, 2> kKeys{"ab", "ac"};
  EXPECT_EQ(nearest_word("ad", kKeys), "ab");
}

std::string random_word() {
  return *rc::gen::container<std::string>(rc::gen::element('a', 'b', 'c'));
}

RC_GTEST_PROP(EditDistance, IsSymmetricAndBounded, ()) {
  const std::string a = random_word();
  const std::string b = random_word();
  const std::size_t distance = edit_distance(a, b);
  RC_ASSERT(distance == edit_distance(b, a));
  RC_ASSERT(distance <= std::max(a.size(), b.size()));
  RC_ASSERT(distance >= std::max(a.size(), b.size()) - std::min(a.size(), b.size()));
  RC_ASSERT((distance == 0) == (a == b));
}

RC_GTEST_PROP(EditDistance, EqualsNumberOfInsertions, ()) {
  const std::string word = random_word();
  std::string edited = word;
  const auto edits = *rc::gen::inRange<std::size_t>(0, 4);
  for (std::size_t i = 0; i < edits; ++i) {
    edited.insert(edited.begin() + *rc::gen::inRange<int>(0, static_cast<int>(edited.size()) + 1), 'x');
  }
  RC_ASSERT(edit_distance(word, edited) == edits);
}

}  // namespace
}  // namespace buoyancy
