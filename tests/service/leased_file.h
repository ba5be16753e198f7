// A file that blocks every process that opens it: a test uses it to make a load last as long as it wants.
#pragma once

#include <csignal>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "base/unique_fd.h"

namespace buoyancy {

// Holds a Linux file lease (fcntl(2)), which blocks open() in other processes until it is released, at most
// for /proc/sys/fs/lease-break-time (45 s by default).
class LeasedFile {
 public:
  explicit LeasedFile(const std::string& path) : file_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    // The kernel signals that a process waits with SIGIO, which would end the test; SIGURG is ignored.
    held_ = ::fcntl(file_.value(), F_SETSIG, SIGURG) == 0 && ::fcntl(file_.value(), F_SETLEASE, F_WRLCK) == 0;
  }
  bool held() const { return held_; }  // false: the file system has no leases
  // Does a process wait for the file?
  bool awaited() const { return ::fcntl(file_.value(), F_GETLEASE) != F_WRLCK; }
  void release() { ::fcntl(file_.value(), F_SETLEASE, F_UNLCK); }

 private:
  UniqueFd file_;
  bool held_ = false;
};

// Why a test that needs a lease on the file is skipped.
inline std::string no_lease_on(const std::string& path) {
  return "the file system of " + path + " has no leases; set TMPDIR to a directory on another one, such as " +
         "ext4 or tmpfs";
}

}  // namespace buoyancy
