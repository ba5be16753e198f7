#include "hydrostatics/fast_surface.h"

#include "hydrostatics/pressure_elements.h"
#include "hydrostatics/wet_surface.h"

namespace buoyancy {

Displacement fast_surface(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const auto sum = sum_over_wet_surface<PressureElements, CutTriangles::kLeaveOut>(
      mesh, plane, [&](PressureElements& block, const auto& a, const auto& b, const auto& c) {
        block.add(a, b, c, plane.up_B);
      });
  return sum.displacement(plane);
}

}  // namespace buoyancy
