// Bytes that are not a request, one of every kind we could think of, each with the cause that it must be
// counted by: for the handler itself and for the service behind a real network.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "messages/wire.h"

namespace buoyancy {

struct MalformedMessage {
  std::string name;  // unique
  std::vector<std::uint8_t> bytes;
  DecodeError cause;
};

// The same list, byte for byte, at every call.
std::vector<MalformedMessage> malformed_messages();

}  // namespace buoyancy
