// A hash of 128 bits that is faster than memory (XXH3, by libxxhash): it detects damage and mix-ups, not
// forgery. `xxhsum -H2 FILE` prints the same digits.
#pragma once

#include <memory>
#include <string>

#include "messages/wire.h"

struct XXH3_state_s;

namespace buoyancy::service {

// Hashes bytes that arrive in pieces: the hash does not depend on how they are divided.
class ContentHash {
 public:
  ContentHash();
  void update(Bytes bytes);
  std::string text() const;  // "xxh128:" and 32 digits

 private:
  struct FreeState {
    void operator()(XXH3_state_s* state) const;
  };
  std::unique_ptr<XXH3_state_s, FreeState> state_;
};

}  // namespace buoyancy::service
