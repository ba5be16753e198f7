#include "service/replay/replay_output.h"

#include <cassert>
#include <span>

#include "engine/pose_request_adapter.h"
#include "recording/event_log.h"

namespace buoyancy::service {
namespace {

Bytes bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

}  // namespace

void Records::clear() {
  bytes_.clear();
  ends_.clear();
}

void Records::append(Bytes record) {
  bytes_.append(reinterpret_cast<const char*>(record.data()), record.size());
  ends_.push_back(bytes_.size());
}

void OutputRecords::add_event(std::int64_t timestamp, std::string_view channel, Bytes bytes) {
  encode_event(0, timestamp, channel, bytes, event_);
  append(event_);
}

void OutputRecords::add_response(std::int64_t timestamp, const ResponseBytes& published,
                                 std::string_view force_torque_channel) {
  const auto& [response, hydrostatics, loads] = published;
  if (layout_.format == FileFormat::kLcmLog) {
    if (force_torque_channel.empty()) {
      add_event(timestamp, layout_.wrenches_channel, response);
    } else {
      encode_force_torque(response, response_, message_);
      add_event(timestamp, force_torque_channel, message_);
    }
    if (!hydrostatics.empty()) add_event(timestamp, layout_.hydrostatics_channel, hydrostatics);
    if (!loads.empty()) add_event(timestamp, layout_.loads_channel, loads);
    return;
  }
  [[maybe_unused]] const auto rejected = decode(response, response_);
  assert(!rejected);  // the handler encoded it
  for (const BodyWrench& wrench : response_.bodies) append_row(response_.id.utime, wrench);
}

void OutputRecords::add_samples(std::int64_t timestamp, Bytes samples) {
  if (layout_.format == FileFormat::kLcmLog) add_event(timestamp, layout_.water_samples_channel, samples);
}

void LoadsRecords::add(Bytes loads) {
  if (loads.empty()) return;
  [[maybe_unused]] const auto rejected = decode(loads, loads_);
  assert(!rejected);  // the handler encoded it
  for (const BodyLoads& body : loads_.bodies) append_row(loads_.id.utime, body);
}

Expected<ReplayOutput> ReplayOutput::create(const std::filesystem::path& path, FileFormat format) {
  Expected<RecordWriter> file = RecordWriter::create(path);
  if (!file) return tl::unexpected(file.error());
  ReplayOutput output(std::move(*file), format, false);
  if (const Expected<void> written = output.write_csv_header(csv_header<BodyWrench>()); !written) {
    return tl::unexpected(written.error());
  }
  return output;
}

Expected<ReplayOutput> ReplayOutput::create_part(const StagedFile& staged, FileFormat format,
                                                 const Part& part) {
  Expected<RecordWriter> file = RecordWriter::create(staged);
  if (!file) return tl::unexpected(file.error());
  ReplayOutput output(std::move(*file), format, true);
  if (part.number > 1) return output;
  if (const Expected<void> written = output.write_csv_header(csv_header<BodyWrench>()); !written) {
    return tl::unexpected(written.error());
  }
  return output;
}

Expected<ReplayOutput> ReplayOutput::create_loads(const std::filesystem::path& path) {
  Expected<RecordWriter> file = RecordWriter::create(path);
  if (!file) return tl::unexpected(file.error());
  ReplayOutput output(std::move(*file), FileFormat::kCsv, false);
  if (const Expected<void> written = output.write_csv_header(csv_header<BodyLoads>()); !written) {
    return tl::unexpected(written.error());
  }
  return output;
}

Expected<void> ReplayOutput::write_csv_header(std::string_view columns) {
  if (format_ != FileFormat::kCsv) return {};
  const std::string header = std::string(columns) + "\n";
  if (is_part_) count(bytes_of(header));
  return file_.append(bytes_of(header));
}

Expected<void> ReplayOutput::write(Records& records) {
  const std::span bytes(reinterpret_cast<std::uint8_t*>(records.bytes_.data()), records.bytes_.size());
  std::size_t start = 0;
  for (const std::size_t end : records.ends_) {
    const std::span<std::uint8_t> record = bytes.subspan(start, end - start);
    if (format_ == FileFormat::kLcmLog) renumber_event(contents_.events++, record);
    if (Expected<void> written = file_.append(record); !written) return written;
    start = end;
  }
  if (is_part_) count(bytes);
  return {};
}

void ReplayOutput::count(Bytes bytes) {
  contents_.hash.update(bytes);
  contents_.bytes += static_cast<std::int64_t>(bytes.size());
}

}  // namespace buoyancy::service
