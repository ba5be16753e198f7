// The water at points, as the loads of bodies see it: the one function that the service, the replay and
// queries in the caller's process share.
#pragma once

#include <cstddef>

#include "base/current.h"
#include "engine/body_evaluation.h"
#include "engine/thread_pool.h"
#include "messages/water_samples.h"
#include "messages/wire_views.h"

namespace buoyancy {

// Returns the water at a point: that of SeaSnapshot::at(), or water at rest, with the pressure of its layers.
// Velocity and acceleration are of the waves alone, and above the surface those at the surface below the
// point. Precondition: the water is known. No heap allocation. Complexity: O(components).
WaterAtPoint water_at(const WaterState& water, const Vec3& p_W);

// Returns what a water_samples_t says of a point; above the surface there is neither pressure nor velocity.
// Numbers are not finite where the surface is not known, or beyond double's range. Precondition and
// complexity: those of water_at().
WaterSample sample_at(const WaterState& water, const Current& current, const WaterPoint& point);

// The status of a request for the water at these points before anything is computed. Checks in this order:
// all coordinates are finite, the water is known. O(points).
BodyStatus check_points(const WaterPointsView& points, const WaterState& water);

// Returns the rough time [ns] that sample_at() takes.
double estimated_time_per_point(const WaterState& water);

// Sets samples [begin, end) of a response, on several threads if that pays; bits do not depend on
// their number. Returns false if one of them is not finite. Precondition: check_points() returned kOk. No
// heap allocation.
bool sample_points(const WaterPointsView& points, std::size_t begin, std::size_t end, const WaterState& water,
                   const Current& current, ThreadPool& threads, WaterSamplesWriter& samples);

}  // namespace buoyancy
