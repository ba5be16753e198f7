// The scene of most service and replay tests.
#pragma once

#include <string>

namespace buoyancy {

inline constexpr double kDensity = 1000.0;
inline constexpr double kGravity = 10.0;

// The first lines of a scene file: kDensity and kGravity.
inline const std::string kTestWater = R"(
[world]
gravity = 10.0
[water]
density = 1000.0
)";

// A box of 2 x 3 x 4 m centred on B's origin.
inline const std::string kOneBoxScene = kTestWater + R"([[body]]
id = 1
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
method = "exact"
)";

}  // namespace buoyancy
