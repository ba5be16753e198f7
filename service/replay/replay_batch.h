// A stretch of a recording: filled in the recording's order, answered on any thread, then written in order.
//
// Each batch is answered by an handler that begins anew, so that answers, and what is counted of them,
// depend on the batch alone and not on who answered what before. (A repeat of a request in the batch before
// is computed again: the same bytes, counted as answered.)
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/request_handler.h"
#include "scene/scene.h"
#include "service/replay/replay_output.h"

namespace buoyancy {

class ReplayBatch {
 public:
  // scene must outlive the batch. keep_answers: for answers().
  ReplayBatch(const Scene& scene, const OutputLayout& layout, bool keep_responses);

  void clear();
  // No further request should be added: enough to be worth a thread's while.
  bool full() const { return items_.size() >= kMaxItems || bytes_.size() >= kMaxBytes; }

  // force_torque_channel: what it is answered as; empty: as body_wrenches_t. Outlives the batch.
  void add_request(std::int64_t timestamp, Bytes request, std::string_view force_torque_channel);
  void add_rejected_pose(std::int64_t timestamp, DecodeError cause);
  void add_copy(std::int64_t timestamp, std::string_view channel, Bytes bytes);
  void add_warning(std::string warning);

  void response();

  // Of what answer() made.
  OutputRecords& records() { return records_; }
  const std::vector<std::string>& warnings() const { return warnings_; }  // in the recording's order
  // Calls see(bytes of a body_wrenches_t) for every response in order, where answers were to be kept.
  template <typename See>
  void each_response(See&& see) const {
    responses_.each(see);
  }
  // The same of the bodies_hydrostatics_t that went with them.
  template <typename See>
  void each_hydrostatics(See&& see) const {
    hydrostatics_.each(see);
  }
  const ServiceCounters& counters() const {
    return handler_.counters();
  }                                                // of all that this was ever filled with
  std::int64_t copied() const { return copied_; }  // likewise

 private:
  static constexpr std::size_t kMaxItems = 1024;
  static constexpr std::size_t kMaxBytes = 262'144;

  enum class Kind { kRequest, kRejectedPose, kCopy, kWarning };
  struct Item {
    Kind kind = Kind::kRequest;
    std::int64_t timestamp = 0;
    std::size_t start = 0;     // of its message, in bytes_
    std::size_t size = 0;      // of its message
    std::string_view channel;  // of a request: its force_torque_channel
    DecodeError cause{};       // of a rejected pose
    std::string text;          // of a copy: its channel; of trouble: what it is
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
    template <typename See>
    void each(See& see) const {
      std::size_t start = 0;
      for (const std::size_t end : ends_) {
        see(Bytes(bytes_).subspan(start, end - start));
        start = end;
      }
    }

   private:
    std::vector<std::uint8_t> bytes_;
    std::vector<std::size_t> ends_;  // in bytes_
  };

  Item& add(Kind kind, std::int64_t timestamp, Bytes message);
  Bytes message_of(const Item& item) const { return Bytes(bytes_).subspan(item.start, item.size); }
  void response_request(const Item& item);
  void reject(const Item& item, const char* what, DecodeError cause);

  RequestHandler handler_;
  bool keep_responses_;
  std::int64_t copied_ = 0;
  std::vector<Item> items_;
  std::vector<std::uint8_t> bytes_;
  OutputRecords records_;
  std::vector<std::string> warnings_;
  Messages responses_;
  Messages hydrostatics_;
};

}  // namespace buoyancy
