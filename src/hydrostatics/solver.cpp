#include "hydrostatics/solver.h"

#include "hydrostatics/hierarchical.h"
#include "hydrostatics/paper_methods.h"

namespace buoyancy {

std::string_view to_string(Method method) {
  switch (method) {
    case Method::kFast:
      return "fast";
    case Method::kImproved:
      return "improved";
    case Method::kExact:
      return "exact";
    case Method::kFastSurface:
      return "fast_surface";
    case Method::kExactSurface:
      return "exact_surface";
    case Method::kHierarchical:
      return "hierarchical";
  }
  return "";
}

std::optional<Method> method_from_name(std::string_view text) {
  for (const Method method : kAllMethods) {
    if (to_string(method) == text) return method;
  }
  return std::nullopt;
}

bool is_of_paper(Method method) {
  return method != Method::kHierarchical;
}

bool is_exact(Method method) {
  return method == Method::kExact || method == Method::kExactSurface || method == Method::kHierarchical;
}

Solver::Solver(const HydrostaticMesh& mesh, Method method, double tolerance)
    : mesh_(&mesh), method_(method), tolerance_(tolerance) {
  if (is_of_paper(method)) {
    meshlets_ =
        mesh.meshlets ? mesh.meshlets : std::make_shared<const Meshlets>(build_meshlets(mesh.surface));
  }
  if (method == Method::kFast) fast_.emplace(mesh, *meshlets_);
  if (method == Method::kHierarchical) plane_error_ = allowed_plane_error(mesh, tolerance);
}

WaterPlane Solver::plane_in_body(const Pose& pose, const Water& water) const {
  if (!has_exact_planes()) {
    const RoughWaterPlane rough = rough_water_plane_in_body(pose, water, mesh_->center_B, mesh_->diagonal);
    if (rough.norm_squared > 1e-100 && rough.norm_squared < 1e100 &&
        rough.error <= plane_error_ * rough.norm_squared) {
      WaterPlane plane;
      plane.up_B = rough.up_B.vec3() / rough.norm_squared;
      plane.h_c = rough.h_c / rough.norm_squared;
      plane.error = rough.error / rough.norm_squared;
      return plane;
    }
  }
  return water_plane_in_body(pose, water, mesh_->center_B);
}

Displacement Solver::displacement(const WaterPlane& plane) const {
  switch (method_) {
    case Method::kFast:
      return fast_->displacement(*mesh_, *meshlets_, plane);
    case Method::kImproved:
      return improved(*mesh_, *meshlets_, plane);
    case Method::kExact:
      return exact(*mesh_, *meshlets_, plane);
    case Method::kFastSurface:
      return fast_surface(*meshlets_, plane);
    case Method::kExactSurface:
      return exact_surface(*mesh_, *meshlets_, plane);
    case Method::kHierarchical:
      return hierarchical(*mesh_, plane, tolerance_);
  }
  return {};
}

}  // namespace buoyancy
