// A directory that is there for one test and gone after it. A directory that cannot be removed ends the
// program with SIGABRT, since this serves programs without GoogleTest too: a process that still writes into
// it was left behind.
#pragma once

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "tests/support/timeouts.h"

namespace buoyancy {

class ScratchDirectory {
 public:
  ScratchDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "buoyancy_test_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no directory " + pattern);
    path_ = pattern;
  }
  ScratchDirectory(const ScratchDirectory&) = delete;
  ScratchDirectory& operator=(const ScratchDirectory&) = delete;
  ~ScratchDirectory() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
    std::error_code error;
    // A file that appears while the directory is emptied makes the removal fail.
    while (std::filesystem::remove_all(path_, error), error) {
      if (std::chrono::steady_clock::now() >= deadline) {
        std::fprintf(stderr, "scratch directory %s cannot be removed: %s\n", path_.c_str(),
                     error.message().c_str());
        std::abort();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  std::string path(const std::string& name) const { return (path_ / name).string(); }

  // The new file's path.
  std::string write(const std::string& name, std::string_view contents) const {
    std::ofstream(path(name), std::ios::binary).write(contents.data(), static_cast<long>(contents.size()));
    return path(name);
  }

 private:
  std::filesystem::path path_;
};

inline std::string contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace buoyancy
