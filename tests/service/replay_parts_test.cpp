// Runs buoyancy-replay --part and --join as programs: the joined parts are what one replay writes, whatever
// is in the recording, and parts that do not belong together are refused.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <functional>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "service/replay/replay_part.h"
#include "tests/messages/encoded_by_lcm.h"
#include "tests/messages/upright_pose.h"
#include "tests/service/replay_fixture.h"
#include "tests/support/contains.h"
#include "tests/support/json.h"

namespace buoyancy {
namespace {

using service::Part;

constexpr std::size_t kBlock = 262'144;  // [bytes], of every input below 256 MB
const std::string kPoseHeader = "utime,body_id,px,py,pz,qw,qx,qy,qz\n";
const std::string kSyncWord = "\xED\xA1\xDA\x01";

std::string json_without_times(const FinishedProcess& finished) {
  auto summary = parse_json(finished.standard_output);
  summary.erase("seconds");
  summary.erase("requests_per_second");
  summary.erase("requests_not_recorded");  // a join does not count them
  return summary.dump(2);
}

std::string other_event(std::int64_t timestamp, const std::string& data) {
  return event("OTHER", timestamp, {data.begin(), data.end()});
}

// Requests of different sizes, some of them retries, poses and other channels.
std::string mixed_log(std::size_t size) {
  std::string log;
  for (int i = 0; log.size() < size; ++i) {
    const double height = 0.0005 * (i % 9000) - 2.5;
    const std::string requested = event("BUOYANCY_STATES", i, request(i, height));
    log += requested;
    if (i % 5 == 0) log += requested;
    if (i % 3 == 0) log += event("POSE", i, encoded_by_lcm(upright_pose(height, i)));
    if (i % 11 == 0) log += event("HULL", i, encoded_by_lcm(upright_pose(-height, i)));
    if (i % 7 == 0) log += other_event(i, std::string(static_cast<std::size_t>(i % 400), 'x'));
    if (i % 901 == 0) log += event("POSE", i, {1});
  }
  return log;
}

std::string csv_of(std::size_t size) {
  std::string csv = kPoseHeader;
  for (int i = 0; csv.size() < size; ++i) {
    if (i % 997 == 0) csv += "malformed\n";
    if (i % 499 == 0) csv += "\n";
    csv += std::to_string(i / 3) + ",1,7,8," + std::to_string(0.0002 * (i % 20'000) - 2.0) + ",1,0,0,0\n";
  }
  return csv;
}

class ReplayParts : public Replay {
 protected:
  FinishedProcess run_part(const std::string& input, const std::string& output, const Part& part,
                           const std::vector<std::string>& options = {}) const {
    std::vector<std::string> all{"--part", std::to_string(part.number) + "/" + std::to_string(part.count)};
    all.insert(all.end(), options.begin(), options.end());
    return replay(input, output, all);
  }
  FinishedProcess join(int count, const std::string& input, const std::string& output) const {
    return run({"--join", std::to_string(count), "--json", input, output});
  }
  // Runs all parts, the last first.
  void run_parts(int count, const std::string& input, const std::string& output,
                 const std::vector<std::string>& options = {}) const {
    for (int number = count; number > 0; --number) {
      const FinishedProcess finished = run_part(input, output, {number, count}, options);
      ASSERT_EQ(finished.exit_code, 0) << number << ": " << finished.standard_error;
    }
  }
  std::string part_of(const std::string& output, int number, int count) const {
    return service::part_path(path(output), {number, count}).string();
  }
  static std::string manifest_of(const std::string& part) { return part + ".json"; }

  // Checks that the parts join to what one replay writes, prints and returns.
  void expect_whole(int count, const std::string& input, const std::string& extension,
                    const std::vector<std::string>& options, const std::string& description) const {
    std::vector<std::string> with_json = options;
    with_json.emplace_back("--json");
    const std::string whole = path("whole" + extension);
    const std::string output = path("joined" + extension);
    const FinishedProcess finished = replay(input, whole, with_json);
    ASSERT_TRUE(finished.exit_code == 0 || finished.exit_code == 1) << description << finished.standard_error;
    run_parts(count, input, output, options);
    const FinishedProcess joined = join(count, input, output);
    EXPECT_EQ(joined.exit_code, finished.exit_code) << description << joined.standard_error;
    ASSERT_FALSE(joined.standard_output.empty()) << description << joined.standard_error;
    EXPECT_EQ(json_without_times(joined), json_without_times(finished)) << description;
    EXPECT_TRUE(read_file(output) == read_file(whole)) << description;
  }

  void expect_refusal(const FinishedProcess& joined, const std::vector<std::string>& texts) const {
    EXPECT_EQ(joined.exit_code, 1) << joined.standard_error;
    EXPECT_EQ(joined.standard_output, "");
    EXPECT_EQ(std::count(joined.standard_error.begin(), joined.standard_error.end(), '\n'), 1)
        << joined.standard_error;
    for (const std::string& text : texts) {
      EXPECT_TRUE(contains(joined.standard_error, text));
    }
    for (const char* output : {"out.csv", "out.lcmlog", "out.csv.tmp", "out.lcmlog.tmp"}) {
      EXPECT_FALSE(std::filesystem::exists(path(output))) << output;
    }
  }

  void change_manifest(const std::string& part, const std::function<void(nlohmann::json&)>& change) const {
    auto manifest = parse_json(read_file(manifest_of(part)));
    change(manifest);
    std::ofstream(manifest_of(part)) << manifest.dump();
  }
};

// ---- The division

TEST(ReplayPart, ParsesNumberAndCount) {
  EXPECT_EQ(service::parse_part("3/7"), (Part{3, 7}));
  EXPECT_EQ(service::parse_part("1/1"), (Part{1, 1}));
  for (const char* text :
       {"", "3", "3/", "/7", "0/7", "8/7", "-1/7", "3/7/9", "3 /7", "1.0/2", "1/10001", "a/b"}) {
    EXPECT_FALSE(service::parse_part(text)) << text;
  }
}

TEST(ReplayPart, DividesInputIntoBlocksWithoutGaps) {
  for (const std::int64_t size : {0LL, 1LL, 262'144LL, 262'145LL, 5'000'000LL, 268'435'456LL, 268'435'457LL,
                                  2'147'483'648LL, 9'000'000'000'000LL}) {
    const std::int64_t block = service::block_size(size);
    EXPECT_GE(block, std::int64_t{kBlock});
    EXPECT_LE((size + block - 1) / block, 1024);
    for (const int count : {1, 2, 7, 1000, service::kMaxParts}) {
      std::int64_t end = 0;
      for (int number = 1; number <= count; ++number) {
        const service::PartLimits limits = service::part_limits({number, count}, size);
        ASSERT_EQ(limits.begin, end) << size;
        EXPECT_TRUE(limits.begin % block == 0 || limits.begin == size);
        const std::int64_t blocks = size / block + 1;
        if (number < count) {
          EXPECT_LE(limits.end - limits.begin, block * (blocks / count + 1));
        }
        end = limits.end;
      }
      EXPECT_EQ(end, kNoLimit);
    }
  }
}

TEST(ReplayPart, NamesFileBesideOutput) {
  EXPECT_EQ(service::part_path("a/b.c.lcmlog", {3, 7}), "a/b.c.part-3-of-7.lcmlog");
}

// ---- Joined parts

TEST_F(ReplayParts, JoinToWholeOutputOfLog) {
  const std::string input = write("in.lcmlog", mixed_log(5 * kBlock));
  for (const int count : {1, 2, 7}) {
    for (const char* extension : {".lcmlog", ".csv"}) {
      expect_whole(count, input, extension, {}, std::to_string(count) + extension);
    }
  }
}

TEST_F(ReplayParts, JoinToWholeOutputOfCsv) {
  const std::string input = write("in.csv", csv_of(5 * kBlock));
  for (const int count : {1, 2, 7}) {
    for (const char* extension : {".lcmlog", ".csv"}) {
      expect_whole(count, input, extension, {}, std::to_string(count) + extension);
    }
  }
}

TEST_F(ReplayParts, JoinPosesCopiesAndHydrostatics) {
  write("scene.toml", kOneBoxScene + "outputs = [\"wrench\", \"hydrostatics\"]\n");
  const std::string input = write("in.lcmlog", mixed_log(4 * kBlock));
  const std::vector<std::string> poses{"--pose", "POSE=1", "--pose", "HULL=1"};
  const auto with_poses = [&poses](std::vector<std::string> options) {
    options.insert(options.begin(), poses.begin(), poses.end());
    return options;
  };
  expect_whole(3, input, ".lcmlog", with_poses({}), "poses");
  expect_whole(3, input, ".csv", with_poses({}), "poses to CSV");
  expect_whole(3, input, ".lcmlog", with_poses({"--copy", ".*"}), "copies");
  expect_whole(3, input, ".lcmlog", with_poses({"--wrenches-channel", "W", "--hydrostatics-channel", "H"}),
               "channels");
  expect_whole(3, input, ".lcmlog", {"--pose", "POSE=1", "--force-torque", "FT=1"}, "force and torque");
  expect_whole(3, input, ".lcmlog", with_poses({"--lead-time", "0.1", "--velocity-frame", "body"}),
               "lead time");
}

TEST_F(ReplayParts, JoinLoads) {
  write("scene.toml", kLoadsBoxScene);
  const std::string input = write("in.lcmlog", mixed_log(4 * kBlock));
  const std::vector<std::string> poses{"--pose", "POSE=1", "--pose", "HULL=1", "--velocity-frame", "world"};
  expect_whole(3, input, ".lcmlog", poses, "poses");
  std::vector<std::string> named = poses;
  named.insert(named.end(), {"--loads-channel", "L"});
  expect_whole(3, input, ".lcmlog", named, "channel");
  const std::vector<LoggedEvent> loads = events_of(path("joined.lcmlog"), only_channel("L"));
  EXPECT_GT(loads.size(), 1'000U);
  EXPECT_EQ(loads.size(), events_of(path("joined.lcmlog"), only_channel("BUOYANCY_WRENCHES")).size());
}

TEST_F(ReplayParts, MayOutnumberMessages) {
  for (const int requests : {0, 1, 3}) {
    expect_whole(5, write("in.lcmlog", log_of_requests(requests)), ".lcmlog", {}, std::to_string(requests));
    std::string csv = kPoseHeader;
    for (int i = 0; i < requests; ++i) csv += std::to_string(i) + ",1,0,0,0,1,0,0,0\n";
    for (const char* extension : {".lcmlog", ".csv"}) {
      expect_whole(5, write("in.csv", csv), extension, {}, std::to_string(requests) + " rows");
    }
  }
  expect_whole(3, write("in.csv", ""), ".csv", {}, "empty CSV");
}

TEST_F(ReplayParts, JoinWholeOutputOfDamagedLogs) {
  const std::string original = mixed_log(3 * kBlock);
  for (unsigned seed = 0; seed < 24; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&random](std::size_t limit) {
      return std::uniform_int_distribution<std::size_t>(0, limit - 1)(random);
    };
    std::string log = original;
    for (const std::size_t boundary : {kBlock, 2 * kBlock}) {
      const std::size_t at = boundary - 300 + below(400);
      const std::size_t size = 1 + below(600);
      std::string garbage(size, '\0');
      if (seed % 2 == 0) std::ranges::generate(garbage, [&] { return static_cast<char>(below(256)); });
      switch (seed % 6) {
        case 0:
          log.replace(at, size, garbage);
          break;
        case 1:
          log.insert(at, garbage);
          break;
        case 2:
          log.erase(at, size);
          break;
        case 3:
          log.insert(at, kSyncWord);
          break;
        case 4:
          log[at] = static_cast<char>(log[at] ^ (1 << below(8)));
          break;
        default:
          log.insert(at, other_event(0, garbage).substr(0, size));
          break;
      }
    }
    if (seed % 5 == 0) log.resize(log.size() - 1 - below(100));
    expect_whole(4, write("in.lcmlog", log), ".lcmlog", {"--pose", "POSE=1", "--copy", "OTHER"},
                 "seed " + std::to_string(seed));
  }
}

TEST_F(ReplayParts, AgreeOnGarbageLongerThanPart) {
  const std::string log = mixed_log(kBlock);
  const std::string garbage(3 * kBlock, '\xED');
  expect_whole(7, write("in.lcmlog", log + garbage + log), ".lcmlog", {}, "garbage");
  expect_whole(7, write("in.csv", csv_of(kBlock) + garbage + "\n" + csv_of(kBlock)), ".csv", {}, "long line");
}

// The cuts lie inside of a message that holds a recording, as if a program sent its log over LCM.
TEST_F(ReplayParts, IgnoreEventsInsideMessagesAtCuts) {
  const std::string inner = mixed_log(5 * kBlock);
  for (const std::size_t missing : {0, 50}) {
    const std::string log = mixed_log(kBlock / 2) +
                            other_event(1, inner.substr(missing, inner.size() - 2 * missing)) +
                            mixed_log(kBlock);
    expect_whole(6, write("in.lcmlog", log), ".lcmlog", {"--copy", "OTHER"}, std::to_string(missing));
    expect_whole(6, write("in.lcmlog", log), ".lcmlog", {}, std::to_string(missing));
  }
}

TEST_F(ReplayParts, KeepRowsWithEqualUtimeTogether) {
  std::string csv = kPoseHeader;
  for (int i = 0; i < 70'000; ++i) csv += "5,1,0,0,0,1,0,0,0\n";
  csv += "6,1,0,0,0,1,0,0,0\n";
  expect_whole(5, write("in.csv", csv), ".lcmlog", {}, "one utime");
}

// A message longer than kSeekDistance can mislead a part. The join notices, and the part is right once it
// knows where the one before ended.
TEST_F(ReplayParts, BeginWherePartBeforeEndsWhenRunAgain) {
  std::string inner;
  const std::string piece = mixed_log(kBlock);
  while (inner.size() < static_cast<std::size_t>(kSeekDistance) + 12 * kBlock) inner += piece;
  const std::string input = write("in.lcmlog", piece + other_event(1, inner) + piece);
  run_parts(10, input, path("out.lcmlog"));
  FinishedProcess joined = join(10, input, path("out.lcmlog"));
  expect_refusal(joined, {"part 10 of 10 begins at byte ", "Run it again (--part 10/10)"});
  ASSERT_EQ(run_part(input, path("out.lcmlog"), {10, 10}).exit_code, 0);
  joined = join(10, input, path("out.lcmlog"));
  EXPECT_EQ(joined.exit_code, 0) << joined.standard_error;
  ASSERT_EQ(replay(input, path("whole.lcmlog")).exit_code, 0);
  EXPECT_TRUE(read_file(path("out.lcmlog")) == read_file(path("whole.lcmlog")));
}

TEST_F(ReplayParts, ReportInputErrorsOnlyWhenJoined) {
  const std::string input = write("in.csv", kPoseHeader + "1,1,zero,0,0,1,0,0,0\n");
  const FinishedProcess part = run_part(input, path("out.csv"), {1, 1});
  EXPECT_EQ(part.exit_code, 0) << "the part is complete";
  EXPECT_TRUE(contains(part.standard_error, "line 2: 'zero'"));
  const FinishedProcess joined = join(1, input, path("out.csv"));
  EXPECT_EQ(joined.exit_code, 1);
  EXPECT_EQ(joined.standard_error, part.standard_error);
  EXPECT_EQ(parse_json(joined.standard_output)["corrupt_sections"], 1);
}

TEST_F(ReplayParts, WarnOfUnseenChannelsOnlyWhenJoined) {
  const std::string input =
      write("in.lcmlog", mixed_log(kBlock) + event("RARE", 1, encoded_by_lcm(upright_pose(0, 1))));
  const std::vector<std::string> options{"--pose", "RARE=1", "--pose", "POZE=1"};
  run_parts(2, input, path("out.lcmlog"), options);
  const FinishedProcess part = run_part(input, path("out.lcmlog"), {1, 2}, options);
  EXPECT_EQ(part.standard_error, "");
  const FinishedProcess joined = join(2, input, path("out.lcmlog"));
  EXPECT_TRUE(contains(joined.standard_error, "channel POZE"));
  EXPECT_FALSE(contains(joined.standard_error, "channel RARE"));
}

TEST_F(ReplayParts, FailOnRequestInSessionOfPoses) {
  WrenchRequest request;
  request.id.session_id = 0x706f736500000000;
  const std::string input = write("in.lcmlog", event("BUOYANCY_STATES", 1, encoded(request)));
  const FinishedProcess finished = run_part(input, path("out.lcmlog"), {1, 1}, {"--pose", "POSE=1"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_TRUE(contains(finished.standard_error, "session_id of a pose channel"));
  EXPECT_FALSE(std::filesystem::exists(part_of("out.lcmlog", 1, 1)));
  EXPECT_EQ(run_part(input, path("out.csv"), {1, 1}, {"--pose", "POSE=1"}).exit_code, 0)
      << "rows have no seq";
  EXPECT_EQ(run_part(input, path("out.lcmlog"), {1, 1}).exit_code, 0) << "no poses";
}

// ---- Refusals

class JoinOfParts : public ReplayParts {
 protected:
  void SetUp() override {
    write("in.lcmlog", mixed_log(4 * kBlock));
    run_parts(4, input(), output());
  }
  std::string input() const { return path("in.lcmlog"); }
  std::string output() const { return path("out.lcmlog"); }
  std::string part(int number) const { return part_of("out.lcmlog", number, 4); }
  void expect_refused(const std::vector<std::string>& texts) const {
    expect_refusal(join(4, input(), output()), texts);
  }
  void run_again(int number, const std::vector<std::string>& options) const {
    const FinishedProcess finished = run_part(input(), output(), {number, 4}, options);
    ASSERT_EQ(finished.exit_code, 0) << finished.standard_error;
  }
};

TEST_F(JoinOfParts, RefusesMissingParts) {
  std::filesystem::remove(part(2));
  std::filesystem::remove(manifest_of(part(4)));
  expect_refused({"parts 2,4 of 4 not complete", "Run them again (--part I/4)"});
  expect_refusal(join(5, input(), output()), {"parts 1-5 of 5 not complete", part_of("out.lcmlog", 1, 5)});
}

TEST_F(JoinOfParts, RefusesDamagedParts) {
  std::string bytes = read_file(part(3));
  bytes[bytes.size() / 2] ^= 1;
  write("out.part-3-of-4.lcmlog", bytes);
  expect_refused({"part 3 of 4 damaged", "Run it again (--part 3/4)"});
  bytes.resize(bytes.size() - 1);
  write("out.part-3-of-4.lcmlog", bytes);
  write("out.part-1-of-4.lcmlog", "");
  expect_refused({"parts 1,3 of 4 damaged"});
}

TEST_F(JoinOfParts, RefusesDamagedManifests) {
  const std::string manifest = read_file(manifest_of(part(2)));
  for (const std::string& text : {std::string(), manifest.substr(0, manifest.size() / 2), std::string("{}"),
                                  std::string("[1, 2]"), std::string("\xFF\xFE")}) {
    std::ofstream(manifest_of(part(2))) << text;
    expect_refused({"part 2 of 4 without a usable manifest", manifest_of(part(2))});
  }
  std::ofstream(manifest_of(part(2))) << manifest;
  change_manifest(part(2), [](auto& json) { json["format"] = "buoyancy-replay part, version 2"; });
  expect_refused({"has another format"});
}

TEST_F(JoinOfParts, RefusesCopiesUnderAnotherNumber) {
  for (const auto& name : {part(2), manifest_of(part(2))}) {
    std::string copy = name;
    copy.replace(copy.find("part-2"), 6, "part-3");
    std::filesystem::copy_file(name, copy, std::filesystem::copy_options::overwrite_existing);
  }
  expect_refused({"part 3 of 4 not what the name says", "is that of part 2 of 4"});
}

TEST_F(JoinOfParts, RefusesCopyOfOutputOnly) {
  std::filesystem::copy_file(part(2), part(3), std::filesystem::copy_options::overwrite_existing);
  expect_refused({"part 3 of 4 damaged"});
}

TEST_F(JoinOfParts, RefusesPartsOfOtherOptions) {
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--pose", "POSE=1"},
                                                  {"--copy", "OTHER"},
                                                  {"--wrenches-channel", "W"},
                                                  {"--hydrostatics-channel", "H"},
                                                  {"--loads-channel", "L"},
                                                  {"--states-channel", "S"}}) {
    run_again(3, options);
    expect_refused({"part 3 of 4 computed with another " + options.front(), "Run it again (--part 3/4)"});
  }
  run_again(3, {});
  run_again(2, {"--pose", "POSE=1"});
  run_again(3, {"--pose", "POSE=1", "--lead-time", "0.1", "--velocity-frame", "world"});
  expect_refused({"part 3 of 4 computed with another --lead-time"});
}

TEST_F(JoinOfParts, RefusesPartsOfOtherScene) {
  const std::string scene = read_file(scene_);
  write("scene.toml", scene + "# a comment\n");
  run_again(1, {});
  run_again(4, {});
  run_again(2, {});
  expect_refused({"part 3 of 4 computed with another scene file"});
}

TEST_F(JoinOfParts, RefusesPartsOfOtherMesh) {
  // Another place of the apex leaves the bounding box as it is.
  const std::string pyramid =
      "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 1 2\n"
      "f 1 4 3\nf 1 3 2\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
  write("mesh.obj", pyramid);
  write("scene.toml", kTestWater + "[[body]]\nid = 1\nmesh = \"mesh.obj\"\n");
  run_parts(4, input(), output());
  write("mesh.obj", pyramid + "# the same mesh\n");
  run_again(2, {});
  EXPECT_EQ(join(4, input(), output()).exit_code, 0);
  std::filesystem::remove(output());
  write("mesh.obj", std::string(pyramid).replace(pyramid.find("1 1 2"), 5, "1.5 1 2"));
  run_again(2, {});
  expect_refused({"part 2 of 4 computed with another scene, meshes and waves"});
}

TEST_F(JoinOfParts, RefusesPartsOfOtherVersionOrInstructionSet) {
  change_manifest(part(4), [](auto& json) { json["facts"]["instruction set"] = "SSE4"; });
  expect_refused({"part 4 of 4 computed with another instruction set", "'SSE4'", "different processors"});
  change_manifest(part(4), [](auto& json) { json["facts"].erase("instruction set"); });
  expect_refused({"part 4 of 4 computed with another instruction set"});
  run_again(4, {});
  change_manifest(part(1), [](auto& json) { json["facts"]["version"] = "0.0.1"; });
  expect_refused({"part 1 of 4 computed with another version", "'0.0.1'"});
}

TEST_F(JoinOfParts, RefusesPartsOfOtherInput) {
  std::string log = read_file(input());
  log[log.find("POSE", 3 * kBlock)] = 'R';
  write("in.lcmlog", log);
  expect_refused({"part 3 of 4 computed from other bytes than INPUT holds", "Run it again (--part 3/4)"});
  run_again(3, {});
  EXPECT_EQ(join(4, input(), output()).exit_code, 0);
  std::filesystem::remove(output());

  write("in.lcmlog", log + "more");
  expect_refused({"in.lcmlog: has " + std::to_string(log.size() + 4) + " bytes"});
  run_again(2, {});
  expect_refused({"part 2 of 4 computed with another size of INPUT"});
}

TEST_F(JoinOfParts, RefusesPartsOfOtherFormat) {
  const std::string csv = write("in.csv", csv_of(kBlock));
  run_parts(1, csv, path("x.csv"));
  run_parts(2, csv, output());
  expect_refusal(join(2, input(), output()), {"in.lcmlog: has "});
}

TEST_F(JoinOfParts, RejectsInvalidArgumentsWithUsageError) {
  const std::string fifo = path("fifo.lcmlog");
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  const std::vector<std::vector<std::string>> invalid{
      {"--join", "0", input(), output()},
      {"--join", "10001", input(), output()},
      {"--join", "4", input()},
      {"--join", "4", input(), output(), "--scene", scene_},
      {"--join", "4", input(), output(), "--jobs", "1"},
      {"--join", "4", input(), output(), "--part", "1/4"},
      {"--join", "4", input(), output(), "--compare", input()},
      {"--join", "4", input(), input()},
      {"--join", "4", input(), "/dev/stdout"},
      {"--join", "4", input(), fifo},
      {"--join", "4", fifo, output()},
      {"--join", "4", path("gone.lcmlog"), output()},
      {"--part", "1/4", input(), output()},
      {"--scene", scene_, "--part", "5/4", input(), output()},
      {"--scene", scene_, "--part", "1/4", input(), "/dev/null"},
      {"--scene", scene_, "--part", "1/4", input(), "/dev/stdout"},
      {"--scene", scene_, "--part", "1/4", input(), fifo},
      {"--scene", scene_, "--part", "1/4", fifo, output()},
      {"--scene", scene_, "--part", "1/4", "/dev/stdin", output()},
      {"--scene", scene_, "--part", "1/4", input(), output(), "--compare", part(1)},
      {"--scene", scene_, "--part", "1/4", part(1), output()},
  };
  const std::string before = read_file(part(1));
  for (const std::vector<std::string>& arguments : invalid) {
    std::string shown;
    for (const std::string& argument : arguments) shown += argument + " ";
    const FinishedProcess finished = run(arguments);
    EXPECT_EQ(finished.exit_code, 2) << shown << finished.standard_error;
    EXPECT_EQ(std::count(finished.standard_error.begin(), finished.standard_error.end(), '\n'), 1)
        << shown << finished.standard_error;
  }
  EXPECT_TRUE(read_file(part(1)) == before);
}

// ---- Interrupted parts

class InterruptedPart : public ReplayParts {
 protected:
  void SetUp() override {
    write("scene.toml",
          "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 3, 4], segments = [20, 20, 20] }\n"
          "method = \"exact\"\n");
    std::string poses = kPoseHeader;
    // Different poses: a repeated one costs nothing, so that the part would soon be complete.
    for (int i = 0; i < 200'000; ++i) {
      poses += std::to_string(i) + ",1,0,0," + std::to_string(1e-5 * i) + ",1,0,0,0\n";
    }
    write("in.csv", poses);
  }
  ChildCommand part_command() const {
    return command({"--scene", scene_, "--part", "2/2", path("in.csv"), path("out.csv")});
  }
  // Waits until a part has written something.
  void wait_for_output(ChildProcess& child) const {
    std::error_code not_there_yet;
    while (std::filesystem::file_size(temporary(), not_there_yet) + 1 <= 1) {
      ASSERT_FALSE(child.wait(0.002)) << child.standard_error();
    }
  }
  std::string temporary() const { return part_of("out.csv", 2, 2) + ".tmp"; }
};

TEST_F(InterruptedPart, LeavesNothingThatJoinAccepts) {
  ASSERT_EQ(run_part(path("in.csv"), path("out.csv"), {1, 2}).exit_code, 0);
  for (const int signal : {SIGKILL, SIGTERM}) {
    std::filesystem::remove(temporary());
    ChildProcess child(part_command());
    wait_for_output(child);
    child.send_signal(signal);
    EXPECT_EQ(child.wait(kWaitTimeout), signal == SIGTERM ? 1 : 128 + signal) << child.standard_error();
    EXPECT_FALSE(std::filesystem::exists(part_of("out.csv", 2, 2)));
    EXPECT_FALSE(std::filesystem::exists(manifest_of(part_of("out.csv", 2, 2))));
    EXPECT_EQ(std::filesystem::exists(temporary()), signal == SIGKILL);
    expect_refusal(join(2, path("in.csv"), path("out.csv")),
                   {"part 2 of 2 not complete", "Run it again (--part 2/2)"});
    if (signal == SIGTERM) {
      EXPECT_TRUE(contains(child.standard_error(), "terminated by SIGTERM; nothing was kept of part 2/2"));
    }
  }
  ASSERT_EQ(run_part(path("in.csv"), path("out.csv"), {2, 2}).exit_code, 0);
  EXPECT_EQ(join(2, path("in.csv"), path("out.csv")).exit_code, 0);
  ASSERT_EQ(replay(path("in.csv"), path("whole.csv")).exit_code, 0);
  EXPECT_TRUE(read_file(path("out.csv")) == read_file(path("whole.csv")));
}

TEST_F(InterruptedPart, IsNotWrittenByTwoProcessesAtOnce) {
  ChildProcess child(part_command());
  wait_for_output(child);
  child.send_signal(SIGSTOP);  // it must not finish before the second one has started
  const FinishedProcess second = run_part(path("in.csv"), path("out.csv"), {2, 2});
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_TRUE(contains(second.standard_error, "is being written by another process"));
  child.send_signal(SIGCONT);
  EXPECT_EQ(child.wait(kWaitTimeout), 0) << "the first goes on: " << child.standard_error();
  EXPECT_TRUE(std::filesystem::exists(manifest_of(part_of("out.csv", 2, 2))));
}

TEST_F(InterruptedPart, KeepsEarlierCompletePart) {
  ASSERT_EQ(run_part(path("in.csv"), path("out.csv"), {2, 2}).exit_code, 0);
  const std::string part = part_of("out.csv", 2, 2);
  const std::string before = read_file(part) + read_file(manifest_of(part));
  ChildProcess child(part_command());
  wait_for_output(child);
  child.send_signal(SIGKILL);
  child.wait(kWaitTimeout);
  EXPECT_TRUE(read_file(part) + read_file(manifest_of(part)) == before);
}

TEST_F(ReplayParts, RefuseTemporaryNamesThatAreLinks) {
  const std::string log = mixed_log(3 * kBlock);
  const std::string input = write("in.lcmlog", log);
  const std::string temporary = path("out.part-1-of-2.lcmlog.tmp");
  std::filesystem::create_hard_link(input, temporary);
  EXPECT_EQ(run_part(input, path("out.lcmlog"), {1, 2}).exit_code, 2);
  std::filesystem::remove(temporary);
  const std::string other = write("other", "precious");
  std::filesystem::create_symlink(other, temporary);
  EXPECT_EQ(run_part(input, path("out.lcmlog"), {1, 2}).exit_code, 1);
  EXPECT_EQ(read_file(input), log);
  EXPECT_EQ(read_file(other), "precious");
}

}  // namespace
}  // namespace buoyancy
