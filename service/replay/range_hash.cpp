#include "service/replay/range_hash.h"

#include <algorithm>

namespace buoyancy::service {

Expected<void> RangeHash::extend_to(std::int64_t end) {
  return extend_to(end, file_);
}

Expected<void> RangeHash::extend_to(std::int64_t end, const FileWindow& reader) {
  while (end_ < end) {
    Bytes bytes = reader.buffered(end_);
    if (bytes.empty()) bytes = file_.read_at(end_, 1);
    if (bytes.empty()) {
      if (file_.read_error()) return tl::unexpected(*file_.read_error());
      return make_error({file_.path().string(), "ends at byte " + std::to_string(end_),
                         std::to_string(end) + " bytes", "the file has been changed since it was opened",
                         "Run the replay again"});
    }
    const auto count = std::min(static_cast<std::size_t>(end - end_), bytes.size());
    hash_.update(bytes.first(count));
    end_ += static_cast<std::int64_t>(count);
  }
  return {};
}

}  // namespace buoyancy::service
