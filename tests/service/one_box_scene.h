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

// Such a box in a current, with drag and added mass. The scene requests its loads; torques are about a point
// beside its centre.
inline const std::string kLoadsBoxScene = kTestWater + R"([water.current]
velocity = [0.5, 0.25, 0]
[[body]]
id = 1
name = "hull"
shape = { type = "box", size = [2, 3, 4], segments = [2, 2, 2] }
reference_point = [0.5, -0.25, 0]
outputs = ["wrench", "loads"]
[body.drag]
linear = [20, 60, 60, 5, 5, 8]
quadratic = [18, 22, 37, 1.5, 1.5, 1.5]
[body.added_mass]
matrix = [5, 126, 126, 0.1, 33, 33]
)";

}  // namespace buoyancy
