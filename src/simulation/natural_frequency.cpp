#include "simulation/natural_frequency.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "flotation/floating_body.h"
#include "geometry/rotation_between.h"
#include "hydrodynamics/linear_algebra.h"
#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/lowest_vertex.h"
#include "scene/body_mass.h"
#include "simulation/hydrodynamic_motion.h"

namespace buoyancy {
namespace {

constexpr int kLevels = 16;

// Gives access to a mesh that has a tree: the mesh itself, or a copy where its method needs no tree.
class MeshWithTree {
 public:
  explicit MeshWithTree(const HydrostaticMesh& mesh) : mesh_(&mesh) {
    if (mesh.tree) return;
    copy_ = mesh;
    copy_->tree = build_moment_tree(*copy_);
    mesh_ = &*copy_;
  }
  MeshWithTree(const MeshWithTree&) = delete;
  MeshWithTree& operator=(const MeshWithTree&) = delete;
  ~MeshWithTree() = default;

  const HydrostaticMesh& mesh() const { return *mesh_; }

 private:
  std::optional<HydrostaticMesh> copy_;
  const HydrostaticMesh* mesh_;
};

// A body's added mass, if it has one.
struct AddedMass {
  Mat6 matrix_B = Mat6::Zero();  // about the centre of mass
  ImmersionScaling scaling = ImmersionScaling::kVolume;
};

// Computes the hydrostatics of a body, with its compartments and tanks if it has them.
class WaterplaneStiffness {
 public:
  WaterplaneStiffness(const HydrostaticMesh& mesh, const RigidBody& rigid, const Water& water)
      : mesh_(&mesh), rigid_(&rigid), water_(&water) {
    if (!rigid.contents) return;
    std::vector<PlacedMesh> meshes = rigid.contents->compartments;
    meshes.insert(meshes.begin(), {.mesh = &mesh});
    const Expected<FloatingBody> body = FloatingBody::make(meshes, rigid.mass, rigid.center_of_mass_B);
    if (body) loaded_ = *body;
  }

  // Returns values about C, the stiffness with that of weights, and the volume of the hull.
  std::optional<Hydrostatics> at(const Pose& pose) const {
    if (!rigid_->contents) {
      return hydrostatics(*mesh_, pose, *water_, rigid_->center_of_mass_B, std::nullopt);
    }
    if (!loaded_) return std::nullopt;
    const std::optional<FloatingState> state = floating_state(*loaded_, pose, *water_);
    if (!state) return std::nullopt;
    const BodyContents& contents = *rigid_->contents;
    Hydrostatics result = state->hydrostatics;
    result.volume += flooded_volume(*rigid_, pose, *water_);
    result.stiffness +=
        stiffness_of_weights(contents.own, contents.tanks, rigid_->center_of_mass_B, pose.q_WB, *water_);
    return result;
  }

