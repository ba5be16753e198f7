#include <string>

#include <gtest/gtest.h>

#include "base/xml_text.h"
#include "client/ping/ping_report.h"
#include "tests/ping/two_scenes.h"

namespace buoyancy::ping {
namespace {

std::int64_t occurrences(const std::string& text, const std::string& part) {
  std::int64_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(JunitReport, EscapesMarkupAndInvalidCharacters) {
  const std::string bad = "\xef\xbf\xbd";  // U+FFFD
  EXPECT_EQ(escape_xml("a<b>&\"c\"'"), "a&lt;b&gt;&amp;&quot;c&quot;'");
  EXPECT_EQ(escape_xml("line\nnext\ttab\r"), "line&#10;next&#9;tab&#13;");
  EXPECT_EQ(escape_xml("m\xc2\xb3 \xe2\x88\x92 \xf0\x9f\x9a\xa2"), "m\xc2\xb3 \xe2\x88\x92 \xf0\x9f\x9a\xa2");
  EXPECT_EQ(escape_xml(std::string_view("\0\x1b", 2)), bad + bad);
  EXPECT_EQ(escape_xml("\xff|\xc3|\xc0\xaf"), bad + "|" + bad + "|" + bad + bad);  // invalid, cut, overlong
  EXPECT_EQ(escape_xml("\xed\xa0\x80"), bad + bad + bad);                          // a surrogate
  EXPECT_EQ(escape_xml("\xef\xbf\xbf"), bad + bad + bad);                          // U+FFFF
  EXPECT_EQ(escape_xml("\xf4\x90\x80\x80"), bad + bad + bad + bad);                // beyond U+10FFFF
}

TEST(JunitReport, HasTestCasePerCheckAndBody) {
  SceneText text;
  text.outputs = kWithHydrostatics;
  const Scene scene = text.scene();
  const PingTask task{.scene = scene, .link = {}, .retry_policy = {}, .sea = {}};
  PingResult result(scene);
  result.url = "memq://";
  text.density = "1000";
  result.checks = compare_scenes(scene, text.scene());
  result.likely_causes = {"another <density>"};
  const std::string xml = to_junit(task, result);
  // Two bodies with five checks, one of them with hydrostatics.
  const auto cases = static_cast<std::int64_t>(kRunChecks.size()) + 5 + 5 + 1;
  EXPECT_EQ(occurrences(xml, "<testcase"), cases);
  EXPECT_EQ(occurrences(xml, "tests=\"" + std::to_string(cases) + "\""), 2);
  // Force and torque of both bodies, and the stiffness.
  EXPECT_EQ(occurrences(xml, "<failure"), 5) << xml;
  EXPECT_EQ(occurrences(xml, "failures=\"5\""), 2);
  EXPECT_EQ(occurrences(xml, "likely cause: another &lt;density&gt;"), 5);
  EXPECT_EQ(occurrences(xml, "<skipped"), 0);
}

TEST(JunitReport, SkipsWhatCouldNotBeChecked) {
  const Scene scene = SceneText{}.scene();
  const PingTask task{.scene = scene, .link = {}, .retry_policy = {}, .sea = {}};
  PingResult result(scene);
  result.failures.push_back({kConnectionCheck, "no route"});
  const std::string xml = to_junit(task, result);
  EXPECT_EQ(occurrences(xml, "<failure message=\"no route\""), 1);
  EXPECT_EQ(occurrences(xml, "<skipped"), static_cast<std::int64_t>(kRunChecks.size()) - 1 + 10);
}

// The percentile p is the shortest that at least the fraction p does not exceed.
TEST(RoundTrips, AreSummarizedByNearestRank) {
  std::vector<double> times;
  for (int i = 200; i >= 1; --i) times.push_back(i);
  const RoundTrips summary = summarize_round_trips(times);
  EXPECT_EQ(summary.min, 1.0);
  EXPECT_EQ(summary.median, 100.0);
  EXPECT_EQ(summary.p90, 180.0);
  EXPECT_EQ(summary.p99, 198.0);
  EXPECT_EQ(summary.max, 200.0);
  EXPECT_EQ(summarize_round_trips({3.0}).median, 3.0);
  EXPECT_EQ(summarize_round_trips({}).max, 0.0);
}

}  // namespace
}  // namespace buoyancy::ping
