// Describes a sea to a page (view/page/sea.js): the numbers that the service computes with.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/json.h"
#include "engine/sea_timeline.h"
#include "waves/sea.h"

namespace buoyancy::view {

// "e1", "e2", "up"   [3], W: the horizontal axes, and up
// "level", "depth"   [m]; depth is null in deep water
// "time_origin"      [us], the utime of t = 0
// "ramp"             [s]
// "pressure"         to_string(WavePressure)
// "amplitude" [m], "apparent_frequency" [rad/s], "wave_number", "k1", "k2" [rad/m] and "phase" [rad]: arrays
//                    of one number per component, as in PreparedComponents
// Numbers have the digits from which the same double is read back.
Json sea_json(const Sea& sea);
// A calm sea has no components.
Json sea_json(const SeaPeriod& period);
// A sea on grids, with its surface at this time. Like the above, and
// "surface"   "rise" [m], and "parts": objects whose splines, times their shares, add up to the elevation:
//   "share"
//   "origin", "spacing"  [2], [m]: of the samples along e1 and e2
//   "cells"              [2], numbers of cells between samples
//   "periodic"
//   "coefficients"       base64 of float32: rows of cells[0] + 3, one after the other along e2; see
//                        ElevationSpline. Splines on the same grid are one part.
// Surfaces of more than kMaxDrawnCoefficients have no parts.
Json surface_json(const SeaPeriod& period, std::int64_t utime, double lead_time);
inline constexpr std::size_t kMaxDrawnCoefficients = 1'100'000;  // about 1,024 by 1,024 samples

// The time t of the sea [s] at utime [us]. Pages get t, since JavaScript's numbers do not hold every utime.
double sea_time(const Sea& sea, std::int64_t utime, double lead_time);
// 0 in a calm sea, which is the same at all times.
double sea_time(const SeaPeriod& period, std::int64_t utime, double lead_time);

}  // namespace buoyancy::view
