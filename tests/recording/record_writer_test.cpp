#include "recording/record_writer.h"

#include <array>
#include <chrono>
#include <csignal>
#include <future>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/unique_fd.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

using testing::HasSubstr;

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// While it lives, no file of this process grows beyond `bytes`, as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST(RecordWriter, WritesRecordsInOrder) {
  const TempDir directory;
  const std::string path = directory.write("x", "earlier contents");
  auto file = RecordWriter::create(path);
  ASSERT_TRUE(file);
  std::string expected;
  for (int i = 0; i < 100'000; ++i) {
    const std::string record = "record " + std::to_string(i) + "\n";
    ASSERT_TRUE(file->append(bytes_of(record)));
    expected += record;
  }
  ASSERT_TRUE(file->append(bytes_of(std::string(3'000'000, 'x'))));
  expected += std::string(3'000'000, 'x');
  ASSERT_TRUE(file->flush());
  EXPECT_EQ(read_file(path), expected);
}

TEST(RecordWriter, EndsWithCompleteRecordOnFullDisk) {
  const TempDir directory;
  for (const rlim_t limit : {1'000'000U, 1'048'576U, 1'500'007U, 5U}) {
    auto file = RecordWriter::create(directory.path("x"));
    ASSERT_TRUE(file);
    Expected<void> written;
    {
      const FileSizeLimit full(limit);
      for (int i = 0; i < 1'000'000 && written; ++i) written = file->append(bytes_of("0123456789"));
    }
    ASSERT_FALSE(written);
    EXPECT_THAT(written.error().message(), HasSubstr("could not be written"));
    EXPECT_EQ(read_file(directory.path("x")).size(), limit / 10 * 10);
  }
}

// A named pipe whose reader reads only in read_all().
class UnreadPipe {
 public:
  UnreadPipe() : path_(directory_.path("pipe")) {
    EXPECT_EQ(::mkfifo(path_.c_str(), 0600), 0);
    reader_ = UniqueFd(::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  }
  const std::string& path() const { return path_; }
  std::string read_all() const {
    std::string all;
    std::array<char, 65'536> buffer{};
    for (ssize_t size = 0; (size = ::read(reader_.value(), buffer.data(), buffer.size())) > 0;) {
      all.append(buffer.data(), static_cast<std::size_t>(size));
    }
    return all;
  }

 private:
  TempDir directory_;
  std::string path_;
  UniqueFd reader_;
};

TEST(RecordWriter, FailsOnStalledPipeReaderAfterSignal) {
  const UnreadPipe pipe;
  auto file = RecordWriter::create(pipe.path());
  ASSERT_TRUE(file);
  const UniqueFd signal(::eventfd(1, EFD_CLOEXEC));
  file->give_up_after(signal.value());
  const std::string record = "0123456789\n";
  for (int i = 0; i < 50'000; ++i) ASSERT_TRUE(file->append(bytes_of(record)));
  const Expected<void> flushed = file->flush();
  ASSERT_FALSE(flushed);
  EXPECT_THAT(flushed.error().message(), HasSubstr("its reader has stalled"));
  const std::string written = pipe.read_all();
  EXPECT_GT(written.size(), 10'000U);
  EXPECT_EQ(written.size() % record.size(), 0U) << "the pipe ends within a record";
}

TEST(RecordWriter, WritesEverythingToActivePipeReaderAfterSignal) {
  const UnreadPipe pipe;
  auto file = RecordWriter::create(pipe.path());
  ASSERT_TRUE(file);
  const UniqueFd signal(::eventfd(1, EFD_CLOEXEC));
  file->give_up_after(signal.value());
  std::string expected;
  for (const std::size_t size : {10U, 4'000U, 4'096U, 5'000U, 300'000U, 1U, 4'097U}) {
    const std::string record(size, static_cast<char>('a' + size % 26));
    ASSERT_TRUE(file->append(bytes_of(record)));
    expected += record;
  }
  const auto start = std::chrono::steady_clock::now();
  std::future<bool> flushed = std::async(std::launch::async, [&file] { return file->flush().has_value(); });
  std::string written;
  while (flushed.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready)
    written += pipe.read_all();
  const bool whole = flushed.get();
  if (!whole && std::chrono::steady_clock::now() - start >= RecordWriter::kGrace) {
    GTEST_SKIP() << "the machine suspended this test for longer than the grace period";
  }
  EXPECT_TRUE(whole);
  written += pipe.read_all();
  EXPECT_TRUE(written == expected) << written.size();
}

TEST(RecordWriter, ReportsFullDiskAndMissingDirectory) {
  auto file = RecordWriter::create("/dev/full");
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->append(bytes_of("x")));
  const Expected<void> flushed = file->flush();
  ASSERT_FALSE(flushed);
  EXPECT_THAT(flushed.error().message(), HasSubstr("the disk is full"));
  const auto missing = RecordWriter::create("/no/such/directory/x");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message(), HasSubstr("the directory does not exist"));
}

}  // namespace
}  // namespace buoyancy
