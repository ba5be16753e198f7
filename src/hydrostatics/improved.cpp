#include <cmath>

#include "hydrostatics/paper_methods.h"
#include "hydrostatics/volume_elements.h"
#include "hydrostatics/wetted_surface.h"

namespace buoyancy {
namespace {

struct ElementSum {
  VolumeElements wet;
  double left_out6 = 0.0;  // [m^3], 6 sum |V_i(o)| of the cut triangles

  ElementSum& operator+=(const ElementSum& other) {
    wet += other.wet;
    left_out6 += other.left_out6;
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
        block.left_out6 += std::abs(six_volumes(a.y, b.y, c.y, o));
      });
  Displacement result = displacement_of_volume(sum.wet.volume(), sum.wet.moment(apex), plane);
  result.left_out = sum.left_out6 / 6.0;
  result.left_out_reach = apex.norm();
  return result;
}

}  // namespace buoyancy
