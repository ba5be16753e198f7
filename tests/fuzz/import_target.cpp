// Fuzz target: what the importer sends for a mesh file (import_channel.h), as a corrupted importer might.
// What arrives must be no mesh, an error, or a mesh whose indices are in range; its polygons must become
// triangles that use these vertices and the means of polygons, with the area vector of the polygons.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>

#include <Eigen/Geometry>
#include <sys/socket.h>
#include <unistd.h>

#include "geometry/import_channel.h"
#include "geometry/triangulation.h"
#include "tests/fuzz/fuzz_check.h"

namespace buoyancy {
namespace {

std::variant<ImportFailure, Expected<StoredMesh>> received(const std::uint8_t* data, std::size_t size) {
  std::array<int, 2> ends{};
  require(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) == 0, "there are sockets");
  const UniqueFd reader(ends[0]);
  UniqueFd writer(ends[1]);
  require(::send(writer.value(), data, size, MSG_DONTWAIT) == static_cast<ssize_t>(size),
          "an input fits into a socket's buffer");
  writer.close();
  ImportLimits limits;
  limits.vertices = 1000;
  limits.faces = 1000;
  const auto deadline = ImportDeadline::clock::now() + std::chrono::seconds(60);
  return receive_import(reader.value(), limits, deadline, [](const std::string&) { return UniqueFd(); });
}

void check_printable(const std::string& text) {
  for (const char c : text) require(c >= ' ' && c <= '~', "texts are printable");
}

bool is_in_range(const StoredMesh& stored, std::int32_t index) {
  return index >= 0 && static_cast<std::size_t>(index) < stored.mesh.vertex_count();
}

// The largest coordinate; infinite if one is not finite.
double extent(const TriangleMesh& mesh) {
  double largest = 0.0;
  for (const auto* coordinates : {&mesh.x, &mesh.y, &mesh.z}) {
    for (const double value : *coordinates) {
      if (!std::isfinite(value)) return INFINITY;
      largest = std::max(largest, std::abs(value));
    }
  }
  return largest;
}

void check_polygons(StoredMesh stored) {
  Vec3 expected = Vec3::Zero();
  std::size_t corners = 0;
  for (std::size_t p = 0; p < stored.polygons.size(); ++p) {
    const auto polygon = stored.polygons[p];
    require(polygon.size() >= 3, "a polygon has three corners");
    corners += polygon.size();
    for (const std::int32_t index : polygon) require(is_in_range(stored, index), "corners are in range");
  }
  require(corners == stored.polygons.corners.size(), "the corners are those of polygons");
  const double size = extent(stored.mesh);
  if (!std::isfinite(size)) return;  // import_mesh() refuses it
  for (std::size_t p = 0; p < stored.polygons.size(); ++p) {
    const auto polygon = stored.polygons[p];
    const Vec3 first = stored.mesh.vertex(polygon[0]);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      expected +=
          0.5 * (stored.mesh.vertex(polygon[i]) - first).cross(stored.mesh.vertex(polygon[i + 1]) - first);
    }
  }
  const std::size_t vertices = stored.mesh.vertex_count();
  const PolygonSplit split = triangulate(stored.polygons, stored.mesh);
  require(split.centers <= split.non_planar && split.non_planar <= split.polygons, "the counts are of parts");
  require(stored.mesh.vertex_count() == vertices + static_cast<std::size_t>(split.centers),
          "only the means of polygons are added");
  require(!stored.mesh.triangles.empty() && stored.mesh.triangles.size() <= corners,
          "a polygon has few triangles");
  Vec3 actual = Vec3::Zero();
  for (const Triangle& face : stored.mesh.triangles) {
    for (const std::int32_t index : face) require(is_in_range(stored, index), "triangles are in range");
    const Vec3 first = stored.mesh.vertex(face[0]);
    actual += 0.5 * (stored.mesh.vertex(face[1]) - first).cross(stored.mesh.vertex(face[2]) - first);
  }
  if (size > 1e100) return;
  require((actual - expected).lpNorm<Eigen::Infinity>() <= 1e-10 * static_cast<double>(corners) * size * size,
          "the area vector is that of the polygons");
}

void check(const std::uint8_t* data, std::size_t size) {
  const auto outcome = received(data, size);
  const auto* result = std::get_if<Expected<StoredMesh>>(&outcome);
  if (result == nullptr) return;
  if (!*result) {
    const Error& error = result->error();
    for (const std::string& text : {error.actual, error.expected, error.cause, error.hint})
      check_printable(text);
    return;
  }
  const StoredMesh& stored = **result;
  for (const std::string& text : {stored.source.format, stored.source.up_axis, stored.source.note}) {
    check_printable(text);
  }
  require(stored.mesh.triangles.empty() != (stored.polygons.size() == 0), "faces are triangles or polygons");
  for (const Triangle& face : stored.mesh.triangles) {
    for (const std::int32_t index : face) require(is_in_range(stored, index), "indices are in range");
  }
  if (stored.polygons.size() > 0) check_polygons(stored);
}

}  // namespace
}  // namespace buoyancy

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  buoyancy::check(data, size);
  return 0;
}
