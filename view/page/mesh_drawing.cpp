#include "view/page/mesh_drawing.h"

#include <utility>

#include <meshoptimizer.h>

namespace buoyancy::view {

void append(MeshDrawing& drawing, const TriangleMesh& mesh, const Mat3& rotation, const Vec3& offset) {
  const auto first = static_cast<std::uint32_t>(drawing.positions.size() / 3);
  drawing.positions.reserve(drawing.positions.size() + 3 * mesh.vertex_count());
  for (std::size_t i = 0; i < mesh.vertex_count(); ++i) {
    const Vec3 position = rotation * Vec3(mesh.x[i], mesh.y[i], mesh.z[i]) + offset;
    for (const double coordinate : position) drawing.positions.push_back(static_cast<float>(coordinate));
  }
  drawing.indices.reserve(drawing.indices.size() + 3 * mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::int32_t vertex : triangle) {
      drawing.indices.push_back(first + static_cast<std::uint32_t>(vertex));
    }
  }
}

void reduce(MeshDrawing& drawing, std::size_t max_triangles) {
  if (drawing.triangle_count() <= max_triangles) return;
  constexpr float kMaxError = 0.02F;  // relative to the mesh's extent
  constexpr std::size_t kVertexBytes = 3 * sizeof(float);
  const std::size_t vertices = drawing.positions.size() / 3;
  const std::size_t max_indices = 3 * max_triangles;
  std::vector<std::uint32_t> reduced(drawing.indices.size());
  std::size_t count =
      meshopt_simplify(reduced.data(), drawing.indices.data(), drawing.indices.size(),
                       drawing.positions.data(), vertices, kVertexBytes, max_indices, kMaxError);
  if (count > max_indices) {  // it preserves topology, so it cannot reduce many small disconnected parts
    count = meshopt_simplifySloppy(reduced.data(), drawing.indices.data(), drawing.indices.size(),
                                   drawing.positions.data(), vertices, kVertexBytes, max_indices, 1.0F);
  }
  reduced.resize(count);
  drawing.indices = std::move(reduced);
  std::vector<float> used_positions(drawing.positions.size());
  const std::size_t used_vertices =
      meshopt_optimizeVertexFetch(used_positions.data(), drawing.indices.data(), drawing.indices.size(),
                                  drawing.positions.data(), vertices, kVertexBytes);
  used_positions.resize(3 * used_vertices);
  drawing.positions = std::move(used_positions);
}

}  // namespace buoyancy::view
