#include <cmath>

#include "hydrostatics/paper_methods.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {
namespace {

struct ElementSum {
  double volume = 0.0;
  Vec3 moment = Vec3::Zero();
  double truncation_bound = 0.0;  // [m^3], sum |V_i| of the cut triangles
  std::size_t wet_triangles = 0;

  ElementSum& operator+=(const ElementSum& other) {
    volume += other.volume;
    moment += other.moment;
    truncation_bound += other.truncation_bound;
    wet_triangles += other.wet_triangles;
    return *this;
  }
};

}  // namespace

FastTable::FastTable(const HydrostaticMesh& mesh) {
  elements_.reserve(mesh.surface.triangles.size());
  const Vec3 origin = -mesh.center_B;  // [m], B's origin about c
  for (const Triangle& triangle : mesh.surface.triangles) {
    VolumeElements element;
    element.add(mesh.point(triangle[0]), mesh.point(triangle[1]), mesh.point(triangle[2]),
                Point<double>::from(origin));
    elements_.push_back({element.volume(), element.moment(origin)});
  }
}

Displacement FastTable::displacement(const HydrostaticMesh& mesh, const WaterPlane& plane) const {
  const VertexHeights heights = vertex_heights(mesh.surface, plane);
  const auto total = sum_over_blocks<ElementSum>(mesh.surface, heights,
                                                 [this](ElementSum& sum, TriangleList wet, TriangleList cut) {
                                                   for (const std::uint32_t i : wet) {
                                                     sum.volume += elements_[i].volume;
                                                     sum.moment += elements_[i].moment;
                                                   }
                                                   for (const std::uint32_t i : cut)
                                                     sum.truncation_bound += std::abs(elements_[i].volume);
                                                   sum.wet_triangles += wet.size();
                                                 });
  Displacement result = displacement_of_volume(total.volume, total.moment, plane);
  result.truncation_bound = total.truncation_bound;
  if (total.wet_triangles < mesh.surface.triangles.size()) {
    // The cone over the waterplane is missing; the waterplane's area is at most that of the wetted surface
    // and at most that of the dry surface.
    const double waterplane_area = mesh.is_open() ? mesh.area : 0.5 * mesh.area;
    result.truncation_bound += std::abs(plane.height(-mesh.center_B)) * waterplane_area / 3.0;
  }
  result.truncation_lever = mesh.center_B.norm();
  return result;
}

}  // namespace buoyancy
