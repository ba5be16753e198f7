#include "service/replay/replay_input.h"

#include <algorithm>
#include <utility>

namespace buoyancy::service {
namespace {

// The hash lags behind the reader by at most this, so that most of what it takes is still in the reader's
// memory.
constexpr std::size_t kMaxHashLag = 65'536;  // [bytes]

}  // namespace

Expected<ReplayInput> ReplayInput::open(const std::filesystem::path& path, FileFormat format,
                                        ChannelFilter wanted, const TableOptions& table) {
  if (format == FileFormat::kCsv) {
    Expected<StateCsvReader> reader = StateCsvReader::open(path, table);
    if (!reader) return tl::unexpected(reader.error());
    return ReplayInput(std::move(*reader));
  }
  Expected<EventLogReader> reader = EventLogReader::open(path, std::move(wanted));
  if (!reader) return tl::unexpected(reader.error());
  return ReplayInput(std::move(*reader));
}

ReplayInput::ReplayInput(Reader reader)
    : reader_(std::move(reader)), block_size_(block_size(file().size())), block_end_(block_size_) {}

Expected<void> ReplayInput::restrict_to(const Part& part, std::optional<std::int64_t> start) {
  const PartLimits limits = part_limits(part, size());
  if (part.number > 1) {
    auto* log = std::get_if<EventLogReader>(&reader_);
    if (log != nullptr && start) {
      log->seek_to(*start);
    } else {
      std::visit([&limits](auto& reader) { reader.seek(limits.begin); }, reader_);
    }
    begin_ = position();
  }
  end_ = limits.end;
  block_end_ = std::min(limits.begin + block_size_, end_);
  Expected<FileWindow> window = file().duplicate(kMaxHashLag);
  if (!window) return tl::unexpected(window.error());
  hash_.emplace(std::move(*window), begin_);
  return {};
}

LogItem ReplayInput::next() {
  LogItem item = std::visit([this](auto& reader) { return reader.next(block_end_); }, reader_);
  if (hash_ && position() - hash_->end() >= std::int64_t{kMaxHashLag}) update_hash();
  if (!std::holds_alternative<LimitReached>(item)) return item;
  while (block_end_ < end_ && reached(block_end_)) block_end_ = std::min(block_end_ + block_size_, end_);
  if (reached(block_end_)) return EndOfLog{};
  return item;
}

std::int64_t ReplayInput::bytes_expected() const {
  return std::max(std::min(end_, size()), position()) - begin_;
}

void ReplayInput::update_hash() {
  if (hash_error_) return;
  if (const Expected<void> hashed = hash_->extend_to(position(), file()); !hashed)
    hash_error_ = hashed.error();
}

Expected<std::string> ReplayInput::hash() {
  update_hash();
  if (hash_error_) return tl::unexpected(*hash_error_);
  if (file().read_error()) return tl::unexpected(*file().read_error());
  return hash_->hash();
}

}  // namespace buoyancy::service
