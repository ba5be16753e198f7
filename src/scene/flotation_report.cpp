#include "scene/flotation_report.h"

#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/angles.h"
#include "flotation/hydrostatic_table.h"
#include "scene/floating_bodies.h"
#include "scene/start_pose.h"
#include "scene/up_axis.h"

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
        .say("heel and trim 0 with the body's {} axis up", axis_name(body.axes.up_B))
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

namespace {

Facts upright_facts(const HydrostaticRow& row, double length) {
  Facts facts;
  facts.line("").add("draft", row.draft, "draft {:4} m");
  facts.add("volume", row.volume, "displaces {:4} m^3").add("mass", row.mass, "{:4} kg");
  facts.add("kb", row.kb, "KB {:4} m").add("bm_t", row.bm_t, "BM {:4} m");
  facts.add("bm_l", row.bm_l, "and lengthwise {:4} m");
  facts.add("lcf", row.lcf).say("LCF {:4} m", without_noise(row.lcf, 1e-12 * length));
  return facts;
}

}  // namespace

void add_upright(const Body& body, const Water& water, const std::vector<double>& drafts,
                 MeshesWithTrees& meshes, Facts& facts) {
  const Expected<FloatingBody> hull = floating_hull_of(body, meshes.of(*body.prepared_mesh));
  const auto table = hull.and_then([&](const FloatingBody& of) {
    return HydrostaticTable::make(of, water, {.axes = body.axes, .knows_mass = false});
  });
  facts.line("upright").say("{} up; KB over the lowest point, LCF forward of the middle",
                            axis_name(body.axes.up_B));
  Json& rows = facts.list("upright");
  for (const double draft : drafts) {
    const std::optional<HydrostaticRow> row = table ? table->row(draft) : std::nullopt;
    Facts one = row ? upright_facts(*row, body.prepared_mesh->mesh.diagonal) : Facts();
    if (!row) {
      one.line("").say("draft {:4} m", draft).say("no result: the edge of the open mesh is under water");
      one.json() = {{"draft", draft},  {"volume", nullptr}, {"mass", nullptr}, {"kb", nullptr},
                    {"bm_t", nullptr}, {"bm_l", nullptr},   {"lcf", nullptr}};
    }
    facts.heading(one.text());
    rows.push_back(std::move(one.json()));
  }
}

}  // namespace buoyancy
