// A rigid body of one or several closed meshes, with a mass, and what acts on it in water at rest.
//
// The displaced volume is a sum over the meshes, each with a factor: 1 for a hull or another part that
// displaces water, minus the permeability for a compartment that is open to the sea. Every integral over the
// displaced volume and over the waterplane is linear in the volume, so that the same sum gives centre,
// waterplane, energy, wrench, stiffness and error bounds. The overlap of two parts counts twice.
//
// Tanks add a third kind of term (hydrostatics/tank.h): the mass of the liquid, its first moment at the given
// attitude, and minus its density times the second moments of its own free surface (docs/mathematics.md,
// "Equilibrium and righting arms").
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/error.h"
#include "hydrostatics/hydrostatics.h"
#include "hydrostatics/tank.h"

namespace buoyancy {

struct PlacedMesh {
  const HydrostaticMesh* mesh = nullptr;                              // with its tree; outlives the body
  Vec3 position_B = Vec3::Zero();                                     // [m], of the mesh's origin in B
  Eigen::Quaterniond orientation_B = Eigen::Quaterniond::Identity();  // x_B = orientation x + position
  double signed_permeability =
      1.0;  // 1: displaces water; minus its permeability: a compartment open to the sea
};

class FloatingBody {
 public:
  // One of the meshes, as the sums need it.
  struct SignedVolume {
    PlacedMesh placed;
    Mat3 R_B = Mat3::Identity();   // of the orientation
    Vec3 offset_B = Vec3::Zero();  // [m], from the body's center_B() to the mesh's centre
    bool is_turned = false;        // true if R_B is not the identity
    double plane_rounding = 0.0;   // [m^3], error by moving the water plane to the mesh's frame
  };

  // mass: [kg], without the liquids in the tanks; center_of_mass_B: [m], of that mass. Errors: no mesh
  // displaces water; a mesh without a tree; a signed permeability other than 1 and outside [-1, 0); an open
  // mesh beside others; a mass not above 0; a liquid volume that a tank cannot hold; numbers that are not
  // finite.
  static Expected<FloatingBody> make(std::span<const PlacedMesh> meshes, double mass,
                                     const Vec3& center_of_mass_B, std::span<const Tank> tanks = {});

  const std::vector<SignedVolume>& volumes() const { return volumes_; }
  const std::vector<Tank>& tanks() const { return tanks_; }
  double mass() const { return mass_; }                               // [kg], without liquids
  const Vec3& center_of_mass_B() const { return center_of_mass_B_; }  // [m], without liquids
  double total_mass() const { return total_mass_; }                   // [kg], with the liquids in the tanks
  const Vec3& center_B() const {
    return center_B_;
  }  // [m], the centre of the first mesh: water planes are about it
  bool is_open() const { return is_open_; }
  double volume() const { return volume_; }  // [m^3], displaced fully submerged; open: only a scale
  double volume_tolerance() const { return volume_tolerance_; }  // [m^3], sum of G_V of the meshes
  double liquid_tolerance() const { return liquid_tolerance_; }  // [kg], sum of density G_V of the tanks
  double reach() const { return reach_; }  // [m], distance of the farthest corner of a box from center_B()

 private:
  FloatingBody() = default;

  std::vector<SignedVolume> volumes_;
  std::vector<Tank> tanks_;
  double mass_ = 0.0;
  double total_mass_ = 0.0;
  double liquid_tolerance_ = 0.0;
  Vec3 center_of_mass_B_ = Vec3::Zero();
  Vec3 center_B_ = Vec3::Zero();
  bool is_open_ = false;
  double volume_ = 0.0;
  double volume_tolerance_ = 0.0;
  double reach_ = 0.0;
};

// Returns the same meshes with another mass [kg], centre of mass [m] and tanks. Errors: those of make().
Expected<FloatingBody> with_mass(const FloatingBody& body, double mass, const Vec3& center_of_mass_B,
                                 std::span<const Tank> tanks);

struct FloatingState {
  Hydrostatics
      hydrostatics;  // of the sum, with metacentric heights; the stiffness is about center_of_mass_B()
  // [J], m g z_G - rho g V z_B with heights over the water, liquids included. Its minima are the stable
  // equilibria.
  double energy = 0.0;
  Vec3 force_W = Vec3::Zero();      // [N], buoyancy and weight
  Vec3 torque_W = Vec3::Zero();     // [N m], about center_of_mass_B()
  double force_error_bound = 0.0;   // [N], bound on the error of the force
  double torque_error_bound = 0.0;  // [N m], bound on the error of the torque
};

// Returns the state of a body at a pose, or nullopt where the boundary of an open mesh is under water or a
// number is beyond double's range. The wetted area is that of the meshes that displace water. Complexity: per
// mesh that of hydrostatics() and buoyancy() with `hierarchical`; no heap.
std::optional<FloatingState> floating_state(const FloatingBody& body, const Pose& pose, const Water& water);

// Returns the least coordinate along up_B, from center_B() [m], of the vertices of meshes that displace
// water. up_B: unit. Complexity: that of lowest_vertex() per mesh.
double lowest_along(const FloatingBody& body, const Vec3& up_B);

}  // namespace buoyancy
