// The energy of a floating body as a function of its attitude alone: at every attitude the body has the
// height at which it displaces its mass (docs/mathematics.md, "Equilibrium and righting arms").
//
// Energies are divided by g and given in kg m. With o the body's center_B, z its height over the water, k the
// world's up in B and Q = m (G - o) - rho M_o, the energy is k . Q + z (m - rho V), its gradient in k is Q,
// and where m = rho V its Hessian over the sphere of k is rho J_F - (k . Q) I, with J_F the second moments of
// the waterplane about its centroid.
//
// In layered water rho is the density at the surface, and V, M_o and J_F are sums over the terms of the
// pressure (displaced_sum.h). The energy then has one more term, -rho times their depth moment. Where the
// density of the body is that of a layer, any height within the layer is the one that is found.
#pragma once

#include <array>
#include <optional>
#include <utility>

#include "flotation/displaced_sum.h"

namespace buoyancy {

// A body in vertical balance: it displaces its mass.
struct BalancedAttitude {
  Vec3 up_B = Vec3::UnitZ();         // k, unit
  double height = 0.0;               // [m], z
  double energy = 0.0;               // [kg m]
  Vec3 lever_moment = Vec3::Zero();  // [kg m], Q
  Vec3 gradient = Vec3::Zero();      // [kg m], Q without its part along k: torque / g x k
  bool is_exact = true;              // true if it displaces its mass to rounding
  double excess = 0.0;               // [m^3], excess displacement that the values above do not account for
  double area = 0.0;                 // [m^2], rough area of the waterplane; 0: not known
  // [m], B axes, from o: a point of the waterplane about which a small turn keeps the displacement.
  Vec3 pivot = Vec3::Zero();

  WaterPlane plane() const { return {.up_B = up_B, .h_c = -height}; }
};

// Principal curvatures of the energy at a balanced attitude.
struct EnergyCurvature {
  std::array<double, 2> values{};  // [kg m], ascending; mass times metacentric height
  std::array<Vec3, 2> directions_B{Vec3::UnitX(),
                                   Vec3::UnitY()};  // unit, at right angles to k and each other
  double largest_moment = 0.0;                      // [kg m], rho times the larger second moment

  // [kg m], curvature of the energy along a unit vector perpendicular to k.
  double along(const Vec3& direction_B) const {
    const double first = direction_B.dot(directions_B[0]);
    const double second = direction_B.dot(directions_B[1]);
    return values[0] * first * first + values[1] * second * second;
  }
};

class Balance {
 public:
  Balance(const FloatingBody& body, const Water& water) : Balance(body, water, false) {}

  // The balance of a body that is fully submerged at every attitude, as in water of its own mean density:
  // there it is neutrally buoyant, so that only the torque about the centre of all mass is left. With C the
  // centre of buoyancy, Q = m (G - C). body: no open mesh, of a volume above 0.
  static Balance submerged(const FloatingBody& body, const Water& water) {
    Water of_body = water;
    of_body.density = body.total_mass() / body.volume();
    of_body.layers.clear();
    return {body, std::move(of_body), true};
  }

  // Finds the height at which the body displaces its mass. guess: an attitude nearby, or nullptr. slack:
  // [m^3], the allowed error of the volume. Height and moments are corrected for this error to first order,
  // the energy to second, with the waterplane of the guess, or else later by curvature(). Returns nullopt
  // where there is no such height: the body is too heavy, or an open mesh takes in water first. Complexity:
  // about two displacements with a guess and a slack, three to six without.
  std::optional<BalancedAttitude> at(const Vec3& up_B, const BalancedAttitude* guess = nullptr,
                                     double slack = 0.0) const;
  // [m^3], the slack that changes the energy by `energy` [kg m]. area: [m^2], of the waterplane.
  double slack(double energy, double area) const;
  double start_slack() const;  // [m^3], for an attitude at which a descent starts
  // Also sets the attitude's waterplane area and pivot, from which balances nearby start, and corrects it for
  // its excess.
  EnergyCurvature curvature(BalancedAttitude& attitude) const;

  const FloatingBody& body() const { return *body_; }
  const Water& water() const { return water_; }
  double target_volume() const { return target_volume_; }          // [m^3], mass over density at the surface
  double energy_rounding() const { return energy_rounding_; }      // [kg m], of differences of energies
  double gradient_rounding() const { return gradient_rounding_; }  // [kg m]
  double curvature_rounding() const { return curvature_rounding_; }  // [kg m]

 private:
  Balance(const FloatingBody& body, Water water, bool is_submerged);
  BalancedAttitude balanced(const Vec3& up_B, double height, const DisplacedSum& displaced) const;
  // Corrects an attitude for its excess by raising it by excess / area, unless that is far.
  void settle(BalancedAttitude& attitude, double area, const Vec3& pivot) const;

  const FloatingBody* body_;
  Water water_;
  bool is_submerged_;
  double steps_;  // the largest density over that at the surface
  double target_volume_;
  double energy_rounding_;
  double gradient_rounding_;
  double curvature_rounding_;
};

// Returns the attitude reached by turning k by |step| [rad] towards a tangent step.
Vec3 turned(const Vec3& up_B, const Vec3& step);

}  // namespace buoyancy
