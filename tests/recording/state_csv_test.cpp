#include "recording/state_csv.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/support/byte_vector.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";

struct CsvContents {
  std::vector<WrenchRequest> requests;
  std::vector<std::string> corrupt_sections;
};

CsvContents read_all(const std::string& contents) {
  const TempDir directory;
  auto reader = StateCsvReader::open(directory.write("x.csv", contents));
  if (!reader) throw std::runtime_error(reader.error().message());
  CsvContents read;
  while (true) {
    const LogItem item = reader->next();
    if (std::holds_alternative<EndOfLog>(item)) break;
    if (const auto* corrupt = std::get_if<CorruptSection>(&item)) {
      read.corrupt_sections.push_back(corrupt->description);
    } else {
      const auto& recorded = std::get<RecordedEvent>(item);
      const auto request = decoded<WrenchRequest>(recorded.bytes);
      EXPECT_EQ(recorded.timestamp, request.id.utime);
      read.requests.push_back(request);
    }
  }
  EXPECT_EQ(reader->offset(), reader->size());
  return read;
}

std::string open_error(const std::string& contents) {
  const TempDir directory;
  const auto reader = StateCsvReader::open(directory.write("x.csv", contents));
  return reader ? "" : reader.error().message();
}

TEST(StateCsv, ParsesEveryColumnExactly) {
  const CsvContents read = read_all(
      "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n"
      "-9223372036854775808,-2147483648,0.1,-2e-308,3,0.5,+.5,-0.5,5e-1,1,2,3,4,5,1.7976931348623157e308\n");
  ASSERT_EQ(read.requests.size(), 1U);
  const WrenchRequest& request = read.requests[0];
  EXPECT_EQ(request.id.utime, INT64_MIN);
  EXPECT_EQ(request.lead_time, 0.0);
  ASSERT_EQ(request.bodies.size(), 1U);
  const BodyState& state = request.bodies[0];
  EXPECT_EQ(state.body_id, INT32_MIN);
  EXPECT_EQ(state.position, (std::array{0.1, -2e-308, 3.0}));
  EXPECT_EQ(state.quaternion_wxyz, (std::array{0.5, 0.5, -0.5, 0.5}));
  EXPECT_EQ(state.linear_velocity, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(state.angular_velocity, (std::array{4.0, 5.0, 1.7976931348623157e308}));
}

TEST(StateCsv, GroupsRowsWithEqualUtimeIntoOneRequest) {
  const CsvContents read = read_all(kHeader +
                                    "10,1,0,0,0,1,0,0,0\n"
                                    "10,2,0,0,0,1,0,0,0\n"
                                    "20,1,0,0,0,1,0,0,0\n"
                                    "10,1,0,0,0,1,0,0,0\n");
  ASSERT_EQ(read.requests.size(), 3U);
  EXPECT_EQ(read.requests[0].bodies.size(), 2U);
  EXPECT_EQ(read.requests[1].bodies.size(), 1U);
  EXPECT_EQ(read.requests[2].id.utime, 10);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(read.requests[i].id.seq, static_cast<std::int64_t>(i));
}

TEST(StateCsv, LimitsRowsPerRequest) {
  std::string contents = kHeader;
  for (std::size_t i = 0; i < 2 * kMaxRowsPerRequest; ++i) contents += "1,1,0,0,0,1,0,0,0\n";
  for (std::size_t rest = 0; rest < 2; ++rest) {
    const CsvContents read = read_all(contents);
    ASSERT_EQ(read.requests.size(), 2 + rest);
    EXPECT_EQ(read.requests[0].bodies.size(), kMaxRowsPerRequest);
    EXPECT_EQ(read.requests[1].bodies.size(), kMaxRowsPerRequest);
    EXPECT_EQ(read.requests.back().bodies.size(), rest == 0 ? kMaxRowsPerRequest : 1U);
    contents += "1,1,0,0,0,1,0,0,0\n";
  }
}

TEST(StateCsv, AcceptsNanAndInfinity) {
  const CsvContents read = read_all(kHeader + "1,1,nan,inf,-inf,1,0,0,0\n");
  ASSERT_EQ(read.requests.size(), 1U);
  const auto& position = read.requests[0].bodies[0].position;
  EXPECT_TRUE(std::isnan(position[0]));
  EXPECT_EQ(position[1], HUGE_VAL);
  EXPECT_EQ(position[2], -HUGE_VAL);
}

TEST(StateCsv, ToleratesWhitespaceBomAndMissingFinalNewline) {
  const CsvContents read = read_all(
      "\xEF\xBB\xBFutime, body_id, px, py, pz, qw, qx, qy, qz\r\n\r\n 1 , 1,0,0,0, "
      "1,0,0,0\r\n\n2,1,0,0,0,1,0,0,0");
  EXPECT_EQ(read.requests.size(), 2U);
  EXPECT_TRUE(read.corrupt_sections.empty());
}

TEST(StateCsv, ReportsMalformedRowsWithLineNumberAndContinues) {
  const std::string good = "1,1,0,0,0,1,0,0,0\n";
  for (const std::string bad :
       {"x,1,0,0,0,1,0,0,0", "1.5,1,0,0,0,1,0,0,0", "9223372036854775808,1,0,0,0,1,0,0,0",
        "1,2147483648,0,0,0,1,0,0,0", "1,1,0,0,0,1,0,0", "1,1,0,0,0,1,0,0,0,0", "1,1,0,0,0,1,0,0,",
        "1,1,0x1,0,0,1,0,0,0", "1,1,1e999,0,0,1,0,0,0", "1,1,0;0;0;1;0;0;0", "1,1,0 0,0,0,1,0,0,0",
        ",,,,,,,,", "1,1,+-1,0,0,1,0,0,0", "\x01\x02"}) {
    std::string rows = kHeader + good;
    rows += bad;
    rows += "\n";
    rows += good;
    const CsvContents read = read_all(rows);
    EXPECT_EQ(read.requests.size(), 2U) << bad;
    EXPECT_THAT(read.corrupt_sections, ElementsAre(StartsWith("line 3: "))) << bad;
  }
}

TEST(StateCsv, ReportsOverlongLineOnce) {
  const std::string good = "1,1,0,0,0,1,0,0,0";
  const CsvContents read = read_all(kHeader + good + "\n" + std::string(3'000'000, '7') + "\n" + good + "\n" +
                                    std::string(5000, ' '));
  EXPECT_EQ(read.requests.size(), 2U);
  EXPECT_THAT(read.corrupt_sections, ElementsAre(StartsWith("line 3: "), StartsWith("line 5: ")));
  for (const std::size_t length : {4096U, 4097U}) {
    const std::string line = good + std::string(length - good.size(), ' ');
    for (const std::string end : {"\n", "\n2,1,0,0,0,1,0,0,0\n", ""}) {
      const CsvContents around = read_all(kHeader + line + end);
      EXPECT_EQ(around.requests.size(), (length == 4096 ? 1U : 0U) + (end.size() > 1 ? 1U : 0U)) << length;
      EXPECT_EQ(around.corrupt_sections.size(), length == 4096 ? 0U : 1U) << length;
    }
  }
}

TEST(StateCsv, NamesExpectedHeaderIfItIsWrong) {
  for (const std::string& contents :
       {std::string("1,1,0,0,0,1,0,0,0\n"), std::string("\n"),
        std::string("utime,body_id,px,py,pz,qx,qy,qz,qw\n"), kHeader.substr(0, kHeader.size() - 1) + ",vx\n",
        std::string(10'000, 'a'), std::string(100, '\0')}) {
    EXPECT_THAT(open_error(contents), HasSubstr("utime,body_id,px,py,pz,qw,qx,qy,qz"));
  }
}

TEST(StateCsv, ReturnsNothingForFileWithoutRows) {
  for (const std::string& contents : {std::string(), kHeader}) {
    const CsvContents read = read_all(contents);
    EXPECT_TRUE(read.requests.empty());
    EXPECT_TRUE(read.corrupt_sections.empty());
  }
}

}  // namespace
}  // namespace buoyancy
