// One door to all methods: a mesh and a method in, the displacement of any water plane out.
//
// The five methods of "Approximate and exact buoyancy calculation for real-time floating simulation of
// meshes", section 4, kept as published as baselines, one file each:
//   fast           4.1  precomputed volume elements about B's origin of wholly wet triangles
//   improved       4.2  volume elements of wholly wet triangles about an apex on the water
//   exact          4.3  the same, and the wet parts of the triangles that the water cuts
//   fast_surface   4.4  pressure on wholly wet triangles
//   exact_surface  4.4  pressure on the whole wet surface
// and beyond the paper
//   hierarchical        a descent of the mesh's moment tree: exact, at the cost of the waterline
//   (hierarchical.h)
// A triangle is wholly wet if its three vertices are below the water (z < 0).
//
// A Solver is immutable after construction: any number of threads may ask it at once. A query allocates
// nothing, but for the first within a tolerance on a tree larger than the thread has seen. Complexity of
// each: O(vertices + triangles) per query.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "hydrostatics/displacement.h"
#include "hydrostatics/paper_methods.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

enum class Method { kFast, kImproved, kExact, kFastSurface, kExactSurface, kHierarchical };

inline constexpr std::array kAllMethods{Method::kFast,        Method::kImproved,     Method::kExact,
                                        Method::kFastSurface, Method::kExactSurface, Method::kHierarchical};

std::string_view to_string(Method method);                      // "exact_surface"
std::optional<Method> method_from_name(std::string_view name);  // nullopt: no such method
bool is_exact(Method method);  // exact to rounding in volume, force and torque

class Solver {
 public:
  // mesh must outlive the solver. Precomputes what the method needs and nothing else. tolerance: 0 (exact) or
  // more, relative to the whole displacement; only `hierarchical` makes use of it.
  Solver(const HydrostaticMesh& mesh, Method method, double tolerance = 0.0);

  Displacement displacement(const WaterPlane& plane) const;

  // The water as the method needs it: exact, or where a tolerance allows it in plain double, which spares a
  // tenth of a query.
  WaterPlane plane_in_body(const Pose& pose, const Water& water) const;

  const HydrostaticMesh& mesh() const { return *mesh_; }
  Method method() const { return method_; }
  double tolerance() const { return tolerance_; }

 private:
  const HydrostaticMesh* mesh_;
  Method method_;
  double tolerance_;
  double plane_error_ = 0.0;  // m: as much as is allowed
  std::optional<FastTable> fast_;
};

}  // namespace buoyancy
