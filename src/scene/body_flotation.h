// Finds the attitudes at which the bodies of a scene float, and warns about those that are likely mistakes.
//
// All results are for water at rest, and for the condition of compartments and tanks in the scene file.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "flotation/equilibrium.h"
#include "scene/scene.h"

namespace buoyancy {

struct BodyFlotation {
  FlotationOutcome outcome = FlotationOutcome::kOutOfRange;
  std::vector<Equilibrium> attitudes;  // the stable ones, the lowest energy first
  bool is_truncated = false;           // there are more of them
  // The index of the attitude to which the body turns from its `orientation` while its energy decreases.
  std::optional<std::size_t> reached;
  double turn = 0.0;  // [rad], by which up turns in B on the way there; 0 where any attitude floats
  // At `orientation` the body is in equilibrium, but not in a stable one.
  bool starts_unstable = false;
  double mass = 0.0;       // [kg], with the liquids in its tanks
  double displaced = 0.0;  // [kg], of the water displaced fully submerged; a mere scale for an open mesh
};

struct FlotationOfBody {
  std::shared_ptr<const BodyFlotation> flotation;  // null: [body.client] is absent or has no mass
  bool left_out = false;                           // not computed, because of the limit; null then, too
};

inline constexpr std::size_t kMaxFlotationVertices = 2'000'000;

// Returns one element per body, in the order of the scene; equal bodies share one. Distinct bodies are
// computed as long as their meshes have at most max_vertices in total, each counted once per distinct body
// and as at least 2,000; the first body always is. Complexity: that of find_equilibria() per distinct body.
std::vector<FlotationOfBody> scene_flotation(const Scene& scene,
                                             std::size_t max_vertices = kMaxFlotationVertices);

// Warns about bodies with [body.client] whose mass is unknown, that sink, take in water, capsize (the
// attitude that they reach is turned by more than 90 degrees), or start at an unstable equilibrium, and about
// those that cannot start at equilibrium. A warning that applies to several bodies alike appears once and
// counts them. flotation: of the scene.
std::vector<Warning> flotation_warnings(const Scene& scene, const std::vector<FlotationOfBody>& flotation);

}  // namespace buoyancy
