#include "service/replay_output.h"

#include <cassert>
#include <string_view>

#include "service/event_log.h"
#include "service/wrench_csv.h"

namespace buoyancy {
namespace {

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

Expected<ReplayOutput> ReplayOutput::create(const std::filesystem::path& path, FileFormat format,
                                            Channels channels) {
  Expected<RecordFile> file = RecordFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (format == FileFormat::kCsv) {
    if (const Expected<void> written = file->append(bytes_of(kWrenchCsvHeader)); !written) {
      return tl::unexpected(written.error());
    }
  }
  return ReplayOutput(std::move(*file), format, std::move(channels));
}

ReplayOutput::ReplayOutput(RecordFile file, FileFormat format, Channels channels)
    : file_(std::move(file)), format_(format), channels_(std::move(channels)) {}

Expected<void> ReplayOutput::write_event(std::int64_t timestamp, const std::string& channel, Bytes bytes) {
  encode_event(events_++, timestamp, channel, bytes, event_);
  return file_.append(event_);
}

Expected<void> ReplayOutput::write(std::int64_t timestamp, Bytes answer, Bytes hydrostatics) {
  if (format_ == FileFormat::kLcmLog) {
    Expected<void> written = write_event(timestamp, channels_.wrenches, answer);
    if (!written || hydrostatics.empty()) return written;
    return write_event(timestamp, channels_.hydrostatics, hydrostatics);
  }
  [[maybe_unused]] const auto rejected = decode(answer, answer_);
  assert(!rejected);  // we encoded it
  for (const BodyWrench& wrench : answer_.bodies) {
    format_wrench_row(answer_.key.utime, wrench, row_);
    if (Expected<void> written = file_.append(bytes_of(row_)); !written) return written;
  }
  return {};
}

}  // namespace buoyancy
