#include "hydrostatics/paper_methods.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {

Displacement fast_surface(const Meshlets& meshlets, const WaterPlane& plane) {
  const PressureElementSum sum = sum_pressure_elements(meshlets, plane, CutTriangles::kBound);
  Displacement result = sum.wet.displacement(plane);
  result.truncation_bound = sum.cut_bound6 / 6.0;
  return result;
}

}  // namespace buoyancy
