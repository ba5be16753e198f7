#include "hydrostatics/exact.h"

#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wet_surface.h"

namespace buoyancy {

Displacement exact(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const Vec3 apex = apex_on_water(mesh.centroid, plane);
  const auto sum = sum_over_wet_surface<VolumeElements, CutTriangles::kClip>(
      mesh, plane, [&](VolumeElements& block, const auto& a, const auto& b, const auto& c) {
        block.add(a.y - apex, b.y - apex, c.y - apex);
      });
  return displacement_about_apex(sum, apex, plane);
}

}  // namespace buoyancy
