// What a replay writes: answers, to an LCM log or as CSV. Made into records on any thread, written in order.
// Hydrostatics, of bodies that ask for them, go to a log alone: a row of the CSV is a wrench.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/request.h"
#include "messages/wire.h"
#include "recording/record_writer.h"
#include "service/replay/replay_input.h"

namespace buoyancy {

// How answers are written.
struct OutputLayout {
  FileFormat format = FileFormat::kCsv;
  std::string wrenches_channel;  // of the events, in a log
  std::string hydrostatics_channel;
};

// Events or rows, one after the other.
class OutputRecords {
 public:
  explicit OutputRecords(OutputLayout layout) : layout_(std::move(layout)) {}

  void clear();
  // timestamp: of the log's events; answer and hydrostatics as the service would publish them, of these
  // nothing where they are empty. force_torque_channel: where, in a log, the response goes as a
  // six_axis_force_torque_t; empty: it goes as it is.
  void add_response(std::int64_t timestamp, Bytes response, Bytes hydrostatics,
                    std::string_view force_torque_channel);
  // An event as it was. To a log only.
  void add_event(std::int64_t timestamp, std::string_view channel, Bytes bytes);

 private:
  friend class ReplayOutput;

  void append(Bytes record);

  OutputLayout layout_;
  std::vector<std::uint8_t> bytes_;
  std::vector<std::size_t> ends_;      // of the records, in bytes_
  std::vector<std::uint8_t> event_;    // reused
  std::vector<std::uint8_t> message_;  // reused
  WrenchResponse response_;            // reused
  std::string row_;                    // reused
};

class ReplayOutput {
 public:
  // Creates or empties the file. Errors: as of RecordWriter.
  static Expected<ReplayOutput> create(const std::filesystem::path& path, FileFormat format);

  // As RecordWriter has it.
  void give_up_after(int signal) { file_.give_up_after(signal); }

  // Numbers a log's events. Errors: disk full, given up.
  Expected<void> write(OutputRecords& records);
  Expected<void> flush() { return file_.flush(); }

 private:
  ReplayOutput(RecordWriter file, FileFormat format) : file_(std::move(file)), format_(format) {}

  RecordWriter file_;
  FileFormat format_;
  std::int64_t events_ = 0;
};

}  // namespace buoyancy
