#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {

TriangleMesh moved_and_scaled(TriangleMesh mesh, const Vec3& by, double scale) {
  for (double& x : mesh.x) x = x * scale + by.x();
  for (double& y : mesh.y) y = y * scale + by.y();
  for (double& z : mesh.z) z = z * scale + by.z();
  return mesh;
}

TriangleMesh rounded_to_float32(TriangleMesh mesh) {
  for (std::vector<double>* const coordinates : {&mesh.x, &mesh.y, &mesh.z}) {
    for (double& value : *coordinates) value = static_cast<double>(static_cast<float>(value));
  }
  return mesh;
}

std::vector<NamedMesh> closed_test_meshes() {
  const TriangleMesh rock = make_shape(RockShape{.radius = 1.0, .frequency = 8, .roughness = 0.4, .seed = 7});
  std::vector<NamedMesh> meshes{
      {"box of 12 triangles", make_shape(BoxShape{})},
      {"box of 1,200 triangles", make_shape(BoxShape{.size = {1, 2, 3}, .segments = {10, 10, 10}})},
      {"plate 1 : 1000", make_shape(BoxShape{.size = {1, 1, 1e-3}, .segments = {6, 6, 1}})},
      {"needle 1 : 8192", make_shape(BoxShape{.size = {8192, 1, 1}, .segments = {40, 1, 1}})},
      {"sphere", make_shape(SphereShape{.radius = 0.7, .segments = 16})},
      {"cylinder", make_shape(CylinderShape{.radius = 0.5, .height = 2, .segments = 24, .stacks = 3})},
      {"cone", make_shape(ConeShape{.radius = 1, .height = 2, .segments = 24, .stacks = 3})},
      {"torus knot", make_shape(TorusKnotShape{.tubular = 60, .radial = 6})},
      {"Wigley hull", make_shape(WigleyShape{.segments = 16, .levels = 6})},
      {"rock", rock},
      {"rock of 1e-6 m", moved_and_scaled(rock, Vec3::Zero(), 1e-6)},
      {"rock of 1e6 m", moved_and_scaled(rock, Vec3::Zero(), 1e6)},
      {"rock 1e3 m from its origin", moved_and_scaled(rock, {600, -800, 100})},
      {"rock 1e6 m from its origin", moved_and_scaled(rock, {6e5, -8e5, 1e5})},
      {"box with a cavity", joined(make_shape(BoxShape{.size = {2, 2, 2}, .segments = {3, 3, 3}}),
                                   inside_out(make_shape(SphereShape{.radius = 0.8, .segments = 8})))},
      {"two boxes apart",
       joined(make_shape(BoxShape{}), moved_and_scaled(make_shape(BoxShape{}), {3, 0, 1}))},
  };
  return meshes;
}

}  // namespace buoyancy
