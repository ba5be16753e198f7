#include "hydrostatics/paper_methods.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {

Displacement improved(const HydrostaticMesh& mesh, const Meshlets& meshlets, const WaterPlane& plane) {
  const Vec3 apex = apex_on_water(mesh, plane);
  const VolumeElementSum sum = sum_volume_elements(meshlets, plane, apex, CutTriangles::kBound);
  Displacement result = displacement_of_volume(sum.wet.volume(), sum.wet.moment(apex), plane);
  result.truncation_bound = sum.cut_bound6 / 6.0;
  result.truncation_lever = apex.norm();
  return result;
}

}  // namespace buoyancy
