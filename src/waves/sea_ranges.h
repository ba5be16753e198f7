// The ranges of the numbers that describe a sea, against which both the scene file's keys and Sea::make()
// check. They are wide enough for every basin and ocean, and narrow enough that nothing that follows from
// them overflows.
#pragma once

#include "base/number_range.h"
#include "waves/sea_description.h"

namespace buoyancy::sea_ranges {

inline constexpr NumberRange kHeight = NumberRange::from_zero_to(1e4, "m");
inline constexpr NumberRange kDepth = NumberRange::above_zero("m");  // infinity is allowed as well
inline constexpr NumberRange kPeriod = NumberRange::from_to(0.01, 1e5, "s");
inline constexpr NumberRange kAngularFrequency = NumberRange::from_to(1e-5, 1e3, "rad/s");
inline constexpr NumberRange kAngle = NumberRange::from_to(-1e6, 1e6, "degrees");
inline constexpr NumberRange kGamma = NumberRange::from_to(1.0, 10.0);
inline constexpr NumberRange kSpreading = NumberRange::above_zero_to(1e4);
inline constexpr NumberRange kBins = NumberRange::from_to(1.0, static_cast<double>(kMaxWaveComponents));
inline constexpr NumberRange kCutoff = NumberRange::from_to(1.1, 20.0, "peak frequencies");
inline constexpr NumberRange kRamp = NumberRange::from_zero_to(1e9, "s");

}  // namespace buoyancy::sea_ranges
