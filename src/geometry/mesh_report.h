// The results of mesh validation: what a user needs to trust a mesh or to repair it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "geometry/hole_closing.h"
#include "geometry/mesh_import.h"
#include "geometry/repair_report.h"
#include "geometry/triangle_mesh.h"
#include "geometry/welding.h"

namespace buoyancy {

// Triangles connected through shared edges.
struct ComponentReport {
  std::int64_t triangles = 0;
  double volume = 0.0;   // [m^3], signed, as used (after flipping), about the mesh's bounding-box centre
  bool closed = false;   // has no boundary edge
  bool cavity = false;   // negative volume, inside another component: its volume is subtracted
  bool nested = false;   // positive volume, inside another component: its volume is counted twice
  bool flipped = false;  // was inside out: its winding was reversed
};

// Connected boundary edges.
struct HoleReport {
  std::int64_t edges = 0;
  BoundingBox box{Vec3::Zero(), Vec3::Zero()};
  double perimeter = 0.0;  // [m]
  double area = 0.0;       // of a cap over it [m^2]
  double bulge = 0.0;      // of a hemisphere over it: an estimate of what a cap may leave out or add [m^3]
  Vec3 length_in_planes = Vec3::Zero();  // of its edges in the planes x = 0, y = 0 and z = 0 [m]
  bool slit = false;                     // narrower than 1e-6 of the mesh's size on average
};

// Describes the mesh after its repair, also if it is refused.
struct MeshReport {
  std::string name;  // file or shape
  MeshSource source;
  std::optional<Vec3> up_B;  // the file's up axis in the body's frame, unit length; nullopt: not stated

  std::int64_t triangles = 0;  // kept; 0 also if a vertex is not finite, since validation then stops
  std::int64_t vertices_stored = 0;
  std::int64_t vertices_welded = 0;
  WeldKind weld = WeldKind::kExact;
  double weld_largest_move = 0.0;  // largest displacement of a vertex by welding [m]
  RepairReport repair;             // empty if the mesh was left as it is

  BoundingBox box{Vec3::Zero(), Vec3::Zero()};
  double diagonal = 0.0;  // L [m]
  double area = 0.0;      // A_s [m^2]
  double volume = 0.0;    // V_T [m^3], about the bounding box's centre; meaningless for open meshes
  Vec3 volume_by_axis = Vec3::Zero();  // [m^3], from x, y and z; equal for a closed mesh
  Vec3 area_vector = Vec3::Zero();     // integral of n dA [m^2]; zero for a closed mesh

  std::int64_t boundary_edges = 0;      // used by one face
  std::int64_t non_manifold_edges = 0;  // used by three or more faces, not equally often in both directions
  std::int64_t balanced_edges = 0;      // used by four or more faces, equally often in both directions
  std::int64_t misoriented_edges = 0;   // used by two faces in the same direction
  std::int64_t degenerate_faces = 0;    // kept, of zero area
  std::int64_t dropped_faces = 0;       // use a vertex twice
  std::int64_t duplicate_faces = 0;     // same three vertices as an earlier face
  std::optional<std::int64_t> intersecting_pairs;  // pairs of intersecting faces, if counted
  // Volume that counts more than once [m^3]; set for accepted closed meshes if all pairs are counted.
  std::optional<double> overlap_volume;
  bool intersections_cut_off = false;  // there are more than counted: too many to count them all

  std::vector<ComponentReport> components;  // largest absolute volume first
  std::vector<HoleReport> holes;            // most edges first
  // What closing all holes would do; set if the mesh is refused for its edges and could be closed.
  std::optional<ClosingEstimate> closing;
  bool flipped = false;  // the whole mesh was inside out: all windings were reversed

  bool closed() const { return boundary_edges == 0 && non_manifold_edges == 0 && misoriented_edges == 0; }
};

// Returns what a user can do about a mesh that is refused for its edges: commands and keys of a scene file,
// with what they do to the volume. Empty if closing its holes does not help.
std::string closing_advice(const MeshReport& report);

// Formats the report as aligned lines for a terminal, without a final newline.
std::string to_text(const MeshReport& report);

}  // namespace buoyancy
