// A mesh prepared for queries: coordinates about its own centre c, and the constants that do not depend on a
// pose. It is built once per mesh and scale, shared by every body that uses it, and immutable afterwards.
//
// c is the centre of the bounding box, rounded so that x_B - c is exact for float32 input: a mesh that lies
// 1e6 m from its own origin loses no digits (docs/mathematics.md, "Re-centring").
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/mesh_validation.h"
#include "geometry/meshlets.h"
#include "geometry/moment_tree.h"
#include "hydrostatics/point.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

struct HydrostaticMesh {
  // Vertices in [m], B axes, about center_B. A triangle's first corner lies opposite its longest edge, so
  // that products of the edges from it are as small as possible.
  TriangleMesh surface;
  double scale = 1.0;                           // by which the mesh file's coordinates were multiplied
  std::optional<MomentTree> tree;               // if requested; `hierarchical` needs it
  std::vector<std::int32_t> boundary_vertices;  // of an accepted open mesh: all must be dry

  Vec3 center_B = Vec3::Zero();  // [m], c
  Vec3 box_min = Vec3::Zero();   // [m], about c
  Vec3 box_max = Vec3::Zero();   // [m], about c
  double diagonal = 0.0;         // [m], L
  double area = 0.0;             // [m^2], A_s
  // [m^2], A_r, the area that rounding errors are proportional to. A face's area is a difference of products
  // of its edges, each of which is rounded: for a needle or a sliver across the axes the products are larger
  // than their difference. A_r sums max(area, half the product of the two shorter edges), which meet at the
  // first corner. Validation does not choose that corner, so its sheet_rounding_area() uses the longest edge.
  double rounding_area = 0.0;
  double volume = 0.0;           // [m^3], V_T; for an open mesh the sum about c, which is only a scale
  Vec3 centroid = Vec3::Zero();  // [m], about c: centroid of the enclosed volume; box centre for open meshes

  bool is_open() const { return !boundary_vertices.empty(); }

  Vec3 vertex(std::int32_t i) const { return surface.vertex(i); }
  Point<double> point(std::int32_t i) const {
    const auto n = static_cast<std::size_t>(i);
    return {surface.x[n], surface.y[n], surface.z[n]};
  }

  // [m^3], the accuracy of the exact solvers in volume and force/(rho g): G_V = eps (64 V_T + L A_s).
  double volume_tolerance() const;
  // True if G_V is guaranteed: for bodies neither slender nor made of thin faces, A_s >= L^2/8 and A_r <= 4/3
  // A_s. Across the axes, a body more slender than about 1 : 50 exceeds G_V in proportion.
  bool meets_volume_tolerance() const;
  // [m^3], the published bound on rounding: 2 eps (64 V_T + L A_r), less than 4 G_V where G_V is guaranteed;
  // elsewhere the exact methods add to it for what is cut (Displacement::rounding).
  double rounding_bound() const;
  // [m^3], the largest bound that `hierarchical` publishes when it prunes nothing: with all leaves cut.
  // Requires the tree.
  double max_rounding_bound() const;
  // [m], L_r: the largest distance from a reference point to a corner of the bounding box. The tolerance of
  // torque/(rho g) is G_V L_r.
  double max_lever_arm(const Vec3& reference_B) const;

  // The surface in meshlets, which the paper's methods need. Where it is null, a solver builds its own.
  std::shared_ptr<const Meshlets> meshlets;
};

enum class WithTree { kNo, kYes };

// scale: by which the mesh file's coordinates were multiplied to give those of `validated`.
HydrostaticMesh make_hydrostatic_mesh(const ValidatedMesh& validated, WithTree with_tree = WithTree::kYes,
                                      double scale = 1.0);

// Builds the tree over the mesh file's coordinates where these are float32 numbers, otherwise over `surface`.
MomentTree build_moment_tree(const HydrostaticMesh& mesh);

}  // namespace buoyancy
