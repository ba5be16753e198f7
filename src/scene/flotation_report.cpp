#include "scene/flotation_report.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/angles.h"
#include "scene/start_pose.h"

namespace buoyancy {
namespace {

constexpr std::size_t kMaxLines = 12;

// Replaces a value that is only rounding noise by 0.
double without_noise(double value, double noise) {
  return std::abs(value) < noise ? 0.0 : value;
}

Facts attitude_facts(const Equilibrium& at, bool reached, const Body& body, const Water& water) {
  const Pose pose = placed_pose(at, body.dynamics, water);
  const std::array<double, 2>& heights = at.state.hydrostatics.metacentric_heights;
  const double heel = at.angles.heel * kDegreesPerRadian;
  const double trim = at.angles.trim * kDegreesPerRadian;
  Facts facts;
  facts.line(reached ? "            *" : "").add("reached", reached);
  facts.add("position", pose.p_WB).add("quaternion_wxyz", pose.q_WB);
  facts.add("draft", at.draft, "draft {:4} m");
  facts.add("heel", heel).say("heel {:4} deg", without_noise(heel, 1e-6));
  facts.add("trim", trim).say("trim {:4} deg", without_noise(trim, 1e-6));
  facts.add("metacentric_heights", heights);
  facts.say("GM {:4} and {:4} m", without_noise(heights[0], 1e-12), without_noise(heights[1], 1e-12));
  facts.add("energy", at.state.energy, "energy {:4} J");
  facts.add("family", to_string(at.family));
  facts.say_if(at.family == AttitudeFamily::kCurve, "one of a curve");
  facts.say_if(at.family == AttitudeFamily::kSphere, "any attitude");
  return facts;
}

Facts flotation_facts(const BodyFlotation& flotation, const Body& body, const Water& water) {
  const bool at_equilibrium = body.dynamics.start == StartKind::kEquilibrium;
  const std::size_t count = flotation.attitudes.size();
  Facts facts;
  facts.add("outcome", to_string(flotation.outcome));
  facts.add("start", at_equilibrium ? "equilibrium" : "pose").add("mass", flotation.mass);
  if (flotation.reached && at_equilibrium) {
    facts.line("start").say("at equilibrium, from its orientation");
  }
  if (count > 0) {
    facts.line("attitudes")
        .say(pluralize(static_cast<std::int64_t>(count), "stable attitude", "stable attitudes"))
        .say("heel and trim 0 with the body's z axis up")
        .say_if(flotation.reached.has_value(), "; * is where it turns to from its orientation");
  }
  Json& attitudes = facts.list("attitudes");
  for (std::size_t i = 0; i < count; ++i) {
    const bool reached = flotation.reached == i;
    Facts one = attitude_facts(flotation.attitudes[i], reached, body, water);
    if (i < kMaxLines || reached) facts.heading(one.text());
    attitudes.push_back(std::move(one.json()));
  }
  if (count > kMaxLines) facts.line("").say("all are listed by --check --json");
  facts.add("truncated", flotation.is_truncated);
  facts.add("turn", flotation.reached ? std::optional(flotation.turn * kDegreesPerRadian) : std::nullopt);
  facts.add("starts_unstable", flotation.starts_unstable);
  return facts;
}

}  // namespace

void add_flotation(const FlotationOfBody& entry, const Body& body, const Water& water, Facts& facts) {
  if (!body.dynamics.given) return;
  if (entry.flotation) {
    facts.include("flotation", flotation_facts(*entry.flotation, body, water));
  } else {
    facts.add("flotation", nullptr);
  }
  if (entry.left_out) facts.line("attitudes").say("left out: the bodies before it have too many vertices");
}

}  // namespace buoyancy
