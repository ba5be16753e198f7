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
                                            const std::string& wrenches_channel) {
  Expected<RecordFile> file = RecordFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (format == FileFormat::kCsv) {
    if (const Expected<void> written = file->append(bytes_of(kWrenchCsvHeader)); !written) {
      return tl::unexpected(written.error());
    }
  }
  return ReplayOutput(std::move(*file), format, wrenches_channel);
}

ReplayOutput::ReplayOutput(RecordFile file, FileFormat format, std::string wrenches_channel)
    : file_(std::move(file)), format_(format), wrenches_channel_(std::move(wrenches_channel)) {}

Expected<void> ReplayOutput::write(std::int64_t timestamp, Bytes bytes) {
  if (format_ == FileFormat::kLcmLog) {
    encode_event(events_++, timestamp, wrenches_channel_, bytes, event_);
    return file_.append(event_);
  }
  [[maybe_unused]] const auto rejected = decode(bytes, answer_);
  assert(!rejected);  // we encoded it
  for (const BodyWrench& wrench : answer_.bodies) {
    format_wrench_row(answer_.key.utime, wrench, row_);
    if (Expected<void> written = file_.append(bytes_of(row_)); !written) return written;
  }
  return {};
}

}  // namespace buoyancy
