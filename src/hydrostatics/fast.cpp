#include "hydrostatics/fast.h"

#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wet_surface.h"

namespace buoyancy {
namespace {

struct ElementSum {
  double volume = 0.0;
  Vec3 moment = Vec3::Zero();

  ElementSum& operator+=(const ElementSum& other) {
    volume += other.volume;
    moment += other.moment;
    return *this;
  }
};

}  // namespace

FastTable::FastTable(const HydrostaticMesh& mesh) {
  elements_.reserve(mesh.surface.triangles.size());
  const Vec3 origin = -mesh.center_B;  // B's origin, about c
  for (const Triangle& triangle : mesh.surface.triangles) {
    VolumeElements element;
    element.add(mesh.point(triangle[0]), mesh.point(triangle[1]), mesh.point(triangle[2]),
                Point<double>::from(origin));
    elements_.push_back({element.volume(), element.moment(origin)});
  }
}

Displacement FastTable::displacement(const HydrostaticMesh& mesh, const WaterPlane& plane) const {
  const VertexHeights heights = vertex_heights(mesh.surface, plane);
  const auto total = sum_over_blocks<ElementSum>(
      mesh.surface, heights, [this](ElementSum& sum, TriangleList wet, TriangleList /*cut*/) {
        for (const std::uint32_t i : wet) sum += {elements_[i].volume, elements_[i].moment};
      });
  return displacement_of_volume(total.volume, total.moment, plane);
}

}  // namespace buoyancy
