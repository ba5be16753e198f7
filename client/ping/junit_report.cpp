#include <array>
#include <cstdint>
#include <cstdio>
#include <span>

#include "base/format.h"
#include "base/xml_text.h"
#include "client/ping/ping_report.h"
#include "recording/record_writer.h"
#include "recording/staged_file.h"

namespace buoyancy::ping {
namespace {

enum class Outcome { kPassed, kFailed, kSkipped };

struct TestCase {
  std::string suite, name;
  Outcome outcome = Outcome::kPassed;
  std::string message;
};

std::vector<TestCase> test_cases(const PingTask& task, const PingResult& result) {
  std::vector<TestCase> cases;
  const bool connected = !result.url.empty();
  for (const char* const check : kRunChecks) {
    TestCase& now = cases.emplace_back(TestCase{"buoyancy-ping.run", check, Outcome::kPassed, ""});
    for (const RunFailure& failure : result.failures) {
      if (failure.check != check) continue;
      now.outcome = Outcome::kFailed;
      if (!now.message.empty()) now.message += "; ";
      now.message += failure.message;
    }
    const bool needs_replies = check != kConnectionCheck && check != kResponsesCheck;
    if (now.outcome == Outcome::kPassed && (!connected || (needs_replies && result.checks.replies() == 0))) {
      now.outcome = Outcome::kSkipped;
      now.message = "nothing was received";
    }
  }
  for (std::size_t i = 0; i < result.checks.bodies().size(); ++i) {
    const BodyChecks& body = result.checks.bodies()[i];
    const Body& of = task.scene.bodies()[i];
    for (const Check check : kAllChecks) {
      if ((check == Check::kHydrostatics && !of.hydrostatics) || (check == Check::kLoads && !of.loads))
        continue;
      const CheckResult& compared = body.at(check);
      TestCase now{"buoyancy-ping.body_" + std::to_string(body.body_id) + "." + body.name,
                   std::string(to_string(check)), Outcome::kPassed, ""};
      if (compared.failed > 0) {
        now.outcome = Outcome::kFailed;
        now.message = describe_check(compared);
      } else if (compared.compared == 0) {
        now.outcome = Outcome::kSkipped;
        now.message = "nothing was compared";
      }
      cases.push_back(std::move(now));
    }
  }
  return cases;
}

std::string format_seconds(double seconds) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6f", seconds);
  return text.data();
}

void append_attribute(std::string& text, std::string_view name, std::string_view value) {
  text += format_text(" {}=\"{}\"", name, escape_xml(value));
}

void append_property(std::string& text, std::string_view name, std::string_view value) {
  text += "      <property";
  append_attribute(text, "name", name);
  append_attribute(text, "value", value);
  text += "/>\n";
}

}  // namespace

std::string to_junit(const PingTask& task, const PingResult& result) {
  const std::vector<TestCase> cases = test_cases(task, result);
  std::size_t failed = 0;
  std::size_t skipped = 0;
  for (const TestCase& now : cases) {
    if (now.outcome == Outcome::kFailed) ++failed;
    if (now.outcome == Outcome::kSkipped) ++skipped;
  }
  std::string causes;
  for (const std::string& cause : result.likely_causes) causes += format_text("likely cause: {}\n", cause);
  std::string totals;
  append_attribute(totals, "name", "buoyancy-ping");
  append_attribute(totals, "tests", std::to_string(cases.size()));
  append_attribute(totals, "failures", std::to_string(failed));
  append_attribute(totals, "errors", "0");
  append_attribute(totals, "skipped", std::to_string(skipped));
  append_attribute(totals, "time", format_seconds(result.seconds));
  std::string text = format_text(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites{}>\n  <testsuite{}>\n    <properties>\n",
      totals, totals);
  append_property(text, "scene", task.scene.name());
  append_property(text, "seed", std::to_string(task.seed));
  append_property(text, "lcm_url", result.url);
  append_property(text, "requests", std::to_string(result.requests));
  append_property(text, "retries", std::to_string(result.retries));
  append_property(text, "round_trip_median_seconds",
                  format_seconds(summarize_round_trips(result.round_trips).median));
  text += "    </properties>\n";
  for (const TestCase& now : cases) {
    text += "    <testcase";
    append_attribute(text, "classname", now.suite);
    append_attribute(text, "name", now.name);
    if (now.outcome == Outcome::kPassed) {
      text += "/>\n";
      continue;
    }
    text += now.outcome == Outcome::kFailed ? ">\n      <failure" : ">\n      <skipped";
    append_attribute(text, "message", now.message);
    if (now.outcome == Outcome::kFailed && !causes.empty()) {
      text += format_text(">{}</failure>\n", escape_xml(causes));
    } else {
      text += "/>\n";
    }
    text += "    </testcase>\n";
  }
  text += "  </testsuite>\n</testsuites>\n";
  return text;
}

Expected<void> write_file(const std::filesystem::path& path, const std::string& text) {
  Expected<StagedFile> staged = StagedFile::create(path);
  if (!staged) return make_error(staged.error());
  Expected<RecordWriter> file = RecordWriter::create(*staged);
  if (!file) return make_error(file.error());
  if (Expected<void> written = file->append(text); !written) return written;
  if (Expected<void> flushed = file->flush(); !flushed) return flushed;
  return staged->commit();
}

}  // namespace buoyancy::ping
