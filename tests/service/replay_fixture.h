// Runs buoyancy-replay as a program on generated logs.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "messages/wire.h"
#include "tests/service/one_box_scene.h"
#include "tests/support/build_paths.h"
#include "tests/support/child_process.h"
#include "tests/support/recorded_log.h"
#include "tests/support/temp_dir.h"
#include "tests/support/timeouts.h"

namespace buoyancy {

class Replay : public testing::Test {
 protected:
  static ChildCommand command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), built_program("buoyancy-replay"));
    return command_of(std::move(arguments));
  }
  FinishedProcess run(std::vector<std::string> arguments) const {
    return run_program("buoyancy-replay", std::move(arguments));
  }
  FinishedProcess replay(const std::string& input, const std::string& output,
                         const std::vector<std::string>& options = {}) const {
    std::vector<std::string> arguments{"--scene", scene_, input, output};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(std::move(arguments));
  }
  std::string path(const std::string& name) const { return directory_.path(name); }
  std::string write(const std::string& name, const std::string& contents) const {
    return directory_.write(name, contents);
  }

  TempDir directory_;
  std::string scene_ = directory_.write("scene.toml", kOneBoxScene);
};

inline std::vector<std::uint8_t> request(std::int64_t utime, double height) {
  WrenchRequest request;
  request.id = {utime, 0, utime};
  request.bodies.resize(1);
  request.bodies[0].body_id = 1;
  request.bodies[0].position = {7.0, 8.0, height};
  request.bodies[0].quaternion_wxyz = {1.0, 0.0, 0.0, 0.0};
  return encoded(request);
}

inline std::string event(const std::string& channel, std::int64_t timestamp,
                         const std::vector<std::uint8_t>& data) {
  RecordedLog log;
  log.add(timestamp, channel, data);
  return log.text();
}

inline std::string log_of_requests(int count) {
  std::string log;
  for (int i = 0; i < count; ++i) log += event("BUOYANCY_STATES", 500 + i, request(i, 0.125 * i));
  return log;
}

struct LoggedEvent {
  std::int64_t timestamp = 0;
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

// The events of a log on the wanted channels.
inline std::vector<LoggedEvent> events_of(const std::string& path, ChannelFilter wanted) {
  auto reader = EventLogReader::open(path, std::move(wanted));
  if (!reader) throw std::runtime_error(reader.error().message());
  std::vector<LoggedEvent> found;
  while (true) {
    const LogItem item = reader->next();
    if (std::holds_alternative<EndOfLog>(item)) return found;
    if (const auto* event = std::get_if<RecordedEvent>(&item)) {
      found.push_back(
          {event->timestamp, std::string(event->channel), {event->bytes.begin(), event->bytes.end()}});
    }
  }
}

inline std::vector<LoggedEvent> events_of(const std::string& path) {
  return events_of(path, [](std::string_view) { return true; });
}

}  // namespace buoyancy
