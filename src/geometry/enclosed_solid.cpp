#include "geometry/enclosed_solid.h"

#include <vector>

#include "geometry/mass_properties.h"
#include "geometry/mesh_orientation.h"
#include "geometry/mesh_topology.h"

namespace buoyancy {

std::optional<EnclosedSolid> enclosed_solid(TriangleMesh mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  if (!topology.counts.all_matched()) return std::nullopt;
  std::vector<ComponentReport> components = describe_components(mesh, topology);
  if (!orient_closed(mesh, topology, components)) return std::nullopt;
  const MassProperties properties = mass_properties(mesh);
  return EnclosedSolid{properties.volume, properties.centroid_B};
}

}  // namespace buoyancy
