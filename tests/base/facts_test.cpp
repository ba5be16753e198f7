#include "base/facts.h"

#include <limits>
#include <optional>
#include <utility>

#include <gtest/gtest.h>

namespace buoyancy {
namespace {

TEST(Facts, BecomeMembersAndWords) {
  Facts facts;
  facts.line("tank").say("'{}'", "ballast");
  facts.add("volume", 1.5, "{:6} m^3").add("mesh", 0).add("fill", 0.25, "fill {:6}");
  EXPECT_EQ(json_line(facts.json()), R"({"volume":1.5,"mesh":0,"fill":0.25})");
  EXPECT_EQ(facts.text(), "  tank          'ballast', 1.5 m^3, fill 0.25");
}

TEST(Facts, SayWhereALabelEndsAndALineContinues) {
  Facts facts;
  facts.heading("body {}", 4).line("explicit step limit").say("a").line("").say("b");
  EXPECT_EQ(facts.text(), "body 4\n  explicit step limit a\n                b");
}

TEST(Facts, SeparateWordsUnlessTheyContinue) {
  Facts facts;
  facts.line("x").say("a").say(" (b)").say("c").say("; d").say(": e").say_if(false, "f");
  EXPECT_EQ(facts.text(), "  x             a (b), c; d: e");
}

TEST(Facts, SayNothingOfWhatIsMissingOrFalse) {
  Facts facts;
  facts.add("draft", std::optional<double>(), "{} m").add("mass", std::optional(2.0), "{} kg");
  facts.add_flag("open", false, "open").add_flag("cavity", true, "a cavity").add("quiet", 1, "");
  EXPECT_EQ(json_line(facts.json()), R"({"draft":null,"mass":2.0,"open":false,"cavity":true,"quiet":1})");
  EXPECT_EQ(facts.text(), "2 kg, a cavity");
}

TEST(Facts, IncludeOtherFacts) {
  Facts one;
  one.line("heave").add("period", 2.0, "period {} s");
  Facts facts;
  facts.heading("body").list("holes");
  facts.include("heave", one);
  facts.include_in("holes", std::move(one)).update(Facts().add("turned", true));
  EXPECT_EQ(json_line(facts.json()), R"({"holes":[{"period":2.0}],"heave":{"period":2.0},"turned":true})");
  EXPECT_EQ(facts.text(), "body\n  heave         period 2 s\n  heave         period 2 s");
}

TEST(Json, HoldsVectorsOrientationsAndMissingValues) {
  const Json json{{"v", Vec3(1.0, 2.0, std::numeric_limits<double>::infinity())},
                  {"q", Eigen::Quaterniond(1.0, 0.0, 0.5, 0.25)},
                  {"none", std::optional<Vec3>()},
                  {"text", "\xff"}};
  EXPECT_EQ(json_line(json),
            "{\"v\":[1.0,2.0,null],\"q\":[1.0,0.0,0.5,0.25],\"none\":null,\"text\":\"\xef\xbf\xbd\"}");
  EXPECT_EQ(json_lines(Json{{"a", 1}}), "{\n  \"a\": 1\n}\n");
}

}  // namespace
}  // namespace buoyancy
