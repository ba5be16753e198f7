// What a replay writes: answers, to an LCM log or as CSV. Hydrostatics, of bodies that ask for them, go to a
// log alone: a row of the CSV is a wrench.
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
  struct Channels {  // of the events, in a log
    std::string wrenches, hydrostatics;
  };

  // Creates or empties the file. Errors: as of RecordFile.
  static Expected<ReplayOutput> create(const std::filesystem::path& path, FileFormat format,
                                       Channels channels);

  // timestamp: of the log's events; answer and hydrostatics as the service would publish them, of these
  // nothing where they are empty. Errors: disk full.
  Expected<void> write(std::int64_t timestamp, Bytes answer, Bytes hydrostatics);
  Expected<void> flush() { return file_.flush(); }

 private:
  ReplayOutput(RecordFile file, FileFormat format, Channels channels);
  Expected<void> write_event(std::int64_t timestamp, const std::string& channel, Bytes bytes);

  RecordFile file_;
  FileFormat format_;
  Channels channels_;
  std::int64_t events_ = 0;
  std::vector<std::uint8_t> event_;  // reused
  Answer answer_;                    // reused
  std::string row_;                  // reused
};

}  // namespace buoyancy