 private:
  const HydrostaticMesh* mesh_;
  const RigidBody* rigid_;
  const Water* water_;
  std::optional<FloatingBody> loaded_;
};

double frequency_at(const WaterplaneStiffness& load, const HydrostaticMesh& mesh, const RigidBody& rigid,
                    const std::optional<AddedMass>& added_mass, const RigidBodyState& state) {
  const std::optional<Hydrostatics> result = load.at(pose_of(rigid, state));
  if (!result) return 0.0;
  Mat6 mass_B = mass_at_center(rigid);
  if (added_mass) {
    const double s =
        immersion_of(added_mass->scaling, mesh, result->volume, [&] { return result->wetted_area; });
    mass_B += s * added_mass->matrix_B;
  }
  const Mat6 K_B = rotated(result->stiffness, state.q_WB.conjugate().toRotationMatrix());
  // A NaN counts as 0.
  return std::sqrt(std::max(0.0, symmetric_eigen<6>(K_B, mass_B).values[5]));
}

// Candidate up directions in B: along the principal axes and along the bisectors of each two and three of
// them, in both senses. The flat and the slender sides of most bodies face one of these directions.
std::vector<Vec3> directions_B(const RigidBody& rigid) {
  std::vector<Vec3> directions;
  const auto components = {-1.0, 0.0, 1.0};
  for (const double x : components) {
    for (const double y : components) {
      for (const double z : components) {
        const Vec3 direction_P(x, y, z);
        if (direction_P == Vec3::Zero()) continue;
        directions.emplace_back(rigid.principal_axes_B * direction_P.normalized());
      }
    }
  }
  return directions;
}

struct Extent {
  double min = 0.0;  // [m]
  double max = 0.0;  // [m]
};

// Returns the extent of the mesh along a direction, relative to the centre of mass.
Extent extent_along(const HydrostaticMesh& mesh, const RigidBody& rigid, const Vec3& up_B) {
  const double offset = up_B.dot(mesh.center_B - rigid.center_of_mass_B);
  return {offset + lowest_vertex(*mesh.tree, up_B), offset - lowest_vertex(*mesh.tree, -up_B)};
}

}  // namespace

double natural_frequency_bound(const Body& body, const RigidBody& rigid, const Water& water) {
  // K is the sum of a waterplane term, whose scaled trace is at most rho g A (1/m + l^2/I), and of a buoyancy
  // lever term, at most rho g V l / I. No waterplane is larger than the whole surface A, and V <= A l / 3.
  const HydrostaticMesh& mesh = body.prepared_mesh->mesh;
  const double inertia = rigid.principal_inertia[0];
  const auto from_water = [&](const HydrostaticMesh& displacing) {
    const double lever = displacing.max_lever_arm(rigid.center_of_mass_B);
    const double levers = 4.0 / 3.0 * lever * lever / inertia;
    return deepest_density(water) * water.gravity * displacing.area * (1.0 / rigid.mass + levers);
  };
  double square = from_water(mesh);
  if (rigid.contents) {
    // Flooding adds at most what a compartment would displace, and a weight at most g m l / I twice.
    for (const PlacedMesh& compartment : rigid.contents->compartments)
      square += from_water(*compartment.mesh);
    const RigidBodyMass& own = rigid.contents->own;
    double moment = own.mass * (own.center_of_mass_B - rigid.center_of_mass_B).norm();  // [kg m]
    for (const Tank& tank : rigid.contents->tanks) {
      moment += tank.liquid_mass() * tank.mesh->max_lever_arm(rigid.center_of_mass_B);
    }
    square += 2.0 * water.gravity * moment / inertia;
  }
  return std::sqrt(square);
}

HighestNaturalFrequency highest_natural_frequency(const Body& body, const RigidBody& rigid,
                                                  const RigidBodyState& state, const Water& water) {
  const MeshWithTree with_tree(body.prepared_mesh->mesh);
  const HydrostaticMesh& mesh = with_tree.mesh();
  const Solver solver(mesh, Method::kHierarchical);
  std::optional<double> energy = mechanical_energy(rigid, state, solver, water);
  if (!energy) return {};
  std::optional<AddedMass> added_mass;
  if (body.hydrodynamics != nullptr && body.hydrodynamics->coefficients().added_mass) {
    added_mass = {.matrix_B = added_mass_at_center(body, rigid),
                  .scaling = body.hydrodynamics->coefficients().added_mass->immersion};
    *energy +=
        HydrodynamicMotion(body, rigid, water, Current{}).added_kinetic_energy_at_pose(state).value_or(0.0);
  }

  const WaterplaneStiffness load(mesh, rigid, water);
  HighestNaturalFrequency highest;
  const auto consider = [&](const RigidBodyState& candidate, double draft) {
    const double frequency = frequency_at(load, mesh, rigid, added_mass, candidate);
    if (frequency > highest.frequency) highest = {frequency, draft};
  };
  const double height = water.up_W.dot(state.center_W) - water.level;
  const auto sweep = [&](const Eigen::Quaterniond& q_WB) {
    const Extent extent = extent_along(mesh, rigid, q_WB.conjugate() * water.up_W);
    for (int i = 1; i <= kLevels; ++i) {
      // The drafts run from half a level spacing above the lowest vertex to the highest vertex.
      const double draft = (extent.max - extent.min) * (i < kLevels ? (i - 0.5) / (kLevels - 1) : 1.0);
      RigidBodyState candidate;
      candidate.q_WB = q_WB;
      candidate.center_W = water.up_W * (water.level - extent.min - draft);
      const std::optional<double> potential = mechanical_energy(rigid, candidate, solver, water);
      if (potential && *potential <= *energy) consider(candidate, draft);
    }
    return extent;
  };
  const Extent present = sweep(state.q_WB);
  consider(state, -(height + present.min));
  for (const Vec3& up_B : directions_B(rigid)) {
    sweep(rotation_between(up_B, water.up_W));
  }
  return highest;
}

}  // namespace buoyancy
