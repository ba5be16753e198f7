// A list of malformed requests, each with the error that decoding must return. Tests use it for the request
// handler itself and for the service over a network.
#pragma once

#include <string>
#include <vector>

#include "messages/wire.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {

struct MalformedMessage {
  std::string name;  // unique
  ByteVector bytes;
  DecodeError error;  // that decoding returns
};

// Returns the same list, byte for byte, at every call.
std::vector<MalformedMessage> malformed_messages();

}  // namespace buoyancy
