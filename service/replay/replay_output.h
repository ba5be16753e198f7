// The output of a replay: responses, to an LCM log or as CSV. Records are encoded on any thread and written
// in order. Hydrostatics and loads of the bodies that request them, and samples of the water, are written to
// a log only: a row of the CSV is a wrench. Loads can be written to a CSV file of their own besides.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/body_csv.h"
#include "messages/loads.h"
#include "messages/request.h"
#include "messages/wire.h"
#include "recording/record_writer.h"
#include "service/replay/content_hash.h"
#include "service/replay/replay_input.h"
#include "service/replay/replay_part.h"

namespace buoyancy::service {

struct OutputLayout {
  FileFormat format = FileFormat::kCsv;
  std::string wrenches_channel;  // the channels: logs only
  std::string hydrostatics_channel;
  std::string loads_channel;
  std::string water_samples_channel;
  bool loads_csv = false;  // also write the loads as rows of a CSV file of their own
};

// What the service would publish for a request. hydrostatics and loads: empty if no body has that output.
struct ResponseBytes {
  Bytes response, hydrostatics, loads;
};

// Encoded events or CSV rows, in order.
class Records {
 public:
  void clear();
  void append(Bytes record);
  // Appends the row of a body.
  template <typename Body>
  void append_row(std::int64_t utime, const Body& body) {
    append_csv_row(utime, body, bytes_);
    ends_.push_back(bytes_.size());
  }

 private:
  friend class ReplayOutput;

  std::string bytes_;
  std::vector<std::size_t> ends_;  // end of each record in bytes_
};

// The records of OUTPUT.
class OutputRecords : public Records {
 public:
  explicit OutputRecords(OutputLayout layout) : layout_(std::move(layout)) {}

  // timestamp: of the log's events [us]. force_torque_channel: the channel of a log to which the response is
  // written as a six_axis_force_torque_t; empty: it is written as a body_wrenches_t.
  void add_response(std::int64_t timestamp, const ResponseBytes& published,
                    std::string_view force_torque_channel);
  // Adds a water_samples_t to a log; CSV has no row for it.
  void add_samples(std::int64_t timestamp, Bytes samples);
  // Copies an event unchanged; to a log only.
  void add_event(std::int64_t timestamp, std::string_view channel, Bytes bytes);

 private:
  OutputLayout layout_;
  std::vector<std::uint8_t> event_;    // reused
  std::vector<std::uint8_t> message_;  // reused
  WrenchResponse response_;            // reused
};

// The rows of a CSV file of loads.
class LoadsRecords : public Records {
 public:
  void add(Bytes loads);  // a row for each body; none if there are no bytes

 private:
  BodiesLoads loads_;  // reused
};

class ReplayOutput {
 public:
  // What was written.
  struct Contents {
    std::int64_t bytes = 0;
    std::int64_t events = 0;  // of a log
    ContentHash hash;
  };

  // Creates or truncates the file. Errors: see RecordWriter.
  static Expected<ReplayOutput> create(const std::filesystem::path& path, FileFormat format);
  // Creates the output of a part (replay_part.h), which keeps account of its contents.
  static Expected<ReplayOutput> create_part(const StagedFile& staged, FileFormat format, const Part& part);
  // Creates or truncates the CSV file of loads.
  static Expected<ReplayOutput> create_loads(const std::filesystem::path& path);

  // See RecordWriter.
  void give_up_after(int signal) { file_.give_up_after(signal); }

  // Sets the event numbers of a log. Errors: disk full, given up.
  Expected<void> write(Records& records);
  Expected<void> flush() { return file_.flush(); }

  const Contents& contents() const { return contents_; }  // of a part

 private:
  ReplayOutput(RecordWriter file, FileFormat format, bool is_part)
      : file_(std::move(file)), format_(format), is_part_(is_part) {}
  Expected<void> write_csv_header(std::string_view columns);
  void count(Bytes bytes);

  RecordWriter file_;
  FileFormat format_;
  bool is_part_;
  Contents contents_;  // bytes and hash: of a part only
};

}  // namespace buoyancy::service
