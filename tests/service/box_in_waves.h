// A box in a sea, for tests of programs in waves.
#pragma once

#include <cstdint>
#include <string>

#include "messages/sea_state.h"
#include "tests/support/byte_vector.h"
#include "tests/support/scene_of.h"

namespace buoyancy {

// water: what the scene says of it.
inline std::string box_in(const std::string& water) {
  return "[water]\n" + water +
         "[[body]]\nid = 1\nshape = { type = \"box\", size = [2, 3, 4], segments = [2, 2, 2] }\n";
}

// The sea that a service would publish.
inline SeaState sea_of(const std::string& water, std::int64_t instance_id) {
  return to_sea_state(*scene_of(box_in(water)).sea(), instance_id);
}

}  // namespace buoyancy
