#include "scene/motion_report.h"

#include <cmath>
#include <string>
#include <string_view>

#include "flotation/submerged.h"

namespace buoyancy {
namespace {

std::string_view to_string(ImmersionScaling scaling) {
  switch (scaling) {
    case ImmersionScaling::kVolume:
      return "volume";
    case ImmersionScaling::kWettedArea:
      return "wetted_area";
    case ImmersionScaling::kNone:
      break;
  }
  return "none";
}

struct BalanceName {
  std::string_view name;
  std::string_view words;
};

BalanceName name_of(VerticalBalance balance) {
  switch (balance) {
    case VerticalBalance::kFloats:
      return {"floats", ""};  // the draft says so
    case VerticalBalance::kSinks:
      return {"sinks", "sinks: heavier than the water that it displaces"};
    case VerticalBalance::kNeutral:
      return {"neutrally buoyant", "neutrally buoyant"};
    case VerticalBalance::kUnknown:
      break;
  }
  return {"unknown", "takes in water at this attitude before it floats"};
}

std::string_view to_string(StepLimit limit) {
  switch (limit) {
    case StepLimit::kFloating:
      return "afloat";
    case StepLimit::kSubmerged:
      return "fully submerged";
    case StepLimit::kTerminalVelocity:
      return "fully submerged at terminal velocity";
    case StepLimit::kNone:
      break;
  }
  return "none";
}

// Adds a matrix as the scene file has it: six numbers if diagonal, else 36 row by row. words: its format.
void add_matrix(std::string_view key, const Mat6& matrix, std::string_view words, Facts& facts) {
  const bool is_diagonal = matrix == Mat6(matrix.diagonal().asDiagonal());
  const Vec6 diagonal = matrix.diagonal();
  facts.say(words, is_diagonal ? "" : "36 numbers, diagonal ", Vec3(diagonal.head<3>()),
            Vec3(diagonal.tail<3>()));
  Json& numbers = facts.list(key);
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = 0; column < 6; ++column) {
      if (row == column || !is_diagonal) numbers.push_back(matrix(row, column));
    }
  }
}

void add_place(const Vec3& center_B, ImmersionScaling immersion, Facts& facts) {
  facts.line("").add("center", center_B, "about [{}] m");
  facts.add("immersion", to_string(immersion), "immersion \"{}\"");
}

Facts drag_facts(const DragCoefficients& drag) {
  Facts facts;
  facts.line("drag");
  add_matrix("linear", drag.linear, "linear {}[{}, {}]", facts);
  facts.line("");
  add_matrix("quadratic", drag.quadratic, "quadratic {}[{}, {}]", facts);
  add_place(drag.center_B, drag.immersion, facts);
  return facts;
}

Facts added_mass_facts(const AddedMassCoefficients& added_mass) {
  Facts facts;
  facts.line("added mass");
  add_matrix("matrix", added_mass.matrix, "{}[{}, {}]", facts);
  add_place(added_mass.center_B, added_mass.immersion, facts);
  return facts;
}

// unit: of the amplitude.
Facts natural_facts(std::string_view name, const NaturalMotion& motion, std::string_view unit,
                    bool has_drag) {
  Facts facts;
  facts.line(name);
  facts.add("period", motion.period(), "period {:4} s");
  facts.add("damping_ratio", motion.damping_ratio, has_drag ? "damping ratio {:4}" : "");
  facts.add("amplitude", motion.amplitude);
  facts.add("damping_ratio_at_amplitude", motion.damping_ratio_at_amplitude);
  facts.say_if(motion.damping_ratio_at_amplitude != motion.damping_ratio, "{:4} at an amplitude of {:4} {}",
               motion.damping_ratio_at_amplitude, motion.amplitude, unit);
  return facts;
}

