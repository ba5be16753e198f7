#include "scene/motion_report.h"

#include <cmath>
#include <string_view>

#include "base/format.h"

namespace buoyancy {
namespace {

using Json = nlohmann::ordered_json;

// A lever within this part of the mesh's diagonal is rounding, or that of a generated mesh.
constexpr double kNoLever = 1e-6;

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

std::string_view to_string(VerticalBalance balance) {
  switch (balance) {
    case VerticalBalance::kFloats:
      return "floats";
    case VerticalBalance::kSinks:
      return "sinks";
    case VerticalBalance::kNeutral:
      return "neutrally buoyant";
    case VerticalBalance::kUnknown:
      break;
  }
  return "unknown";
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

// Derived numbers are rounded; the JSON report has all digits.
std::string format_rounded(double value) {
  return format_number(value, 4);
}

// g++ 12 warns about overflow in sums of strings that begin with a literal.
template <typename... Parts>
std::string joined(const Parts&... parts) {
  std::string text;
  ((text += parts), ...);
  return text;
}

bool is_diagonal(const Mat6& matrix) {
  return matrix == Mat6(matrix.diagonal().asDiagonal());
}

std::string diagonal_text(const Mat6& matrix) {
  return joined(is_diagonal(matrix) ? "[" : "36 numbers, diagonal [",
                format_vector(matrix.diagonal().head<3>()), ", ", format_vector(matrix.diagonal().tail<3>()),
                "]");
}

std::string placed_text(const Vec3& center_B, ImmersionScaling immersion) {
  return joined("                about [", format_vector(center_B), "] m, immersion \"", to_string(immersion),
                "\"\n");
}

std::string motion_text(const char* label, const NaturalMotion& motion, const char* unit, bool has_drag) {
  if (!(motion.frequency > 0.0)) return joined(label, "nothing restores it\n");
  std::string text = joined(label, "period ", format_rounded(motion.period()), " s");
  if (has_drag) text += joined(", damping ratio ", format_rounded(motion.damping_ratio));
  if (motion.damping_ratio_at_amplitude != motion.damping_ratio) {
    text += joined(", ", format_rounded(motion.damping_ratio_at_amplitude), " at an amplitude of ",
                   format_rounded(motion.amplitude), " ", unit);
  }
  return text + "\n";
}

std::string balance_text(const BodyMotions& motions) {
  switch (motions.balance) {
    case VerticalBalance::kFloats:
      return joined("floats at a draft of ", format_rounded(*motions.draft), " m");
    case VerticalBalance::kSinks:
      return "sinks: heavier than the water that it displaces";
    case VerticalBalance::kNeutral:
      return "neutrally buoyant";
    case VerticalBalance::kUnknown:
      break;
  }
  return "takes in water at this attitude before it floats";
}

std::string terminal_velocity_text(const BodyMotions& motions) {
  const double velocity = motions.terminal_velocity.value_or(0.0);
  if (velocity == 0.0) return "";
  return joined("  terminal      ", velocity > 0.0 ? "rises" : "sinks", " at ",
                format_rounded(std::abs(velocity)), " m/s, fully submerged\n");
}

std::string known_text(const BodyMotions& motions, const Body& body) {
  const bool has_drag = body.hydrodynamics != nullptr && body.hydrodynamics->coefficients().drag;
  std::string text = joined("  balance       ", balance_text(motions));
  if (motions.turning_lever > kNoLever * body.prepared_mesh->mesh.diagonal) {
    const bool floats = motions.balance == VerticalBalance::kFloats;
    text += joined(floats ? " at its orientation, from which it turns" : ", and turns", ": buoyancy acts ",
                   format_rounded(motions.turning_lever), " m beside the centre of mass");
  }
  text += "\n";
  text += terminal_velocity_text(motions);
  if (motions.natural) {
    text += motion_text("  heave         ", motions.natural->heave, "m", has_drag);
    text += motion_text("  roll          ", motions.natural->roll, "rad", has_drag);
    text += motion_text("  pitch         ", motions.natural->pitch, "rad", has_drag);
    text += joined("                of small motions about its orientation, ",
                   motions.balance == VerticalBalance::kFloats ? "afloat\n" : "fully submerged\n");
  }
  if (std::isfinite(motions.max_explicit_step)) {
    text += joined("  explicit step below ", format_rounded(motions.max_explicit_step), " s, ",
                   to_string(motions.step_limit), "\n");
  }
  if (motions.added_mass_ratio > 1.0) {
    text += joined("  mass ratio    added mass up to ", format_rounded(motions.added_mass_ratio),
                   " times the mass: as an explicit force it diverges; use the matrix s A\n");
  }
  return text;
}

std::string unknown_text(const MotionsOfBody& entry, const Body& body, const Water& water) {
  if (!body.dynamics.given) {
    return body.hydrodynamics == nullptr ? "" : "  motions       unknown: no mass in [body.client]\n";
  }
  if (entry.left_out) return "  motions       left out: the bodies before it have too many vertices\n";
  const Expected<BodyMass> mass = mass_of_body(body, water);
  return joined("  motions       unknown: ", mass ? "numbers beyond double's range" : mass.error().actual,
                "\n");
}

Json to_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// As in the scene file: six numbers, or 36 row by row.
Json to_json(const Mat6& matrix) {
  Json numbers = Json::array();
  const bool diagonal = is_diagonal(matrix);
  for (Eigen::Index row = 0; row < 6; ++row) {
    for (Eigen::Index column = 0; column < 6; ++column) {
      if (row == column || !diagonal) numbers.push_back(matrix(row, column));
    }
  }
  return numbers;
}

Json to_json(const NaturalMotion& motion) {
  if (!(motion.frequency > 0.0)) return nullptr;
  return {{"period", motion.period()},
          {"damping_ratio", motion.damping_ratio},
          {"amplitude", motion.amplitude},
          {"damping_ratio_at_amplitude", motion.damping_ratio_at_amplitude}};
}

}  // namespace

std::string coefficients_text(const Body& body) {
  if (body.hydrodynamics == nullptr) return "";
  const HydrodynamicCoefficients& coefficients = body.hydrodynamics->coefficients();
  std::string text;
  if (coefficients.drag) {
    const DragCoefficients& drag = *coefficients.drag;
    text += joined("  drag          linear ", diagonal_text(drag.linear), "\n");
    text += joined("                quadratic ", diagonal_text(drag.quadratic), "\n");
    text += placed_text(drag.center_B, drag.immersion);
  }
  if (coefficients.added_mass) {
    text += joined("  added mass    ", diagonal_text(coefficients.added_mass->matrix), "\n");
    text += placed_text(coefficients.added_mass->center_B, coefficients.added_mass->immersion);
  }
  return text;
}

std::string motions_text(const MotionsOfBody& entry, const Body& body, const Water& water) {
  return entry.motions ? known_text(*entry.motions, body) : unknown_text(entry, body, water);
}

Json to_json(const DragCoefficients& drag) {
  return {{"linear", to_json(drag.linear)},
          {"quadratic", to_json(drag.quadratic)},
          {"center", to_json(drag.center_B)},
          {"immersion", to_string(drag.immersion)}};
}

Json to_json(const AddedMassCoefficients& added_mass) {
  return {{"matrix", to_json(added_mass.matrix)},
          {"center", to_json(added_mass.center_B)},
          {"immersion", to_string(added_mass.immersion)}};
}

Json to_json(const BodyMotions& motions) {
  const std::optional<NaturalMotions>& natural = motions.natural;
  return {{"balance", to_string(motions.balance)},
          {"draft", motions.draft ? Json(*motions.draft) : Json(nullptr)},
          {"turning_lever", motions.turning_lever},
          {"terminal_velocity", motions.terminal_velocity ? Json(*motions.terminal_velocity) : Json(nullptr)},
          {"heave", natural ? to_json(natural->heave) : Json(nullptr)},
          {"roll", natural ? to_json(natural->roll) : Json(nullptr)},
          {"pitch", natural ? to_json(natural->pitch) : Json(nullptr)},
          {"max_explicit_step", motions.max_explicit_step},
          {"step_limit", to_string(motions.step_limit)},
          {"added_mass_ratio", motions.added_mass_ratio}};
}

}  // namespace buoyancy
