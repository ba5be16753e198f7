#include "tests/random_search/flotation_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "flotation/equilibrium.h"
#include "geometry/mass_properties.h"
#include "geometry/shapes.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// [J], of rounding: of the volume and of the mass, at their levers, and of the pose where the mesh is far
// from B's origin.
double energy_rounding(const FloatingBody& body, const Water& water, const Equilibrium& at) {
  const double lever = body.reach() + (body.center_of_mass_B() - body.center_B()).norm();
  const double volume =
      water.density * body.volume_tolerance() + body.liquid_tolerance() + 16.0 * kEpsilon * body.total_mass();
  const double distance = body.center_of_mass_B().norm() + body.reach();
  return water.gravity * volume * lever + at.force_bound * distance * kEpsilon;
}

// Violation of an attitude, or an empty string.
std::string violation_of(const FloatingBody& body, const Water& water, const Equilibrium& at,
                         RandomPoses& random) {
  std::ostringstream text;
  if (!(at.residual_force <= at.force_bound)) {
    text << "force " << at.residual_force << " N, bound " << at.force_bound;
    return text.str();
  }
  if (!(at.residual_torque <= at.torque_bound)) {
    text << "torque " << at.residual_torque << " N m, bound " << at.torque_bound;
    return text.str();
  }
  if (at.family != AttitudeFamily::kNone) return {};
  constexpr int kDirections = 20;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = i % 2 == 0 ? 1e-3 : 1e-4;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, random.direction()));
    const Vec3 to_mass_W = at.pose.q_WB * body.center_of_mass_B();
    Pose moved = at.pose;
    moved.q_WB = turn * at.pose.q_WB;
    moved.p_WB += to_mass_W - moved.q_WB * body.center_of_mass_B();
    moved.p_WB += 0.1 * angle * random.uniform(-1.0, 1.0) * body.reach() * water.up_W;
    const std::optional<FloatingState> state = floating_state(body, moved, water);
    const double fall = state ? at.state.energy - state->energy : -1.0;
    if (fall > energy_rounding(body, water, at)) {
      text << "the energy falls by " << fall << " J of " << at.state.energy << " at a turn of " << angle
           << " rad, rounding " << energy_rounding(body, water, at) << ", stiffness " << at.stiffness[0]
           << " and " << at.stiffness[1] << " N m";
      return text.str();
    }
  }
  return {};
}

HydrostaticMesh box_mesh(const BoundingBox& box) {
  const Vec3 size = box.max_B - box.min_B;
  const BoxShape shape{.size = {size.x(), size.y(), size.z()}};
  return make_hydrostatic_mesh({moved_and_scaled(make_shape(shape), box.center()), {}});
}

// The meshes of a case and the body that they make. In place: the body refers to the meshes.
struct CaseBody {
  explicit CaseBody(const FlotationCase& flotation) : mesh(make_hydrostatic_mesh(flotation.mesh.validated)) {
    const double total_mass =
        flotation.relative_density * water.density * (1.0 - flotation.permeability) * mesh.volume;
    std::vector<PlacedMesh> meshes{{.mesh = &mesh}};
    if (flotation.permeability > 0.0) {
      meshes.push_back({.mesh = &mesh, .signed_permeability = -flotation.permeability});
    }
    double mass = total_mass;
    tank_meshes.reserve(flotation.tanks.size());
    std::vector<Tank> tanks;
    for (const RandomTank& tank : flotation.tanks) {
      const HydrostaticMesh& tank_mesh = tank_meshes.emplace_back(box_mesh(tank.box));
      const double volume = tank.fill * tank_mesh.volume;
      tanks.push_back({&tank_mesh, volume, tank.share_of_mass * total_mass / volume});
      mass -= tank.share_of_mass * total_mass;
    }
    body = FloatingBody::make(meshes, mass, flotation.center_of_mass_B, tanks);
  }
  CaseBody(const CaseBody&) = delete;
  CaseBody& operator=(const CaseBody&) = delete;

  Water water;
  HydrostaticMesh mesh;
  std::vector<HydrostaticMesh> tank_meshes;
  std::optional<Expected<FloatingBody>> body;
};

FlotationCase case_of(std::uint64_t seed, std::int64_t number) {
  RandomPoses random(seed * 1'000'003 + static_cast<std::uint64_t>(number));
  return random_flotation_case(random);
}

