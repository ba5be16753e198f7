// Checks that every mesh import error has to pass, and a fixture that detects leaked descriptors and
// processes.
#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>

#include "geometry/mesh_import.h"
#include "tests/geometry/mesh_files.h"
#include "tests/support/contains.h"

namespace buoyancy {

// Requires a one-line message in printable characters with the file, the actual and the expected value.
inline void expect_complete_error(const Error& error, const std::filesystem::path& file) {
  const std::string message = error.message();
  EXPECT_EQ(error.subject, file.string());
  EXPECT_EQ(message.rfind(file.string() + ": ", 0), 0U) << message;
  EXPECT_FALSE(error.actual.empty()) << message;
  EXPECT_FALSE(error.expected.empty()) << message;
  for (const char c : error.actual + error.expected + error.cause + error.hint) {
    EXPECT_TRUE(c >= ' ' && c <= '~') << message;
  }
}

// Returns the error's message; fails the test if the import succeeds.
inline std::string import_error(const std::filesystem::path& file, const ImportLimits& limits = {}) {
  const Expected<ImportedMesh> result = import_mesh(file, limits);
  if (result) {
    ADD_FAILURE() << file << " was imported: " << result->mesh.triangles.size() << " triangles";
    return "";
  }
  expect_complete_error(result.error(), file);
  return result.error().message();
}

inline void expect_mesh_or_complete_error(const std::filesystem::path& file, const ImportLimits& limits) {
  const Expected<ImportedMesh> result = import_mesh(file, limits);
  if (!result) return expect_complete_error(result.error(), file);
  EXPECT_FALSE(result->mesh.triangles.empty()) << file;
  const auto vertices = static_cast<std::int32_t>(result->mesh.vertex_count());
  for (const Triangle& triangle : result->mesh.triangles) {
    for (const std::int32_t i : triangle) ASSERT_TRUE(i >= 0 && i < vertices) << file;
  }
}

inline std::size_t open_descriptors() {
  const std::filesystem::directory_iterator descriptors("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(descriptors), end(descriptors)));
}

// Requires that no descriptor and no child process outlives an import.
class ImportTest : public testing::Test {
 protected:
  ~ImportTest() override {
    EXPECT_EQ(open_descriptors(), descriptors_before_);
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child was left behind";
    EXPECT_EQ(errno, ECHILD);
  }

  TempDir directory_;

 private:
  std::size_t descriptors_before_ = open_descriptors();
};

}  // namespace buoyancy
