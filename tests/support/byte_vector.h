// Messages as bytes that a test owns, since those that a request handler returns are valid until its next
// call only.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

using ByteVector = std::vector<std::uint8_t>;

inline ByteVector copy_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

// Message: any that has encode() and decode().
template <typename Message>
ByteVector encoded(const Message& message) {
  ByteVector bytes;
  encode(message, bytes);
  return bytes;
}

// Throws std::runtime_error if the bytes are not such a message.
template <typename Message>
Message decoded(Bytes bytes) {
  Message message;
  if (const auto error = decode(bytes, message)) throw std::runtime_error(to_string(*error));
  return message;
}

}  // namespace buoyancy
