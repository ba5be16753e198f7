// import_mesh() of an FMU, in the place of the one that starts the importer in a process of its own
// (geometry/mesh_import.h): the meshes of an FMU were imported when it was packed. They are PLY files with
// the importer's vertices, in double, and triangles, as export_mesh() writes them; no other PLY is read.
#include <algorithm>
#include <charconv>
#include <cstring>
#include <string_view>

#include "base/text_file.h"
#include "geometry/mesh_export.h"
#include "geometry/mesh_import.h"

namespace buoyancy {
namespace {

constexpr std::size_t kVertexBytes = 3 * sizeof(double);
constexpr std::size_t kTriangleBytes = 1 + sizeof(Triangle);

// Returns the number after the first line that begins with these words; 0 if there is none.
std::size_t count_after(std::string_view header, std::string_view words) {
  const std::size_t at = header.find(words);
  std::size_t count = 0;
  if (at != std::string_view::npos) {
    const char* const digits = header.data() + at + words.size();
    std::from_chars(digits, header.data() + header.size(), count);
  }
  return count;
}

// Returns false if the bytes are not those of a stored mesh.
bool read_stored(std::string_view bytes, TriangleMesh& mesh) {
  constexpr std::string_view kEnd = "\nend_header\n";
  const std::size_t end = bytes.find(kEnd);
  if (!bytes.starts_with("ply\nformat binary_little_endian") || end == std::string_view::npos) return false;
  const std::string_view header = bytes.substr(0, end);
  std::string_view data = bytes.substr(end + kEnd.size());
  const std::size_t vertices = count_after(header, "\nelement vertex ");
  const std::size_t triangles = count_after(header, "\nelement face ");
  if (vertices > data.size() || triangles > data.size() ||
      data.size() != vertices * kVertexBytes + triangles * kTriangleBytes) {
    return false;
  }
  for (std::size_t v = 0; v < vertices; ++v, data.remove_prefix(kVertexBytes)) {
    Vec3 vertex_B;
    std::memcpy(vertex_B.data(), data.data(), kVertexBytes);
    if (!vertex_B.allFinite()) return false;
    mesh.add_vertex(vertex_B);
  }
  for (std::size_t t = 0; t < triangles; ++t, data.remove_prefix(kTriangleBytes)) {
    Triangle& triangle = mesh.triangles.emplace_back();
    std::memcpy(triangle.data(), data.data() + 1, sizeof triangle);
    const auto is_vertex = [vertices](std::int32_t v) {
      return v >= 0 && static_cast<std::size_t>(v) < vertices;
    };
    if (!std::ranges::all_of(triangle, is_vertex)) return false;
  }
  return true;
}

}  // namespace

Expected<ImportedMesh> import_mesh(const std::filesystem::path& path, const ImportLimits& limits) {
  const Expected<std::string> bytes = read_text_file(path, "a mesh of the FMU", limits.mesh_bytes);
  if (!bytes) return make_error(bytes.error());
  ImportedMesh imported;
  imported.source.format = "stored";
  if (!read_stored(*bytes, imported.mesh)) {
    return make_error({path.string(), "other bytes", "a mesh as buoyancy-fmu stores it",
                       "the file was replaced or damaged", "Pack the scene again"});
  }
  return imported;
}

}  // namespace buoyancy
