#include "service/replay/content_hash.h"

#include <new>

#include <spdlog/fmt/fmt.h>
#include <xxhash.h>

namespace buoyancy::service {

ContentHash::ContentHash() : state_(XXH3_createState()) {
  if (!state_) throw std::bad_alloc();
  XXH3_128bits_reset(state_.get());
}

void ContentHash::update(Bytes bytes) {
  XXH3_128bits_update(state_.get(), bytes.data(), bytes.size());
}

std::string ContentHash::text() const {
  const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
  return fmt::format("xxh128:{:016x}{:016x}", hash.high64, hash.low64);
}

void ContentHash::FreeState::operator()(XXH3_state_s* state) const {
  XXH3_freeState(state);
}

}  // namespace buoyancy::service
