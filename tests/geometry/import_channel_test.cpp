#include "geometry/import_channel.h"

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/timeouts.h"

namespace buoyancy {
namespace {

ImportDeadline deadline_in(std::chrono::milliseconds delay) {
  return ImportDeadline::clock::now() + delay;
}
const auto kShortTimeout = std::chrono::milliseconds(50);
const auto kLongTimeout = std::chrono::milliseconds(to_milliseconds(kWaitTimeout));

UniqueFd no_files(const std::string& /*name*/) {
  return {};
}

class ImportChannel : public testing::Test {
 protected:
  ImportChannel() { EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends_.data()), 0); }
  ~ImportChannel() override {
    ::close(ends_[0]);
    close_write_end();
  }

  void close_write_end() {
    if (ends_[1] >= 0) ::close(ends_[1]);
    ends_[1] = -1;
  }
  void write(const std::string& bytes) {
    ASSERT_EQ(::write(ends_[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  auto receive(const ImportLimits& limits = {}) {
    return receive_import(ends_[0], limits, deadline_in(kLongTimeout), no_files);
  }

  std::array<int, 2> ends_{-1, -1};
};

StoredMesh triangle() {
  StoredMesh stored;
  stored.mesh.x = {0, 1, 0.1};
  stored.mesh.y = {0, 0, 1e300};
  stored.mesh.z = {-0.0, 2, 3};
  stored.mesh.triangles = {{0, 1, 2}};
  stored.source = {"PLY", "z", "a note", 3, 4};
  return stored;
}

// A quad and a triangle.
StoredMesh polygons() {
  StoredMesh stored = triangle();
  stored.mesh.add_vertex({5, 6, 7});
  stored.mesh.triangles.clear();
  stored.polygons.add(std::array<std::int32_t, 4>{3, 2, 1, 0});
  stored.polygons.add(std::array<std::int32_t, 3>{0, 1, 3});
  return stored;
}

// Returns the bytes that send_import writes.
std::string serialize(const Expected<StoredMesh>& result) {
  std::array<int, 2> ends{};
  EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
  EXPECT_TRUE(send_import(ends[1], result));
  ::close(ends[1]);
  std::string bytes(65'536, '\0');
  const ssize_t received = ::read(ends[0], bytes.data(), bytes.size());
  ::close(ends[0]);
  bytes.resize(static_cast<std::size_t>(received));
  return bytes;
}

bool is_broken(const std::variant<ImportFailure, Expected<StoredMesh>>& outcome) {
  const ImportFailure* failure = std::get_if<ImportFailure>(&outcome);
  return failure != nullptr && *failure == ImportFailure::kBroken;
}

TEST_F(ImportChannel, TransfersMeshBitForBit) {
  ASSERT_TRUE(send_import(ends_[1], triangle()));
  const auto outcome = receive();
  const auto& result = std::get<Expected<StoredMesh>>(outcome);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->mesh.x, triangle().mesh.x);
  EXPECT_EQ(result->mesh.y, triangle().mesh.y);
  EXPECT_TRUE(std::signbit(result->mesh.z[0]));
  EXPECT_EQ(result->mesh.triangles, triangle().mesh.triangles);
  EXPECT_EQ(result->source.format, "PLY");
  EXPECT_EQ(result->source.up_axis, "z");
  EXPECT_EQ(result->source.note, "a note");
  EXPECT_EQ(result->source.nodes, 3);
  EXPECT_EQ(result->source.ignored_primitives, 4);
}

TEST_F(ImportChannel, TransfersPolygons) {
  ASSERT_TRUE(send_import(ends_[1], polygons()));
  const auto outcome = receive();
  const auto& result = std::get<Expected<StoredMesh>>(outcome);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->mesh.x, polygons().mesh.x);
  EXPECT_TRUE(result->mesh.triangles.empty());
  EXPECT_EQ(result->polygons.corners, polygons().polygons.corners);
  EXPECT_EQ(result->polygons.ends, polygons().polygons.ends);
}

TEST_F(ImportChannel, RejectsPolygonsThatAreNone) {
  const std::array<std::vector<std::int64_t>, 7> wrong_ends{{{2, 7},
                                                             {4, 6},
                                                             {5, 7},
                                                             {7, 7},
                                                             {-4, 7},
                                                             {std::numeric_limits<std::int64_t>::min(), 7},
                                                             {4, std::numeric_limits<std::int64_t>::max()}}};
  for (const std::vector<std::int64_t>& ends : wrong_ends) {
    StoredMesh wrong = polygons();
    wrong.polygons.ends = ends;
    write(serialize(wrong));
    EXPECT_TRUE(is_broken(receive())) << ends[0] << ' ' << ends[1];
  }
  for (const std::int32_t outside : {-1, 4, std::numeric_limits<std::int32_t>::max()}) {
    StoredMesh wrong = polygons();
    wrong.polygons.corners[5] = outside;
    write(serialize(wrong));
    EXPECT_TRUE(is_broken(receive())) << outside;
  }
  StoredMesh both = polygons();
  both.mesh.triangles = triangle().mesh.triangles;
  write(serialize(both));
  EXPECT_TRUE(is_broken(receive()));
}

TEST_F(ImportChannel, CountsTrianglesOfPolygonsAgainstLimit) {
  ImportLimits limits;
  limits.faces = 3;
  write(serialize(polygons()));
  EXPECT_FALSE(is_broken(receive(limits)));
  limits.faces = 2;
  write(serialize(polygons()));
  EXPECT_TRUE(is_broken(receive(limits)));
}

TEST_F(ImportChannel, TransfersMoreThanSocketBuffer) {
  StoredMesh large = triangle();
  for (int i = 0; i < 300'000; ++i) large.mesh.add_vertex({1.0 * i, 2.0 * i, 3.0 * i});
  std::thread sender([&] { EXPECT_TRUE(send_import(ends_[1], large)); });
  const auto outcome = receive();
  sender.join();
  EXPECT_EQ(std::get<Expected<StoredMesh>>(outcome)->mesh.z, large.mesh.z);
}

TEST_F(ImportChannel, TransfersErrorsInPrintableCharacters) {
  ASSERT_TRUE(send_import(ends_[1], make_error({"", "a\nb\x1b[31m", "exp\xff", "", "do"})));
  const auto outcome = receive();
  const Error& error = std::get<Expected<StoredMesh>>(outcome).error();
  EXPECT_EQ(error.actual, "a?b?[31m");
  EXPECT_EQ(error.expected, "exp?");
  EXPECT_EQ(error.hint, "do");
}

TEST_F(ImportChannel, RejectsTruncatedResults) {
  const std::string complete = serialize(triangle());
  for (std::size_t length = 0; length < complete.size(); length += 7) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
    ASSERT_EQ(::write(ends[1], complete.data(), length), static_cast<ssize_t>(length));
    ::close(ends[1]);
    EXPECT_TRUE(is_broken(receive_import(ends[0], {}, deadline_in(kLongTimeout), no_files))) << length;
    ::close(ends[0]);
  }
}

TEST_F(ImportChannel, TimesOutAtDeadline) {
  write(serialize(triangle()).substr(0, 20));
  const auto outcome = receive_import(ends_[0], {}, deadline_in(kShortTimeout), no_files);
  EXPECT_EQ(std::get<ImportFailure>(outcome), ImportFailure::kTimedOut);
}

TEST_F(ImportChannel, RejectsVertexCountsAboveLimit) {
  ImportLimits limits;
  limits.vertices = 2;
  write(serialize(triangle()));
  EXPECT_TRUE(is_broken(receive(limits)));
}

TEST_F(ImportChannel, RejectsFaceCountsAboveLimit) {
  ImportLimits limits;
  limits.faces = 0;
  write(serialize(triangle()));
  EXPECT_TRUE(is_broken(receive(limits)));
}

TEST_F(ImportChannel, RejectsMeshesWithoutTriangles) {
  StoredMesh empty = triangle();
  empty.mesh.triangles.clear();
  write(serialize(empty));
  EXPECT_TRUE(is_broken(receive()));
}

TEST_F(ImportChannel, RejectsVertexIndicesOutOfRange) {
  for (const std::int32_t outside : {-1, 3, std::numeric_limits<std::int32_t>::max()}) {
    StoredMesh wrong = triangle();
    wrong.mesh.triangles[0][2] = outside;
    write(serialize(wrong));
    EXPECT_TRUE(is_broken(receive())) << outside;
  }
}

TEST_F(ImportChannel, AllocatesNoMemoryForMissingBytes) {
  // Each 8-byte field of the header in turn is set to the maximum and to a large number: either the header is
  // rejected or the data ends early.
  constexpr std::size_t kHeaderBytes = 88;
  for (std::size_t at = 0; at < 2 * kHeaderBytes; at += 8) {
    const std::string complete = serialize(at < kHeaderBytes ? triangle() : polygons());
    for (const std::uint64_t value :
         {std::numeric_limits<std::uint64_t>::max(), std::uint64_t{150'000'000}}) {
      const std::size_t field = at % kHeaderBytes;
      if (field == 40 || field == 48) continue;  // nodes and ignored_primitives: any number >= 0 is valid
      std::string wrong = complete;
      std::memcpy(wrong.data() + field, &value, sizeof(value));
      std::array<int, 2> ends{};
      ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()), 0);
      ASSERT_EQ(::write(ends[1], wrong.data(), wrong.size()), static_cast<ssize_t>(wrong.size()));
      ::close(ends[1]);
      const auto outcome = receive_import(ends[0], {}, deadline_in(kLongTimeout), no_files);
      ::close(ends[0]);
      const auto* result = std::get_if<Expected<StoredMesh>>(&outcome);
      EXPECT_TRUE(is_broken(outcome) || (result != nullptr && !*result)) << at << ": " << value;
    }
  }
}

TEST_F(ImportChannel, ReportsClosedReadEnd) {
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  ::close(ends_[0]);
  EXPECT_FALSE(send_import(ends_[1], triangle()));
  ends_[0] = -1;
  std::signal(SIGPIPE, before);
}

}  // namespace
}  // namespace buoyancy
