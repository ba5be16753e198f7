#include "hydrostatics/paper_methods.h"
#include "hydrostatics/pressure_elements.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {

Displacement exact_surface(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const auto k = Point<double>::from(plane.up_B);
  const auto sum = sum_over_wetted_surface<PressureElements>(
      mesh, plane,
      [k](PressureElements& block, const auto& a, const auto& b, const auto& c) { block.add(a, b, c, k); });
  Displacement result = sum.displacement(plane);
  result.rounding = rounding_of_cut_faces(mesh, plane);
  return result;
}

}  // namespace buoyancy
