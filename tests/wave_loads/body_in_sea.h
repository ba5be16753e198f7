// A body and a sea with everything that a query needs, the load by the methods that integrate the pressure
// over the wetted surface, and the truth.
#pragma once

#include <cstdint>

#include "geometry/shapes.h"
#include "tests/hydrostatics/test_meshes.h"
#include "tests/truth/reference_load.h"
#include "wave_loads/wave_load.h"
#include "wave_loads/wave_surface_methods.h"

namespace buoyancy {

struct SeaBody {
  explicit SeaBody(const Shape& shape)
      : mesh(make_hydrostatic_mesh(ValidatedMesh{make_shape(shape), {}})),
        tree(build_patch_tree(mesh.surface)) {}

  HydrostaticMesh mesh;
  PatchTree tree;
};

struct TestSea {
  explicit TestSea(const SeaDescription& description, std::int64_t at_utime = 0, const Water& water = {})
      : sea(Sea::make(description, water).value()), utime(at_utime), snapshot(sea, utime), expansion(sea) {}
  TestSea(const TestSea&) = delete;
  TestSea& operator=(const TestSea&) = delete;

  Sea sea;
  std::int64_t utime;
  SeaSnapshot snapshot;
  SeaExpansion expansion;
};

inline WaveLoad hierarchical_load(const SeaBody& body, const TestSea& sea, const Pose& pose, double tolerance,
                                  const Vec3& reference_B = Vec3::Zero()) {
  return wave_load({&body.mesh, &body.tree, tolerance}, sea.expansion, sea.snapshot, pose, reference_B);
}

inline WaveLoad exact_surface_load(const SeaBody& body, const TestSea& sea, const Pose& pose,
                                   const Vec3& reference_B = Vec3::Zero()) {
  return exact_surface_in_waves(body.mesh, sea.snapshot, pose, reference_B);
}

// accuracy: of the force, and of the volume, relative to the volume of the mesh.
inline ReferenceLoad true_wave_load(const HydrostaticMesh& mesh, const Sea& sea, std::int64_t utime,
                                    const Pose& pose, double accuracy,
                                    const Vec3& reference_B = Vec3::Zero()) {
  const double error = accuracy * mesh.volume;
  const ReferenceSea reference(sea, utime, 0.0, pose, mesh.center_B);
  return reference_load(moved_and_scaled(mesh.surface, mesh.center_B), mesh.center_B, reference, reference_B,
                        {.force_error = error,
                         .torque_error = error * mesh.max_lever_arm(reference_B),
                         .volume_error = error,
                         .max_work = 2'000'000'000});
}

}  // namespace buoyancy
