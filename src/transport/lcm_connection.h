// An LCM connection that says what is wrong instead of blocking or aborting, and that delivers bytes, not
// decoded messages: service, client and tests all talk through it.
//
// Sends through liblcm and receives, over UDP, through UdpmReceiver, which says why. liblcm's traps that this
// file keeps in one place: a machine without a multicast route (one Error, with the command that mends it),
// subscribe() hiding that failure, handle() asserting after an exception, select() and EINTR. One thread at a
// time, and none is started but for memq://.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "messages/wire.h"
#include "transport/udpm_receiver.h"

namespace buoyancy {

// The URL that LCM's own tools would use: url if not empty, else $LCM_DEFAULT_URL, else LCM's default.
std::string resolve_lcm_url(const std::string& url);

// Is url (after resolve_lcm_url) one that LcmConnection::open takes? Opens nothing.
Expected<void> check_lcm_url(const std::string& url);

// Is channel a name that LCM can carry: 1 to 63 characters?
Expected<void> check_channel(const std::string& channel);

// The same of each, and that no two are the same.
Expected<void> check_channels_distinct(const std::vector<std::string>& channels);

// us since 1970, by the clock that messages are stamped with.
std::int64_t utime_now();

struct ConnectionOptions {
  // Over UDP: are this connection's own messages received on the channels that it subscribes to? Without,
  // they take next to no room in its receive buffer, which those of others then have for themselves. Other
  // connections, of this process too, receive them in any case.
  bool receive_own = true;
  // May handle_one_spinning() look for a message for a moment, which costs processor time?
  bool spin = true;
};

class LcmConnection {
 public:
  // Called for every message: bytes are valid during the call only. Must not throw.
  using Handler = std::function<void(Bytes bytes, std::string_view channel)>;

  // url: "" for the default, "udpm://239.255.76.67:7667?ttl=1", or "memq://" (within this connection only, no
  // network). LCM's other providers are refused: the death of a tcpq server aborts its clients. Asks the
  // kernel for a receive buffer of 4 MB where the URL does not say. Errors: not such a URL, no multicast
  // route (at once) or one that brings nothing back (after 2 s).
  static Expected<LcmConnection> open(const std::string& url, const ConnectionOptions& options = {});

  LcmConnection(LcmConnection&&) noexcept;
  LcmConnection& operator=(LcmConnection&&) noexcept;
  ~LcmConnection();

  // channel: exactly this name, and once (regular-expression characters are taken literally).
  Expected<void> subscribe(const std::string& channel, Handler handler);

  // Errors: the transport refused (message too large, route gone).
  Expected<void> publish(const std::string& channel, Bytes bytes);

  int fileno() const;  // for poll(): readable when something waits, though perhaps of other channels
  bool handle_one();   // dispatches one message that has come; false: none was there
  // The same, but looks for it for a moment (AdaptiveSpin), up to `most`, where that pays and the options
  // allow it: for whoever goes to sleep where it says false.
  bool handle_one_spinning(std::chrono::nanoseconds most = std::chrono::nanoseconds::max());

  // us since 1970: when the message came in that was handled last; what lies between is the time that it
  // waited for handle_one(). 0: none has been handled.
  std::int64_t received_utime() const;
  // What did not become a message; of memq:// nothing.
  DropCounts drop_counts() const;
  const std::string& url() const { return url_; }

 private:
  struct Impl;
  explicit LcmConnection(std::unique_ptr<Impl> impl, std::string url);
  std::unique_ptr<Impl> impl_;
  std::string url_;
};

}  // namespace buoyancy
