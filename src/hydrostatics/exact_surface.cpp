#include "hydrostatics/paper_methods.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {

Displacement exact_surface(const HydrostaticMesh& mesh, const Meshlets& meshlets, const WaterPlane& plane) {
  const PressureElementSum sum = sum_pressure_elements(meshlets, plane, CutTriangles::kClip);
  Displacement result = sum.wet.displacement(plane);
  result.rounding = rounding_of_cut_faces(mesh, sum.cut_edges_squared);
  return result;
}

}  // namespace buoyancy
