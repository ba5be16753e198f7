// The processes that the network benchmarks measure: buoyancyd and its echo, each alone on a port of its own,
// so that nobody is woken by what concerns him not.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <sched.h>

#include "fail.h"
#include "scene/scene.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"

namespace buoyancy::bench {

inline Scene scene_of(const std::string& text) {
  return value_or_exit(Scene::prepare(value_or_exit(parse_scene(text, "benchmark", {}))));
}

// `count` bodies of the same shape or mesh file, with the ids 1 to count.
inline std::string bodies_of(int count, const std::string& what) {
  std::string text;
  for (int id = 1; id <= count; ++id) text += "[[body]]\nid = " + std::to_string(id) + "\n" + what + "\n";
  return text;
}

// A program that says "ready", and has said so when this is constructed. Killed by the destructor.
class ReadyProcess {
 public:
  explicit ReadyProcess(std::vector<std::string> command) : child_(command_of(std::move(command))) {
    if (!child_.wait_for_text("ready", 60.0)) fail(child_.standard_error());
  }
  ChildProcess& child() { return child_; }

 private:
  ChildProcess child_;
};

inline std::string url_of_port(int port) {
  return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
}

inline constexpr int kServicePort = 7667;
inline constexpr int kEchoPort = 7668;

// While it lives, everything that is started has one processor for all of it: a round trip then wakes no
// other one, which is dear on a virtual machine, and happens or not as the kernel's scheduler likes.
class PinToOneCpu {
 public:
  PinToOneCpu() {
    ::sched_getaffinity(0, sizeof before_, &before_);
    int first = 0;
    while (CPU_ISSET(first, &before_) == 0) ++first;
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(first, &one);
    ::sched_setaffinity(0, sizeof one, &one);
  }
  PinToOneCpu(const PinToOneCpu&) = delete;
  PinToOneCpu& operator=(const PinToOneCpu&) = delete;
  ~PinToOneCpu() { ::sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_{};
};

class ServiceProcess {
 public:
  explicit ServiceProcess(const std::string& scene, const std::string& mode = "lockstep")
      : process_({BUOYANCYD, "--scene", directory_.write("scene.toml", scene), "-l",
                  url_of_port(kServicePort), "--mode", mode}) {}
  ChildProcess& child() { return process_.child(); }

 private:
  TempDir directory_;
  ReadyProcess process_;
};

class EchoProcess {
 public:
  explicit EchoProcess(int bodies) : process_({LCM_ECHO, url_of_port(kEchoPort), std::to_string(bodies)}) {}

 private:
  ReadyProcess process_;
};

}  // namespace buoyancy::bench
