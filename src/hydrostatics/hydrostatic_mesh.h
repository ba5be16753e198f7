// A mesh made ready for queries: coordinates about its own centre c, and the constants that do not depend on
// a pose. Built once per mesh and scale, shared by every body that uses it, never changed afterwards.
//
// c is the centre of the bounding box, rounded so that x_B - c is exact for float32 input: a mesh that lies
// 1e6 m from its own origin loses nothing (docs/mathematics.md, "Re-centring").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/mesh_validation.h"
#include "geometry/moment_tree.h"
#include "hydrostatics/point.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

struct HydrostaticMesh {
  // Vertices in m, B axes, about center_B; of a triangle the first corner lies opposite the longest edge, so
  // that products of the edges from it are as small as they can be.
  TriangleMesh surface;
  std::optional<MomentTree> tree;               // where asked for; `hierarchical` needs it
  std::vector<std::int32_t> boundary_vertices;  // of an accepted open mesh: all must be dry

  Vec3 center_B = Vec3::Zero();  // m: c
  Vec3 box_min = Vec3::Zero();   // m, about c
  Vec3 box_max = Vec3::Zero();   // m, about c
  double diagonal = 0.0;         // m: L
  double area = 0.0;             // m^2: A_s
  // m^2: A_r, the area that rounding takes its share of. A face's area is a difference of products of its
  // edges, of which each is rounded: of a needle or a sliver across the axes the products are larger than
  // what is left.
  double rounding_area = 0.0;
  double volume = 0.0;           // m^3: V_T; of an open mesh the sum about c, a scale and no more
  Vec3 centroid = Vec3::Zero();  // m, about c: centroid of the enclosed volume; box centre for open meshes

  bool is_open() const { return !boundary_vertices.empty(); }

  Vec3 vertex(std::int32_t i) const { return surface.vertex(i); }
  Point<double> point(std::int32_t i) const {
    const auto n = static_cast<std::size_t>(i);
    return {surface.x[n], surface.y[n], surface.z[n]};
  }

  // The accuracy that the exact solvers hold in volume and force/(rho g), m^3: G_V = eps (64 V_T + L A_s).
  double volume_tolerance() const;
  // Where G_V is promised: bodies neither slender nor made of thin faces, A_s >= L^2/8 and A_r <= 4/3 A_s. A
  // body thinner than some 1 : 50 across the axes is known less well by as much.
  bool meets_volume_tolerance() const;
  // What is published as a bound on rounding, m^3: 2 eps (64 V_T + L A_r), less than 4 G_V where that is
  // promised; elsewhere the exact methods add to it for what is cut (Displacement::rounding).
  double rounding_bound() const;
  // The most that `hierarchical` publishes where it leaves nothing out, m^3: with all leaves cut. Needs the
  // tree.
  double max_rounding_bound() const;
  // Largest distance from a reference point to a corner of the bounding box, m: L_r. Torque is held to G_V
  // L_r.
  double max_lever_arm(const Vec3& reference_B) const;
};

enum class WithTree { kNo, kYes };

HydrostaticMesh make_hydrostatic_mesh(const ValidatedMesh& validated, WithTree with_tree = WithTree::kYes);

}  // namespace buoyancy
