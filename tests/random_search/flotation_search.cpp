#include "tests/random_search/flotation_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>
#include <thread>

#include "geometry/mass_properties.h"
#include "geometry/shapes.h"

namespace buoyancy {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

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
                         std::mt19937_64& random) {
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
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int i = 0; i < kDirections; ++i) {
    const double angle = i % 2 == 0 ? 1e-3 : 1e-4;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, random_direction(random)));
    const Vec3 to_mass_W = at.pose.q_WB * body.center_of_mass_B();
    Pose moved = at.pose;
    moved.q_WB = turn * at.pose.q_WB;
    moved.p_WB += to_mass_W - moved.q_WB * body.center_of_mass_B();
    moved.p_WB += 0.1 * angle * uniform(random) * body.reach() * water.up_W;
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
  TriangleMesh mesh = make_shape(BoxShape{.size = {size.x(), size.y(), size.z()}});
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    mesh.x[i] += box.center().x();
    mesh.y[i] += box.center().y();
    mesh.z[i] += box.center().z();
  }
  return make_hydrostatic_mesh({mesh, {}});
}

void run_case(std::uint64_t seed, std::int64_t number, FlotationSearchStats& stats) {
  const FlotationCase flotation = random_flotation_case(seed, number);
  const HydrostaticMesh mesh = make_hydrostatic_mesh(flotation.mesh.validated);
  const Water water;
  std::vector<PlacedMesh> meshes{{.mesh = &mesh}};
  if (flotation.permeability > 0.0) meshes.push_back({.mesh = &mesh, .factor = -flotation.permeability});
  const double total_mass =
      flotation.relative_density * water.density * (1.0 - flotation.permeability) * mesh.volume;
  double mass = total_mass;
  std::vector<HydrostaticMesh> tank_meshes;
  tank_meshes.reserve(flotation.tanks.size());
  std::vector<Tank> tanks;
  for (const RandomTank& tank : flotation.tanks) {
    const HydrostaticMesh& tank_mesh = tank_meshes.emplace_back(box_mesh(tank.box));
    const double volume = tank.fill * tank_mesh.volume;
    tanks.push_back({&tank_mesh, volume, tank.share_of_mass * total_mass / volume});
    mass -= tank.share_of_mass * total_mass;
  }
  ++stats.cases;
  const Expected<FloatingBody> body = FloatingBody::make(meshes, mass, flotation.center_of_mass_B, tanks);
  if (!body) {
    stats.failures.push_back({number, body.error().message()});
    return;
  }
  const Equilibria equilibria = find_equilibria(*body, water);
  if (equilibria.outcome != FlotationOutcome::kFloats || equilibria.attitudes.empty()) {
    stats.failures.push_back({number, "no attitude was found"});
    return;
  }
  const auto count = static_cast<std::int64_t>(equilibria.attitudes.size());
  stats.attitudes += count;
  stats.most_attitudes = std::max(stats.most_attitudes, count);
  std::mt19937_64 random(seed * 7919 + static_cast<std::uint64_t>(number));
  for (const Equilibrium& at : equilibria.attitudes) {
    if (at.family != AttitudeFamily::kNone) ++stats.families;
    stats.largest_force = std::max(stats.largest_force, at.residual_force / at.force_bound);
    stats.largest_torque = std::max(stats.largest_torque, at.residual_torque / at.torque_bound);
    const std::string violation = violation_of(*body, water, at, random);
    if (!violation.empty()) stats.failures.push_back({number, violation});
  }
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

FlotationCase random_flotation_case(std::uint64_t seed, std::int64_t number) {
  std::mt19937_64 random(seed * 1'000'003 + static_cast<std::uint64_t>(number));
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  FlotationCase flotation;
  flotation.mesh = random_mesh(random());
  const double fraction = uniform(random);
  const double small = std::pow(10.0, -4.0 * uniform(random));
  const double which = uniform(random);
  flotation.relative_density = which < 0.6 ? fraction : which < 0.8 ? small : 1.0 - small;
  flotation.relative_density = std::clamp(flotation.relative_density, 1e-5, 1.0 - 1e-5);
  const BoundingBox box = bounding_box(flotation.mesh.validated.mesh);
  const Vec3 share(uniform(random), uniform(random), uniform(random));
  flotation.center_of_mass_B = box.min_B + share.cwiseProduct(box.max_B - box.min_B);
  // Bodies of even density, many of which are symmetric, float in more attitudes.
  if (uniform(random) < 0.5) {
    flotation.center_of_mass_B = mass_properties(flotation.mesh.validated.mesh).centroid_B;
  }
  if (uniform(random) < 0.5) return flotation;
  if (uniform(random) < 0.5) flotation.permeability = 0.9 * uniform(random);
  const int tanks = static_cast<int>(3.0 * uniform(random));
  for (int i = 0; i < tanks; ++i) {
    const Vec3 a(uniform(random), uniform(random), uniform(random));
    const Vec3 b = a + 0.1 * Vec3::Ones() + 0.3 * Vec3(uniform(random), uniform(random), uniform(random));
    const Vec3 size = box.max_B - box.min_B;
    flotation.tanks.push_back({.box = {box.min_B + a.cwiseProduct(size), box.min_B + b.cwiseProduct(size)},
                               .fill = 0.05 + 0.9 * uniform(random),
                               .share_of_mass = 0.4 * uniform(random)});
  }
  return flotation;
}

FlotationSearchStats& FlotationSearchStats::operator+=(const FlotationSearchStats& other) {
  cases += other.cases;
  attitudes += other.attitudes;
  families += other.families;
  most_attitudes = std::max(most_attitudes, other.most_attitudes);
  largest_force = std::max(largest_force, other.largest_force);
  largest_torque = std::max(largest_torque, other.largest_torque);
  failures.insert(failures.end(), other.failures.begin(), other.failures.end());
  return *this;
}

std::string FlotationSearchStats::text() const {
  std::ostringstream text;
  text << cases << " bodies, " << attitudes << " attitudes (" << families << " of families, at most "
       << most_attitudes << " of one body), largest residual over bound: force " << largest_force
       << ", torque " << largest_torque;
  return text.str();
}

FlotationSearchStats search_flotation(std::uint64_t seed, std::int64_t begin, std::int64_t end,
                                      unsigned threads) {
  std::vector<FlotationSearchStats> parts(std::max(1U, threads));
  std::vector<std::thread> workers;
  for (std::size_t part = 0; part < parts.size(); ++part) {
    workers.emplace_back([&, part] {
      for (std::int64_t number = begin + static_cast<std::int64_t>(part); number < end;
           number += static_cast<std::int64_t>(parts.size())) {
        run_case(seed, number, parts[part]);
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
  FlotationSearchStats stats;
  for (const FlotationSearchStats& part : parts) stats += part;
  std::sort(stats.failures.begin(), stats.failures.end(),
            [](const FailedFlotationCase& a, const FailedFlotationCase& b) { return a.number < b.number; });
  return stats;
}

}  // namespace buoyancy
