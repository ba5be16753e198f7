#include <algorithm>

#include "hydrostatics/paper_methods.h"
#include "hydrostatics/pressure_elements.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {
namespace {

struct PressureSum {
  PressureElements wet;
  // [m^3], sum over the cut triangles of twice the area times the sum of the corners' depths
  double truncation_bound6 = 0.0;

  PressureSum& operator+=(const PressureSum& other) {
    wet += other.wet;
    truncation_bound6 += other.truncation_bound6;
    return *this;
  }
};

}  // namespace

Displacement fast_surface(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const auto k = Point<double>::from(plane.up_B);
  const auto sum = sum_over_wet_triangles<PressureSum>(
      mesh, plane,
      [k](PressureSum& block, const auto& a, const auto& b, const auto& c) { block.wet.add(a, b, c, k); },
      [](PressureSum& block, const auto& a, const auto& b, const auto& c) {
        // The integral of a convex function is at most that of the plane through its corner values:
        // int |min(z, 0)| dA <= A/3 sum |min(z_i, 0)|.
        const double depths = std::max(-a.z, 0.0) + std::max(-b.z, 0.0) + std::max(-c.z, 0.0);
        block.truncation_bound6 += depths * cross(b.y - a.y, c.y - a.y).vec3().norm();
      });
  Displacement result = sum.wet.displacement(plane);
  result.truncation_bound = sum.truncation_bound6 / 6.0;
  return result;
}

}  // namespace buoyancy
