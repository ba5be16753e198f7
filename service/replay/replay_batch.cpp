#include "service/replay/replay_batch.h"

#include <utility>

namespace buoyancy::service {
namespace {

std::string event_error(std::int64_t timestamp, const Error& error) {
  return "event at " + std::to_string(timestamp) + " us: " + error.message();
}

}  // namespace

ReplayBatch::ReplayBatch(const Scene& scene, const OutputLayout& layout, bool keep_responses)
    : handler_(scene, {.threads = 1, .checks_motion = false}),  // the reader checks it, in order
      loads_csv_(layout.loads_csv),
      keep_responses_(keep_responses),
      conditions_(scene),
      records_(layout) {}

void ReplayBatch::start(SeaTimeline seas, ConditionTimeline conditions) {
  items_.clear();
  grid_bytes_ = 0;
  seas_.clear();
  seas_.push_back(std::move(seas));
  conditions_ = std::move(conditions);
  bytes_.clear();
  records_.clear();
  loads_records_.clear();
  input_errors_.clear();
  responses_.clear();
  hydrostatics_.clear();
  loads_.clear();
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
  add(Kind::kRequest, timestamp, request).force_torque_channel = force_torque_channel;
}

void ReplayBatch::add_rejected(std::int64_t timestamp, const char* expected, DecodeError cause) {
  Item& item = add(Kind::kRejected, timestamp, {});
  item.text = expected;
  item.cause = cause;
}

void ReplayBatch::add_copy(std::int64_t timestamp, std::string_view channel, Bytes bytes) {
  add(Kind::kCopy, timestamp, bytes).text = channel;
}

void ReplayBatch::add_seas(std::int64_t timestamp, SeaTimeline seas, std::size_t grid_bytes) {
  grid_bytes_ += grid_bytes;
  add(Kind::kSeas, timestamp, {}).seas = seas_.size();
  seas_.push_back(std::move(seas));
}

void ReplayBatch::add_rejected_sea(std::int64_t timestamp, const Error& error) {
  add(Kind::kRejectedSea, timestamp, {}).text = event_error(timestamp, error);
}

void ReplayBatch::add_condition(std::int64_t timestamp, Bytes message) {
  add(Kind::kCondition, timestamp, message);
}

void ReplayBatch::add_input_error(std::string error) {
  add(Kind::kInputError, 0, {}).text = std::move(error);
}

void ReplayBatch::evaluate() {
  handler_.reset();
  handler_.set_seas(seas_.front());
  handler_.set_conditions(std::move(conditions_));
  for (Item& item : items_) {
    switch (item.kind) {
      case Kind::kRequest:
        handle_request(item);
        break;
      case Kind::kRejected:
        handler_.record_rejected(item.cause);
        report_invalid(item, item.text, item.cause);
        break;
      case Kind::kCopy:
        records_.add_event(item.timestamp, item.text, message_of(item));
        ++copied_;
        break;
      case Kind::kSeas:
        handler_.receive_seas(seas_[item.seas]);
        break;
      case Kind::kRejectedSea:
        handler_.record_rejected_sea();
        input_errors_.push_back(std::move(item.text));
        break;
      case Kind::kCondition:
        if (const Expected<void> received = handler_.receive_condition(message_of(item)); !received) {
          input_errors_.push_back(event_error(item.timestamp, received.error()));
        }
        break;
      case Kind::kInputError:
        input_errors_.push_back(std::move(item.text));
        break;
    }
  }
}

void ReplayBatch::handle_request(const Item& item) {
  const Bytes request = message_of(item);
  const Bytes response = handler_.handle(request);
  if (response.empty()) {
    report_invalid(item, "request", peek_request(request).error());
    return;
  }
  if (handler_.last_session().kind == RequestKind::kWaterPoints) {
    records_.add_samples(item.timestamp, response);
    return;
  }
  const ResponseBytes published{response, handler_.last_hydrostatics(), handler_.last_loads()};
  records_.add_response(item.timestamp, published, item.force_torque_channel);
  if (loads_csv_) loads_records_.add(published.loads);
  if (keep_responses_) {
    responses_.add(response);
    if (!published.hydrostatics.empty()) hydrostatics_.add(published.hydrostatics);
    if (!published.loads.empty()) loads_.add(published.loads);
  }
}

void ReplayBatch::report_invalid(const Item& item, const std::string& expected, DecodeError cause) {
  input_errors_.push_back("event at " + std::to_string(item.timestamp) + " us is not a valid " + expected +
                          ": " + to_string(cause));
}

}  // namespace buoyancy::service
