#include <cmath>

#include "hydrostatics/paper_methods.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {
namespace {

struct ElementSum {
  VolumeElements wet;
  double truncation_bound6 = 0.0;  // [m^3], 6 sum |V_i(o)| of the cut triangles

  ElementSum& operator+=(const ElementSum& other) {
    wet += other.wet;
    truncation_bound6 += other.truncation_bound6;
    return *this;
  }
};

}  // namespace

Displacement improved(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  const Vec3 apex = apex_on_water(mesh, plane);
  const auto o = Point<double>::from(apex);
  const auto sum = sum_over_wet_triangles<ElementSum>(
      mesh, plane,
      [o](ElementSum& block, const auto& a, const auto& b, const auto& c) {
        block.wet.add(a.y, b.y, c.y, o);
      },
      [o](ElementSum& block, const auto& a, const auto& b, const auto& c) {
        block.truncation_bound6 += std::abs(six_volumes(a.y, b.y, c.y, o));
      });
  Displacement result = displacement_of_volume(sum.wet.volume(), sum.wet.moment(apex), plane);
  result.truncation_bound = sum.truncation_bound6 / 6.0;
  result.truncation_lever = apex.norm();
  return result;
}

}  // namespace buoyancy
