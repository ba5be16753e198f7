// Meshes of the C interface.
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/format.h"
#include "c/pose_arguments.h"

namespace buoyancy {
namespace {

constexpr std::int64_t kMaxMeshCount = std::numeric_limits<std::int32_t>::max();
constexpr buoyancy_mesh_options kDefaultMeshOptions{sizeof(buoyancy_mesh_options), 1.0, BUOYANCY_OPEN_REFUSE,
                                                    0};

QueryMeshOptions check_options(ArgumentChecks& checks, const buoyancy_mesh_options* given) {
  QueryMeshOptions options;
  if (given == nullptr || checks.given("options", given) == nullptr) return options;
  options.placement.scale.setConstant(given->scale);
  checks.number("options->scale", given->scale, std::isfinite(given->scale) && given->scale > 0.0,
                "a finite number above 0");
  if (given->open != BUOYANCY_OPEN_REFUSE && given->open != BUOYANCY_OPEN_DRY_BOUNDARY) {
    checks.fail("options->open", std::to_string(given->open),
                "BUOYANCY_OPEN_REFUSE (0) or BUOYANCY_OPEN_DRY_BOUNDARY (1)");
  }
  options.open = given->open == BUOYANCY_OPEN_DRY_BOUNDARY ? OpenPolicy::kDryBoundary : OpenPolicy::kRefuse;
  if (given->count_intersecting_pairs != 0 && given->count_intersecting_pairs != 1) {
    checks.fail("options->count_intersecting_pairs", std::to_string(given->count_intersecting_pairs),
                "0 or 1");
  }
  options.count_intersecting_pairs = given->count_intersecting_pairs == 1;
  return options;
}

CallResult store_mesh(Expected<std::shared_ptr<const QueryMesh>> mesh, buoyancy_error code,
                      buoyancy_mesh** out) {
  if (!mesh) return failure(code, std::move(mesh.error()));
  hand_over(std::make_unique<buoyancy_mesh>(*std::move(mesh)), out);
  return {};
}

template <typename Index>
buoyancy_error create_mesh(const char* function, const double* vertices, std::int64_t vertex_count,
                           const Index* faces, std::int64_t face_count, const buoyancy_mesh_options* options,
                           buoyancy_mesh** mesh) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks(function);
    checks.out_handle("mesh", mesh);
    checks.count("vertex_count", vertex_count, kMaxMeshCount);
    checks.count("face_count", face_count, kMaxMeshCount);
    const std::span coordinates = checks.array("vertices", vertices, vertex_count, 3);
    const std::span indices = checks.array("faces", faces, face_count, 3);
    const QueryMeshOptions given = check_options(checks, options);
    if (checks.failed()) return checks.failure();
    if constexpr (std::same_as<Index, std::int64_t>) {
      return store_mesh(QueryMesh::make(coordinates, indices, "mesh", given), BUOYANCY_ERROR_MESH, mesh);
    } else {
      const std::vector<std::int64_t> wide(indices.begin(), indices.end());
      return store_mesh(QueryMesh::make(coordinates, wide, "mesh", given), BUOYANCY_ERROR_MESH, mesh);
    }
  });
}

void set_info(const QueryMesh& mesh, buoyancy_mesh_info& info) {
  const MeshReport& report = mesh.report();
  const MassProperties& mass = mesh.mass_properties();
  info.triangles = report.triangles;
  info.vertices_stored = report.vertices_stored;
  info.vertices_welded = report.vertices_welded;
  for (int axis = 0; axis < 3; ++axis) {
    info.box_min[axis] = report.box.min_B[axis];
    info.box_max[axis] = report.box.max_B[axis];
    info.centroid[axis] = mass.centroid_B[axis];
    for (int column = 0; column < 3; ++column) info.inertia[3 * axis + column] = mass.inertia_B(axis, column);
  }
  info.diagonal = report.diagonal;
  info.area = report.area;
  info.volume = report.volume;
  info.boundary_edges = report.boundary_edges;
  info.non_manifold_edges = report.non_manifold_edges;
  info.misoriented_edges = report.misoriented_edges;
  info.degenerate_faces = report.degenerate_faces;
  info.dropped_faces = report.dropped_faces;
  info.duplicate_faces = report.duplicate_faces;
  info.intersecting_pairs = report.intersecting_pairs.value_or(-1);
  info.components = static_cast<std::int64_t>(report.components.size());
  info.holes = static_cast<std::int64_t>(report.holes.size());
  info.closed = report.closed() ? 1 : 0;
  info.flipped = report.flipped ? 1 : 0;
}

}  // namespace
}  // namespace buoyancy

using buoyancy::ArgumentChecks;
using buoyancy::CallResult;
using buoyancy::run_call;

buoyancy_error buoyancy_default_mesh_options(buoyancy_mesh_options* options, size_t size) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_default_mesh_options");
    checks.not_null("options", options);
    checks.has_size("options", size, sizeof *options);
    if (!checks.failed()) *options = buoyancy::kDefaultMeshOptions;
    return checks.failure();
  });
}

