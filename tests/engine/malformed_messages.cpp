#include "tests/engine/malformed_messages.h"

#include <algorithm>
#include <climits>
#include <random>
#include <string_view>
#include <utility>

#include "messages/status.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {
namespace {

constexpr std::size_t kFingerprint = 8;
constexpr std::size_t kFixed = 44;  // fingerprint, utime, session_id, seq, lead_time, num_bodies
constexpr std::size_t kBody = 108;
constexpr std::size_t kLargeDatagram = 60000;

ByteVector request_of(std::size_t bodies) {
  WrenchRequest request{
      .id = {.utime = 1'000'000, .session_id = 77, .seq = 5}, .lead_time = 0.0, .bodies = {}};
  BodyState body;
  body.body_id = 1;
  body.quaternion_wxyz = {1, 0, 0, 0};
  request.bodies.assign(bodies, body);
  return encoded(request);
}

ByteVector response_of(std::size_t bodies) {
  WrenchResponse response{.id = {.utime = 1'000'000, .session_id = 77, .seq = 5}, .bodies = {}};
  response.bodies.resize(bodies);
  return encoded(response);
}

ByteVector status() {
  ServiceStatus status;
  status.version = "0.1.0";
  return encoded(status);
}

ByteVector first(ByteVector bytes, std::size_t size) {
  bytes.resize(size);
  return bytes;
}

ByteVector extended(ByteVector bytes, std::size_t extra, std::uint8_t value) {
  bytes.insert(bytes.end(), extra, value);
  return bytes;
}

ByteVector joined(ByteVector bytes, const ByteVector& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
  return bytes;
}

ByteVector with_count(ByteVector bytes, std::int32_t count) {
  const auto value = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < 4; ++i) bytes[kFixed - 1 - i] = static_cast<std::uint8_t>(value >> (8 * i));
  return bytes;
}

ByteVector with_flipped(ByteVector bytes, std::size_t byte, std::uint8_t mask) {
  bytes[byte] ^= mask;
  return bytes;
}

ByteVector with_fingerprint(ByteVector bytes, std::uint64_t fingerprint) {
  for (std::size_t i = 0; i < kFingerprint; ++i) {
    bytes[kFingerprint - 1 - i] = static_cast<std::uint8_t>(fingerprint >> (8 * i));
  }
  return bytes;
}

ByteVector with_fingerprint_reversed(ByteVector bytes) {
  std::reverse(bytes.begin(), bytes.begin() + kFingerprint);
  return bytes;
}

ByteVector without_fingerprint(ByteVector bytes) {
  bytes.erase(bytes.begin(), bytes.begin() + kFingerprint);
  return bytes;
}

ByteVector text(std::string_view characters) {
  return {characters.begin(), characters.end()};
}

ByteVector garbage(std::size_t size, unsigned seed) {
  std::mt19937 random(seed);
  ByteVector bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

// A request's fingerprint, followed by random bytes and this number of bodies.
ByteVector garbage_after_fingerprint(std::size_t size, unsigned seed, std::int32_t count) {
  return with_count(joined(first(request_of(0), kFingerprint), garbage(size, seed)), count);
}

}  // namespace