void add_natural(std::string_view name, const NaturalMotion& motion, std::string_view unit, bool has_drag,
                 Facts& facts) {
  if (motion.frequency > 0.0) {
    facts.include(name, natural_facts(name, motion, unit, has_drag));
  } else {
    facts.line(name).add(name, nullptr).say("nothing restores it");
  }
}

Facts motion_facts(const BodyMotions& motions, const Body& body) {
  const bool has_drag = body.hydrodynamics != nullptr && body.hydrodynamics->coefficients().drag;
  const bool floats = motions.balance == VerticalBalance::kFloats;
  const BalanceName balance = name_of(motions.balance);
  const double terminal_velocity = motions.terminal_velocity.value_or(0.0);
  Facts facts;
  facts.line("balance").add("balance", balance.name).say_if(!floats, balance.words);
  facts.add("draft", motions.draft, floats ? "floats at a draft of {:4} m" : "");
  const bool turns = motions.turning_lever > kNoLever * body.prepared_mesh->mesh.diagonal;
  facts.say_if(turns, floats ? " at its orientation, from which it turns" : "and turns");
  facts.add("turning_lever", motions.turning_lever,
            turns ? ": buoyancy acts {:4} m beside the centre of mass" : "");
  facts.add("terminal_velocity", motions.terminal_velocity);
  if (terminal_velocity != 0.0) {
    facts.line("terminal")
        .say("{} at {:4} m/s, fully submerged", terminal_velocity > 0.0 ? "rises" : "sinks",
             std::abs(terminal_velocity));
  }
  if (motions.natural) {
    add_natural("heave", motions.natural->heave, "m", has_drag, facts);
    add_natural("roll", motions.natural->roll, "rad", has_drag, facts);
    add_natural("pitch", motions.natural->pitch, "rad", has_drag, facts);
    facts.line("").say("of small motions about its orientation");
    facts.say(floats ? "afloat" : "fully submerged");
  } else {
    facts.add("heave", nullptr).add("roll", nullptr).add("pitch", nullptr);
  }
  const std::string_view limit = to_string(motions.step_limit);
  facts.add("max_explicit_step", motions.max_explicit_step).add("step_limit", limit);
  if (std::isfinite(motions.max_explicit_step)) {
    facts.line("explicit step").say("below {:4} s, {}", motions.max_explicit_step, limit);
  }
  facts.add("added_mass_ratio", motions.added_mass_ratio);
  if (motions.added_mass_ratio > 1.0) {
    facts.line("mass ratio")
        .say("added mass up to {:4} times the mass: as an explicit force it diverges; use the matrix s A",
             motions.added_mass_ratio);
  }
  return facts;
}

// Returns why the motions of a body are unknown; empty where the report says nothing about them.
std::string why_unknown(const MotionsOfBody& entry, const Body& body, const Water& water) {
  if (!body.dynamics.given) {
    return body.hydrodynamics == nullptr ? "" : "unknown: no mass in [body.client]";
  }
  if (entry.left_out) return "left out: the bodies before it have too many vertices";
  const Expected<RigidBodyMass> mass = mass_of_body(body, water);
  return format_text("unknown: {}", mass ? "numbers beyond double's range" : mass.error().actual);
}

}  // namespace

void add_coefficients(const Body& body, Facts& facts) {
  if (body.hydrodynamics == nullptr) return;
  const HydrodynamicCoefficients& coefficients = body.hydrodynamics->coefficients();
  if (coefficients.drag) facts.include("drag", drag_facts(*coefficients.drag));
  if (coefficients.added_mass) facts.include("added_mass", added_mass_facts(*coefficients.added_mass));
}

void add_motions(const MotionsOfBody& entry, const Body& body, const Water& water, Facts& facts) {
  if (entry.motions) {
    facts.include("motions", motion_facts(*entry.motions, body));
    return;
  }
  if (body.dynamics.given) facts.add("motions", nullptr);
  const std::string reason = why_unknown(entry, body, water);
  if (!reason.empty()) facts.line("motions").say("{}", reason);
}

}  // namespace buoyancy
