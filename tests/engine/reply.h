// What a request handler publishes for a request.
#pragma once

#include "engine/request_handler.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {

struct Reply {
  ByteVector response, hydrostatics, loads;

  bool operator==(const Reply&) const = default;
};

// Of the last request.
inline Reply reply_of(const RequestHandler& handler) {
  return {copy_of(handler.last_response()), copy_of(handler.last_hydrostatics()),
          copy_of(handler.last_loads())};
}

inline Reply reply_to(RequestHandler& handler, Bytes request) {
  handler.handle(request);
  return reply_of(handler);
}

inline WrenchResponse response_of(const Reply& reply) {
  return decoded<WrenchResponse>(reply.response);
}

}  // namespace buoyancy
