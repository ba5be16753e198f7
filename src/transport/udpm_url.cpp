#include "transport/udpm_url.h"

#include <charconv>
#include <string_view>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace buoyancy {
namespace {

constexpr std::string_view kScheme = "udpm://";
constexpr std::string_view kForm = "udpm://ADDRESS:PORT?ttl=N, for example udpm://239.255.76.67:7667?ttl=0";

std::optional<std::int32_t> parse_integer(std::string_view text, std::int32_t min, std::int32_t max) {
  std::int32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if (value < min || value > max) return std::nullopt;
  return value;
}

bool is_multicast(const std::string& address) {
  in_addr parsed{};
  return inet_pton(AF_INET, address.c_str(), &parsed) == 1 && IN_MULTICAST(ntohl(parsed.s_addr));
}

tl::unexpected<Error> invalid_url(const std::string& url, std::string actual, std::string expected) {
  return make_error({"LCM URL '" + url + "'", std::move(actual), std::move(expected), "", ""});
}

}  // namespace

Expected<UdpmUrl> parse_udpm_url(const std::string& url) {
  std::string_view rest = url;
  if (!rest.starts_with(kScheme)) return invalid_url(url, "does not start with udpm://", std::string(kForm));
  rest.remove_prefix(kScheme.size());

  UdpmUrl parsed;
  const std::size_t query_separator = rest.find('?');
  std::string_view network = rest.substr(0, query_separator);
  std::string_view options = query_separator == rest.npos ? "" : rest.substr(query_separator + 1);

  const std::size_t colon = network.find(':');
  if (const std::string_view group = network.substr(0, colon); !group.empty()) parsed.group = group;
  if (!is_multicast(parsed.group)) {
    return invalid_url(url, "address '" + parsed.group + "'",
                       "an IPv4 multicast address, 224.0.0.0 to 239.255.255.255");
  }
  if (colon != network.npos) {
    const std::string_view text = network.substr(colon + 1);
    const auto port = parse_integer(text, 1, 65535);
    if (!port) return invalid_url(url, "port '" + std::string(text) + "'", "a number from 1 to 65535");
    parsed.port = static_cast<std::uint16_t>(*port);
  }

  while (!options.empty()) {
    const std::size_t ampersand = options.find('&');
    const std::string_view option = options.substr(0, ampersand);
    options = ampersand == options.npos ? "" : options.substr(ampersand + 1);
    const std::size_t equals = option.find('=');
    const std::string_view key = option.substr(0, equals);
    const std::string_view text = equals == option.npos ? "" : option.substr(equals + 1);
    if (key == "ttl") {
      const auto ttl = parse_integer(text, 0, 255);
      if (!ttl) return invalid_url(url, "ttl '" + std::string(text) + "'", "a number from 0 to 255");
      parsed.ttl = *ttl;
    } else if (key == "recv_buf_size") {
      parsed.recv_buf_size = parse_integer(text, 1, INT32_MAX);
      if (!parsed.recv_buf_size) {
        return invalid_url(url, "recv_buf_size '" + std::string(text) + "'", "a number of bytes above 0");
      }
    } else {
      return invalid_url(url, "option '" + std::string(option) + "'", "ttl=N or recv_buf_size=N");
    }
  }
  return parsed;
}

std::string to_string(const UdpmUrl& url) {
  std::string text =
      std::string(kScheme) + url.group + ":" + std::to_string(url.port) + "?ttl=" + std::to_string(url.ttl);
  if (url.recv_buf_size) text += "&recv_buf_size=" + std::to_string(*url.recv_buf_size);
  return text;
}

}  // namespace buoyancy
