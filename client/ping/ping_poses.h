// The poses that buoyancy-ping sends. They depend on the scene, the seed and the number of the request alone,
// so that a failure can be repeated on any machine.
//
// Every body in turn is surface-piercing at any attitude, fully submerged, dry, and surface-piercing near its
// mesh's own attitude: the most telling pose comes first, for runs of one request. Every fourth quaternion
// has a norm other than 1, within what the service normalises, and all bodies move, since drag and added mass
// depend on it.
#pragma once

#include <cstdint>
#include <vector>

#include "hydrostatics/immersion.h"
#include "messages/request.h"
#include "scene/scene.h"

namespace buoyancy::ping {

// The surface of the water that poses are placed about.
struct WaterSurface {
  double level = 0.0;          // [m], at rest
  double max_elevation = 0.0;  // [m], of the highest crest over it; 0 in still water
};

// Returns where the bounding box of the body with this index in the scene lies in this request.
Immersion immersion_of(std::int64_t request, std::size_t body);

// Replaces states by those of this request: one of each body, in the order of the scene. O(bodies).
void make_states(const Scene& scene, const WaterSurface& surface, std::uint64_t seed, std::int64_t request,
                 std::vector<BodyState>& states);

}  // namespace buoyancy::ping