buoyancy_error buoyancy_mesh_load(const char* path, const buoyancy_mesh_options* options,
                                  buoyancy_mesh** mesh) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_mesh_load");
    checks.out_handle("mesh", mesh);
    const std::string_view file = checks.text("path", path);
    const buoyancy::QueryMeshOptions given = buoyancy::check_options(checks, options);
    if (checks.failed()) return checks.failure();
    buoyancy::Expected<std::shared_ptr<const buoyancy::QueryMesh>> loaded =
        buoyancy::QueryMesh::load(file, given);
    const bool readable = loaded || buoyancy::is_readable_file(file);
    return buoyancy::store_mesh(std::move(loaded), readable ? BUOYANCY_ERROR_MESH : BUOYANCY_ERROR_FILE,
                                mesh);
  });
}

buoyancy_error buoyancy_mesh_create(const double* vertices, int64_t vertex_count, const int32_t* faces,
                                    int64_t face_count, const buoyancy_mesh_options* options,
                                    buoyancy_mesh** mesh) {
  return buoyancy::create_mesh("buoyancy_mesh_create", vertices, vertex_count, faces, face_count, options,
                               mesh);
}

buoyancy_error buoyancy_mesh_create_64(const double* vertices, int64_t vertex_count, const int64_t* faces,
                                       int64_t face_count, const buoyancy_mesh_options* options,
                                       buoyancy_mesh** mesh) {
  return buoyancy::create_mesh("buoyancy_mesh_create_64", vertices, vertex_count, faces, face_count, options,
                               mesh);
}

buoyancy_error buoyancy_mesh_free(buoyancy_mesh* mesh) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_mesh_free");
    checks.free("mesh", mesh);
    return checks.failure();
  });
}

buoyancy_error buoyancy_mesh_get_info(const buoyancy_mesh* mesh, buoyancy_mesh_info* info) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_mesh_get_info");
    const buoyancy_mesh* const of = checks.handle("mesh", mesh);
    buoyancy_mesh_info* const out = checks.output("info", info);
    if (!checks.failed()) buoyancy::set_info(*of->mesh, *out);
    return checks.failure();
  });
}

buoyancy_error buoyancy_mesh_report(const buoyancy_mesh* mesh, char* text, size_t capacity, size_t* length) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_mesh_report");
    const buoyancy_mesh* const of = checks.handle("mesh", mesh);
    if (capacity > 0) checks.not_null("text", text);
    if (checks.failed()) return checks.failure();
    const std::string report = to_text(of->mesh->report());
    if (capacity > 0) {
      const std::size_t copied = std::min(report.size(), capacity - 1);
      std::memcpy(text, report.data(), copied);
      text[copied] = '\0';
    }
    if (length != nullptr) *length = report.size();
    return {};
  });
}

buoyancy_error buoyancy_mesh_query(const buoyancy_mesh* mesh, const buoyancy_water* water,
                                   buoyancy_method method, double tolerance, const buoyancy_poses* poses,
                                   const buoyancy_wrenches* wrenches, int32_t threads) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_mesh_query");
    const buoyancy_mesh* const of = checks.handle("mesh", mesh);
    const buoyancy::QueryWater in = buoyancy::check_water(checks, water);
    const buoyancy::Method by = checks.method(method);
    checks.number("tolerance", tolerance, tolerance >= 0.0 && tolerance <= 1.0, "a number from 0 to 1");
    const buoyancy::PoseArrays at = buoyancy::check_poses(checks, poses);
    const unsigned on = checks.threads(threads);
    const buoyancy::WrenchOutput out(checks, wrenches, at.size());
    if (checks.failed()) return checks.failure();
    const auto body = of->mesh->body(by, tolerance, in.waves != nullptr);
    if (!body) return buoyancy::failure(BUOYANCY_ERROR_INVALID_ARGUMENT, body.error());
    evaluate_poses(**body, in, at, out.arrays(), {}, on);
    return {};
  });
}

buoyancy_error buoyancy_mesh_hydrostatics(const buoyancy_mesh* mesh, const buoyancy_water* water,
                                          const double* center_of_mass, const buoyancy_poses* poses,
                                          const buoyancy_hydrostatics* hydrostatics, int32_t threads) {
  return run_call([&]() -> CallResult {
    ArgumentChecks checks("buoyancy_mesh_hydrostatics");
    const buoyancy_mesh* const of = checks.handle("mesh", mesh);
    const buoyancy::QueryWater in = buoyancy::check_water(checks, water);
    const std::span center = checks.optional_array("center_of_mass", center_of_mass, 3);
    for (const double coordinate : center) {
      checks.number("center_of_mass", coordinate, std::isfinite(coordinate), "three finite numbers (m)");
    }
    const buoyancy::PoseArrays at = buoyancy::check_poses(checks, poses);
    const unsigned on = checks.threads(threads);
    if (checks.given("hydrostatics", hydrostatics) != nullptr) {
      buoyancy::check_hydrostatics(checks, *hydrostatics, at.size());
    }
    if (in.waves != nullptr) {
      checks.fail("water->sea", "waves", "a surface at rest", "", "Pass a sea without waves, or none");
    }
    if (checks.failed()) return checks.failure();
    const auto body = of->mesh->body(buoyancy::Method::kHierarchical, 0.0, false);
    if (!body) return buoyancy::failure(BUOYANCY_ERROR_INVALID_ARGUMENT, body.error());
    buoyancy::Body with_center = **body;
    if (!center.empty()) with_center.center_of_mass_B = buoyancy::Vec3(center[0], center[1], center[2]);
    buoyancy::evaluate_hydrostatics(with_center, in.at_rest, at, *hydrostatics, on);
    return {};
  });
}
