// Coordinates of a body's velocities in which its kinetic energy, with that of the added mass, is half their
// square.
//
// Let nu = (R^T v, R^T w) be the twist of the centre of mass C in B's axes, M = diag(m, I) the body's mass
// matrix and A its added mass about C, s the immersion. The eigenvectors V of A V = M V diag(a) make both
// diagonal: V^T M V = 1 and V^T A V = diag(a), so that V^-1 = V^T M. In the modal velocities
// u_i = sqrt(1 + s a_i) (V^-1 nu)_i the energy 1/2 nu . (M + s A) nu is 1/2 u . u.
#pragma once

#include <algorithm>

#include "base/spatial.h"
#include "simulation/rigid_body.h"

namespace buoyancy {

class AddedMassModes {
 public:
  // added_mass_B: A, symmetric and positive semidefinite. Complexity: O(1), some microseconds.
  AddedMassModes(const RigidBody& rigid, const Mat6& added_mass_B);

  Vec6 modal(const Vec6& twist_B, double immersion) const;
  // Returns N with nu = N u: a matrix D from twists to wrenches becomes N^T D N, a wrench f becomes N^T f.
  Mat6 twist_of_modal(double immersion) const;

 private:
  Mat6 to_twist_ = Mat6::Zero();  // V
  Mat6 to_modal_ = Mat6::Zero();  // V^-1
  Vec6 ratio_ = Vec6::Zero();     // a
};

// N^T matrix N.
Mat6 congruent(const Mat6& matrix, const Mat6& N);

// Returns the mass matrix M of the body alone, in B's axes.
Mat6 mass_at_center(const RigidBody& rigid);

// Returns a body's added mass about its centre of mass, in B's axes; zero if it has none.
Mat6 added_mass_at_center(const Body& body, const RigidBody& rigid);

// Returns the immersion s (hydrodynamics/coefficients.h) of a body that displaces this volume. area: returns
// its wetted area [m^2]; it is called only where the area scales the coefficients.
template <typename WettedAreaOf>
double immersion_of(ImmersionScaling scaling, const HydrostaticMesh& mesh, double volume,
                    const WettedAreaOf& area) {
  if (!(volume > mesh.volume_tolerance())) return 0.0;
  if (scaling == ImmersionScaling::kVolume) return std::min(volume / mesh.volume, 1.0);
  if (scaling == ImmersionScaling::kWettedArea) return std::min(area() / mesh.area, 1.0);
  return 1.0;
}

}  // namespace buoyancy
