// The curve of righting arms with what is read from it: immersions of the deck edge and of openings, and the
// general criteria of the 2008 IS Code.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flotation/point_immersion.h"
#include "flotation/righting_arms.h"

namespace buoyancy::service {

// One of the general criteria of the 2008 IS Code, part A, 2.2. They are data, not an approval by a class.
struct StabilityCriterion {
  std::string name;
  double value = 0.0;
  double required = 0.0;
  std::string unit;
  bool reached = true;  // does the curve reach the heel that the criterion names?

  bool is_met() const { return reached && value >= required; }
};

struct RightingResults {
  RightingCurve curve;
  std::vector<StabilityCriterion> criteria;                // to starboard; empty: not known
  std::optional<FirstImmersions> deck_edge, downflooding;  // nullopt: no points were given
};

// [m], B: points of the deck edge, and openings through which water comes in.
struct ImmersionPoints {
  std::vector<Vec3> deck_edge_B, downflooding_B;
};

// heels and nullopt: see righting_curve(). The curve of the criteria ends at the angle of downflooding to
// starboard; that of the results does not. options.progress counts the heels of the curve and of the
// criteria.
std::optional<RightingResults> righting_results(const FloatingBody& body, const Water& water,
                                                std::span<const double> heels, const ImmersionPoints& points,
                                                const RightingArmOptions& options);

}  // namespace buoyancy::service
