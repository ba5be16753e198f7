#include "scene/prepared_mesh.h"

#include <cassert>
#include <utility>
#include <vector>

#include "base/format.h"

namespace buoyancy {
namespace {

void apply_scale(TriangleMesh& mesh, double scale) {
  if (scale == 1.0) return;
  for (std::vector<double>* coordinates : {&mesh.x, &mesh.y, &mesh.z}) {
    for (double& coordinate : *coordinates) coordinate *= scale;
  }
}

// The others sum volumes under a plane water surface.
bool works_in_waves(Method method) {
  return method == Method::kHierarchical || method == Method::kFastSurface || method == Method::kExactSurface;
}

}  // namespace

Expected<PreparedMesh> prepare_mesh(ImportedMesh imported, const std::string& name, double scale,
                                    const ValidationOptions& options) {
  apply_scale(imported.mesh, scale);
  MeshValidation validation = validate_mesh(imported, name, options);
  if (!validation.mesh) {
    assert(validation.refusal);
    return make_error(*std::move(validation.refusal));
  }
  return PreparedMesh{std::move(validation.report),
                      make_hydrostatic_mesh(*validation.mesh, WithTree::kNo, scale),
                      mass_properties(validation.mesh->mesh), std::nullopt};
}

std::optional<Error> method_error_in_waves(const std::string& subject, Method method, double tolerance) {
  if (!works_in_waves(method)) {
    return Error{
        subject, "method = \"" + std::string(to_string(method)) + "\"",
        "hierarchical, fast_surface or exact_surface in waves",
        "the methods fast, improved and exact sum volumes under a plane water surface, which waves are "
        "not",
        "Use hierarchical; fast_surface and exact_surface are baselines without an error bound"};
  }
  if (method == Method::kHierarchical && tolerance == 0.0) {
    return Error{subject, "tolerance = 0", "a number above 0, at most 1, in waves",
                 "the load of waves has no exact sum, only one within a bound",
                 "Leave the tolerance out: it is then " + format_shortest(kDefaultWaveTolerance)};
  }
  return std::nullopt;
}

std::optional<Error> size_error_in_waves(const std::string& name, const HydrostaticMesh& mesh) {
  constexpr double kSmallest = 1e-5;  // [m]
  constexpr double kLargest = 1e6;    // [m]
  if (mesh.diagonal >= kSmallest && mesh.diagonal <= kLargest) return std::nullopt;
  return Error{name, "a size of " + format_shortest(mesh.diagonal) + " m",
               "1e-5 to 1e6 m in waves (the diagonal of the bounding box)", "the mesh is in another unit",
               "Set scale, for example 0.001 for millimetres"};
}

}  // namespace buoyancy
