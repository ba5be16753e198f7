// What a naval architect asks of a body at its present pose: wetted area, waterplane, metacentres, stiffness.
//
// Read from the moments of the wet surface (wetted_moments.h, displacement_moments.h), exact to rounding
// whatever method answers the body's wrench. A heel about a horizontal axis through the waterplane's centroid
// that displaces nothing moves the centre of buoyancy as if the body hung from its metacentre, BM = I/V above
// it, I the waterplane's second moment about that axis; GM is how far the metacentre lies above the centre of
// mass.
//
// Undefined is NaN: points and radii that divide by V where V does not exceed its own error bound G_V
// (HydrostaticMesh::volume_tolerance), those that divide by A where there is no waterplane, GM without a
// centre of mass. A waterplane whose area does not exceed 64 eps A_s, its error bound, is none: area and
// moments 0. Errors, each a few eps times: V as G_V; areas A_s; first moments L A_s; second moments L^2 A_s.
// Stiffness is those times rho g, moved to the reference point; within 1e-9 of automatic differentiation
// (tests).
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

// A pair for the waterplane's two principal axes: [0] of the smaller second moment, [1] of the larger.
template <typename T>
using PrincipalPair = std::array<T, 2>;

inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Everything in W axes, points relative to p_WB. Its defaults are a dry body's.
struct Hydrostatics {
  double volume = 0.0;                                // m^3: V, displaced
  Vec3 center_of_buoyancy_W = Vec3::Constant(kNaN);   // m
  double wetted_area = 0.0;                           // m^2, without the waterplane
  double waterplane_area = 0.0;                       // m^2: A
  Vec3 waterplane_centroid_W = Vec3::Constant(kNaN);  // m
  PrincipalPair<double> waterplane_second_moments{};  // m^4, about axes through the centroid
  // Those axes: unit, horizontal, [1] = up x [0]. Any such pair where the two moments are equal.
  PrincipalPair<Vec3> waterplane_axes_W{Vec3::Constant(kNaN), Vec3::Constant(kNaN)};
  PrincipalPair<double> metacentric_radii{kNaN, kNaN};  // m: BM, when heeling about those axes
  PrincipalPair<Vec3> metacenters_W{Vec3::Constant(kNaN), Vec3::Constant(kNaN)};  // m
  PrincipalPair<double> metacentric_heights{kNaN, kNaN};                          // m: GM
  // -d(F, tau)/d(p, theta) of buoyancy alone: rows force (N), torque (N m) about the reference point; columns
  // translation (m), rotation (rad) about W axes through the reference point, which goes with the body. Not
  // symmetric where the centre of buoyancy does not lie over or under the reference point.
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
};

// mesh: with its tree; an open one with its whole boundary dry. pose: one that buoyancy() answers with kOk.
// center_of_mass_B: m; nullopt: not known. nullopt: a result is beyond double's range.
// O(triangles that the water cuts + log n), O(1) for a body clear of the surface; no heap.
std::optional<Hydrostatics> hydrostatics(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                                         const Vec3& reference_B,
                                         const std::optional<Vec3>& center_of_mass_B);

}  // namespace buoyancy
