// The water plane in the body frame: the plane is moved into the body frame, never the vertices into the
// world. A far-away body then costs no accuracy, and everything precomputed in B stays valid for every pose.
//
//   k = R_WB^T up,   h_c = level - up . p_WB - k . c,
//   signed height of a vertex y = x_B - c:   z(y) = k . y - h_c,
//
// wet where z < 0; a vertex on the plane (z = 0) is dry. c is the mesh's own centre (HydrostaticMesh). k and
// h_c are computed in double-double and rounded once: |error of k| <= eps, |error of h_c| <= eps |h_c| +
// 1e-29 (|p_WB| + |c|). The quaternion is normalised in the same arithmetic, and q and -q give the same bits.
// Every instruction set gives the same bits (Highway, run-time dispatch), unless a product underflows.
#pragma once

#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Geometry>

#include "base/vec3.h"
#include "base/water.h"
#include "hydrostatics/point.h"

namespace buoyancy {

struct Pose {
  Vec3 p_WB = Vec3::Zero();                                  // [m]
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();  // any norm but 0; read as q/|q|
};

struct WaterPlane {
  Vec3 up_B = Vec3::UnitZ();  // k
  double h_c = 0.0;           // [m]
  // The rounding errors of both: up_B + up_B_rest and h_c + h_c_rest are k and h_c in double-double. Only
  // `hierarchical` uses them.
  Vec3 up_B_rest = Vec3::Zero();
  double h_c_rest = 0.0;  // [m]
  // [m], bound on the error of the plane's heights over the body, without the rounding of height() itself.
  double error = 0.0;

  double height(const Vec3& y) const { return up_B.dot(y) - h_c; }
};

// h_c is NaN where a coordinate of the position or of c is 2^996 m (7e299 m) or more.
WaterPlane water_plane_in_body(const Pose& pose, const Water& water, const Vec3& c_B);

// Sets planes[i] to water_plane_in_body(poses[i], water, centers_B[i]), with the same bits but in a fraction
// of the time. All spans have the same size. No heap allocation.
void water_planes_in_body(std::span<const Pose> poses, const Water& water, std::span<const Vec3> centers_B,
                          std::span<WaterPlane> planes);

// The plane in plain double, at a tenth of the cost, for callers that accept an error that grows with the
// distances of the pose and of c. All values are multiplied by |q|^2, which saves divisions. Where
// norm_squared is above 1e-100 the plane is within its error, unless the squares or their products with the
// distances overflow.
struct RoughWaterPlane {
  Point<double> up_B;   // |q|^2 k
  double h_c;           // [m |q|^2]
  double norm_squared;  // |q|^2
  double error;         // [m |q|^2], bound on the error of heights of points within `reach` of c
};

inline RoughWaterPlane rough_water_plane_in_body(const Pose& pose, const Water& water, const Vec3& c_B,
                                                 double reach) {
  const Eigen::Quaterniond& q = pose.q_WB;
  const auto up = Point<double>::from(water.up_W);
  const Point<double> u{q.x(), q.y(), q.z()};
  const double u_squared = dot(u, u);
  const double w_squared = q.w() * q.w();
  RoughWaterPlane plane;
  plane.norm_squared = w_squared + u_squared;
  plane.up_B = (w_squared - u_squared) * up + 2.0 * (dot(u, up) * u - q.w() * cross(u, up));
  plane.h_c = plane.norm_squared * (water.level - dot(up, Point<double>::from(pose.p_WB))) -
              dot(plane.up_B, Point<double>::from(c_B));
  // k is off by at most 16 epsilon, every product and sum by half an epsilon of the sum of its terms.
  plane.error = 32.0 * std::numeric_limits<double>::epsilon() * plane.norm_squared *
                (pose.p_WB.lpNorm<1>() + std::abs(water.level) + c_B.lpNorm<1>() + reach);
  return plane;
}

}  // namespace buoyancy
