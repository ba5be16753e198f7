#include "geometry/mirroring.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/format.h"
#include "geometry/mesh_repair.h"
#include "geometry/swept_volume.h"

namespace buoyancy {

Expected<RepairStep> add_mirror_image(TriangleMesh& mesh, Axis axis, const std::string& name) {
  RepairStep step;
  step.kind = RepairKind::kMirror;
  if (mesh.triangles.empty()) return step;
  const BoundingBox box = bounding_box(mesh);
  const double tolerance = kRepairTolerance * box.diagonal();
  const auto a = static_cast<std::size_t>(axis);
  const double low = box.min_B[static_cast<Eigen::Index>(a)];
  const double high = box.max_B[static_cast<Eigen::Index>(a)];
  const bool reaches = low <= tolerance && high >= -tolerance;
  if (!reaches || (low < -tolerance && high > tolerance)) {
    const std::string letter(1, "xyz"[a]);
    return make_error(
        {name, letter + " from " + format_number(low, 6) + " to " + format_number(high, 6) + " m",
         "half a body that ends at " + letter + " = 0, to be mirrored in that plane",
         reaches ? "the mesh is whole already, or another plane is its plane of symmetry"
                 : "the plane of symmetry is elsewhere than through the mesh's origin",
         "Choose another axis, or move the mesh so that its plane of symmetry is " + letter + " = 0"});
  }
  std::vector<double>& across = axis == Axis::kX ? mesh.x : axis == Axis::kY ? mesh.y : mesh.z;
  std::vector<std::int32_t> image(mesh.vertex_count());
  const std::size_t vertices = mesh.vertex_count();
  for (std::size_t v = 0; v < vertices; ++v) {
    if (std::abs(across[v]) <= tolerance) {
      step.max_move = std::max(step.max_move, std::abs(across[v]));
      across[v] = 0.0;
    }
    image[v] = static_cast<std::int32_t>(v);
  }
  std::erase_if(mesh.triangles, [&across](const Triangle& face) {
    return std::all_of(face.begin(), face.end(),
                       [&across](std::int32_t v) { return across[static_cast<std::size_t>(v)] == 0.0; });
  });
  for (std::size_t v = 0; v < vertices; ++v) {
    if (across[v] == 0.0) continue;
    Vec3 mirrored = mesh.vertex(static_cast<std::int32_t>(v));
    mirrored[static_cast<Eigen::Index>(a)] *= -1.0;
    image[v] = mesh.add_vertex(mirrored);
  }
  const std::size_t faces = mesh.triangles.size();
  mesh.triangles.reserve(2 * faces);
  for (std::size_t i = 0; i < faces; ++i) {
    const Triangle& face = mesh.triangles[i];
    const auto of = [&image](std::int32_t v) { return image[static_cast<std::size_t>(v)]; };
    mesh.triangles.push_back({of(face[0]), of(face[2]), of(face[1])});
    step.area += area_of_face(mesh, face);
  }
  step.count = static_cast<std::int64_t>(faces);
  return step;
}

}  // namespace buoyancy
