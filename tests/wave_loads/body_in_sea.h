// A body and a sea, and the load by the methods that integrate the pressure over the wetted surface.
#pragma once

#include <cstdint>

#include "geometry/shapes.h"
#include "wave_loads/wave_load.h"
#include "wave_loads/wave_surface_methods.h"

namespace buoyancy {

struct FloatingBody {
  explicit FloatingBody(const Shape& shape)
      : mesh(make_hydrostatic_mesh(ValidatedMesh{make_shape(shape), {}})),
        tree(build_patch_tree(mesh.surface)) {}

  HydrostaticMesh mesh;
  PatchTree tree;
};

struct SeaAtTime {
  explicit SeaAtTime(const SeaDescription& description, std::int64_t utime = 0, const Water& water = {})
      : sea(Sea::make(description, water).value()), snapshot(sea), expansion(sea) {
    snapshot.set_time(utime);
  }
  SeaAtTime(const SeaAtTime&) = delete;
  SeaAtTime& operator=(const SeaAtTime&) = delete;

  Sea sea;
  SeaSnapshot snapshot;
  SeaExpansion expansion;
};

inline WaveLoad hierarchical_load(const FloatingBody& body, const SeaAtTime& sea, const Pose& pose,
                                  double tolerance, const Vec3& reference_B = Vec3::Zero()) {
  return wave_load({&body.mesh, &body.tree, tolerance}, sea.expansion, sea.snapshot, pose, reference_B);
}

inline WaveLoad exact_surface_load(const FloatingBody& body, const SeaAtTime& sea, const Pose& pose,
                                   const Vec3& reference_B = Vec3::Zero()) {
  return exact_surface_in_waves(body.mesh, sea.snapshot, pose, reference_B);
}

}  // namespace buoyancy
