// The asking end of the LCM connection: sends the requests of one session and keeps the newest response to
// them.
//
// A response belongs to the session if its session_id is the session's and its seq is that of a request
// already sent; of those the highest seq is kept. All else on the channel is somebody else's and ignored. One
// thread.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "messages/wire.h"
#include "transport/lcm_connection.h"

namespace buoyancy {

using Clock = std::chrono::steady_clock;

struct ResponseArrival {
  std::int64_t seq = 0;
  Clock::time_point at;
};

struct ChannelOptions {
  std::string lcm_url;  // "": as LCM's own tools choose
  std::string states_channel{kStatesChannel};
  std::string wrenches_channel{kWrenchesChannel};
  bool spin = true;  // look for a response for a moment before going to sleep: quicker, for processor time
  const std::atomic<bool>* cancelled = nullptr;  // not null: waiting ends soon after it became true
};

class LcmRequestChannel {
 public:
  // Errors: those of LcmConnection::open.
  static Expected<LcmRequestChannel> open(const ChannelOptions& options);

  // Encodes and publishes. Sessions must not change, seq must not fall. Errors: the transport's.
  Expected<void> send(const WrenchRequest& request);
  // The last request once more, the same bytes.
  Expected<void> resend();

  // Waits until a response with at least this seq is there, but not beyond the deadline; takes in what has
  // already arrived even where the deadline has passed. False: it is not there.
  bool wait_for(std::int64_t seq, Clock::time_point deadline);
  // The session's responses that came in during the last wait_for, duplicates and old ones too.
  const std::vector<ResponseArrival>& arrivals() const { return inbox_->arrivals; }

  bool has_response() const { return inbox_->has_response; }
  const WrenchResponse& latest_response() const { return inbox_->newest; }  // only if has_response()
  bool cancelled() const { return cancelled_ != nullptr && cancelled_->load(); }

  // "udpm://239.255.76.67:7667?ttl=0, channels BUOYANCY_STATES and BUOYANCY_WRENCHES", for errors.
  std::string describe_endpoint() const;

 private:
  // At a fixed address, because the connection's handler writes here.
  struct Inbox {
    std::int64_t session_id = 0;
    std::int64_t last_sent = -1;
    bool has_response = false;
    WrenchResponse newest;
    WrenchResponse incoming;  // reused
    std::vector<ResponseArrival> arrivals;

    void receive(Bytes bytes);
  };

  LcmRequestChannel(ChannelOptions options, LcmConnection connection);

  ChannelOptions options_;
  const std::atomic<bool>* cancelled_;
  std::unique_ptr<Inbox> inbox_;
  LcmConnection connection_;
  std::vector<std::uint8_t> request_bytes_;
};

}  // namespace buoyancy
