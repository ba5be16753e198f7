// The processes that the network benchmarks measure: buoyancyd and the echo, each alone on its own port, so
// that no process is woken by messages for another one.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <sched.h>

#include "fail.h"
#include "scene/scene.h"
#include "tests/support/build_paths.h"
#include "tests/support/child_process.h"
#include "tests/support/temp_dir.h"

namespace buoyancy::bench {

inline Scene scene_of(const std::string& text) {
  return value_or_exit(Scene::prepare(value_or_exit(parse_scene(text, "benchmark", {}))));
}

// Scene text of `count` bodies with the ids 1 to count. source: their shape or mesh line.
inline std::string bodies_of(int count, const std::string& source) {
  std::string text;
  for (int id = 1; id <= count; ++id) text += "[[body]]\nid = " + std::to_string(id) + "\n" + source + "\n";
  return text;
}

// A program that prints "ready"; the constructor waits for that line. The destructor kills the program.
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

// Pins this thread, and every process that it starts, to one processor during the object's lifetime. A round
// trip then never wakes another processor, which is expensive on a virtual machine and depends on the
// kernel's scheduler.
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
      : process_({built_program("buoyancyd"), "--scene", directory_.write("scene.toml", scene), "-l",
                  url_of_port(kServicePort), "--mode", mode}) {}
  ChildProcess& child() { return process_.child(); }

 private:
  TempDir directory_;
  ReadyProcess process_;
};

class EchoProcess {
 public:
  explicit EchoProcess(int bodies)
      : process_({built_program("lcm_echo"), url_of_port(kEchoPort), std::to_string(bodies)}) {}

 private:
  ReadyProcess process_;
};

}  // namespace buoyancy::bench
