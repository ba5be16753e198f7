#include "importer/reader_errors.h"

#include <algorithm>

namespace buoyancy {
namespace {

Error over_limit(std::uint64_t actual, const char* what, std::uint64_t limit, const char* key) {
  return {"", std::to_string(actual) + " " + what,
          "at most " + std::to_string(limit) + " (limit '" + key + "')",
          "the mesh is finer than this service is configured for, or one part is instanced very often",
          std::string("Simplify the mesh, or raise '") + key + "' under [limits]"};
}

}  // namespace

std::optional<Error> check_limits(std::uint64_t vertices, std::uint64_t triangles,
                                  const ImportLimits& limits) {
  constexpr std::uint64_t kMaxVertexCount = 2'147'483'647;  // vertex indices have 32 bits
  const std::uint64_t max_vertices = std::min(limits.vertices, kMaxVertexCount);
  if (vertices > max_vertices) return over_limit(vertices, "vertices", max_vertices, "vertices");
  if (triangles > limits.faces) return over_limit(triangles, "triangles", limits.faces, "faces");
  return std::nullopt;
}

Error unreadable(MeshFormat format, const std::string& message) {
  const std::string name(to_string(format));
  return {"", "not readable as " + name + (message.empty() ? "" : " (" + message + ")"),
          "a complete " + name + " file", "the file is cut short, damaged or of another format",
          "Open it in a mesh editor and export it again"};
}

Error no_triangles(std::int64_t points_and_lines) {
  return {"",
          points_and_lines == 0
              ? std::string("no triangles")
              : "no triangles, but " + std::to_string(points_and_lines) + " points and lines",
          "a mesh of triangles or polygons", "a point cloud, curves, or an export without its faces",
          "Export the surface as polygons"};
}

}  // namespace buoyancy
