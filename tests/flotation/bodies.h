// Floating bodies of one generated mesh.
#pragma once

#include <memory>

#include "flotation/floating_body.h"
#include "geometry/shapes.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "tests/hydrostatics/test_meshes.h"

namespace buoyancy {

// mesh: outlives the body. relative_density: of the mass to that of the water which the mesh can displace.
inline FloatingBody body_of(const HydrostaticMesh& mesh, double relative_density,
                            const Vec3& center_of_mass_B = Vec3::Zero(), const Water& water = {}) {
  const PlacedMesh placed{.mesh = &mesh};
  return FloatingBody::make({&placed, 1}, relative_density * water.density * mesh.volume, center_of_mass_B)
      .value();
}

// Beam 20, depth 12, draught 6, KG 8 [m], with B's origin in the middle.
struct BoxShip {
  HydrostaticMesh mesh = mesh_of(BoxShape{{80, 20, 12}, {2, 2, 2}});
  FloatingBody body = body_of(mesh, 0.5, Vec3(0, 0, 2));
};

}  // namespace buoyancy
