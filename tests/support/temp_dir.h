// A temporary directory that the destructor removes with its contents. If it cannot be removed, a process
// that still writes into it was left behind, and the program is aborted (programs without GoogleTest use this
// too).
#pragma once

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include "tests/support/timeouts.h"

namespace buoyancy {

class TempDir {
 public:
  TempDir() {
    std::string pattern = (std::filesystem::temp_directory_path() / "buoyancy_test_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("cannot create directory " + pattern);
    path_ = pattern;
  }
  TempDir(const TempDir&) = delete;
  TempDir& operator=(const TempDir&) = delete;
  ~TempDir() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(kWaitTimeout);
    std::error_code error;
    // The removal fails if a file is created meanwhile.
    while (std::filesystem::remove_all(path_, error), error) {
      if (std::chrono::steady_clock::now() >= deadline) {
        std::fprintf(stderr, "temporary directory %s cannot be removed: %s\n", path_.c_str(),
                     error.message().c_str());
        std::abort();
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }

  const std::filesystem::path& path() const { return path_; }
  std::string path(const std::string& name) const { return (path_ / name).string(); }

  // Writes a file and returns its path.
  std::string write(const std::string& name, std::string_view contents) const {
    std::ofstream(path(name), std::ios::binary).write(contents.data(), static_cast<long>(contents.size()));
    return path(name);
  }

 private:
  std::filesystem::path path_;
};

// Returns the contents of a file as far as it can be read: nothing if there is no such file, or if it is one
// in /proc whose process ends before it is read.
inline std::string read_file(const std::filesystem::path& path) {
  std::ostringstream contents;
  contents << std::ifstream(path, std::ios::binary).rdbuf();
  return contents.str();
}

}  // namespace buoyancy
