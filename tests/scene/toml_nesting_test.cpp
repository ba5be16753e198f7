#include "scene/toml_nesting.h"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_file.h"
#include "tests/support/contains.h"

namespace buoyancy {
namespace {

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  all.reserve(text.size() * times);
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

struct Bomb {
  std::string kind;
  std::string text;
};

// Texts that are nested `depth` levels deep, each from its second line on.
std::vector<Bomb> bombs(std::size_t depth) {
  const std::string keys = repeated("a.", depth) + "a";
  return {
      {"key", "\n" + keys + " = 1\n"},
      {"spaced quoted key", "\n" + repeated("\"a\" . ", depth) + "a = 1\n"},
      {"header", "\n[" + keys + "]\n"},
      {"header of array", "\n[[" + keys + "]]\n"},
      {"array", "\na = " + repeated("[", depth) + repeated("]", depth) + "\n"},
      {"inline table", "\na = " + repeated("{a=", depth) + "1" + repeated("}", depth) + "\n"},
      {"array of inline tables", "\na = " + repeated("[{a=", depth) + "1" + repeated("}]", depth) + "\n"},
      {"dots in inline tables", "\na = " + repeated("{a.a.a.a=", depth) + "1" + repeated("}", depth) + "\n"}};
}

TEST(TomlNesting, RefusesBombsWithTheirLine) {
  for (const std::size_t depth : {40U, 1'000U, 50'000U, 5'000'000U}) {
    for (const auto& [kind, text] : bombs(depth)) {
      if (text.size() > 60'000'000) continue;
      SCOPED_TRACE(kind + " " + std::to_string(depth));
      for (const auto& parsed : {parse_scene(text, "bomb.toml", "."), parse_water(text, "bomb.toml", ".")}) {
        ASSERT_FALSE(parsed);
        EXPECT_EQ(parsed.error().subject, "bomb.toml:2");
        EXPECT_EQ(parsed.error().actual, "more than 32 levels of tables and arrays within each other");
      }
    }
  }
}

TEST(TomlNesting, LeavesShallowTextToTheParser) {
  for (const auto& [kind, text] : bombs(5)) {
    EXPECT_FALSE(check_toml_nesting(text, "")) << kind;
    const auto parsed = parse_scene(text, "a.toml", ".");
    ASSERT_FALSE(parsed);
    EXPECT_FALSE(contains(parsed.error().actual, "levels")) << kind;
  }
}

TEST(TomlNesting, SkipsStringsAndComments) {
  const std::string deep = repeated("[", 100) + repeated(".", 100);
  for (const std::string& text :
       {"# " + deep + "\n", "a = \"" + deep + "\\\"" + deep + "\"\n", "a = '" + deep + "\\'\n",
        "a = \"\"\"\n" + deep + "\"\"" + deep + "\\\"\"\"" + deep + "\"\"\"\"\"\n",
        "a = '''" + deep + "''" + deep + "'''''\n", "a = 1 # '" + deep + "\nb = 2\n",
        "\"" + deep + "\" = 1\n"}) {
    EXPECT_FALSE(check_toml_nesting(text, "")) << text;
  }
}

TEST(TomlNesting, SeesWhatFollowsStringsAndComments) {
  const std::string deep = repeated("[", 40);
  for (const std::string before :
       {"a = \"x\\\\\"", "a = 'x\\'", "a = \"\"\"x\"\"\"\"\"", "a = ''''''", "a = \"\"", "# '"}) {
    EXPECT_TRUE(check_toml_nesting(before + "\nb = " + deep, "")) << before;
  }
}

TEST(TomlNesting, CountsOneValueAtATime) {
  std::string text = "a = [\n";
  for (int i = 0; i < 1'000; ++i) text += "  { b.c = 1.5, d.e = [1.5, 2.5] },\n";
  text += "]\n";
  for (int i = 0; i < 1'000; ++i) text += "[[body]]\nx.y = 1.5\nz = { q = 0.5 }\n";
  EXPECT_FALSE(check_toml_nesting(text, ""));
}

TEST(TomlNesting, LimitsLengthOfText) {
  const auto parsed = parse_water(std::string(64'000'001, '\n'), "long.toml", ".");
  ASSERT_FALSE(parsed);
  EXPECT_EQ(parsed.error().actual, "64000001 bytes");
}

}  // namespace
}  // namespace buoyancy
