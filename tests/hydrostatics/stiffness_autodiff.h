// Force, torque and stiffness as derivatives: dual numbers through the templated clip, moments and read-out.
#pragma once

#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"
#include "tests/hydrostatics/dual.h"

namespace buoyancy {

using Mat6 = Eigen::Matrix<double, 6, 6>;

// The water's plane seen from a body that moves: slopes 0 to 2 by p, which moves it, 3 to 5 by theta, which
// turns it about W's axes through the reference point.
struct DualPlane {
  Mat3T<Dual> R_WB;
  Vec3T<Dual> up_B;      // k
  Dual h_c;              // [m]
  Vec3T<Dual> c_from_r;  // [m], B
};

DualPlane dual_water_plane(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                           const Vec3& reference_B);

// -d(F, tau)/d(p, theta).
Mat6 stiffness_autodiff(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                               const Vec3& reference_B);

// The largest difference of a 3 x 3 block (they have different units), relative to the block. Without a
// waterplane only the last one is not zero.
double largest_difference(const Mat6& found, const Mat6& expected, bool waterplane);

// 1e-9, but where the waterplane is so small that its area is not known so well, on either side: eps A_s of
// it.
double stiffness_tolerance(const HydrostaticMesh& mesh, double waterplane_area);

}  // namespace buoyancy
