// Common interface to all buoyancy methods: computes the displacement of one mesh by one method for any water
// plane.
//
// The five methods of "Approximate and exact buoyancy calculation for real-time floating simulation of
// meshes", section 4, kept as published as baselines (paper_methods.h):
//   fast           4.1  precomputed volume elements about B's origin of fully submerged triangles
//   improved       4.2  volume elements of fully submerged triangles about an apex on the water
//   exact          4.3  the same, and the wet parts of the triangles that the water cuts
//   fast_surface   4.4  pressure on fully submerged triangles
//   exact_surface  4.4  pressure on the whole wetted surface
// and beyond the paper
//   hierarchical        a descent of the mesh's moment tree: exact, with a cost that follows the waterline
//                       (hierarchical.h)
// A triangle is fully submerged if its three vertices are below the water (z < 0).
//
// A Solver is immutable after construction: any number of threads may use it at once. Queries allocate
// nothing, but for a thread's first one with a tolerance on a tree larger than any before. Complexity per
// query: O(vertices + triangles) with the paper's methods, that of hierarchical.h with `hierarchical`.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>

#include "hydrostatics/displacement.h"
#include "hydrostatics/hydrostatic_mesh.h"
#include "hydrostatics/paper_methods.h"
#include "hydrostatics/water_plane.h"

namespace buoyancy {

enum class Method { kFast, kImproved, kExact, kFastSurface, kExactSurface, kHierarchical };

inline constexpr std::array kAllMethods{Method::kFast,        Method::kImproved,     Method::kExact,
                                        Method::kFastSurface, Method::kExactSurface, Method::kHierarchical};

std::string_view to_string(Method method);                      // "exact_surface"
std::optional<Method> method_from_name(std::string_view name);  // nullopt if there is no such method
bool is_of_paper(Method method);                                // true for the first five
bool is_exact(Method method);  // true if exact to rounding in volume, force and torque

class Solver {
 public:
  // mesh must outlive the solver. Precomputes only what the method needs: for the paper's methods the mesh's
  // meshlets, unless it has them already, in O(n log n) for n triangles. tolerance: 0 (exact) or more,
  // relative to the whole displacement; only `hierarchical` uses it.
  Solver(const HydrostaticMesh& mesh, Method method, double tolerance = 0.0);

  Displacement displacement(const WaterPlane& plane) const;

  // The water plane as the method needs it: exact or, where a tolerance allows it, in plain double, which
  // saves a tenth of a query.
  WaterPlane plane_in_body(const Pose& pose, const Water& water) const;
  // True if plane_in_body() equals water_plane_in_body() for every pose.
  bool has_exact_planes() const { return plane_error_ == 0.0; }

  const HydrostaticMesh& mesh() const { return *mesh_; }
  Method method() const { return method_; }
  double tolerance() const { return tolerance_; }

 private:
  const HydrostaticMesh* mesh_;
  Method method_;
  double tolerance_;
  double plane_error_ = 0.0;                  // [m], the largest allowed
  std::shared_ptr<const Meshlets> meshlets_;  // of the paper's methods
  std::optional<FastTable> fast_;
};

}  // namespace buoyancy
