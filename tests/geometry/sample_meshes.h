// Small meshes with known properties, and functions that modify them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

#include "geometry/shapes.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

inline TriangleMesh box_mesh(const Vec3& min_B, const Vec3& max_B) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    mesh.add_vertex({((corner & 1) != 0 ? max_B : min_B).x(), ((corner & 2) != 0 ? max_B : min_B).y(),
                     ((corner & 4) != 0 ? max_B : min_B).z()});
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh cube_mesh(double size = 1.0, const Vec3& center_B = Vec3::Zero()) {
  return box_mesh(center_B - Vec3::Constant(size / 2), center_B + Vec3::Constant(size / 2));
}

inline TriangleMesh tetrahedron_mesh() {
  TriangleMesh mesh;
  for (const Vec3& vertex_B : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
    mesh.add_vertex(vertex_B);
  }
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

// Returns a welded, closed, star-shaped mesh whose faces all differ.
inline TriangleMesh rock_mesh(std::int32_t frequency = 8) {
  return make_shape(RockShape{1.0, frequency, 0.3, 7});
}

inline TriangleMesh sphere_mesh(std::int32_t segments, double radius = 1.0) {
  return make_shape(SphereShape{radius, segments});
}

// Returns the mesh with three separate vertices per face, as in an STL file.
inline TriangleMesh unwelded(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& face : mesh.triangles) {
    Triangle own{};
    for (std::size_t corner = 0; corner < 3; ++corner)
      own[corner] = soup.add_vertex(mesh.vertex(face[corner]));
    soup.triangles.push_back(own);
  }
  return soup;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
  for (Triangle& face : mesh.triangles) std::swap(face[1], face[2]);
  return mesh;
}

inline TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& other) {
  const auto offset = static_cast<std::int32_t>(mesh.vertex_count());
  for (std::size_t v = 0; v < other.vertex_count(); ++v)
    mesh.add_vertex(other.vertex(static_cast<std::int32_t>(v)));
  for (const Triangle& face : other.triangles) {
    mesh.triangles.push_back({face[0] + offset, face[1] + offset, face[2] + offset});
  }
  return mesh;
}

inline TriangleMesh without_face(TriangleMesh mesh, std::size_t face) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(face));
  return mesh;
}

// Maps each vertex x_B to map(x_B).
template <typename Map>
TriangleMesh mapped(TriangleMesh mesh, const Map& map) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 image_B = map(mesh.vertex(static_cast<std::int32_t>(v)));
    mesh.x[v] = image_B.x();
    mesh.y[v] = image_B.y();
    mesh.z[v] = image_B.z();
  }
  return mesh;
}

// Maps each vertex x_B to rotation x_B + translation_B.
inline TriangleMesh moved_mesh(TriangleMesh mesh, const Mat3& rotation, const Vec3& translation_B) {
  return mapped(std::move(mesh), [&](const Vec3& x_B) { return Vec3(rotation * x_B + translation_B); });
}
inline TriangleMesh turned(TriangleMesh mesh, const Eigen::Quaterniond& q,
                           const Vec3& translation_B = Vec3::Zero()) {
  return mapped(std::move(mesh), [&](const Vec3& x_B) { return Vec3(q * x_B + translation_B); });
}

// [m^3], of the cones from the origin to the faces.
inline double volume_of(const TriangleMesh& mesh) {
  double six_volumes = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    six_volumes += mesh.vertex(a).dot(mesh.vertex(b).cross(mesh.vertex(c)));
  }
  return six_volumes / 6.0;
}

}  // namespace buoyancy
