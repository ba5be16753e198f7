// Owns a file descriptor and closes it on destruction.
#pragma once

#include <utility>

#include <unistd.h>

namespace buoyancy {

class UniqueFd {
 public:
  UniqueFd() = default;
  explicit UniqueFd(int value) : value_(value) {}  // takes ownership; negative: no descriptor
  UniqueFd(UniqueFd&& other) noexcept : value_(std::exchange(other.value_, -1)) {}
  UniqueFd& operator=(UniqueFd&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~UniqueFd() {
    if (value_ >= 0) ::close(value_);
  }

  int value() const { return value_; }
  bool valid() const { return value_ >= 0; }
  bool close() { return ::close(std::exchange(value_, -1)) == 0; }  // false: errno holds the cause

 private:
  int value_ = -1;
};

}  // namespace buoyancy
