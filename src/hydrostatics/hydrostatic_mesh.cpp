#include "hydrostatics/hydrostatic_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/pairwise_sum.h"
#include "hydrostatics/volume_elements.h"

namespace buoyancy {
namespace {

// The value nearest to x on a grid of 2^-22 of the largest coordinate's power of two. float32 coordinates and
// such a centre are multiples of a common unit with few enough bits between them that their difference is
// exact in double.
Vec3 round_to_coarse_grid(const Vec3& point, double largest) {
  if (!(largest > 0.0)) return point;
  int exponent = 0;
  std::frexp(largest, &exponent);
  Vec3 rounded;
  for (int i = 0; i < 3; ++i)
    rounded[i] = std::ldexp(std::nearbyint(std::ldexp(point[i], 22 - exponent)), exponent - 22);
  return rounded;
}

struct Totals {
  VolumeElements elements;
  double twice_area = 0.0;

  Totals& operator+=(const Totals& other) {
    elements += other.elements;
    twice_area += other.twice_area;
    return *this;
  }
};

}  // namespace

double HydrostaticMesh::volume_gate() const {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  return kEpsilon * (64.0 * std::abs(volume) + diagonal * area);
}

double HydrostaticMesh::largest_lever(const Vec3& reference_B) const {
  const Vec3 reference = reference_B - center_B;
  return (box_min - reference).cwiseAbs().cwiseMax((box_max - reference).cwiseAbs()).norm();
}

HydrostaticMesh make_hydrostatic_mesh(const ValidatedMesh& validated, WithTree with_tree) {
  const TriangleMesh& source = validated.mesh;
  const BoundingBox box = bounding_box(source);
  HydrostaticMesh mesh;
  mesh.center_B =
      round_to_coarse_grid(box.center(), box.min_B.cwiseAbs().cwiseMax(box.max_B.cwiseAbs()).maxCoeff());
  mesh.box_min = box.min_B - mesh.center_B;
  mesh.box_max = box.max_B - mesh.center_B;
  mesh.diagonal = box.diagonal();
  mesh.surface.triangles = source.triangles;
  mesh.boundary_vertices = validated.boundary_vertices;

  const auto recentre = [](const std::vector<double>& from, double center) {
    std::vector<double> to(from.size());
    std::transform(from.begin(), from.end(), to.begin(), [center](double value) { return value - center; });
    return to;
  };
  mesh.surface.x = recentre(source.x, mesh.center_B.x());
  mesh.surface.y = recentre(source.y, mesh.center_B.y());
  mesh.surface.z = recentre(source.z, mesh.center_B.z());

  PairwiseSum<Totals> sum;
  for (const Triangle& triangle : mesh.surface.triangles) {
    const Point<double> a = mesh.point(triangle[0]);
    const Point<double> b = mesh.point(triangle[1]);
    const Point<double> c = mesh.point(triangle[2]);
    Totals term;
    term.elements.add(a, b, c, {0, 0, 0});
    term.twice_area = cross(b - a, c - a).vec3().norm();
    sum.add(term);
  }
  const Totals totals = sum.total();
  mesh.area = 0.5 * totals.twice_area;
  mesh.volume = totals.elements.volume();
  const bool has_centroid = !mesh.open() && std::abs(mesh.volume) > mesh.volume_gate();
  mesh.centroid = has_centroid ? Vec3(totals.elements.moment(Vec3::Zero()) / mesh.volume)
                               : Vec3(0.5 * (mesh.box_min + mesh.box_max));
  if (with_tree == WithTree::kYes) mesh.tree = build_moment_tree(mesh.surface);
  return mesh;
}

}  // namespace buoyancy
