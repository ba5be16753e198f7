// The largest permissible height of the centre of mass over a range of drafts: the KG up to which the general
// criteria of the 2008 IS Code, part A, 2.2, and if asked for the weather criterion of 2.3, are met. Data,
// not an approval by a class.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/json.h"
#include "flotation/hydrostatic_table.h"
#include "service/hydrostatics/righting_results.h"

namespace buoyancy::service {

struct KgLimit {
  double draft = 0.0;  // [m], at midship
  double trim = 0.0;   // [rad]
  double mass = 0.0;   // [kg], displaced
  // [m], over K, with the correction for free surfaces; nullopt: a criterion fails at every KG from 0 on.
  std::optional<double> kg_max;
  std::string governing;  // the criterion that fails above kg_max, or at KG 0
};

// The body displaces what it does at the draft and trim, upright, with its centre of mass on the vertical of
// the centre of buoyancy; its own mass, centre of mass and tanks do not count. KG is searched from the
// metacentre down, in steps of a twentieth of KM, and then refined to 1e-6 m, so that a criterion that fails
// only between two steps below may be missed. points, weather: see righting_results(). Returns nullopt where
// table.row() does, and where nothing is displaced or there is no waterplane. Complexity: some 20 times
// righting_results().
std::optional<KgLimit> kg_limit(const FloatingBody& body, const Water& water, const HydrostaticTable& table,
                                double draft, double trim, const ImmersionPoints& points,
                                const RightingArmOptions& options, const WeatherInputs* weather);

// Masses in tonnes, angles in degrees.
std::string kg_limits_text(const std::vector<KgLimit>& limits);
Json kg_limits_json(const std::vector<KgLimit>& limits);
std::string kg_limits_csv(const std::vector<KgLimit>& limits);

}  // namespace buoyancy::service
