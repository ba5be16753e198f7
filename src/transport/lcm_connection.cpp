#include "transport/lcm_connection.h"

#include <cerrno>
#include <cstdlib>
#include <set>
#include <system_error>

#include <lcm/lcm.h>
#include <poll.h>

#include "transport/multicast_probe.h"
#include "transport/udpm_url.h"

namespace buoyancy {
namespace {

constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr std::size_t kLongestChannel = 63;  // LCM's own limit

// Holds 200,000 small messages a second without loss; the kernel's default holds a few hundred.
constexpr std::int32_t kReceiveBufferBytes = 4'194'304;

bool is_memq(const std::string& url) {
  return url.starts_with("memq://");
}

// liblcm reads a channel as a regular expression between ^ and $.
std::string literal(const std::string& channel) {
  std::string escaped;
  for (const char c : channel) {
    if (std::string_view(R"(\^$.|?*+()[]{}-)").find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

// liblcm's own limit. Of a packet that ends before its channel's name does liblcm says a size below zero,
// which reads as one of 4 GB.
constexpr std::size_t kLargestMessage = std::size_t{1} << 28U;

struct Subscription {
  LcmConnection::Handler handler;
  std::int64_t* received_utime;
};

extern "C" void buoyancy_lcm_dispatch(const lcm_recv_buf_t* received, const char* channel,
                                      void* subscription) noexcept {
  const std::size_t size = received->data_size <= kLargestMessage ? received->data_size : 0;
  const Bytes bytes(static_cast<const std::uint8_t*>(received->data), size);
  const auto* to = static_cast<Subscription*>(subscription);
  *to->received_utime = received->recv_utime;
  to->handler(bytes, channel);
}

}  // namespace

std::string effective_lcm_url(const std::string& url) {
  if (!url.empty()) return url;
  const char* from_environment =
      std::getenv("LCM_DEFAULT_URL");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  return from_environment != nullptr && *from_environment != '\0' ? from_environment : kDefaultUrl;
}

Expected<void> check_lcm_url(const std::string& url) {
  const std::string shown = effective_lcm_url(url);
  if (is_memq(shown)) return {};
  const Expected<UdpmUrl> parsed = parse_udpm_url(shown);
  if (!parsed) return tl::unexpected(parsed.error());
  return {};
}

Expected<void> check_channel(const std::string& channel) {
  if (channel.empty() || channel.size() > kLongestChannel) {
    return failure({"LCM channel '" + channel + "'", std::to_string(channel.size()) + " characters",
                    "1 to " + std::to_string(kLongestChannel) + " characters", "", ""});
  }
  return {};
}

Expected<void> check_different_channels(const std::vector<std::string>& channels) {
  std::string names;
  for (const std::string& channel : channels) {
    if (Expected<void> checked = check_channel(channel); !checked) return checked;
    names += (names.empty() ? "" : ", ") + channel;
  }
  if (std::set<std::string>(channels.begin(), channels.end()).size() == channels.size()) return {};
  return failure({"channels " + names, "two are the same", "different names", "", ""});
}

struct LcmConnection::Impl {
  explicit Impl(lcm_t* connection) : lcm(connection) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { lcm_destroy(lcm); }

  lcm_t* lcm;
  std::int64_t received_utime = 0;
  std::vector<std::unique_ptr<Subscription>> subscriptions;  // liblcm holds their addresses
};

LcmConnection::LcmConnection(std::unique_ptr<Impl> impl, std::string url)
    : impl_(std::move(impl)), url_(std::move(url)) {}
LcmConnection::LcmConnection(LcmConnection&&) noexcept = default;
LcmConnection& LcmConnection::operator=(LcmConnection&&) noexcept = default;
LcmConnection::~LcmConnection() = default;

Expected<LcmConnection> LcmConnection::open(const std::string& url) {
  const std::string shown = effective_lcm_url(url);
  std::string provider = shown;
  if (!is_memq(shown)) {
    const Expected<UdpmUrl> parsed = parse_udpm_url(shown);
    if (!parsed) return tl::unexpected(parsed.error());
    const Expected<std::int32_t> receive_buffer = probe_multicast(*parsed, kReceiveBufferBytes);
    if (!receive_buffer) return tl::unexpected(receive_buffer.error());
    if (!parsed->recv_buf_size) {
      provider += (shown.find('?') == shown.npos ? "?" : "&");
      provider += "recv_buf_size=" + std::to_string(*receive_buffer);
    }
  }
  lcm_t* lcm = lcm_create(provider.c_str());
  // The descriptor exists only once liblcm has set up its receiving half: here it fails, if it fails, and not
  // in a later subscribe() or handle() that would not say so.
  if (lcm != nullptr && lcm_get_fileno(lcm) < 0) {
    lcm_destroy(lcm);
    lcm = nullptr;
  }
  if (lcm == nullptr) {
    return failure({"LCM URL '" + shown + "'", "LCM could not open it", "a working LCM connection",
                    "what LCM itself printed above", ""});
  }
  return LcmConnection(std::make_unique<Impl>(lcm), shown);
}

Expected<void> LcmConnection::subscribe(const std::string& channel, Handler handler, int queue_capacity) {
  if (Expected<void> checked = check_channel(channel); !checked) return checked;
  auto& subscription = impl_->subscriptions.emplace_back(
      std::make_unique<Subscription>(Subscription{std::move(handler), &impl_->received_utime}));
  lcm_subscription_t* made =
      lcm_subscribe(impl_->lcm, literal(channel).c_str(), buoyancy_lcm_dispatch, subscription.get());
  if (made == nullptr || lcm_subscription_set_queue_capacity(made, queue_capacity) != 0) {
    return failure(
        {"LCM channel '" + channel + "'", "LCM refused the subscription", "a channel's name", "", ""});
  }
  return {};
}

Expected<void> LcmConnection::publish(const std::string& channel, Bytes bytes) {
  if (Expected<void> checked = check_channel(channel); !checked) return checked;
  errno = 0;
  if (lcm_publish(impl_->lcm, channel.c_str(), bytes.data(), static_cast<unsigned>(bytes.size())) != 0) {
    return failure({"LCM channel '" + channel + "'",
                    "a message of " + std::to_string(bytes.size()) + " bytes was not sent (" +
                        std::generic_category().message(errno) + ")",
                    "the network to take it", "the multicast route is gone", ""});
  }
  return {};
}

int LcmConnection::fileno() const {
  return lcm_get_fileno(impl_->lcm);
}

std::int64_t LcmConnection::received_utime() const {
  return impl_->received_utime;
}

bool LcmConnection::handle_one() {
  pollfd waiting{fileno(), POLLIN, 0};
  if (::poll(&waiting, 1, 0) <= 0) return false;
  return lcm_handle(impl_->lcm) == 0;
}

}  // namespace buoyancy
