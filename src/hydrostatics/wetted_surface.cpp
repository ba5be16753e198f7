#include "hydrostatics/wetted_surface.h"

#include <limits>
#include <vector>

namespace buoyancy {

VertexHeights vertex_heights(const TriangleMesh& surface, const WaterPlane& plane) {
  thread_local std::vector<double> heights;
  thread_local std::vector<std::uint8_t> wet;
  const std::size_t count = surface.x.size();
  if (heights.size() < count) {
    heights.resize(count);
    wet.resize(count);
  }
  const auto k = Point<double>::from(plane.up_B);
  const double h_c = plane.h_c;
  const double* const x = surface.x.data();
  const double* const y = surface.y.data();
  const double* const z = surface.z.data();
  double* const height = heights.data();
  std::uint8_t* const is_wet = wet.data();
  for (std::size_t i = 0; i < count; ++i) height[i] = dot(k, Point<double>{x[i], y[i], z[i]}) - h_c;
  for (std::size_t i = 0; i < count; ++i) is_wet[i] = height[i] < 0.0;
  return {height, is_wet};
}

double rounding_of_cut_faces(const HydrostaticMesh& mesh, const WaterPlane& plane) {
  if (mesh.meets_volume_tolerance()) return 0.0;
  // In HydrostaticMesh the longest edge of a triangle lies opposite its first corner.
  const auto edges_squared = sum_over_wet_triangles<double>(
      mesh, plane, [](double&, const auto&, const auto&, const auto&) {},
      [](double& sum, const auto&, const auto& b, const auto& c) { sum += dot(c.y - b.y, c.y - b.y); });
  return std::numeric_limits<double>::epsilon() * mesh.diagonal * edges_squared;
}

}  // namespace buoyancy
