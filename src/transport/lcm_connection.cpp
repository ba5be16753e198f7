#include "transport/lcm_connection.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <random>
#include <set>
#include <system_error>
#include <utility>

#include <lcm/lcm.h>
#include <poll.h>
#include <sched.h>

#include "transport/adaptive_spin.h"
#include "transport/message_limits.h"
#include "transport/multicast_probe.h"
#include "transport/udpm_url.h"

namespace buoyancy {
namespace {

constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr std::size_t kMaxChannelLength = 63;              // LCM's own limit
constexpr const char* kSelfTestChannel = "LCM_SELF_TEST";  // liblcm's own, for messages without meaning

// The most packets that one handle_one() reads, so that a flood on other channels cannot block its caller.
constexpr int kMaxForeignPackets = 1'000;

bool is_memq(const std::string& url) {
  return url.starts_with("memq://");
}

// Escapes a channel name, which liblcm interprets as a regular expression between ^ and $.
std::string escape_regex(const std::string& channel) {
  std::string escaped;
  for (const char c : channel) {
    if (std::string_view(R"(\^$.|?*+()[]{}-)").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

struct Subscription {
  LcmConnection::Handler handler;
  std::string channel;
  std::int64_t* received_utime;
};

// Makes the receiver ignore what lcm sends. liblcm does not expose the port that it sends from: a message
// with random bytes is sent and its sender is identified when it comes back. If it does not, nothing is
// ignored.
void ignore_own_packets(lcm_t* lcm, UdpmReceiver& receiver) {
  constexpr std::chrono::milliseconds kTimeout{200};
  std::random_device device;
  std::array<std::uint8_t, 16> token{};
  std::ranges::generate(token, [&device] { return static_cast<std::uint8_t>(device()); });
  if (lcm_publish(lcm, kSelfTestChannel, token.data(), static_cast<unsigned>(token.size())) != 0) return;
  if (const auto own = receiver.find_sender(token, kTimeout)) receiver.truncate_packets_of(*own);
}

std::string send_hint(const std::string& url) {
  const Expected<UdpmUrl> parsed = parse_udpm_url(url);
  if (!parsed) return "";  // memq://
  return "Check the route with 'ip route get " + parsed->group +
         "'; for 'Message too long', send fewer bodies per request";
}

// Dispatches messages of memq://.
extern "C" void buoyancy_lcm_dispatch(const lcm_recv_buf_t* received, const char* channel,
                                      void* subscription) noexcept {
  const auto* to = static_cast<Subscription*>(subscription);
  *to->received_utime = received->recv_utime;
  to->handler({static_cast<const std::uint8_t*>(received->data), received->data_size}, channel);
}

}  // namespace

std::int64_t utime_now() {
  using std::chrono::microseconds;
  return std::chrono::duration_cast<microseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string resolve_lcm_url(const std::string& url) {
  if (!url.empty()) return url;
  const char* from_environment =
      std::getenv("LCM_DEFAULT_URL");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return from_environment != nullptr && *from_environment != '\0' ? from_environment : kDefaultUrl;
}

Expected<void> check_lcm_url(const std::string& url) {
  const std::string resolved = resolve_lcm_url(url);
  if (is_memq(resolved)) return {};
  const Expected<UdpmUrl> parsed = parse_udpm_url(resolved);
  if (!parsed) return tl::unexpected(parsed.error());
  return {};
}

Expected<void> check_channel(const std::string& channel) {
  if (channel.empty() || channel.size() > kMaxChannelLength) {
    return make_error({"LCM channel '" + channel + "'", std::to_string(channel.size()) + " characters",
                       "1 to " + std::to_string(kMaxChannelLength) + " characters", "", ""});
  }
  return {};
}

Expected<void> check_channels_distinct(const std::vector<std::string>& channels) {
  std::string names;
  for (const std::string& channel : channels) {
    if (Expected<void> checked = check_channel(channel); !checked) return checked;
    names += (names.empty() ? "" : ", ") + channel;
  }
  if (std::set<std::string>(channels.begin(), channels.end()).size() == channels.size()) return {};
  return make_error(
      {"channels " + names, "two are equal", "different names", "", "Give each channel its own name"});
}

struct LcmConnection::Impl {
  Impl(lcm_t* connection, std::optional<UdpmReceiver> udpm_receiver, bool may_spin)
      : lcm(connection), receiver(std::move(udpm_receiver)), spin(may_spin) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { lcm_destroy(lcm); }

  lcm_t* lcm;                            // sends, and receives with memq://
  std::optional<UdpmReceiver> receiver;  // none with memq://
  bool spin;
  AdaptiveSpin spin_policy;
  std::int64_t blocked_since = 0;  // when the current wait stopped spinning [us since 1970]; 0: no wait
  std::int64_t received_utime = 0;
  // Indexed by the receiver's channel numbers. With memq:// liblcm holds the addresses.
  std::vector<std::unique_ptr<Subscription>> subscriptions;

  void dispatch(const UdpmReceiver::Message& message) noexcept {
    const Subscription& to = *subscriptions[message.channel];
    received_utime = message.arrived;
    to.handler(message.payload, to.channel);
  }
};

LcmConnection::LcmConnection(std::unique_ptr<Impl> impl, std::string url)
    : impl_(std::move(impl)), url_(std::move(url)) {}
LcmConnection::LcmConnection(LcmConnection&&) noexcept = default;
LcmConnection& LcmConnection::operator=(LcmConnection&&) noexcept = default;
LcmConnection::~LcmConnection() = default;

Expected<LcmConnection> LcmConnection::open(const std::string& url, const ConnectionOptions& options) {
  std::string resolved = resolve_lcm_url(url);
  std::optional<UdpmReceiver> receiver;
  if (!is_memq(resolved)) {
    const Expected<UdpmUrl> parsed = parse_udpm_url(resolved);
    if (!parsed) return tl::unexpected(parsed.error());
    if (Expected<void> probed = probe_multicast(*parsed); !probed) return tl::unexpected(probed.error());
    resolved = to_string(*parsed);
    Expected<UdpmReceiver> opened = UdpmReceiver::open(*parsed);
    if (!opened) return tl::unexpected(opened.error());
    receiver = std::move(*opened);
  }
  lcm_t* lcm = lcm_create(resolved.c_str());
  if (lcm == nullptr) {
    return make_error({"LCM URL '" + resolved + "'", "LCM could not open it", "a working LCM connection", "",
                       "See the message that LCM printed above"});
  }
  if (receiver && !options.receive_own) ignore_own_packets(lcm, *receiver);
  return LcmConnection(std::make_unique<Impl>(lcm, std::move(receiver), options.spin), resolved);
}

Expected<void> LcmConnection::subscribe(const std::string& channel, Handler handler) {
  if (Expected<void> checked = check_channel(channel); !checked) return checked;
  if (impl_->receiver) {
    const Expected<std::size_t> number = impl_->receiver->subscribe(channel);
    if (!number) return tl::unexpected(number.error());
  }
  const auto& subscription = impl_->subscriptions.emplace_back(
      std::make_unique<Subscription>(Subscription{std::move(handler), channel, &impl_->received_utime}));
  if (impl_->receiver) return {};
  lcm_subscription_t* lcm_subscription =
      lcm_subscribe(impl_->lcm, escape_regex(channel).c_str(), buoyancy_lcm_dispatch, subscription.get());
  constexpr int kUnbounded = 0;
  if (lcm_subscription == nullptr || lcm_subscription_set_queue_capacity(lcm_subscription, kUnbounded) != 0) {
    return make_error(
        {"LCM channel '" + channel + "'", "LCM rejected the subscription", "a valid channel name", "", ""});
  }
  return {};
}

bool LcmConnection::is_network() const {
  return impl_->receiver.has_value();
}

std::optional<ReceiveBuffer> LcmConnection::reserve_receive_buffer(std::size_t message_bytes) {
  if (!impl_->receiver) return std::nullopt;
  impl_->receiver->reserve(message_bytes);
  return impl_->receiver->receive_buffer();
}

Expected<void> LcmConnection::publish(const std::string& channel, Bytes bytes) {
  if (Expected<void> checked = check_channel(channel); !checked) return checked;
  if (impl_->receiver && bytes.size() > kMaxMessageBytes) {
    return check_message_size("LCM channel '" + channel + "'", bytes.size());
  }
  errno = 0;
  if (lcm_publish(impl_->lcm, channel.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())) != 0) {
    return make_error({"LCM channel '" + channel + "'",
                       "a message of " + std::to_string(bytes.size()) + " bytes was not sent (" +
                           std::generic_category().message(errno) + ")",
                       "a network that accepts it",
                       "the multicast route is gone, or the network accepts only smaller messages",
                       send_hint(url_)});
  }
  return {};
}

int LcmConnection::fileno() const {
  return impl_->receiver ? impl_->receiver->fileno() : lcm_get_fileno(impl_->lcm);
}

std::int64_t LcmConnection::received_utime() const {
  return impl_->received_utime;
}

DropCounts LcmConnection::drop_counts() const {
  return impl_->receiver ? impl_->receiver->drop_counts() : DropCounts{};
}

bool LcmConnection::handle_one() {
  if (!impl_->receiver) {
    pollfd waiting{fileno(), POLLIN, 0};
    return ::poll(&waiting, 1, 0) > 0 && lcm_handle(impl_->lcm) == 0;
  }
  const auto message = impl_->receiver->receive(kMaxForeignPackets);
  if (!message) return false;
  if (const std::int64_t blocked_since = std::exchange(impl_->blocked_since, 0); blocked_since != 0) {
    impl_->spin_policy.record_sleep(std::chrono::microseconds(message->arrived - blocked_since));
  }
  impl_->dispatch(*message);
  return true;
}

bool LcmConnection::handle_one_spinning(std::chrono::nanoseconds max_spin) {
  using Clock = std::chrono::steady_clock;
  if (handle_one()) return true;
  if (!impl_->spin || !impl_->receiver || impl_->blocked_since != 0) return false;
  const AdaptiveSpin::Duration limit = std::min(max_spin, impl_->spin_policy.begin());
  if (limit > AdaptiveSpin::Duration::zero()) {
    const Clock::time_point start = Clock::now();
    AdaptiveSpin::Duration elapsed{0};
    while (elapsed < limit) {
      // If sender and receiver share a processor, the sender must run.
      ::sched_yield();
      const auto message = impl_->receiver->receive(kMaxForeignPackets);
      elapsed = Clock::now() - start;
      if (!message) continue;
      impl_->spin_policy.record_spin(elapsed, true);
      impl_->dispatch(*message);
      return true;
    }
    impl_->spin_policy.record_spin(elapsed, false);
  }
  impl_->blocked_since = utime_now();
  return false;
}

}  // namespace buoyancy
