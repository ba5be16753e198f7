// What a replay writes: answers, to an LCM log or as CSV.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "geometry/error.h"
#include "messages/question.h"
#include "messages/wire.h"
#include "service/record_file.h"
#include "service/replay_input.h"

namespace buoyancy {

class ReplayOutput {
 public:
  // Creates or empties the file. wrenches_channel: of the events, in a log. Errors: as of RecordFile.
  static Expected<ReplayOutput> create(const std::filesystem::path& path, FileFormat format,
                                       const std::string& wrenches_channel);

  // timestamp: of the log's event; bytes: the answer as the service would publish it. Errors: disk full.
  Expected<void> write(std::int64_t timestamp, Bytes bytes);
  Expected<void> flush() { return file_.flush(); }

 private:
  ReplayOutput(RecordFile file, FileFormat format, std::string wrenches_channel);

  RecordFile file_;
  FileFormat format_;
  std::string wrenches_channel_;
  std::int64_t events_ = 0;
  std::vector<std::uint8_t> event_;  // reused
  Answer answer_;                    // reused
  std::string row_;                  // reused
};

}  // namespace buoyancy
