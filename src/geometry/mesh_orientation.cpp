#include "geometry/mesh_orientation.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/component_nesting.h"
#include "geometry/pairwise_total.h"

namespace buoyancy {
namespace {

double signed_volume(const Vec3& a, const Vec3& b, const Vec3& c) {
  return a.dot(b.cross(c)) / 6.0;
}

double signed_volume(const TriangleMesh& mesh, const Triangle& face, const Vec3& center_B) {
  return signed_volume(mesh.vertex(face[0]) - center_B, mesh.vertex(face[1]) - center_B,
                       mesh.vertex(face[2]) - center_B);
}

// Faces grouped by component: faces[first[i]] .. faces[first[i + 1] - 1] belong to component i, ascending.
struct FacesByComponent {
  std::vector<std::size_t> faces;
  std::vector<std::size_t> first;
};

FacesByComponent faces_by_component(const MeshTopology& topology) {
  FacesByComponent grouped;
  grouped.first.assign(static_cast<std::size_t>(topology.components) + 1, 0);
  for (const std::int32_t component : topology.component_of_face) {
    ++grouped.first[static_cast<std::size_t>(component) + 1];
  }
  std::partial_sum(grouped.first.begin(), grouped.first.end(), grouped.first.begin());
  std::vector<std::size_t> next(grouped.first.begin(), grouped.first.end() - 1);
  grouped.faces.resize(topology.component_of_face.size());
  for (std::size_t f = 0; f < grouped.faces.size(); ++f) {
    grouped.faces[next[static_cast<std::size_t>(topology.component_of_face[f])]++] = f;
  }
  return grouped;
}

// Returns the volume of an open mesh with its holes closed [m^3].
double volume_with_holes_closed(const TriangleMesh& mesh, const std::vector<Hole>& holes) {
  const Vec3 center_B = bounding_box(mesh).center();
  PairwiseSum<double> volume;
  for (const Triangle& face : mesh.triangles) volume.add(signed_volume(mesh, face, center_B));
  for (const Hole& hole : holes) {
    Vec3 mean = Vec3::Zero();  // relative to center_B
    for (const Edge& edge : hole.edges) mean += mesh.vertex(edge[0]) - center_B;
    mean /= static_cast<double>(hole.edges.size());
    for (const auto& [from, to] : hole.edges) {
      volume.add(signed_volume(mesh.vertex(to) - center_B, mesh.vertex(from) - center_B, mean));
    }
  }
  return volume.total();
}

void flip(ComponentReport& component) {
  component.volume = -component.volume;
  component.flipped = !component.flipped;
}

// Flips inside-out components, marks cavities and nested solids. enclosing: as enclosing_components()
// returns.
void classify_components(const std::vector<std::vector<std::int32_t>>& enclosing,
                         std::vector<ComponentReport>& components) {
  const auto depth = [&enclosing](std::size_t i) { return enclosing[i].size(); };
  std::vector<std::size_t> outermost_first(components.size());
  std::iota(outermost_first.begin(), outermost_first.end(), std::size_t{0});
  std::stable_sort(outermost_first.begin(), outermost_first.end(),
                   [&depth](std::size_t i, std::size_t j) { return depth(i) < depth(j); });

  std::vector<bool> root_is_flipped(components.size(), false);
  for (const std::size_t i : outermost_first) {
    ComponentReport& component = components[i];
    std::int64_t counted = 0;  // times that the space around it is counted
    std::size_t root = i;
    for (const std::int32_t j : enclosing[i]) {
      const auto outer = static_cast<std::size_t>(j);
      counted += components[outer].volume > 0.0 ? 1 : -1;
      if (depth(outer) < depth(root)) root = outer;
    }
    root_is_flipped[i] = root == i ? component.volume < 0.0 : root_is_flipped[root];
    if (root_is_flipped[i]) flip(component);
    if (component.volume < 0.0 && counted <= 0) flip(component);
    component.cavity = component.volume < 0.0;
    component.nested = component.volume > 0.0 && counted > 0;
  }
}

}  // namespace

std::vector<ComponentReport> describe_components(const TriangleMesh& mesh, const MeshTopology& topology) {
  const Vec3 center_B = bounding_box(mesh).center();
  const FacesByComponent grouped = faces_by_component(topology);
  std::vector<ComponentReport> components(static_cast<std::size_t>(topology.components));
  for (std::size_t i = 0; i < components.size(); ++i) {
    const std::size_t count = grouped.first[i + 1] - grouped.first[i];
    components[i].triangles = static_cast<std::int64_t>(count);
    components[i].volume = pairwise_total<double>(count, [&](std::size_t n) {
      return signed_volume(mesh, mesh.triangles[grouped.faces[grouped.first[i] + n]], center_B);
    });
    components[i].closed = true;
  }
  for (const std::int32_t face : topology.boundary_faces) {
    const std::int32_t component = topology.component_of_face[static_cast<std::size_t>(face)];
    components[static_cast<std::size_t>(component)].closed = false;
  }
  return components;
}

bool orient_closed(TriangleMesh& mesh, const MeshTopology& topology,
                   std::vector<ComponentReport>& components) {
  const auto enclosing = enclosing_components(mesh, topology);
  if (!enclosing) return false;
  classify_components(*enclosing, components);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (components[static_cast<std::size_t>(topology.component_of_face[f])].flipped) {
      std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
    }
  }
  return true;
}

double orient_open(TriangleMesh& mesh, const std::vector<Hole>& holes,
                   std::vector<ComponentReport>& components) {
  const double volume = volume_with_holes_closed(mesh, holes);
  if (volume >= 0.0) return volume;
  for (Triangle& face : mesh.triangles) std::swap(face[1], face[2]);
  for (ComponentReport& component : components) flip(component);
  return -volume;
}

}  // namespace buoyancy
