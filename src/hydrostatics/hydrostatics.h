// Hydrostatics of a body at its current pose: wetted area, waterplane, metacentres, stiffness.
//
// All values come from the moments of the wetted surface (wetted_moments.h, displacement_moments.h) and are
// exact to rounding, whichever method computes the body's wrench. A heel about a horizontal axis through the
// waterplane's centroid that keeps the displaced volume moves the centre of buoyancy as if the body hung from
// its metacentre, BM = I/V above it, with I the waterplane's second moment about that axis; GM is the height
// of the metacentre above the centre of mass.
//
// In layered water (base/water.h) the values are those in water of the mean density of what the body
// displaces: the volume and the wetted area are under the surface, and the centre of buoyancy is that of the
// displaced mass. The waterplane is the sum of those in the tops of the layers, each times its step of
// density over the mean density.
//
// Undefined values are NaN: points and radii that divide by V where V does not exceed its own error bound G_V
// (HydrostaticMesh::volume_tolerance), those that divide by A where there is no waterplane, GM without a
// centre of mass. A waterplane whose area does not exceed its error bound 64 eps A_s counts as absent: its
// area and moments are 0. Errors, each a few eps times: V as G_V; areas A_s; first moments L A_s; second
// moments L^2 A_s. The errors of the stiffness are those times rho g, moved to the reference point; the
// stiffness is within 1e-9 of automatic differentiation (tests).
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

// All vectors are in W axes, points are relative to p_WB, and the default values are those of a dry body.
struct Hydrostatics {
  double volume = 0.0;                                // [m^3], V, displaced
  Vec3 center_of_buoyancy_W = Vec3::Constant(kNaN);   // [m]
  double wetted_area = 0.0;                           // [m^2], without the waterplane
  double waterplane_area = 0.0;                       // [m^2], A
  Vec3 waterplane_centroid_W = Vec3::Constant(kNaN);  // [m]
  PrincipalPair<double> waterplane_second_moments{};  // [m^4], about axes through the centroid
  // Those axes: unit, horizontal, [1] = up x [0]; an arbitrary such pair where the two moments are equal.
  PrincipalPair<Vec3> waterplane_axes_W{Vec3::Constant(kNaN), Vec3::Constant(kNaN)};
  PrincipalPair<double> metacentric_radii{kNaN, kNaN};  // [m], BM for heel about those axes
  PrincipalPair<Vec3> metacenters_W{Vec3::Constant(kNaN), Vec3::Constant(kNaN)};  // [m]
  PrincipalPair<double> metacentric_heights{kNaN, kNaN};                          // [m], GM
  // -d(F, tau)/d(p, theta) of buoyancy, and of the liquids in tanks: rows force [N] and torque [N m] about
  // the reference point; columns translation [m] and rotation [rad] about W axes through that point, which
  // moves with the body. Not symmetric where the centre of buoyancy does not lie above or below it.
  Eigen::Matrix<double, 6, 6> stiffness = Eigen::Matrix<double, 6, 6>::Zero();
  double density = 0.0;  // [kg/m^3], mean, of the displaced water; dry: that at the surface
};

// mesh: with its tree; the whole boundary of an open mesh must be dry. pose: one for which buoyancy() returns
// kOk. center_of_mass_B: [m]; nullopt if not known. Returns nullopt if a result is beyond double's range.
// Complexity: O(triangles that the water cuts + log n), O(1) for a dry or fully submerged body; no heap.
std::optional<Hydrostatics> hydrostatics(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                                         const Vec3& reference_B,
                                         const std::optional<Vec3>& center_of_mass_B);

struct WettedArea {
  double value = 0.0;  // [m^2]
  double error = 0.0;  // [m^2], bound on the error
};

// Returns the area of the body's surface under water. mesh: with its tree. The bound comes from the areas
// under slightly lower and higher water, since the area jumps where a face is level with the surface.
// Complexity: three times O(triangles that the water cuts + log n); O(1) for a dry or fully submerged body;
// no heap.
WettedArea wetted_area(const HydrostaticMesh& mesh, const Pose& pose, const Water& water);

}  // namespace buoyancy