SearchStats run_case(std::uint64_t seed, std::int64_t number) {
  const FlotationCase flotation = case_of(seed, number);
  const CaseBody of_case(flotation);
  SearchStats stats;
  stats.cases = 1;
  if (!*of_case.body) {
    stats.add_violations(number, flotation.text(), {of_case.body->error().message()});
    return stats;
  }
  const FloatingBody& body = **of_case.body;
  const Equilibria equilibria = find_equilibria(body, of_case.water);
  std::vector<std::string> violations;
  if (equilibria.outcome != FlotationOutcome::kFloats || equilibria.attitudes.empty()) {
    violations.emplace_back("no attitude was found");
  }
  SearchFigures& figures = stats.rows["all"];
  const auto count = static_cast<std::int64_t>(equilibria.attitudes.size());
  figures.counts = {{"cases", 1}, {"attitudes", count}, {"of families", 0}};
  figures.largest["attitudes of one body"].add(static_cast<double>(count), number);
  RandomPoses random(seed * 7919 + static_cast<std::uint64_t>(number));
  for (const Equilibrium& at : equilibria.attitudes) {
    if (at.family != AttitudeFamily::kNone) ++figures.counts["of families"];
    figures.largest["force over its bound"].add(at.residual_force / at.force_bound, number);
    figures.largest["torque over its bound"].add(at.residual_torque / at.torque_bound, number);
    const std::string violation = violation_of(body, of_case.water, at, random);
    if (!violation.empty()) violations.push_back(violation);
  }
  stats.add_violations(number, flotation.text(), violations);
  return stats;
}

}  // namespace

std::string FlotationCase::text() const {
  std::ostringstream text;
  text.precision(17);
  text << "  " << mesh.kind << ", relative density " << relative_density << ", centre of mass "
       << center_of_mass_B.transpose() << ", permeability " << permeability << "\n";
  for (const RandomTank& tank : tanks) {
    text << "    tank from " << tank.box.min_B.transpose() << " to " << tank.box.max_B.transpose()
         << ", fill " << tank.fill << ", " << tank.share_of_mass << " of the mass\n";
  }
  return text.str();
}

FlotationCase random_flotation_case(RandomPoses& random) {
  const auto share = [&random] { return random.uniform(0.0, 1.0); };
  // Each number is drawn in a statement or in braces, whose order is fixed.
  const auto shares = [&share] {
    const std::array<double, 3> drawn{share(), share(), share()};
    return Vec3(drawn[0], drawn[1], drawn[2]);
  };
  FlotationCase flotation;
  flotation.mesh = random_mesh(random);
  const double fraction = share();
  const double small = std::pow(10.0, -4.0 * share());
  const double which = share();
  flotation.relative_density = which < 0.6 ? fraction : which < 0.8 ? small : 1.0 - small;
  flotation.relative_density = std::clamp(flotation.relative_density, 1e-5, 1.0 - 1e-5);
  const BoundingBox box = bounding_box(flotation.mesh.validated.mesh);
  flotation.center_of_mass_B = box.min_B + shares().cwiseProduct(box.max_B - box.min_B);
  // Bodies of even density, many of which are symmetric, float in more attitudes.
  if (share() < 0.5) {
    flotation.center_of_mass_B = mass_properties(flotation.mesh.validated.mesh).centroid_B;
  }
  if (share() < 0.5) return flotation;
  if (share() < 0.5) flotation.permeability = 0.9 * share();
  const int tanks = static_cast<int>(3.0 * share());
  for (int i = 0; i < tanks; ++i) {
    const Vec3 a = shares();
    const Vec3 b = a + 0.1 * Vec3::Ones() + 0.3 * shares();
    const Vec3 size = box.max_B - box.min_B;
    flotation.tanks.push_back({.box = {box.min_B + a.cwiseProduct(size), box.min_B + b.cwiseProduct(size)},
                               .fill = 0.05 + 0.9 * share(),
                               .share_of_mass = 0.4 * share()});
  }
  return flotation;
}

BalanceShares balance_shares(const FlotationCase& flotation) {
  const CaseBody of_case(flotation);
  BalanceShares shares;
  if (!*of_case.body) return shares;
  for (const Equilibrium& at : find_equilibria(**of_case.body, of_case.water).attitudes) {
    shares.force = std::max(shares.force, at.residual_force / at.force_bound);
    shares.torque = std::max(shares.torque, at.residual_torque / at.torque_bound);
  }
  return shares;
}

RandomSearch flotation_search() {
  RandomSearch one;
  one.name = "flotation";
  one.description = "Search for an attitude that is reported and is no stable equilibrium";
  one.first_column = "bodies";
  one.rows = {"all"};
  one.run = [](std::uint64_t seed, std::int64_t begin, std::int64_t end, unsigned threads) {
    return sum_in_parallel(static_cast<std::size_t>(end - begin), threads, [&](std::size_t i) {
      return run_case(seed, begin + static_cast<std::int64_t>(i));
    });
  };
  one.replay = [](std::uint64_t seed, std::int64_t number) {
    const SearchStats stats = run_case(seed, number);
    return stats.failures.empty() ? SearchFailure{number, case_of(seed, number).text(), {}}
                                  : stats.failures.front();
  };
  one.columns = {count_column("cases", "cases"),
                 count_column("attitudes", "attitudes"),
                 count_column("of families", "of families"),
                 largest_column("most of one body", "attitudes of one body"),
                 largest_column("largest residual / bound, force", "force over its bound"),
                 largest_column("torque", "torque over its bound")};
  return one;
}

}  // namespace buoyancy
