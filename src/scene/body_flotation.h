// At which attitudes the bodies of a scene float, and what about that is worth a warning.
//
// All of it is for water at rest, and for the condition of compartments and tanks in the scene file.
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
  // The one that the body turns to from its `orientation` when its energy can only fall.
  std::optional<std::size_t> reached;
  double turn = 0.0;  // [rad], by which up turns in the body's axes until there; 0: any attitude floats
  // At `orientation`, buoyancy acts above or below the centre of mass although the body does not stay there.
  bool starts_unstable = false;
  double mass = 0.0;       // [kg], with the liquids in its tanks
  double displaced = 0.0;  // [kg], of the water that it displaces fully submerged; of an open mesh a scale
};

struct FlotationOfBody {
  std::shared_ptr<const BodyFlotation> flotation;  // null: [body.client] is absent or has no mass
  bool left_out = false;                           // not computed, because of the limit; null then, too
};

inline constexpr std::size_t kMaxFlotationVertices = 2'000'000;

// One element per body of the scene, in its order. Equal bodies share theirs. Those that differ are computed
// as long as their meshes have at most max_vertices together, each counted as often as it is used, and as
// 2,000 at least; the first body is always computed. Complexity: find_equilibria() per body that differs.
std::vector<FlotationOfBody> scene_flotation(const Scene& scene,
                                             std::size_t max_vertices = kMaxFlotationVertices);

// Warnings about bodies with [body.client] whose mass is unknown, that sink, take in water, capsize (the
// attitude that they reach is turned by more than 90 degrees), or start at an unstable equilibrium, and about
// those that cannot start at equilibrium. A warning that applies to several bodies alike appears once and
// counts them. flotation: of the scene.
std::vector<Warning> flotation_warnings(const Scene& scene, const std::vector<FlotationOfBody>& flotation);

}  // namespace buoyancy
