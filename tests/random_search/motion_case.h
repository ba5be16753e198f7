// Random bodies with drag and added mass, and random steps, for the search for motions that gain energy.
#pragma once

#include <cstdint>
#include <string>

#include "scene/scene_file.h"
#include "simulation/simulation.h"

namespace buoyancy {

enum class MotionKind { kSubmerged, kPiercing };

// A body in water at rest. Submerged ones are neutrally buoyant, far below the surface. Piercing ones start
// at the surface, with a step that the step warning accepts: the highest natural frequency times the step is
// at most 0.5.
struct MotionCase {
  MotionKind kind = MotionKind::kSubmerged;
  SceneDescription scene;  // one body
  SimulationOptions options;
  std::int64_t steps = 0;

  // The same body without drag.
  SceneDescription scene_without_drag() const;
  std::string text() const;
};

// Depends on the seed and the number alone.
MotionCase random_motion_case(std::uint64_t seed, std::int64_t number);

}  // namespace buoyancy
