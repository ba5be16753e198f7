// Evaluates one body at many poses in the caller's process: no messages, no sessions.
//
// The results have the bits of the service's responses to the same poses: both call the same functions
// (engine/body_evaluation.h), and the bits depend neither on the number of threads nor on the other poses.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "engine/body_evaluation.h"
#include "messages/loads.h"
#include "query/pose_arrays.h"
#include "query/query_sea.h"

namespace buoyancy {

// The water of a query.
struct QueryWater {
  Water at_rest;
  std::shared_ptr<const PreparedSea> waves;  // nullptr: the water is at rest
  Current current;                           // beside the waves
  bool is_known = true;                      // false: every pose gets BodyStatus::kNoSea
};

QueryWater water_of(const QuerySea& sea);
// The water that the scene describes. It is unknown where its waves come in messages.
QueryWater water_of(const Scene& scene);

// Sets one wrench per pose. Arrays have the sizes that pose_arrays.h states. The checks of a pose and their
// order are those of the service (validate_pose(), then the twist of a body with drag or added mass, then the
// sea), and so are drag and added mass, if the body has them.
// loads: one per pose, of which those with status kOk are set, with the body's loads; or empty.
// threads: 0 for the number of hardware threads. Little work stays on the caller's thread.
// Precondition: in waves the body's mesh has a wave_mesh. Several threads may evaluate at once.
// Complexity: per pose that of buoyancy(), or of buoyancy_in_waves(), O(components) more where the utime
// differs from that of the pose before it.
void evaluate_poses(const Body& body, const QueryWater& water, const PoseArrays& poses,
                    const WrenchArrays& wrenches, std::span<BodyLoads> loads = {}, unsigned threads = 1);

// Sets the hydrostatics of each pose in water at rest: one per pose. A pose that buoyancy() does not accept
// gets its status. body: its mesh has a moment tree. See evaluate_poses() for threads.
void evaluate_hydrostatics(const Body& body, const Water& water, const PoseArrays& poses,
                           std::span<BodyHydrostatics> hydrostatics, unsigned threads = 1);

}  // namespace buoyancy
