// Bytes of a message that a test owns, since those that a request handler returns are valid until its next
// call only.
#pragma once

#include <cstdint>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

using ByteVector = std::vector<std::uint8_t>;

inline ByteVector copy_of(Bytes bytes) {
  return {bytes.begin(), bytes.end()};
}

}  // namespace buoyancy
