// Messages of seas.
#pragma once

#include <cstdint>
#include <string>

#include "messages/sea_state.h"
#include "scene/scene_file.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {

// An encoded sea_state_t of the sea that these keys of [water] describe.
inline ByteVector sea_bytes(const std::string& water, std::int64_t utime) {
  const SceneDescription described = parse_water("[water]\n" + water, "sea", {}).value();
  SeaState state = to_sea_state(Sea::make(described.sea, described.water).value(), 5);
  state.utime = utime;
  return encoded(state);
}

}  // namespace buoyancy
