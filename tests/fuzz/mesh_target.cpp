// Fuzz target: bytes to vertices, faces and a policy (fuzz_mesh.h), then the whole preparation of a mesh:
// welding, topology, orientation, rejections, the moment tree. A rejection must state its reason; an accepted
// mesh must satisfy the contract of ValidatedMesh and pass a second validation unchanged.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "geometry/mass_properties.h"
#include "geometry/mesh_topology.h"
#include "geometry/mesh_validation.h"
#include "geometry/sheet_rounding_area.h"
#include "hydrostatics/buoyancy.h"
#include "hydrostatics/hydrostatics.h"
#include "tests/fuzz/fuzz_bytes.h"
#include "tests/fuzz/fuzz_check.h"
#include "tests/fuzz/fuzz_mesh.h"

namespace buoyancy {
namespace {

void check_welded(const TriangleMesh& mesh) {
  std::set<std::array<double, 3>> positions;
  std::vector<bool> used(mesh.vertex_count(), false);
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 vertex = mesh.vertex(static_cast<std::int32_t>(v));
    require(vertex.allFinite(), "the vertices of an accepted mesh are finite");
    require(positions.insert({vertex.x(), vertex.y(), vertex.z()}).second,
            "no two vertices have the same position");
  }
  for (const Triangle& face : mesh.triangles) {
    require(face[0] != face[1] && face[1] != face[2] && face[2] != face[0], "no face repeats a vertex");
    for (const std::int32_t v : face) {
      require(v >= 0 && static_cast<std::size_t>(v) < mesh.vertex_count(), "indices are in range");
      used[static_cast<std::size_t>(v)] = true;
    }
  }
  require(std::find(used.begin(), used.end(), false) == used.end(), "every vertex is used");
}

void check_edges(const ValidatedMesh& accepted, OpenPolicy open) {
  const MeshTopology topology = mesh_topology(accepted.mesh);
  require(topology.misoriented.empty() && topology.non_manifold.empty(),
          "edges are closed, balanced or open");
  require(topology.boundary.empty() || open == OpenPolicy::kDryBoundary,
          "open meshes are accepted only on request");
  std::set<std::int32_t> boundary;
  for (const Edge& edge : topology.boundary) boundary.insert(edge.begin(), edge.end());
  require(std::equal(boundary.begin(), boundary.end(), accepted.boundary_vertices.begin(),
                     accepted.boundary_vertices.end()),
          "boundary_vertices are those of the boundary, ascending");
}

void check_volume(const TriangleMesh& mesh, const MeshReport& report) {
  require(std::isfinite(report.diagonal) && std::isfinite(report.area), "extent and area are finite");
  require(report.diagonal > 0.0 && report.area > 0.0, "an accepted mesh has an extent");
  if (!report.closed()) return;
  require(report.volume > 0.0, "a closed mesh encloses a positive volume");
  const double rounding = std::numeric_limits<double>::epsilon() *
                          (64.0 * std::abs(report.volume) + report.diagonal * sheet_rounding_area(mesh));
  const double spread = report.volume_by_axis.maxCoeff() - report.volume_by_axis.minCoeff();
  require(spread <= rounding, "the volume is the same from x, y and z");
}

// make_hydrostatic_mesh() and every method must give a status or finite numbers.
void check_results(const ValidatedMesh& accepted) {
  const HydrostaticMesh mesh = make_hydrostatic_mesh(accepted);
  const Vec3 middle = mesh.center_B;
  for (const Method method : kAllMethods) {
    const Solver solver(mesh, method);
    for (const double turn : {0.0, 0.3}) {
      const Pose pose{.p_WB = -middle, .q_WB = Eigen::Quaterniond(1.0, turn, 0.5 * turn, 0.0)};
      const BuoyancyResult result = buoyancy(solver, pose, {}, middle);
      require(result.force_W.allFinite() && result.torque_W.allFinite() && std::isfinite(result.volume) &&
                  result.center_of_buoyancy_W.allFinite(),
              "a result holds finite numbers");
      if (result.status == BuoyancyStatus::kOk) hydrostatics(mesh, pose, {}, middle, middle);
    }
  }
}

void check_again(const MeshValidation& first, const ValidationOptions& options) {
  ImportedMesh imported;
  imported.mesh = first.mesh->mesh;
  const MeshValidation second = validate_mesh(imported, "again", options);
  require(second.mesh.has_value(), "an accepted mesh is accepted again");
  require(second.report.weld == WeldKind::kExact && second.report.dropped_faces == 0,
          "a second weld changes nothing");
  require(second.mesh->mesh.x == imported.mesh.x && second.mesh->mesh.y == imported.mesh.y &&
              second.mesh->mesh.z == imported.mesh.z,
          "a second validation moves no vertex");
  require(second.mesh->mesh.triangles == imported.mesh.triangles, "a second validation reorients nothing");
}

// A mesh turned inside out as a whole must be turned back; a component of zero volume has no outside. Repair
// may divide faces otherwise, and keep the other of two opposite faces.
void check_inside_out(const FuzzMesh& input, const MeshValidation& first) {
  if (!first.report.repair.steps.empty()) return;
  const auto has_no_outside = [](const ComponentReport& component) { return component.volume == 0.0; };
  const auto& components = first.report.components;
  if (std::any_of(components.begin(), components.end(), has_no_outside)) return;
  ImportedMesh turned = input.imported;
  for (Triangle& face : turned.mesh.triangles) std::swap(face[1], face[2]);
  const MeshValidation second = validate_mesh(turned, "turned", input.options);
  // The holes of an open mesh are closed in another order, which may reduce its volume below its rounding
  // error.
  if (!second.mesh && !first.report.closed()) return;
  require(second.mesh.has_value(), "a mesh inside out is accepted like the mesh itself");
  require(second.mesh->mesh.triangles == first.mesh->mesh.triangles, "a mesh inside out is turned back");
}

void check(const FuzzMesh& input) {
  const MeshValidation validation = validate_mesh(input.imported, "fuzz", input.options);
  require(!to_text(validation.report).empty(), "the report is not empty");
  require(validation.mesh.has_value() != validation.refusal.has_value(), "a mesh is accepted or rejected");
  if (validation.refusal) {
    const Error& refusal = *validation.refusal;
    require(!refusal.actual.empty() && !refusal.expected.empty() && !refusal.cause.empty() &&
                !refusal.hint.empty(),
            "a rejection states actual, expected, cause and hint");
    return;
  }
  const ValidatedMesh& accepted = *validation.mesh;
  check_welded(accepted.mesh);
  check_edges(accepted, input.options.open);
  check_volume(accepted.mesh, validation.report);
  check_again(validation, input.options);
  check_inside_out(input, validation);
  mass_properties(accepted.mesh);
  check_results(accepted);
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(buoyancy::read_mesh(buoyancy::FuzzBytes({data, size})));
  return 0;
}
