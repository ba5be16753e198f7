// Computes force, torque and stiffness as derivatives by automatic differentiation: dual numbers through the
// templated clip, moments and their conversion to volume integrals.
#pragma once

#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"
#include "tests/truth/dual.h"

namespace buoyancy {

using Mat6 = Eigen::Matrix<double, 6, 6>;

// The water plane in the frame of a moving body: slopes 0 to 2 are derivatives by p, which translates the
// body, 3 to 5 by theta, which rotates it about W's axes through the reference point.
struct DualPlane {
  Mat3T<Dual> R_WB;
  Vec3T<Dual> up_B;      // k
  Dual h_c;              // [m]
  Vec3T<Dual> c_from_r;  // [m], B axes
};

DualPlane dual_water_plane(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                           const Vec3& reference_B);

// -d(F, tau)/d(p, theta).
Mat6 stiffness_autodiff(const HydrostaticMesh& mesh, const Pose& pose, const Water& water,
                        const Vec3& reference_B);

// The largest difference of a 3 x 3 block, relative to the block (blocks have different units). Without a
// waterplane only the last block is not zero.
double max_difference(const Mat6& found, const Mat6& expected, bool waterplane);

// 1e-9; more where the waterplane is so small that its area, in both computations, is known only to eps A_s.
double stiffness_tolerance(const HydrostaticMesh& mesh, double waterplane_area);

}  // namespace buoyancy
