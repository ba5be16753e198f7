// Turns what is inside out, so that the volume of a solid is positive and that of a cavity in it negative.
//
// A component inside no other is a solid: of negative volume it is inside out, and is turned with everything
// inside it. A component inside others is judged by how often the space around it is counted, outermost
// components first. Not at all, as in a cavity: it is a solid, and turned if negative. Once or more: if
// negative it is a cavity; if positive its volume is counted once more than it should, which stays and is
// reported. Solids that share an edge are one component, turned together or not at all.
#pragma once

#include <vector>

#include "geometry/mesh_report.h"
#include "geometry/mesh_topology.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

// By component number: what topology and volumes say, nothing turned.
std::vector<ComponentReport> describe_components(const TriangleMesh& mesh, const MeshTopology& topology);

// Turns faces of a mesh whose edges are all matched, and keeps the account of it in `components`.
void orient_closed(TriangleMesh& mesh, const MeshTopology& topology,
                   std::vector<ComponentReport>& components);

// Turns all faces of an open mesh if its volume is negative once its holes are closed, each by triangles
// around the middle of its edges; boundary edges must be its only fault. Returns that volume, m^3, as turned.
double orient_open(TriangleMesh& mesh, const std::vector<Hole>& holes,
                   std::vector<ComponentReport>& components);

}  // namespace buoyancy
