#include "tests/random_search/random_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <utility>

#include "geometry/shapes.h"
#include "tests/geometry/sample_meshes.h"
#include "tests/hydrostatics/random_poses.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {
namespace {

std::int32_t count(RandomPoses& random, int min, int max) {
  return min + static_cast<std::int32_t>(random.pick(static_cast<std::size_t>(max - min) + 1));
}

TriangleMesh tetrahedron(RandomPoses& random) {
  TriangleMesh mesh;
  for (int i = 0; i < 4; ++i) mesh.add_vertex(random.direction());
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  return mesh;
}

TriangleMesh rock(RandomPoses& random, double roughness) {
  return make_shape(
      RockShape{.frequency = count(random, 1, 2), .roughness = roughness, .seed = random.pick(1U << 30U)});
}

TriangleMesh knot(RandomPoses& random) {
  return make_shape(TorusKnotShape{
      .tube = random.uniform(0.05, 0.15), .tubular = count(random, 12, 22), .radial = count(random, 3, 4)});
}

TriangleMesh box(RandomPoses& random) {
  return make_shape(BoxShape{.segments = {count(random, 1, 3), count(random, 1, 3), count(random, 1, 2)}});
}

TriangleMesh round_shape(RandomPoses& random) {
  if (random.pick(2) == 0) {
    return make_shape(CylinderShape{.segments = count(random, 3, 12), .stacks = count(random, 1, 3)});
  }
  return make_shape(ConeShape{.segments = count(random, 3, 14), .stacks = count(random, 1, 2)});
}

using NamedShape = std::pair<const char*, TriangleMesh>;

NamedShape random_shape(RandomPoses& random) {
  switch (random.pick(8)) {
    case 0:
      return {"tetrahedron", tetrahedron(random)};
    case 1:
      return {"box", box(random)};
    case 2:
      return {"convex body", rock(random, 0.0)};
    case 3:
      return {"rock", rock(random, random.uniform(0.1, 0.6))};
    case 4:
      return {"knot", knot(random)};
    case 5:
      return {"cylinder or cone", round_shape(random)};
    case 6: {
      const TriangleMesh cavity = inside_out(random.pick(2) == 0 ? box(random) : rock(random, 0.3));
      return {"hollow box", joined(make_shape(BoxShape{.size = {3, 3, 3}, .segments = {2, 1, 2}}),
                                   moved_and_scaled(cavity, 0.3 * random.direction(), 0.7))};
    }
    default: {
      TriangleMesh parts = rock(random, 0.2);
      const TriangleMesh second = box(random);
      parts = joined(std::move(parts), moved_and_scaled(second, 3.0 * random.direction(), 0.8));
      return {"parts", joined(std::move(parts), moved_and_scaled(tetrahedron(random), {0, 0, 6}, 0.5))};
    }
  }
}

// Adds a vertex on an edge, near one of its ends: two faces become four, two of them slivers.
void split_edge(TriangleMesh& mesh, RandomPoses& random) {
  const Triangle face = mesh.triangles[random.pick(mesh.triangles.size())];
  const std::int32_t a = face[0];
  const std::int32_t b = face[1];
  const double share = random.power_of_ten(-9.0, -0.3);
  mesh.add_vertex(mesh.vertex(a) + share * (mesh.vertex(b) - mesh.vertex(a)));
  const auto middle = static_cast<std::int32_t>(mesh.vertex_count()) - 1;
  const std::size_t faces = mesh.triangles.size();
  for (std::size_t t = 0; t < faces; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t from = mesh.triangles[t][i];
      const std::int32_t to = mesh.triangles[t][(i + 1) % 3];
      if (!((from == a && to == b) || (from == b && to == a))) continue;
      const std::int32_t apex = mesh.triangles[t][(i + 2) % 3];
      mesh.triangles[t] = {from, middle, apex};
      mesh.triangles.push_back({middle, to, apex});
      break;
    }
  }
}

// Adds a vertex inside a face, near one of its edges: one face becomes three, one of them a needle.
void split_face(TriangleMesh& mesh, RandomPoses& random) {
  const std::size_t t = random.pick(mesh.triangles.size());
  const Triangle face = mesh.triangles[t];
  const double near = random.power_of_ten(-9.0, -0.5);
  const double along = random.uniform(0.0, 1.0);
  const Vec3 a = mesh.vertex(face[0]);
  const Vec3 b = mesh.vertex(face[1]);
  mesh.add_vertex((1.0 - near) * (a + along * (b - a)) + near * mesh.vertex(face[2]));
  const auto middle = static_cast<std::int32_t>(mesh.vertex_count()) - 1;
  mesh.triangles[t] = {face[0], face[1], middle};
  mesh.triangles.push_back({face[1], face[2], middle});
  mesh.triangles.push_back({face[2], face[0], middle});
}

void stretch(TriangleMesh& mesh, const Vec3& factors, const Eigen::Quaterniond& turn, double scale,
             const Vec3& offset, bool single_precision) {
  mesh = mapped(std::move(mesh), [&](const Vec3& vertex) {
    const Vec3 stretched = factors.cwiseProduct(vertex);
    return Vec3(scale * (turn * stretched) + offset);
  });
  if (single_precision) mesh = rounded_to_float32(std::move(mesh));
}

RandomMesh drawn(RandomPoses& random) {
  auto [name, mesh] = random_shape(random);
  std::string kind = name;
  if (random.pick(4) == 0) {
    kind += " with slivers";
    for (int i = count(random, 1, 8); i > 0; --i) {
      if (random.pick(2) == 0) {
        split_edge(mesh, random);
      } else {
        split_face(mesh, random);
      }
    }
  }
  Vec3 factors = Vec3::Ones();
  if (random.pick(3) == 0) {
    kind += ", stretched";
    for (double& factor : factors) factor = random.power_of_ten(-2.5, 0.0);
  }
  const double scale = random.power_of_ten(-6.0, 6.0);
  Vec3 offset = Vec3::Zero();
  const bool far = random.pick(3) == 0;
  if (far) offset = scale * random.far_vector(0.0, 6.0);
  const Eigen::Quaterniond turn = random.pick(2) == 0 ? Eigen::Quaterniond::Identity() : random.rotation();
  const bool single_precision = random.pick(3) == 0;
  stretch(mesh, factors, turn, scale, offset, single_precision);

  std::array<char, 80> rest;
  std::snprintf(rest.data(), rest.size(), ", %.1e m%s%s", scale, far ? ", far from B's origin" : "",
                single_precision ? ", in float32" : "");
  ImportedMesh imported;
  imported.mesh = std::move(mesh);
  MeshValidation validation = validate_mesh(imported, kind, {.repair = RepairPolicy::kNone});
  RandomMesh result;
  result.kind = kind + rest.data();
  if (validation.mesh) result.validated = std::move(*validation.mesh);
  return result;
}

}  // namespace

RandomMesh random_mesh(RandomPoses& random) {
  RandomMesh mesh;
  do {
    mesh = drawn(random);
  } while (mesh.validated.mesh.triangles.empty());
  return mesh;
}

}  // namespace buoyancy
