#include "recording/record_file.h"

#include <csignal>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "tests/service/scratch_directory.h"

namespace buoyancy {
namespace {

Bytes bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// While it lives, no file of this process grows beyond `bytes`: what a full disk does, without one.
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

TEST(RecordFile, WritesRecordsInOrder) {
  const ScratchDirectory directory;
  const std::string path = directory.write("x", "what was there before, which goes");
  auto file = RecordFile::create(path);
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
  EXPECT_EQ(contents_of(path), expected);
}

TEST(RecordFile, EndsAtARecordsEndWhereTheDiskIsFull) {
  const ScratchDirectory directory;
  for (const rlim_t limit : {1'000'000U, 1'048'576U, 1'500'007U, 5U}) {
    auto file = RecordFile::create(directory.path("x"));
    ASSERT_TRUE(file);
    Expected<void> written;
    {
      const FileSizeLimit full(limit);
      for (int i = 0; i < 1'000'000 && written; ++i) written = file->append(bytes_of("0123456789"));
    }
    ASSERT_FALSE(written);
    EXPECT_NE(written.error().message().find("could not be written"), std::string::npos);
    EXPECT_EQ(contents_of(directory.path("x")).size(), limit / 10 * 10);
  }
}

TEST(RecordFile, SaysWhatIsWrongWithTheDisk) {
  auto file = RecordFile::create("/dev/full");
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->append(bytes_of("x")));
  const Expected<void> flushed = file->flush();
  ASSERT_FALSE(flushed);
  EXPECT_NE(flushed.error().message().find("the disk is full"), std::string::npos)
      << flushed.error().message();
  const auto missing = RecordFile::create("/no/such/directory/x");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message().find("the directory does not exist"), std::string::npos);
}

}  // namespace
}  // namespace buoyancy
