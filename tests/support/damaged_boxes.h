// A scene of boxes with compartments and tanks for tests, and messages that change them.
#pragma once

#include <cstdint>
#include <string>

#include "messages/condition_change.h"
#include "tests/support/byte_vector.h"

namespace buoyancy {

// What the scene says of the condition of body 1.
struct DamagedBoxes {
  std::string bow_flooded = "0";
  std::string stern_flooded = "0.25";
  std::string ballast = "fill = 0.5";
};

// The compartments "bow" and "stern" of body 1 have 2 and 4 m^3, and its tank "ballast" 1 m^3. Body 2 is an
// equal box without any, body 3 has the tank "bilge" of 1 m^3 alone. outputs: of body 1.
inline std::string damaged_boxes(const DamagedBoxes& condition = {},
                                 const std::string& outputs = "\"wrench\", \"hydrostatics\", \"loads\"") {
  const std::string box = "shape = { type = \"box\", size = [6, 3, 2], segments = [3, 2, 2] }\n";
  return "[[body]]\nid = 1\nname = \"hull\"\n" + box + "outputs = [" + outputs +
         "]\n"
         "[[body.compartment]]\nname = \"bow\"\nshape = { type = \"box\", size = [1, 2, 1] }\n"
         "position = [2, 0, -0.5]\npermeability = 0.9\nflooded = " +
         condition.bow_flooded +
         "\n"
         "[[body.compartment]]\nname = \"stern\"\nshape = { type = \"box\", size = [2, 2, 1] }\n"
         "position = [-2, 0, -0.5]\nflooded = " +
         condition.stern_flooded +
         "\n"
         "[[body.tank]]\nname = \"ballast\"\nshape = { type = \"box\", size = [1, 1, 1] }\n"
         "position = [0, 0.5, -0.5]\n" +
         condition.ballast +
         "\n"
         "[[body]]\nid = 2\nname = \"plain\"\n" +
         box + "[[body]]\nid = 3\nname = \"barge\"\n" + box +
         "[[body.tank]]\nname = \"bilge\"\nshape = { type = \"box\", size = [1, 1, 1] }\nfill = 0\n";
}

inline ConditionChange flooded(std::int64_t utime, std::int32_t compartment, double share,
                               std::int32_t body_id = 1) {
  return {.utime = utime,
          .body_id = body_id,
          .kind = ConditionKind::kCompartment,
          .index = compartment,
          .flooded = share,
          .liquid_volume = -1.0};  // ignored
}

inline ConditionChange filled(std::int64_t utime, std::int32_t tank, double volume,
                              std::int32_t body_id = 1) {
  return {.utime = utime,
          .body_id = body_id,
          .kind = ConditionKind::kTank,
          .index = tank,
          .flooded = -1.0,  // ignored
          .liquid_volume = volume};
}

}  // namespace buoyancy
