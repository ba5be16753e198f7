#include "recording/staged_file.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "recording/record_writer.h"
#include "tests/support/temp_dir.h"

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

class StagedFileTest : public testing::Test {
 protected:
  TempDir directory_;
  const fs::path output_ = directory_.path() / "out.csv";
  const fs::path temporary_ = directory_.path() / "out.csv.tmp";
  const fs::path other_ = directory_.write("other", "precious");
};

TEST_F(StagedFileTest, RefusesTemporaryNameThatIsLinkOrPipe) {
  fs::create_symlink(other_, temporary_);
  EXPECT_FALSE(StagedFile::create(output_));
  fs::remove(temporary_);
  fs::create_symlink(directory_.path() / "none", temporary_);
  EXPECT_FALSE(StagedFile::create(output_));
  EXPECT_FALSE(fs::exists(directory_.path() / "none"));
  fs::remove(temporary_);
  fs::create_hard_link(other_, temporary_);
  EXPECT_FALSE(StagedFile::create(output_));
  fs::remove(temporary_);
  ASSERT_EQ(::mkfifo(temporary_.c_str(), 0600), 0);
  EXPECT_FALSE(StagedFile::create(output_));
  fs::remove(temporary_);
  EXPECT_EQ(read_file(other_), "precious");
}

TEST_F(StagedFileTest, TakesOverWhatKilledProcessLeft) {
  directory_.write("out.csv.tmp", "left behind, longer than what follows");
  auto staged = StagedFile::create(output_);
  ASSERT_TRUE(staged);
  EXPECT_FALSE(StagedFile::create(output_)) << "two processes write one file";
  auto writer = RecordWriter::create(*staged);
  ASSERT_TRUE(writer);
  const std::vector<std::uint8_t> record{'n', 'e', 'w'};
  ASSERT_TRUE(writer->append(record));
  ASSERT_TRUE(writer->flush());
  ASSERT_TRUE(staged->commit());
  EXPECT_EQ(read_file(output_), "new");
  EXPECT_FALSE(fs::exists(temporary_));
}

}  // namespace
}  // namespace buoyancy
