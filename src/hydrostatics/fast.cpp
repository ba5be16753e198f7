#include <cmath>

#include "hydrostatics/paper_methods.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {

FastTable::FastTable(const HydrostaticMesh& mesh, const Meshlets& meshlets) {
  elements_.reserve(kGroupTriangles * meshlets.groups.size());
  const Vec3 origin = -mesh.center_B;  // [m], B's origin about c
  for (const Meshlet& meshlet : meshlets.meshlets) {
    const auto point = [&](std::uint8_t corner) {
      const std::size_t i = meshlet.first_vertex + corner / 4U;
      return Point<double>{meshlets.x[i], meshlets.y[i], meshlets.z[i]};
    };
    for (std::size_t group = 0; group < meshlet.groups; ++group) {
      const CornerGroup& corners = meshlets.groups[meshlet.first_group + group];
      for (std::size_t i = 0; i < kGroupTriangles; ++i) {
        VolumeElements element;
        element.add(point(corners.a[i]), point(corners.b[i]), point(corners.c[i]),
                    Point<double>::from(origin));
        const Vec3 moment = element.moment(origin);
        elements_.push_back({element.volume(), moment.x(), moment.y(), moment.z()});
      }
    }
  }
}

Displacement FastTable::displacement(const HydrostaticMesh& mesh, const Meshlets& meshlets,
                                     const WaterPlane& plane) const {
  const TableSum sum = sum_table(meshlets, plane, elements_);
  Displacement result = displacement_of_volume(sum.wet[0], Vec3(sum.wet[1], sum.wet[2], sum.wet[3]), plane);
  result.truncation_bound = sum.cut_bound;
  if (!sum.fully_submerged) {
    // The cone over the waterplane is missing; the waterplane's area is at most that of the wetted surface
    // and at most that of the dry surface.
    const double waterplane_area = mesh.is_open() ? mesh.area : 0.5 * mesh.area;
    result.truncation_bound += std::abs(plane.height(-mesh.center_B)) * waterplane_area / 3.0;
  }
  result.truncation_lever = mesh.center_B.norm();
  return result;
}

}  // namespace buoyancy
