// The curve of righting arms with what is read from it: immersions of the deck edge and of openings, the
// general criteria and the weather criterion of the 2008 IS Code.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "flotation/point_immersion.h"
#include "flotation/righting_arms.h"
#include "flotation/weather_criterion.h"

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
  bool asks_weather = false;                               // was the weather criterion asked for?
  std::optional<WeatherCriterion> weather = {};            // nullopt: not asked for, or not known
};

// [m], B: points of the deck edge, and openings through which water comes in.
struct ImmersionPoints {
  std::vector<Vec3> deck_edge_B, downflooding_B;
};

// What the weather criterion needs. table: of a body of the same meshes; outlives this.
struct WeatherInputs {
  WeatherExposure exposure;
  const HydrostaticTable* table = nullptr;
};

// heels and nullopt: see righting_curve(). weather: nullptr leaves its criterion out. The curve of the
// criteria ends at the angle of downflooding to starboard; that of the results does not. options.progress
// counts the heels of the curve and of the criteria.
std::optional<RightingResults> righting_results(const FloatingBody& body, const Water& water,
                                                std::span<const double> heels, const ImmersionPoints& points,
                                                const RightingArmOptions& options,
                                                const WeatherInputs* weather = nullptr);

}  // namespace buoyancy::service