std::vector<MalformedMessage> malformed_messages() {
  std::vector<MalformedMessage> list;
  DecodeError error = DecodeError::kTruncated;
  const auto add = [&](std::string name, ByteVector bytes) {
    list.push_back({std::move(name), std::move(bytes), error});
  };
  add("no bytes", {});
  add("one byte", first(request_of(1), 1));
  add("a fingerprint without its last byte", first(request_of(1), 7));
  add("a fingerprint alone", first(request_of(1), 8));
  add("cut within the number of bodies", first(request_of(1), 43));
  add("a response without bodies", response_of(0));
  add("twenty bytes of garbage", garbage(20, 1));
  add("a short line of text", text("hello\n"));
  add("zeros, one byte short of the fixed fields", ByteVector(kFixed - 1, 0x00));

  error = DecodeError::kFingerprint;
  add("first bit of the fingerprint flipped", with_flipped(request_of(1), 0, 0x80));
  add("last bit of the fingerprint flipped", with_flipped(request_of(1), 7, 0x01));
  add("a middle byte of the fingerprint inverted", with_flipped(request_of(1), 4, 0xff));
  add("fingerprint in little-endian order", with_fingerprint_reversed(request_of(1)));
  add("fingerprint zero", with_fingerprint(request_of(1), 0));
  add("fingerprint all ones", with_fingerprint(request_of(1), ~std::uint64_t{0}));
  add("fingerprint of bot_core.pose_t", with_fingerprint(request_of(1), 0x2e16efb052b0105e));
  add("fingerprint of bot_core.rigid_transform_t", with_fingerprint(request_of(1), 0xea9ffbf2acc5c5ae));
  add("no fingerprint at all", without_fingerprint(request_of(1)));
  add("a byte before the message", joined({0}, request_of(1)));
  add("all bytes in reverse order", [] {
    ByteVector bytes = request_of(1);
    std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }());
  add("a body_wrenches_t", response_of(1));
  add("a body_wrenches_t with 1000 bodies", response_of(1000));
  add("a service_status_t", status());
  add("a response's fingerprint before a request",
      joined(first(response_of(0), 8), without_fingerprint(request_of(1))));
  // LCM's short message header: magic, number, channel.
  add("a datagram of LCM inside the message", joined(text("LC02....BUOYANCY_STATES."), request_of(1)));
  add("JSON", text(R"({"utime": 0, "session_id": 1, "seq": 1, "bodies": [{"body_id": 1}]})"));
  add("HTTP", text("GET /index.html HTTP/1.1\r\nHost: 239.255.76.67:7667\r\nAccept: */*\r\n\r\n"));
  add("as long as the fixed fields, zeros", ByteVector(kFixed, 0x00));
  add("a large datagram of zeros", ByteVector(kLargeDatagram, 0x00));
  add("a large datagram of ones", ByteVector(kLargeDatagram, 0xff));
  add("garbage as long as a request of one body", garbage(kFixed + kBody, 2));
  add("a large datagram of garbage", garbage(kLargeDatagram, 3));

  error = DecodeError::kCount;
  add("-1 bodies", with_count(request_of(1), -1));
  add("-1 bodies and nothing after it", with_count(request_of(0), -1));
  add("-2 bodies", with_count(request_of(2), -2));
  add("INT_MIN bodies", with_count(request_of(1), INT_MIN));
  add("INT_MIN bodies and nothing after it", with_count(request_of(0), INT_MIN));
  add("INT_MIN + 1 bodies", with_count(request_of(1), INT_MIN + 1));
  add("a negative number of bodies before garbage", garbage_after_fingerprint(1000, 4, -1000));
  add("a negative number of bodies in a large datagram", garbage_after_fingerprint(kLargeDatagram, 5, -7));

  error = DecodeError::kLength;
  add("one body announced, none present", with_count(request_of(0), 1));
  add("cut after the first body's id", first(request_of(1), kFixed + 4));
  add("one body, its last byte missing", first(request_of(1), kFixed + kBody - 1));
  add("three bodies, the last byte missing", first(request_of(3), kFixed + 3 * kBody - 1));
  add("three bodies announced, two present", first(request_of(3), kFixed + 2 * kBody));
  add("one body announced too few", with_count(request_of(2), 1));
  add("no body announced, one present", with_count(request_of(1), 0));
  add("INT_MAX bodies", with_count(request_of(1), INT_MAX));
  add("INT_MAX bodies and nothing after it", with_count(request_of(0), INT_MAX));
  add("a number of bodies in little-endian order", with_count(request_of(1), 1 << 24));
  add("2^30 bodies, which is no byte modulo 2^32", with_count(request_of(0), 1 << 30));
  add("2^30 + 1 bodies, which is one body modulo 2^32", with_count(request_of(1), (1 << 30) + 1));
  add("a million bodies", with_count(request_of(1), 1'000'000));
  add("a zero byte too many", extended(request_of(1), 1, 0x00));
  add("another byte too many", extended(request_of(1), 1, 0x5a));
  add("padded to a multiple of eight bytes", extended(request_of(2), 4, 0x00));
  add("nearly another body after the last", extended(request_of(1), kBody - 1, 0x00));
  add("another body after the last", extended(request_of(1), kBody, 0x00));
  add("a byte after no bodies", extended(request_of(0), 1, 0x00));
  add("two requests in one message", joined(request_of(1), request_of(1)));
  add("a request and a response in one message", joined(request_of(1), response_of(1)));
  add("garbage after the fingerprint", garbage_after_fingerprint(1000, 6, 9));
  add("a large datagram of garbage after the fingerprint",
      garbage_after_fingerprint(kLargeDatagram, 7, 12345));
  return list;
}

}  // namespace buoyancy
