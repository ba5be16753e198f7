#include "waves/wave_components_csv.h"

#include <cmath>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/format.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kHeader = "amplitude,angular_frequency,direction,phase\n";

std::string error_of(const std::string& text) {
  const Expected<WaveComponents> components = parse_wave_components(text, "sea.csv");
  return components ? "accepted" : components.error().message();
}

TEST(WaveComponentsCsv, ReadsTheSameDoublesThatWereWritten) {
  const WaveComponents written{{0.1, 2.0 / 3.0, -123.456789012345678, 1e-7},
                               {0.050000000000000003, 0.58143928978123527, 30.0, 320.49330227125586},
                               {0.0, std::nextafter(1.0, 2.0), -0.0, 1e6}};
  std::string text = kHeader;
  for (const WaveComponent& component : written) {
    text += format_number(component.amplitude, 17) + "," + format_number(component.angular_frequency, 17) +
            "," + format_number(component.direction, 17) + "," + format_number(component.phase, 17) + "\n";
  }
  const Expected<WaveComponents> read = parse_wave_components(text, "sea.csv");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ((*read)[i].amplitude, written[i].amplitude) << i;
    EXPECT_EQ((*read)[i].angular_frequency, written[i].angular_frequency) << i;
    EXPECT_EQ((*read)[i].direction, written[i].direction) << i;
    EXPECT_EQ((*read)[i].phase, written[i].phase) << i;
  }
}

TEST(WaveComponentsCsv, ToleratesSpacesBlankLinesAndCrLf) {
  const Expected<WaveComponents> read = parse_wave_components(
      "\xEF\xBB\xBF amplitude, angular_frequency, direction, phase\r\n 0.5,\t+1 , 2,3 \r\n\r\n.25,4,5,6\n\n",
      "sea.csv");
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(read->size(), 2U);
  EXPECT_EQ((*read)[0].amplitude, 0.5);
  EXPECT_EQ((*read)[0].angular_frequency, 1.0);
  EXPECT_EQ((*read)[1].phase, 6.0);
  EXPECT_EQ(parse_wave_components(kHeader + "0.5,1,2,3", "sea.csv")->size(), 1U) << "no last newline";
  EXPECT_EQ(parse_wave_components(kHeader, "sea.csv")->size(), 0U);
}

TEST(WaveComponentsCsv, NamesLineAndColumnOfErrors) {
  EXPECT_EQ(error_of(kHeader + "0.5,1,2,3\n0.5,x,2,3\n"),
            "sea.csv:3, column 2: angular_frequency = 'x'; expected a number from 1e-05 to 1000 (rad/s).");
  EXPECT_EQ(error_of(kHeader + "-0.5,1,2,3\n"),
            "sea.csv:2, column 1: amplitude = '-0.5'; expected a number from 0 to 10000 (m).");
  EXPECT_THAT(error_of(kHeader + "nan,1,2,3\n"), StartsWith("sea.csv:2, column 1: amplitude = 'nan'"));
  EXPECT_THAT(error_of(kHeader + "0.5,0,2,3\n"), HasSubstr("column 2: angular_frequency = '0'"));
  EXPECT_THAT(error_of(kHeader + "0.5,1,north,3\n"), HasSubstr("column 3: direction = 'north'"));
  EXPECT_THAT(error_of(kHeader + "0.5,1,2,inf\n"), HasSubstr("column 4: phase = 'inf'"));
  EXPECT_THAT(error_of(kHeader + "0.5,1,2,\n"), HasSubstr("column 4: phase = ''"));
  EXPECT_THAT(error_of(kHeader + "0.5,1,2,3 4\n"), HasSubstr("column 4: phase = '3 4'"));
  EXPECT_THAT(error_of(kHeader + "\n\n0.5,1,2\n"), StartsWith("sea.csv:4: 3 fields; expected 4 numbers"));
  EXPECT_THAT(error_of(kHeader + "0.5,1,2,3,4\n"), StartsWith("sea.csv:2: 5 fields; expected 4 numbers"));
}

TEST(WaveComponentsCsv, RequiresTheHeader) {
  EXPECT_THAT(error_of("0.5,1,2,3\n"), StartsWith("sea.csv:1: header '0.5,1,2,3'; expected 'amplitude,"));
  EXPECT_THAT(error_of("angular_frequency,amplitude,direction,phase\n"), StartsWith("sea.csv:1: header "));
  EXPECT_THAT(error_of(""), StartsWith("sea.csv:1: header ''"));
  EXPECT_THAT(error_of("\n" + kHeader), StartsWith("sea.csv:1: header ''"));
}

TEST(WaveComponentsCsv, RemovesControlCharactersFromErrors) {
  const std::string message = error_of(kHeader + "0.5,\x1b[31m,2,3\n");
  EXPECT_THAT(message, HasSubstr("angular_frequency = '?[31m'"));
  EXPECT_THAT(error_of("\x1b[31m" + std::string(200, 'x')), HasSubstr("xxx...'"));
}

TEST(WaveComponentsCsv, BoundsTheNumberOfComponents) {
  std::string text = kHeader;
  for (std::size_t i = 0; i < kMaxWaveComponents; ++i) text += "0.5,1,2,3\n";
  EXPECT_EQ(error_of(text), "accepted");
  EXPECT_THAT(error_of(text + "0.5,1,2,3\n"),
              StartsWith("sea.csv:4098: more than 4096 components; expected at most 4096"));
}

TEST(WaveComponentsCsv, NamesUnreadableFiles) {
  const TempDir directory;
  const auto file_error = [](const std::filesystem::path& path) {
    const Expected<WaveComponents> components = read_wave_components(path);
    return components ? "accepted" : components.error().message();
  };
  const std::filesystem::path missing = directory.path() / "missing.csv";
  EXPECT_THAT(file_error(missing), StartsWith(missing.string() + ": no such file"));
  EXPECT_THAT(file_error(directory.path()), HasSubstr("is a directory"));
  EXPECT_THAT(file_error("/dev/null"), HasSubstr("is not a regular file"));
  const std::filesystem::path large = directory.write("large.csv", "");
  std::filesystem::resize_file(large, 4'000'001);
  EXPECT_THAT(file_error(large), HasSubstr("4000001 bytes"));
  const std::string wrong = directory.write("wrong.csv", kHeader + "1,2,3,x\n");
  EXPECT_THAT(file_error(wrong), StartsWith(wrong + ":2, column 4: "));
  EXPECT_EQ(file_error(directory.write("right.csv", kHeader + "1,2,3,4\n")), "accepted");
}

}  // namespace
}  // namespace buoyancy
