// Bytes as a CSV file of recorded poses. Every line must turn up once: as the header, blank, as a body of a
// question, or reported; and the rows written out again, 17 digits each, must be read as the same questions.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include "recording/state_csv.h"
#include "tests/fuzz/fuzz_check.h"

namespace buoyancy {
namespace {

constexpr std::size_t kLongestLine = 4096;
constexpr std::string_view kTwistHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n";

// A file without a place on any disk, one for the whole run.
std::string path_of_file_with(std::string_view text) {
  static const int kFile = ::memfd_create("fuzz.csv", MFD_CLOEXEC);
  const auto size = static_cast<ssize_t>(text.size());
  if (kFile < 0 || ::ftruncate(kFile, 0) != 0 || ::pwrite(kFile, text.data(), text.size(), 0) != size) {
    broken_law("the target can write its own file");
  }
  return "/proc/self/fd/" + std::to_string(kFile);
}

// Lines behind the header that are not blank; the last one counts without its newline too.
std::vector<std::string_view> telling_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  bool is_header = true;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    const bool blank = line.find_first_not_of(" \t\r") == line.npos && line.size() <= kLongestLine;
    if (!is_header && !blank) lines.push_back(line);
    is_header = false;
    text.remove_prefix(std::min(text.size(), line.size() + 1));
  }
  return lines;
}

// Of a line that was read as a row.
std::int64_t utime_of(std::string_view line) {
  return std::strtoll(std::string(line.substr(0, line.find(','))).c_str(), nullptr, 10);
}

Question question_of(const RecordedEvent& recorded, std::size_t number) {
  Question question;
  law(!decode(recorded.bytes, question), "a question from CSV is a message of ours");
  law(!question.bodies.empty() && question.bodies.size() <= kMostRowsPerQuestion, "a question has bodies");
  law(question.key.utime == recorded.timestamp && question.key.session_id == 0 &&
          question.key.seq == static_cast<std::int64_t>(number) && question.lead_time == 0.0,
      "a question from CSV has its rows' utime, session 0, and counts from 0");
  return question;
}

// Walks along the lines: each is a row of the next question, or the next one reported.
std::vector<Question> read_all(StateCsvReader& reader, const std::vector<std::string_view>& lines) {
  std::vector<Question> questions;
  std::int64_t offset = 0;
  std::size_t next_line = 0;
  while (true) {
    const InputItem item = reader.next();
    law(reader.offset() >= offset && reader.offset() <= reader.size(), "reading goes forward, to the end");
    offset = reader.offset();
    if (std::holds_alternative<EndOfInput>(item)) break;
    law(next_line < lines.size(), "a file has no more rows and reports than lines");
    if (const auto* recorded = std::get_if<RecordedEvent>(&item)) {
      questions.push_back(question_of(*recorded, questions.size()));
      const Question& question = questions.back();
      law(question.bodies.size() <= lines.size() - next_line, "a file has no more rows than lines");
      for (std::size_t row = 0; row < question.bodies.size(); ++row) {
        law(utime_of(lines[next_line++]) == question.key.utime, "the rows of a question have its utime");
      }
    } else {
      law(!std::get<Damage>(item).description.empty(), "a report says what is wrong");
      ++next_line;
    }
  }
  law(offset == reader.size(), "the end is the end of the file");
  law(std::holds_alternative<EndOfInput>(reader.next()), "the end stays the end");
  law(next_line == lines.size(), "every line is a row or reported");
  return questions;
}

void append(double value, std::string& row) {
  char text[40];
  std::snprintf(text, sizeof(text), ",%.17g", value);
  row += text;
}

std::string written_again(const std::vector<Question>& questions) {
  std::string text(kTwistHeader);
  for (const Question& question : questions) {
    for (const BodyState& body : question.bodies) {
      text += std::to_string(question.key.utime) + "," + std::to_string(body.body_id);
      for (const double value : body.position) append(value, text);
      for (const double value : body.quaternion_wxyz) append(value, text);
      for (const double value : body.linear_velocity) append(value, text);
      for (const double value : body.angular_velocity) append(value, text);
      text += '\n';
    }
  }
  return text;
}

template <std::size_t kSize>
bool same(const std::array<double, kSize>& a, const std::array<double, kSize>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) {
    return std::isnan(x) ? std::isnan(y) : x == y && std::signbit(x) == std::signbit(y);
  });
}

void check_same_rows(const std::vector<Question>& first, const std::vector<Question>& second) {
  std::vector<BodyState> rows;
  for (const Question& question : first) {
    rows.insert(rows.end(), question.bodies.begin(), question.bodies.end());
  }
  std::size_t row = 0;
  for (const Question& question : second) {
    law(question.bodies.size() <= rows.size() - row, "what we write has no more rows");
    for (const BodyState& again : question.bodies) {
      const BodyState& body = rows[row++];
      law(body.body_id == again.body_id && same(body.position, again.position) &&
              same(body.quaternion_wxyz, again.quaternion_wxyz) &&
              same(body.linear_velocity, again.linear_velocity) &&
              same(body.angular_velocity, again.angular_velocity),
          "a row written again is read as the same row");
    }
  }
  law(row == rows.size(), "what we write is read whole");
}

void check(std::string_view text) {
  Expected<StateCsvReader> reader = StateCsvReader::open(path_of_file_with(text));
  if (!reader) {
    law(reader.error().message().find('\n') == std::string::npos, "an error is one line");
    return;
  }
  const std::vector<Question> questions = read_all(*reader, telling_lines(text));

  const std::string again = written_again(questions);
  Expected<StateCsvReader> second = StateCsvReader::open(path_of_file_with(again));
  law(second.has_value(), "what we write has our header");
  check_same_rows(questions, read_all(*second, telling_lines(again)));
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check({reinterpret_cast<const char*>(data), size});
  return 0;
}
