#include <array>
#include <cstdint>
#include <cstdio>
#include <span>

#include "base/format.h"
#include "client/ping/ping_report.h"
#include "recording/record_writer.h"
#include "recording/staged_file.h"

namespace buoyancy::ping {
namespace {

constexpr std::string_view kReplacement = "\xef\xbf\xbd";  // U+FFFD

enum class Outcome { kPassed, kFailed, kSkipped };

struct TestCase {
  std::string suite, name;
  Outcome outcome = Outcome::kPassed;
  std::string message;
};

// Length [bytes] of the valid UTF-8 sequence that text begins with; 0: there is none, or it is a character
// that XML 1.0 does not allow.
std::size_t xml_character_size(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned first = byte(0);
  if (first < 0x80U) return first >= 0x20U || first == '\t' || first == '\n' || first == '\r' ? 1 : 0;
  const std::size_t size = first < 0xc2U ? 0 : first < 0xe0U ? 2 : first < 0xf0U ? 3 : first < 0xf5U ? 4 : 0;
  if (size == 0 || text.size() < size) return 0;
  std::uint32_t code = first & (0xffU >> (size + 1));
  for (std::size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0U) != 0x80U) return 0;
    code = (code << 6U) | (byte(i) & 0x3fU);
  }
  constexpr std::array<std::uint32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};  // by size
  const bool surrogate = code >= 0xd800U && code < 0xe000U;
  const bool not_a_character = code == 0xfffeU || code == 0xffffU;
  return code >= kSmallest[size] && code < 0x110000U && !surrogate && !not_a_character ? size : 0;
}

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

std::string escape_xml(std::string_view text) {
  std::string escaped;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = xml_character_size(text.substr(i));
    switch (text[i]) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\t':
        escaped += "&#9;";
        break;
      case '\n':
        escaped += "&#10;";
        break;
      case '\r':
        escaped += "&#13;";
        break;
      default:
        escaped += size == 0 ? kReplacement : text.substr(i, size);
    }
    i += size == 0 ? 1 : size;
  }
  return escaped;
}

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
