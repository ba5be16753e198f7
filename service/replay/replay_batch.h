// Consecutive events of a recording: filled in the recording's order, evaluated on any thread, then written
// in order.
//
// The handler is reset before each evaluation, so that responses and counters depend on the batch alone and
// not on earlier batches, except for received seas and conditions, which the reader hands from batch to
// batch. (A retry of a request of the previous batch is computed again: it gives the same bytes and is
// counted as computed.)
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "engine/condition_timeline.h"
#include "engine/request_handler.h"
#include "engine/sea_timeline.h"
#include "scene/scene.h"
#include "service/replay/replay_output.h"

namespace buoyancy::service {

class ReplayBatch {
 public:
  // scene must outlive the batch. keep_responses: for each_response(), each_hydrostatics() and each_loads().
  ReplayBatch(const Scene& scene, const OutputLayout& layout, bool keep_responses);

  // seas, conditions: those received before the batch's events.
  void start(SeaTimeline seas, ConditionTimeline conditions);
  bool empty() const { return items_.empty(); }
  // Is the batch large enough to be evaluated on a thread? Then no further event should be added.
  bool full() const { return items_.size() >= kMaxItems || bytes_.size() + grid_bytes_ >= kMaxBytes; }

  // force_torque_channel: the channel of the response as a six_axis_force_torque_t; empty: the response is a
  // body_wrenches_t. It must outlive the batch.
  void add_request(std::int64_t timestamp, Bytes request, std::string_view force_torque_channel);
  // expected: what the event is not, "pose".
  void add_rejected(std::int64_t timestamp, const char* expected, DecodeError cause);
  void add_copy(std::int64_t timestamp, std::string_view channel, Bytes bytes);
  // seas: with the one that the event brings. grid_bytes: of its message, if that is a grid.
  void add_seas(std::int64_t timestamp, SeaTimeline seas, std::size_t grid_bytes);
  void add_rejected_sea(std::int64_t timestamp, const Error& error);
  void add_condition(std::int64_t timestamp, Bytes message);
  void add_input_error(std::string error);

  void evaluate();

  // The results of evaluate().
  OutputRecords& records() { return records_; }
  LoadsRecords& loads_records() { return loads_records_; }  // empty unless the layout has loads_csv
  const std::vector<std::string>& input_errors() const { return input_errors_; }  // in the recording's order
  // Calls visit(bytes of a body_wrenches_t) for every response in order; only with keep_responses.
  template <typename Visit>
  void each_response(Visit&& visit) const {
    responses_.each(visit);
  }
  // The same for the bodies_hydrostatics_t that belong to the responses.
  template <typename Visit>
  void each_hydrostatics(Visit&& visit) const {
    hydrostatics_.each(visit);
  }
  // The same for the bodies_loads_t.
  template <typename Visit>
  void each_loads(Visit&& visit) const {
    loads_.each(visit);
  }
  // Totals since the construction; clear() keeps them.
  const ServiceCounters& counters() const { return handler_.counters(); }
  std::int64_t copied() const { return copied_; }

 private:
  static constexpr std::size_t kMaxItems = 1024;
  static constexpr std::size_t kMaxBytes = 262'144;

  enum class Kind { kRequest, kRejected, kCopy, kSeas, kRejectedSea, kCondition, kInputError };
  struct Item {
    Kind kind = Kind::kRequest;
    std::int64_t timestamp = 0;
    std::size_t start = 0;                  // of the message, in bytes_
    std::size_t size = 0;                   // of the message
    std::string_view force_torque_channel;  // kRequest
    DecodeError cause{};                    // kRejected
    // kCopy: the channel; kRejected: what was expected; kRejectedSea, kInputError: the description.
    std::string text;
    std::size_t seas = 0;  // kSeas: index into seas_
  };

  class Messages {
   public:
    void clear() {
      bytes_.clear();
      ends_.clear();
    }
    void add(Bytes message) {
      bytes_.insert(bytes_.end(), message.begin(), message.end());
      ends_.push_back(bytes_.size());
    }
    template <typename Visit>
    void each(Visit& visit) const {
      std::size_t start = 0;
      for (const std::size_t end : ends_) {
        visit(Bytes(bytes_).subspan(start, end - start));
        start = end;
      }
    }

   private:
    std::vector<std::uint8_t> bytes_;
    std::vector<std::size_t> ends_;  // in bytes_
  };

  Item& add(Kind kind, std::int64_t timestamp, Bytes message);
  Bytes message_of(const Item& item) const { return Bytes(bytes_).subspan(item.start, item.size); }
  void handle_request(const Item& item);
  void report_invalid(const Item& item, const std::string& expected, DecodeError cause);

  RequestHandler handler_;
  bool loads_csv_;
  bool keep_responses_;
  std::int64_t copied_ = 0;
  std::vector<Item> items_;
  std::vector<std::uint8_t> bytes_;
  std::size_t grid_bytes_ = 0;     // of the messages whose grids seas_ has
  std::vector<SeaTimeline> seas_;  // the first is that at the start
  ConditionTimeline conditions_;   // at the start
  OutputRecords records_;
  LoadsRecords loads_records_;
  std::vector<std::string> input_errors_;
  Messages responses_;
  Messages hydrostatics_;
  Messages loads_;
};

}  // namespace buoyancy::service
