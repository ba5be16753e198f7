#include "flotation/ballast.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/format.h"
#include "flotation/balance.h"

namespace buoyancy {
namespace {

std::string kilograms(double mass) {
  return format_number(mass, 6) + " kg";
}

std::string at_place(const Vec3& place_B) {
  return format_number(place_B.x(), 6) + "," + format_number(place_B.y(), 6) + "," +
         format_number(place_B.z(), 6);
}

tl::unexpected<Error> ballast_error(std::string actual, std::string expected, std::string cause,
                                    std::string hint) {
  return make_error({"ballast", std::move(actual), std::move(expected), std::move(cause), std::move(hint)});
}

bool is_in_box(const FloatingBody& body, const Vec3& position_B) {
  for (int axis = 0; axis < 3; ++axis) {
    const double from_center = (position_B - body.center_B())[axis];
    const double slack = 1e-9 * body.reach();
    if (from_center < lowest_along(body, Vec3::Unit(axis)) - slack) return false;
    if (from_center > -lowest_along(body, -Vec3::Unit(axis)) + slack) return false;
  }
  return true;
}

std::optional<Error> fault_of(const BallastTask& task) {
  const auto error = [](std::string actual, std::string expected, std::string hint) {
    return Error{"ballast", std::move(actual), std::move(expected), "", std::move(hint)};
  };
  if (!task.mass && !task.draft) {
    return error("neither a mass nor a draft", "the mass of the ballast, or the draft",
                 "Give one of them: it decides how deep the body lies");
  }
  if (task.mass && !(*task.mass > 0.0 && std::isfinite(*task.mass))) {
    return error(kilograms(*task.mass), "a finite mass above 0", "");
  }
  if (task.draft && !(*task.draft > 0.0 && std::isfinite(*task.draft))) {
    return error("a draft of " + format_number(*task.draft, 6) + " m", "a finite draft above 0", "");
  }
  if (task.places_B.size() > 2 || (task.places_B.size() == 2 && task.along_B)) {
    return error(std::to_string(task.places_B.size()) + " places", "at most two, or one on a line", "");
  }
  for (const Vec3& place : task.places_B) {
    if (!place.allFinite()) return error(at_place(place), "places of finite numbers", "");
  }
  return std::nullopt;
}

// How the body lies at the target, whatever the place of the ballast.
struct Depth {
  double mass = 0.0;       // [kg], of the ballast
  WaterPlane plane;        // about center_B
  DisplacedSum displaced;  // of that plane
  FlotationOutcome outcome = FlotationOutcome::kFloats;
};

// The draft's plane: it decides the mass.
Expected<Depth> depth_at_draft(const FloatingBody& body, const Water& water, const BallastTask& task,
                               const Vec3& up_B) {
  Depth depth;
  depth.plane = {.up_B = up_B, .h_c = lowest_along(body, up_B) + *task.draft};
  const std::string draft = "a draft of " + format_number(*task.draft, 6) + " m";
  if (is_boundary_wet(body, depth.plane)) {
    return ballast_error(draft, "a draft at which the edge of the open mesh is dry", "",
                         "Give a smaller draft");
  }
  const double top = -lowest_along(body, -up_B);
  if (!(depth.plane.h_c < top)) {
    return ballast_error(draft,
                         "less than " + format_number(top - lowest_along(body, up_B), 6) +
                             " m, where the hull goes under water",
                         "the draft of a submerged body is not determined",
                         "Give the mass of the ballast instead");
  }
  depth.displaced = displaced_sum(body, depth.plane, water);
  depth.mass = water.density * depth.displaced.volume - body.total_mass();
  if (!(depth.mass > 0.0)) {
    return ballast_error(
        draft + " takes " + kilograms(depth.mass),
        "a draft at which the hull displaces more than the body weighs, " + kilograms(body.total_mass()),
        "ballast cannot lift the body", "Give a larger draft");
  }
  if (task.mass && std::abs(*task.mass - depth.mass) > 1e-9 * (body.total_mass() + depth.mass)) {
    return ballast_error(draft + " takes " + kilograms(depth.mass) + ", not " + kilograms(*task.mass),
                         "a mass and a draft that agree", "the mass decides the draft", "Give one of them");
  }
  return depth;
}

Expected<Depth> depth_with_mass(const FloatingBody& body, const Water& water, double mass, const Vec3& up_B) {
  const Expected<FloatingBody> loaded =
      with_mass(body, body.mass() + mass, body.center_of_mass_B(), body.tanks());
  if (!loaded) return tl::unexpected(loaded.error());
  Depth depth;
  depth.mass = mass;
  depth.outcome = outcome_by_mass(*loaded, water);
  if (depth.outcome != FlotationOutcome::kFloats) {
    depth.plane = {.up_B = up_B, .h_c = 2.0 * body.reach()};
  } else {
    const std::optional<BalancedAttitude> at = Balance(*loaded, water).at(up_B);
    if (!at) {
      return ballast_error(kilograms(mass), "a mass with which the edge of the open mesh is dry",
                           "the mesh takes in water first", "Give a smaller mass");
    }
    depth.plane = at->plane();
  }
  depth.displaced = displaced_sum(body, depth.plane, water);
  return depth;
}

Vec3 across(const Vec3& vector_B, const Vec3& up_B) {
  return vector_B - up_B.dot(vector_B) * up_B;
}

// Sets the places, relative to the body's center_B. lever: [m], from center_B to where the ballast must lie
// but for its height.
std::vector<BallastPlace> placed(const FloatingBody& body, const BallastTask& task, double mass,
                                 const Vec3& lever, const Vec3& up_B) {
  constexpr double kVertical = 1e-9;  // [-], sine of an angle
  const Vec3& o = body.center_B();
  const double lowest = lowest_along(body, up_B);
  const Vec3 first = task.places_B.empty() ? Vec3(Vec3::Zero()) : task.places_B.front();
  const bool is_split = task.places_B.size() == 2;
  if (!is_split && !task.along_B) {
    if (!task.places_B.empty()) return {{first, mass}};
    return {{o + lever + lowest * up_B, mass}};
  }
  const Vec3 line = is_split ? Vec3(task.places_B[1] - first) : *task.along_B;
  const Vec3 flat = across(line, up_B);
  const Vec3 from_first = lever - across(first - o, up_B);
  const bool is_vertical = flat.norm() <= kVertical * line.norm();
  double share = is_vertical ? 0.0 : flat.dot(from_first) / flat.squaredNorm();
  if (is_split) {
    constexpr double kRounding = 1e-12;
    if (is_vertical) share = up_B.dot(line) < 0.0 ? 1.0 : 0.0;
    if (std::abs(share) < kRounding) share = 0.0;
    if (std::abs(share - 1.0) < kRounding) share = 1.0;
    return {{first, (1.0 - share) * mass}, {task.places_B[1], share * mass}};
  }
  if (is_vertical) share = (lowest - up_B.dot(first - o)) / up_B.dot(line);
  return {{first + share * line, mass}};
}

}  // namespace

Expected<Ballast> find_ballast(const FloatingBody& body, const Water& water, const BallastTask& task) {
  if (const std::optional<Error> fault = fault_of(task)) return make_error(*fault);
  const Vec3 k = up_at(task.axes, task.target);
  const Expected<Depth> depth =
      task.draft ? depth_at_draft(body, water, task, k) : depth_with_mass(body, water, *task.mass, k);
  if (!depth) return tl::unexpected(depth.error());

  Ballast result;
  result.mass = depth->mass;
  result.mass_with_body = body.mass() + depth->mass;
  result.total_mass = body.total_mass() + depth->mass;
  result.displaced_mass = water.density * depth->displaced.volume;
  result.outcome = depth->outcome;
  if (!result.is_submerged()) result.draft = depth->plane.h_c - lowest_along(body, k);

  // About center_B: the moment that the ballast must have, but for its part along k.
  const Vec3 without = mass_moment(body, liquid_sum(body, k, FreeSurfaces::kNo));
  const Vec3 required = result.total_mass * depth->displaced.moment / depth->displaced.volume - without;
  result.places = placed(body, task, depth->mass, across(required, k) / depth->mass, k);

  Vec3 moment_B = body.mass() * body.center_of_mass_B();
  Vec3 missing = required;
  for (const BallastPlace& place : result.places) {
    moment_B += place.mass * place.position_B;
    missing -= place.mass * (place.position_B - body.center_B());
    if (place.mass > 0.0 && !is_in_box(body, place.position_B)) result.is_in_box = false;
  }
  result.center_of_mass_B = moment_B / result.mass_with_body;

  BalancedAttitude attitude{.up_B = k, .height = -depth->plane.h_c, .lever_moment = -missing};
  const EnergyCurvature curvature = Balance(body, water).curvature(attitude);
  for (std::size_t i = 0; i < 2; ++i) {
    result.metacentric_heights[i] = curvature.values[i] / result.total_mass;
    // The up vector moves at right angles to the axis of the turn.
    result.turning_axes_B[i] = k.cross(curvature.directions_B[i]);
  }
  const Vec3 left = across(missing, k);
  const double rounding = 1e-12 * result.total_mass * body.reach();
  if (left.norm() > std::max(kBallastAttitude * std::abs(curvature.values[0]), rounding)) {
    const Vec3 parts = task.axes.components(left);
    return ballast_error(
        "a moment of " + format_number(left.norm(), 6) + " kg m is left: ballast would have to bring " +
            format_number(parts.x(), 6) + " kg m forward, " + format_number(parts.y(), 6) + " to port and " +
            format_number(parts.z(), 6) + " up",
        "places at which " + kilograms(depth->mass) + " balance the body at this heel and trim",
        "what is given cannot move the centre of mass under that of buoyancy",
        "Leave the place free to see where the ballast belongs");
  }
  for (const BallastPlace& place : result.places) {
    if (place.mass >= 0.0) continue;
    return ballast_error("it would take " + kilograms(place.mass) + " at " + at_place(place.position_B),
                         "masses of 0 or more",
                         "the point at which all the ballast would balance is not between the places",
                         "Move one of the places beyond it");
  }
  if (result.places.size() == 1) {
    result.stability_limit_B = result.places.front().position_B + curvature.values[0] / result.mass * k;
  }
  return result;
}

}  // namespace buoyancy
