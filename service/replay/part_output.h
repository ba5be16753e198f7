// The output of one part (replay_part.h): a file and its manifest, both under their names only once the part
// is complete. Whatever ends the program before, the join accepts nothing of the part, and running the part
// again replaces what there is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "recording/staged_file.h"
#include "service/replay/part_manifest.h"
#include "service/replay/replay.h"

namespace buoyancy::service {

// Returns where the part before `part` ended, if its manifest is there and has the same facts. Even where the
// events do not show it (event_log.h), a part that starts there is right if the one before is.
std::optional<std::int64_t> end_of_part_before(const Part& part, const std::filesystem::path& output,
                                               const ReplayFacts& facts);

class PartOutput {
 public:
  // output: that of the join. Errors: see StagedFile and RecordWriter.
  static Expected<PartOutput> create(const std::filesystem::path& output, FileFormat format, const Part& part,
                                     ReplayFacts facts);

  ReplayOutput& responses() { return responses_; }

  // Gives the files their names. task: its replay has come to its end. Errors: the input was not readable as
  // a whole; it holds a request in a session of poses; the disk is full or failed.
  Expected<void> complete(const ReplayTask& task, const ReplaySummary& summary,
                          std::vector<std::string> input_errors);

 private:
  PartOutput(PartManifest manifest, std::filesystem::path path, FileFormat format, StagedFile staged,
             ReplayOutput responses)
      : manifest_(std::move(manifest)),
        path_(std::move(path)),
        format_(format),
        staged_(std::move(staged)),
        responses_(std::move(responses)) {}

  PartManifest manifest_;
  std::filesystem::path path_;
  FileFormat format_;
  StagedFile staged_;
  ReplayOutput responses_;
};

}  // namespace buoyancy::service
