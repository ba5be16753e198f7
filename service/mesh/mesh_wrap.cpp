#include "service/mesh/mesh_wrap.h"

#include "base/format.h"

#ifdef BUOYANCY_WITH_OPENVDB
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <openvdb/openvdb.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include "geometry/mesh_orientation.h"
#include "geometry/mesh_topology.h"
#include "geometry/winding_number.h"
#endif

namespace buoyancy::service {

#ifndef BUOYANCY_WITH_OPENVDB

Expected<TriangleMesh> wrap_mesh(const TriangleMesh&, double gap) {
  return make_error({"--wrap", format_shortest(gap) + " m", "a program that was built with OpenVDB", "",
                     "Install libopenvdb-dev and build again"});
}

#else

namespace {

constexpr double kCellsPerGap = 3.0;
constexpr double kAdaptivity = 0.1;  // of the result: larger faces where it is flat
constexpr double kMaxCells = 1'500.0;

struct Polyhedron {
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  std::vector<openvdb::Vec4I> quads;
};

Polyhedron to_polyhedron(const TriangleMesh& mesh) {
  Polyhedron polyhedron;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
    polyhedron.points.emplace_back(static_cast<float>(mesh.x[v]), static_cast<float>(mesh.y[v]),
                                   static_cast<float>(mesh.z[v]));
  for (const Triangle& t : mesh.triangles) polyhedron.triangles.emplace_back(t[0], t[1], t[2]);
  return polyhedron;
}

// Returns the isosurface of a distance field. The winding of its faces depends on the kind of grid.
TriangleMesh surface_at(const openvdb::FloatGrid& distance, double isovalue, double adaptivity) {
  Polyhedron found;
  openvdb::tools::volumeToMesh(distance, found.points, found.triangles, found.quads, isovalue, adaptivity);
  TriangleMesh mesh;
  for (const openvdb::Vec3s& point : found.points) {
    mesh.add_vertex(
        {static_cast<double>(point.x()), static_cast<double>(point.y()), static_cast<double>(point.z())});
  }
  const auto add = [&mesh](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh.triangles.push_back(
        {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)});
  };
  for (const openvdb::Vec3I& t : found.triangles) add(t[0], t[1], t[2]);
  for (const openvdb::Vec4I& q : found.quads) {
    add(q[0], q[1], q[2]);
    add(q[0], q[2], q[3]);
  }
  return mesh;
}

// Removes cavities and what lies in them. Orients the faces such that the largest component is a solid.
TriangleMesh outer_surfaces(TriangleMesh mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  std::vector<ComponentReport> components = describe_components(mesh, topology);
  const auto largest =
      std::max_element(components.begin(), components.end(),
                       [](const auto& a, const auto& b) { return std::abs(a.volume) < std::abs(b.volume); });
  if (largest != components.end() && largest->volume < 0.0) {
    for (Triangle& face : mesh.triangles) std::swap(face[1], face[2]);
    for (ComponentReport& component : components) component.volume *= -1.0;
  }
  std::vector<std::vector<Triangle>> faces(components.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    faces[static_cast<std::size_t>(topology.component_of_face[i])].push_back(mesh.triangles[i]);
  std::vector<std::size_t> solids;
  for (std::size_t i = 0; i < components.size(); ++i) {
    if (components[i].volume > 0.0) solids.push_back(i);
  }
  std::sort(solids.begin(), solids.end(),
            [&](std::size_t a, std::size_t b) { return components[a].volume > components[b].volume; });
  TriangleMesh outer = mesh;
  outer.triangles.clear();
  for (const std::size_t i : solids) {
    const WindingNumber around(mesh, outer.triangles);
    if (!outer.triangles.empty() && around.about(mesh.vertex(faces[i].front()[0])).winding != 0) continue;
    outer.triangles.insert(outer.triangles.end(), faces[i].begin(), faces[i].end());
  }
  return outer;
}

}  // namespace

Expected<TriangleMesh> wrap_mesh(const TriangleMesh& mesh, double gap) {
  const double cell = gap / kCellsPerGap;
  const double diagonal = bounding_box(mesh).diagonal();
  if (!(diagonal / cell <= kMaxCells)) {
    return make_error(
        {"--wrap", format_shortest(gap) + " m",
         "at least " + format_number(diagonal * kCellsPerGap / kMaxCells, 3) + " m for a mesh of this size",
         "a finer grid than memory holds", ""});
  }
  openvdb::initialize();
  const auto transform = openvdb::math::Transform::createLinearTransform(cell);
  const double offset = 0.5 * gap;
  const auto band = static_cast<float>(offset / cell + 3.0);
  const Polyhedron given = to_polyhedron(mesh);
  const auto unsigned_distance = openvdb::tools::meshToUnsignedDistanceField<openvdb::FloatGrid>(
      *transform, given.points, given.triangles, given.quads, band);
  const TriangleMesh shell = outer_surfaces(surface_at(*unsigned_distance, offset, 0.0));
  if (!shell.triangles.empty()) {
    const Polyhedron outside = to_polyhedron(shell);
    const auto distance = openvdb::tools::meshToLevelSet<openvdb::FloatGrid>(
        *transform, outside.points, outside.triangles, outside.quads, band);
    TriangleMesh wrapped = outer_surfaces(surface_at(*distance, -offset, kAdaptivity));
    if (!wrapped.triangles.empty()) return wrapped;
  }
  return make_error({"--wrap", "nothing is left of the mesh", "a mesh that encloses something, but for gaps",
                     "sheets without an inside, or holes wider than the gap",
                     "Close the holes first: --wrap together with --rims"});
}

#endif

}  // namespace buoyancy::service
