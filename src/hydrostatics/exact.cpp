#include "hydrostatics/paper_methods.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {

Displacement exact(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const Vec3 apex = apex_on_water(mesh, plane);
  const auto o = Point<double>::from(apex);
  const auto sum = sum_over_wetted_surface<VolumeElements>(
      mesh, plane, [o](VolumeElements& block, const auto& a, const auto& b, const auto& c) {
        block.add(a.y, b.y, c.y, o);
      });
  Displacement result = displacement_of_volume(sum.volume(), sum.moment(apex), plane);
  result.rounding = rounding_of_cut_faces(mesh, plane);
  return result;
}

}  // namespace buoyancy
