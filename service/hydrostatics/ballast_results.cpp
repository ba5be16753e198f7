#include "service/hydrostatics/ballast_results.h"

#include <spdlog/fmt/fmt.h>

#include "base/format.h"
#include "service/hydrostatics/hydrostatics_output.h"

namespace buoyancy::service {
namespace {

std::string depth_sentence(const Ballast& ballast) {
  if (!ballast.is_submerged()) return fmt::format("The body floats with a draft of {:.6g} m.", ballast.draft);
  if (ballast.outcome == FlotationOutcome::kNeutral) return "The body hangs in the water, neutrally buoyant.";
  return fmt::format("The body sinks: it weighs {:.6g} kg more than the water that it displaces.",
                     ballast.total_mass - ballast.displaced_mass);
}

}  // namespace

std::string ballast_text(const Ballast& ballast) {
  std::string text = fmt::format("{:>14}{:>14}{:>14}{:>14}\n", "ballast, kg", "x, m", "y, m", "z, m");
  for (const BallastPlace& place : ballast.places) {
    const Vec3& at = place.position_B;
    text += fmt::format("{:>14.8g}{:>14.6f}{:>14.6f}{:>14.6f}\n", place.mass, at.x() + 0.0, at.y() + 0.0,
                        at.z() + 0.0);
  }
  text += fmt::format("{}\nGM {:.5g} m and {:.5g} m: {}\n", depth_sentence(ballast),
                      ballast.metacentric_heights[0], ballast.metacentric_heights[1],
                      ballast.is_stable() ? "stable" : "NOT stable");
  if (ballast.stability_limit_B) {
    const Vec3& limit = *ballast.stability_limit_B;
    text += fmt::format("stable with the ballast straight below ({:.6f}, {:.6f}, {:.6f})\n", limit.x() + 0.0,
                        limit.y() + 0.0, limit.z() + 0.0);
  }
  const Vec3& center = ballast.center_of_mass_B;
  text += fmt::format("\n[body.client]\nmass           = {:.17g}  # kg\n", ballast.mass_with_body);
  text +=
      fmt::format("center_of_mass = [{:.17g}, {:.17g}, {:.17g}]  # m\n", center.x(), center.y(), center.z());
  return text;
}

Json ballast_json(const Ballast& ballast) {
  Json places = Json::array();
  for (const BallastPlace& place : ballast.places) {
    places.push_back({{"mass", place.mass}, {"position", place.position_B}});
  }
  Json json{{"ballast", std::move(places)},
            {"outcome", to_string(ballast.outcome)},
            {"draft", ballast.is_submerged() ? Json(nullptr) : Json(ballast.draft)},
            {"stable", ballast.is_stable()},
            {"metacentric_heights", ballast.metacentric_heights},
            {"stability_limit", nullptr},
            {"in_box", ballast.is_in_box},
            {"total_mass", ballast.total_mass},
            {"displaced_mass", ballast.displaced_mass},
            {"mass", ballast.mass_with_body},
            {"center_of_mass", ballast.center_of_mass_B}};
  if (ballast.stability_limit_B) json["stability_limit"] = *ballast.stability_limit_B;
  return json;
}

std::string ballast_csv(const Ballast& ballast) {
  std::string text = "mass,x,y,z\n";
  for (const BallastPlace& place : ballast.places) {
    const Vec3& at = place.position_B;
    text += csv_row({place.mass, at.x(), at.y(), at.z()});
  }
  return text;
}

std::optional<Warning> outside_warning(const Ballast& ballast) {
  if (ballast.is_in_box) return std::nullopt;
  return Warning{"ballast", "outside of the hull", "a place in the box around the hull",
                 "a keel or an outrigger may carry it there", "Use more ballast if the hull has neither"};
}

std::optional<Error> instability(const Ballast& ballast) {
  if (ballast.is_stable()) return std::nullopt;
  std::string text = "in balance, but not stable";
  for (std::size_t i = 0; i < 2; ++i) {
    if (ballast.metacentric_heights[i] > 0.0) continue;
    text += i == 0 ? ": " : "; ";
    text += gm_about_axis(ballast.metacentric_heights[i], ballast.turning_axes_B[i]);
  }
  return Error{"ballast", std::move(text), "both metacentric heights above 0",
               "the centre of mass is too high", "Put the ballast lower or use more of it"};
}

}  // namespace buoyancy::service
