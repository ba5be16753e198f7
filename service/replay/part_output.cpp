#include "service/replay/part_output.h"

#include <utility>

namespace buoyancy::service {
namespace {

// The sessions whose requests the replay numbers: one per pose channel, or that of the rows of a CSV.
std::map<std::int64_t, std::int64_t> numbered_requests(const ReplayTask& task, const ReplaySummary& summary) {
  if (task.input.format() == FileFormat::kCsv) return {{kCsvSession, summary.counters.requests}};
  std::map<std::int64_t, std::int64_t> numbered;
  for (std::size_t i = 0; i < task.poses.channels().size(); ++i) {
    numbered[task.poses.session_of(i)] = task.poses.next_seq(i);
  }
  return numbered;
}

}  // namespace

std::optional<std::int64_t> end_of_part_before(const Part& part, const std::filesystem::path& output,
                                               const ReplayFacts& facts) {
  if (part.number == 1) return std::nullopt;
  const Part before{part.number - 1, part.count};
  const Expected<PartManifest> manifest = read_manifest(part_path(output, before));
  if (!manifest || manifest->part != before || manifest->facts != facts) return std::nullopt;
  return manifest->input_end;
}

Expected<PartOutput> PartOutput::create(const std::filesystem::path& output, FileFormat format,
                                        const Part& part, ReplayFacts facts) {
  const std::filesystem::path path = part_path(output, part);
  Expected<StagedFile> staged = StagedFile::create(path);
  if (!staged) return tl::unexpected(staged.error());
  Expected<ReplayOutput> responses = ReplayOutput::create_part(*staged, format, part);
  if (!responses) return tl::unexpected(responses.error());
  PartManifest manifest;
  manifest.part = part;
  manifest.facts = std::move(facts);
  return PartOutput(std::move(manifest), path, format, std::move(*staged), std::move(*responses));
}

Expected<void> PartOutput::complete(const ReplayTask& task, const ReplaySummary& summary,
                                    std::vector<std::string> input_errors) {
  if (format_ == FileFormat::kLcmLog && summary.requests_in_pose_sessions > 0) {
    return make_error({path_.string(),
                       std::to_string(summary.requests_in_pose_sessions) +
                           " recorded requests have the session_id of a pose channel",
                       "no recorded request in the sessions from " +
                           std::to_string(task.poses.session_of(0)) + " on, which the replay numbers itself",
                       "", "Replay this log as a whole, without --part"});
  }
  const Expected<std::string> input_hash = task.input.hash();
  if (!input_hash) return tl::unexpected(input_hash.error());
  manifest_.input_begin = task.input.begin();
  manifest_.input_end = task.input.position();
  manifest_.input_hash = *input_hash;
  const ReplayOutput::Contents& contents = responses_.contents();
  manifest_.output_bytes = contents.bytes;
  manifest_.output_hash = contents.hash.text();
  manifest_.output_events = contents.events;
  manifest_.numbered_requests = numbered_requests(task, summary);
  manifest_.summary = summary;
  manifest_.input_errors = std::move(input_errors);
  if (task.input.format() == FileFormat::kLcmLog) manifest_.unseen_channels = task.channels.unseen_channels();
  remove_manifest(path_);  // an older one would not belong to the new file
  if (Expected<void> committed = staged_.commit(); !committed) return committed;
  return write_manifest(path_, manifest_);
}

}  // namespace buoyancy::service
