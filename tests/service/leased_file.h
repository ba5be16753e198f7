// A file that whoever opens it has to wait for: what makes a load last exactly as long as a test wants.
#pragma once

#include <csignal>
#include <string>

#include <fcntl.h>
#include <unistd.h>

#include "base/unique_fd.h"

namespace buoyancy {

// By a lease of Linux's (fcntl(2)), which blocks the open() of others until it is given up, or for
// /proc/sys/fs/lease-break-time, 45 s where nobody changed it.
class LeasedFile {
 public:
  explicit LeasedFile(const std::string& path) : file_(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    // The kernel says that somebody waits, by a signal that would end us: by one that does not.
    delay_line_ =
        ::fcntl(file_.value(), F_SETSIG, SIGURG) == 0 && ::fcntl(file_.value(), F_SETLEASE, F_WRLCK) == 0;
  }
  bool held() const { return delay_line_; }  // false: the file system has no leases
  // Does somebody wait for it?
  bool awaited() const { return ::fcntl(file_.value(), F_GETLEASE) != F_WRLCK; }
  void let_go() { ::fcntl(file_.value(), F_SETLEASE, F_UNLCK); }

 private:
  UniqueFd file_;
  bool delay_line_ = false;
};

}  // namespace buoyancy
