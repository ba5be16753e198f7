#include "scene/flotation_report.h"

#include <cmath>
#include <numbers>

#include "base/format.h"
#include "scene/start_pose.h"

namespace buoyancy {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::size_t kMaxLines = 12;

// Derived numbers are rounded, and what is 0 but for rounding is 0; the JSON report has all digits.
std::string rounded(double value, double noise) {
  return format_number(std::abs(value) < noise ? 0.0 : value, 4);
}

std::string attitude_text(const Equilibrium& at, bool reached) {
  const std::array<double, 2>& heights = at.state.hydrostatics.metacentric_heights;
  std::string text = reached ? "              * " : "                ";
  text += "draft " + rounded(at.draft, 0.0) + " m, heel " + rounded(at.angles.heel * kDegrees, 1e-6);
  text += " deg, trim " + rounded(at.angles.trim * kDegrees, 1e-6) + " deg, GM " + rounded(heights[0], 1e-12);
  text += " and " + rounded(heights[1], 1e-12) + " m, energy " + rounded(at.state.energy, 0.0) + " J";
  if (at.family == AttitudeFamily::kCurve) text += ", one of a curve";
  if (at.family == AttitudeFamily::kSphere) text += ", any attitude";
  return text + "\n";
}

Json to_json(const Equilibrium& at, bool reached, const Body& body, const Water& water) {
  const Pose pose = placed_pose(at, body.dynamics, water);
  return {{"reached", reached},
          {"position", {pose.p_WB.x(), pose.p_WB.y(), pose.p_WB.z()}},
          {"quaternion_wxyz", {pose.q_WB.w(), pose.q_WB.x(), pose.q_WB.y(), pose.q_WB.z()}},
          {"draft", at.draft},
          {"heel", at.angles.heel * kDegrees},
          {"trim", at.angles.trim * kDegrees},
          {"metacentric_heights", at.state.hydrostatics.metacentric_heights},
          {"energy", at.state.energy},
          {"family", to_string(at.family)}};
}

}  // namespace

std::string flotation_text(const FlotationOfBody& entry, const Body& body) {
  if (entry.left_out) return "  attitudes     left out: the bodies before it have too many vertices\n";
  if (!entry.flotation || entry.flotation->attitudes.empty()) return "";
  const BodyFlotation& flotation = *entry.flotation;
  std::string text;
  if (flotation.reached && body.dynamics.start == StartKind::kEquilibrium) {
    text += "  start         at equilibrium, from its orientation\n";
  }
  const std::size_t count = flotation.attitudes.size();
  text +=
      "  attitudes     " + pluralize(static_cast<std::int64_t>(count), "stable attitude", "stable attitudes");
  text += ", heel and trim 0 with the body's z axis up";
  text += flotation.reached ? "; * is where it turns to from its orientation\n" : "\n";
  for (std::size_t i = 0; i < count; ++i) {
    const bool reached = flotation.reached == i;
    if (i < kMaxLines || reached) text += attitude_text(flotation.attitudes[i], reached);
  }
  if (count > kMaxLines) text += "                all are listed by --check --json\n";
  return text;
}

Json to_json(const BodyFlotation& flotation, const Body& body, const Water& water) {
  Json attitudes = Json::array();
  for (std::size_t i = 0; i < flotation.attitudes.size(); ++i) {
    attitudes.push_back(to_json(flotation.attitudes[i], flotation.reached == i, body, water));
  }
  return {{"outcome", to_string(flotation.outcome)},
          {"start", body.dynamics.start == StartKind::kEquilibrium ? "equilibrium" : "pose"},
          {"mass", flotation.mass},
          {"attitudes", std::move(attitudes)},
          {"truncated", flotation.is_truncated},
          {"turn", flotation.reached ? Json(flotation.turn * kDegrees) : Json(nullptr)},
          {"starts_unstable", flotation.starts_unstable}};
}

}  // namespace buoyancy
