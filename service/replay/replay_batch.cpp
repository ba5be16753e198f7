#include "service/replay/replay_batch.h"

#include <utility>

namespace buoyancy {

ReplayBatch::ReplayBatch(const Scene& scene, const OutputLayout& layout, bool keep_responses)
    : handler_(scene, {.threads = 1}), keep_responses_(keep_responses), records_(layout) {}

void ReplayBatch::clear() {
  items_.clear();
  bytes_.clear();
  records_.clear();
  warnings_.clear();
  responses_.clear();
  hydrostatics_.clear();
}

ReplayBatch::Item& ReplayBatch::add(Kind kind, std::int64_t timestamp, Bytes message) {
  Item& item = items_.emplace_back();
  item.kind = kind;
  item.timestamp = timestamp;
  item.start = bytes_.size();
  item.size = message.size();
  bytes_.insert(bytes_.end(), message.begin(), message.end());
  return item;
}

void ReplayBatch::add_request(std::int64_t timestamp, Bytes request, std::string_view force_torque_channel) {
  add(Kind::kRequest, timestamp, request).channel = force_torque_channel;
}

void ReplayBatch::add_rejected_pose(std::int64_t timestamp, DecodeError cause) {
  add(Kind::kRejectedPose, timestamp, {}).cause = cause;
}

void ReplayBatch::add_copy(std::int64_t timestamp, std::string_view channel, Bytes bytes) {
  add(Kind::kCopy, timestamp, bytes).text = channel;
}

void ReplayBatch::add_warning(std::string warning) {
  add(Kind::kWarning, 0, {}).text = std::move(warning);
}

void ReplayBatch::response() {
  handler_.reset();
  for (Item& item : items_) {
    switch (item.kind) {
      case Kind::kRequest:
        response_request(item);
        break;
      case Kind::kRejectedPose:
        handler_.record_rejected(item.cause);
        reject(item, "pose", item.cause);
        break;
      case Kind::kCopy:
        records_.add_event(item.timestamp, item.text, message_of(item));
        ++copied_;
        break;
      case Kind::kWarning:
        warnings_.push_back(std::move(item.text));
        break;
    }
  }
}

void ReplayBatch::response_request(const Item& item) {
  const Bytes request = message_of(item);
  const Bytes response = handler_.handle(request);
  if (response.empty()) {
    reject(item, "request", peek_request_id(request).error());
    return;
  }
  records_.add_response(item.timestamp, response, handler_.last_hydrostatics(), item.channel);
  if (keep_responses_) {
    responses_.add(response);
    if (const Bytes hydrostatics = handler_.last_hydrostatics(); !hydrostatics.empty()) {
      hydrostatics_.add(hydrostatics);
    }
  }
}

void ReplayBatch::reject(const Item& item, const char* what, DecodeError cause) {
  warnings_.push_back("event at " + std::to_string(item.timestamp) + " us is no " + what + ": " +
                      to_string(cause));
}

}  // namespace buoyancy
