#include "hydrostatics/hydrostatic_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/double_double.h"
#include "geometry/pairwise_total.h"
#include "geometry/parallel_tasks.h"
#include "hydrostatics/volume_elements.h"

namespace buoyancy {
namespace {

// Rounds a point to a grid of 2^-22 of the largest coordinate's power of two. float32 coordinates and such a
// centre are multiples of a common unit with few enough bits between them that their difference is exact in
// double. For a mesh farther from its origin than 2^16 times its size the grid is 1/64 of its size: there
// coordinates and centre are so near to each other that their difference is exact anyway.
Vec3 round_to_coarse_grid(const Vec3& point, double max_coordinate, double size) {
  if (!(max_coordinate > 0.0) || !(size > 0.0)) return point;
  const int unit = std::min(std::ilogb(max_coordinate) - 21, std::ilogb(size) - 6);
  Vec3 rounded;
  for (int i = 0; i < 3; ++i) rounded[i] = std::ldexp(std::nearbyint(std::ldexp(point[i], -unit)), unit);
  return rounded;
}

struct Totals {
  VolumeElements elements;
  double twice_area = 0.0;
  double twice_rounding_area = 0.0;

  Totals& operator+=(const Totals& other) {
    elements += other.elements;
    twice_area += other.twice_area;
    twice_rounding_area += other.twice_rounding_area;
    return *this;
  }
};

// Returns the triangle, rotated to start with the corner opposite its longest edge; of edges of equal length
// the first one counts.
Triangle starting_opposite_longest_edge(const Triangle& triangle, const TriangleMesh& mesh) {
  const Vec3 a = mesh.vertex(triangle[0]);
  const Vec3 b = mesh.vertex(triangle[1]);
  const Vec3 c = mesh.vertex(triangle[2]);
  const double bc = (c - b).squaredNorm();
  const double ca = (a - c).squaredNorm();
  const double ab = (b - a).squaredNorm();
  if (bc >= ca && bc >= ab) return triangle;
  if (ca >= ab) return {triangle[1], triangle[2], triangle[0]};
  return {triangle[2], triangle[0], triangle[1]};
}

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// A mesh in its file's coordinates, relative to `center`.
struct FileSurface {
  TriangleMesh surface;
  Vec3 center;
};

// Undoes the scale for float32 coordinates: the float32 number nearest to value / scale is the file's
// coordinate, unless the value is too small to matter. Returns nothing if a vertex is not the scale times a
// float32 number, to within the rounding of HydrostaticMesh::surface.
std::optional<FileSurface> file_surface(const HydrostaticMesh& mesh) {
  const Vec3 half = 0.5 * (mesh.box_max - mesh.box_min);
  const Vec3 middle = mesh.center_B + 0.5 * (mesh.box_max + mesh.box_min);
  FileSurface file;
  file.center = round_to_coarse_grid(middle / mesh.scale, (middle.cwiseAbs() + half).maxCoeff() / mesh.scale,
                                     mesh.diagonal / mesh.scale);
  file.surface.triangles = mesh.surface.triangles;
  const auto convert = [&mesh](const std::vector<double>& from, double center_B, double center,
                               std::vector<double>& to) {
    to.reserve(from.size());
    for (const double value : from) {
      const double at_B = value + center_B;
      const auto in_file = static_cast<double>(static_cast<float>(at_B / mesh.scale));
      const double max_error = 2.0 * kEpsilon * (std::abs(value) + std::abs(center_B));
      if (!(std::abs(mesh.scale * in_file - at_B) <= max_error)) return false;
      to.push_back(in_file - center);
    }
    return true;
  };
  const bool exact = convert(mesh.surface.x, mesh.center_B.x(), file.center.x(), file.surface.x) &&
                     convert(mesh.surface.y, mesh.center_B.y(), file.center.y(), file.surface.y) &&
                     convert(mesh.surface.z, mesh.center_B.z(), file.center.z(), file.surface.z);
  if (!exact) return std::nullopt;
  return file;
}

double cubed(double x) {
  return x * x * x;
}

double rounding(double volume, double diagonal, double area) {
  return kEpsilon * (64.0 * std::abs(volume) + diagonal * area);
}

}  // namespace

double HydrostaticMesh::volume_tolerance() const {
  return rounding(volume, diagonal, area);
}

bool HydrostaticMesh::meets_volume_tolerance() const {
  return area >= diagonal * diagonal / 8.0 && rounding_area <= 4.0 / 3.0 * area;
}

double HydrostaticMesh::rounding_bound() const {
  return 2.0 * rounding(volume, diagonal, rounding_area);
}

double HydrostaticMesh::max_rounding_bound() const {
  return rounding_bound() + (meets_volume_tolerance() ? 0.0 : kEpsilon * cubed(tree->scale) * tree->rounding);
}

double HydrostaticMesh::max_lever_arm(const Vec3& reference_B) const {
  const Vec3 reference = reference_B - center_B;
  return (box_min - reference).cwiseAbs().cwiseMax((box_max - reference).cwiseAbs()).norm();
}

HydrostaticMesh make_hydrostatic_mesh(const ValidatedMesh& validated, WithTree with_tree, double scale) {
  const TriangleMesh& source = validated.mesh;
  const BoundingBox box = bounding_box(source);
  HydrostaticMesh mesh;
  mesh.scale = scale;
  mesh.center_B = round_to_coarse_grid(
      box.center(), box.min_B.cwiseAbs().cwiseMax(box.max_B.cwiseAbs()).maxCoeff(), box.diagonal());
  mesh.box_min = box.min_B - mesh.center_B;
  mesh.box_max = box.max_B - mesh.center_B;
  mesh.diagonal = box.diagonal();
  mesh.boundary_vertices = validated.boundary_vertices;

  const auto recentre = [](const std::vector<double>& from, double center) {
    std::vector<double> to(from.size());
    std::transform(from.begin(), from.end(), to.begin(), [center](double value) { return value - center; });
    return to;
  };
  mesh.surface.x = recentre(source.x, mesh.center_B.x());
  mesh.surface.y = recentre(source.y, mesh.center_B.y());
  mesh.surface.z = recentre(source.z, mesh.center_B.z());

  mesh.surface.triangles.resize(source.triangles.size());
  run_parallel_ranges(source.triangles.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      mesh.surface.triangles[i] = starting_opposite_longest_edge(source.triangles[i], mesh.surface);
    }
  });

  const auto totals = pairwise_total<Totals>(mesh.surface.triangles.size(), [&mesh](std::size_t i) {
    const Triangle& triangle = mesh.surface.triangles[i];
    const Point<double> a = mesh.point(triangle[0]);
    const Point<double> b = mesh.point(triangle[1]);
    const Point<double> c = mesh.point(triangle[2]);
    Totals term;
    term.elements.add(a, b, c, {0, 0, 0});
    term.twice_area = cross(b - a, c - a).vec3().norm();
    term.twice_rounding_area = std::max(term.twice_area, (b - a).vec3().norm() * (c - a).vec3().norm());
    return term;
  });
  mesh.area = 0.5 * totals.twice_area;
  mesh.rounding_area = 0.5 * totals.twice_rounding_area;
  mesh.volume = totals.elements.volume();
  const bool has_centroid = !mesh.is_open() && std::abs(mesh.volume) > mesh.volume_tolerance();
  mesh.centroid = has_centroid ? Vec3(totals.elements.moment(Vec3::Zero()) / mesh.volume)
                               : Vec3(0.5 * (mesh.box_min + mesh.box_max));
  if (with_tree == WithTree::kYes) mesh.tree = build_moment_tree(mesh);
  return mesh;
}

MomentTree build_moment_tree(const HydrostaticMesh& mesh) {
  if (mesh.scale != 1.0) {
    if (std::optional<FileSurface> file = file_surface(mesh)) {
      MomentTree tree = build_moment_tree(file->surface, -file->center);
      tree.scale = mesh.scale;
      for (int i = 0; i < 3; ++i) {
        const DoubleDouble center = two_product(mesh.scale, file->center[i]);
        tree.offset[i] = (center.hi - mesh.center_B[i]) + center.lo;
      }
      return tree;
    }
  }
  return build_moment_tree(mesh.surface, -mesh.center_B);
}

}  // namespace buoyancy
