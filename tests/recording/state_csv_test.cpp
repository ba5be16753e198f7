#include "recording/state_csv.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

const std::string kHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";

struct Found {
  std::vector<WrenchRequest> requests;
  std::vector<std::string> corrupt_sections;
};

Found read_all(const std::string& contents) {
  const TempDir directory;
  auto reader = StateCsvReader::open(directory.write("x.csv", contents));
  if (!reader) throw std::runtime_error(reader.error().message());
  Found found;
  while (true) {
    const LogItem item = reader->next();
    if (std::holds_alternative<EndOfLog>(item)) break;
    if (const auto* damage = std::get_if<CorruptSection>(&item)) {
      found.corrupt_sections.push_back(damage->description);
    } else {
      const auto& recorded = std::get<RecordedEvent>(item);
      WrenchRequest request;
      EXPECT_FALSE(decode(recorded.bytes, request));
      EXPECT_EQ(recorded.timestamp, request.key.utime);
      found.requests.push_back(request);
    }
  }
  EXPECT_EQ(reader->offset(), reader->size());
  return found;
}

std::string refusal(const std::string& contents) {
  const TempDir directory;
  const auto reader = StateCsvReader::open(directory.write("x.csv", contents));
  return reader ? "" : reader.error().message();
}

TEST(StateCsv, ReadsEveryColumnExactly) {
  const Found found = read_all(
      "utime,body_id,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz\n"
      "-9223372036854775808,-2147483648,0.1,-2e-308,3,0.5,+.5,-0.5,5e-1,1,2,3,4,5,1.7976931348623157e308\n");
  ASSERT_EQ(found.requests.size(), 1U);
  const WrenchRequest& request = found.requests[0];
  EXPECT_EQ(request.key.utime, INT64_MIN);
  EXPECT_EQ(request.lead_time, 0.0);
  ASSERT_EQ(request.bodies.size(), 1U);
  const BodyState& state = request.bodies[0];
  EXPECT_EQ(state.body_id, INT32_MIN);
  EXPECT_EQ(state.position, (std::array{0.1, -2e-308, 3.0}));
  EXPECT_EQ(state.quaternion_wxyz, (std::array{0.5, 0.5, -0.5, 0.5}));
  EXPECT_EQ(state.linear_velocity, (std::array{1.0, 2.0, 3.0}));
  EXPECT_EQ(state.angular_velocity, (std::array{4.0, 5.0, 1.7976931348623157e308}));
}

TEST(StateCsv, TakesRowsOfOneUtimeAsOneQuestion) {
  const Found found = read_all(kHeader +
                               "10,1,0,0,0,1,0,0,0\n"
                               "10,2,0,0,0,1,0,0,0\n"
                               "20,1,0,0,0,1,0,0,0\n"
                               "10,1,0,0,0,1,0,0,0\n");
  ASSERT_EQ(found.requests.size(), 3U);
  EXPECT_EQ(found.requests[0].bodies.size(), 2U);
  EXPECT_EQ(found.requests[1].bodies.size(), 1U);
  EXPECT_EQ(found.requests[2].key.utime, 10);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found.requests[i].key.seq, static_cast<std::int64_t>(i));
}

TEST(StateCsv, BoundsTheRowsOfOneQuestion) {
  std::string contents = kHeader;
  for (std::size_t i = 0; i < kMaxRowsPerRequest + 1; ++i) contents += "1,1,0,0,0,1,0,0,0\n";
  const Found found = read_all(contents);
  ASSERT_EQ(found.requests.size(), 2U);
  EXPECT_EQ(found.requests[0].bodies.size(), kMaxRowsPerRequest);
  EXPECT_EQ(found.requests[1].bodies.size(), 1U);
}

TEST(StateCsv, TakesNanAndInfinityAsNumbers) {
  const Found found = read_all(kHeader + "1,1,nan,inf,-inf,1,0,0,0\n");
  ASSERT_EQ(found.requests.size(), 1U);
  const auto& position = found.requests[0].bodies[0].position;
  EXPECT_TRUE(std::isnan(position[0]));
  EXPECT_EQ(position[1], HUGE_VAL);
  EXPECT_EQ(position[2], -HUGE_VAL);
}

TEST(StateCsv, BearsSpacesBlankLinesCarriageReturnsAMarkInFrontAndNoNewlineAtTheEnd) {
  const Found found = read_all(
      "\xEF\xBB\xBFutime, body_id, px, py, pz, qw, qx, qy, qz\r\n\r\n 1 , 1,0,0,0, "
      "1,0,0,0\r\n\n2,1,0,0,0,1,0,0,0");
  EXPECT_EQ(found.requests.size(), 2U);
  EXPECT_TRUE(found.corrupt_sections.empty());
}

TEST(StateCsv, ReportsMalformedRowsWithTheirLineAndReadsOn) {
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
    const Found found = read_all(rows);
    EXPECT_EQ(found.requests.size(), 2U) << bad;
    ASSERT_EQ(found.corrupt_sections.size(), 1U) << bad;
    EXPECT_EQ(found.corrupt_sections[0].rfind("line 3: ", 0), 0U) << found.corrupt_sections[0];
  }
}

TEST(StateCsv, ReportsALineWithoutEndOnce) {
  const std::string good = "1,1,0,0,0,1,0,0,0\n";
  const Found found =
      read_all(kHeader + good + std::string(3'000'000, '7') + "\n" + good + std::string(5000, ' '));
  EXPECT_EQ(found.requests.size(), 2U);
  ASSERT_EQ(found.corrupt_sections.size(), 2U);
  EXPECT_EQ(found.corrupt_sections[0].rfind("line 3: ", 0), 0U) << found.corrupt_sections[0];
  EXPECT_EQ(found.corrupt_sections[1].rfind("line 5: ", 0), 0U) << found.corrupt_sections[1];
}

TEST(StateCsv, NamesTheHeaderItWantsWhereThereIsAnother) {
  for (const std::string& contents :
       {std::string("1,1,0,0,0,1,0,0,0\n"), std::string("\n"),
        std::string("utime,body_id,px,py,pz,qx,qy,qz,qw\n"), kHeader.substr(0, kHeader.size() - 1) + ",vx\n",
        std::string(10'000, 'a'), std::string(100, '\0')}) {
    EXPECT_NE(refusal(contents).find("utime,body_id,px,py,pz,qw,qx,qy,qz"), std::string::npos)
        << refusal(contents);
  }
}

TEST(StateCsv, FindsNothingInAnEmptyFileOrBehindTheHeader) {
  for (const std::string& contents : {std::string(), kHeader}) {
    const Found found = read_all(contents);
    EXPECT_TRUE(found.requests.empty());
    EXPECT_TRUE(found.corrupt_sections.empty());
  }
}

}  // namespace
}  // namespace buoyancy
