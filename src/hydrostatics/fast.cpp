#include "hydrostatics/fast.h"

#include "geometry/pairwise_sum.h"
#include "hydrostatics/volume_elements.h"

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
  PairwiseSum<ElementSum> sum;
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const Triangle& triangle = mesh.surface.triangles[i];
    const bool wet = plane.height(mesh.vertex(triangle[0])) < 0.0 &&
                     plane.height(mesh.vertex(triangle[1])) < 0.0 &&
                     plane.height(mesh.vertex(triangle[2])) < 0.0;
    if (wet) sum.add({elements_[i].volume, elements_[i].moment});
  }
  const ElementSum total = sum.total();
  return displacement_of_volume(total.volume, total.moment, plane);
}

}  // namespace buoyancy
