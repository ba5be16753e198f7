// An LCM connection that returns errors instead of blocking or aborting, and that delivers bytes instead of
// decoded messages. The service, the client and the tests all use it.
//
// It sends through liblcm and receives, over UDP, through UdpmReceiver (which documents why). It works around
// four defects of liblcm: without a multicast route it blocks and aborts (here: one Error, with the command
// that fixes it); subscribe() hides that failure; handle() asserts after an exception; select() is not
// restarted after EINTR. Use from one thread at a time; only memq:// starts a thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/wire.h"
#include "transport/udpm_receiver.h"

namespace buoyancy {

// Returns the URL that LCM's own tools would use: url if not empty, else $LCM_DEFAULT_URL, else LCM's
// default.
std::string resolve_lcm_url(const std::string& url);

// Checks that LcmConnection::open accepts url (after resolve_lcm_url), without opening anything.
Expected<void> check_lcm_url(const std::string& url);

// Checks that LCM can carry the channel name: 1 to 63 characters.
Expected<void> check_channel(const std::string& channel);

// Checks each channel name with check_channel(), and that no two are equal.
Expected<void> check_channels_distinct(const std::vector<std::string>& channels);

// The current time [us since 1970], from the clock that stamps messages.
std::int64_t utime_now();

struct ConnectionOptions {
  // Over UDP: whether the connection receives its own messages on the channels that it subscribes to. If not,
  // they take almost no space in its receive buffer, which is then left to other senders. Other connections,
  // including those of this process, receive them in any case.
  bool receive_own = true;
  // Whether handle_one_spinning() may poll for a message for a moment, which costs processor time.
  bool spin = true;
};

class LcmConnection {
 public:
  // Called for every message. The bytes are valid during the call only. Must not throw.
  using Handler = std::function<void(Bytes bytes, std::string_view channel)>;

  // url: "" for the default, "udpm://239.255.76.67:7667?ttl=1", or "memq://" (within this connection only, no
  // network). LCM's other providers are rejected: the death of a tcpq server aborts its clients. Requests a
  // receive buffer of kMinReceiveBuffer from the kernel unless the URL gives a size. Errors: an invalid URL,
  // no multicast route (at once), or a route that does not loop packets back (after 2 s).
  static Expected<LcmConnection> open(const std::string& url, const ConnectionOptions& options = {});

  LcmConnection(LcmConnection&&) noexcept;
  LcmConnection& operator=(LcmConnection&&) noexcept;
  ~LcmConnection();

  // channel: an exact name (regular-expression characters are literal) that is not yet subscribed to.
  Expected<void> subscribe(const std::string& channel, Handler handler);

  // Enlarges the receive buffer for messages of this size [bytes], unless the URL fixes its size, and returns
  // what the kernel granted (see receive_buffer_warning()); nullopt: memq://, which has no such limit.
  std::optional<ReceiveBuffer> reserve_receive_buffer(std::size_t message_bytes);

  // Errors: over UDP, a message larger than kMaxMessageBytes; the transport rejected the message (route
  // gone).
  Expected<void> publish(const std::string& channel, Bytes bytes);

  int fileno() const;  // for poll(): readable when a packet is pending, perhaps of another channel
  bool handle_one();   // dispatches one pending message; false: there was none
  // Like handle_one(), but polls for a message for a moment first, for max_spin at most, if AdaptiveSpin and
  // the options allow it. For callers that block after it returned false.
  bool handle_one_spinning(std::chrono::nanoseconds max_spin = std::chrono::nanoseconds::max());

  // Returns when the last handled message arrived [us since 1970]; 0: none has been handled yet. The time
  // from then to its handling is the time that it was queued.
  std::int64_t received_utime() const;
  // Counts packets, fragments and messages that were lost; always 0 with memq://.
  DropCounts drop_counts() const;
  const std::string& url() const { return url_; }
  bool is_network() const;  // false: memq://

 private:
  struct Impl;
  explicit LcmConnection(std::unique_ptr<Impl> impl, std::string url);
  std::unique_ptr<Impl> impl_;
  std::string url_;
};

}  // namespace buoyancy
