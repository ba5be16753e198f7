#include "hydrostatics/paper_methods.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {

Displacement exact(const HydrostaticMesh& mesh, const Meshlets& meshlets, const WaterPlane& plane) {
  const Vec3 apex = apex_on_water(mesh, plane);
  const VolumeElementSum sum = sum_volume_elements(meshlets, plane, apex, CutTriangles::kClip);
  Displacement result = displacement_of_volume(sum.wet.volume(), sum.wet.moment(apex), plane);
  result.rounding = rounding_of_cut_faces(mesh, sum.cut_edges_squared);
  return result;
}

}  // namespace buoyancy
