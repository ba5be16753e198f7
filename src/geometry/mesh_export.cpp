#include "geometry/mesh_export.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include <Eigen/Geometry>

#include "base/format.h"
#include "geometry/mesh_format.h"

namespace buoyancy {
namespace {

static_assert(std::endian::native == std::endian::little, "the files are little-endian");

template <typename Number>
void append(const Number& number, std::string& bytes) {
  std::array<char, sizeof(Number)> raw;
  std::memcpy(raw.data(), &number, sizeof(Number));
  bytes.append(raw.data(), raw.size());
}

void append(const Eigen::Vector3f& vector, std::string& bytes) {
  for (const float component : vector) append(component, bytes);
}

std::string to_stl(const TriangleMesh& mesh) {
  constexpr std::size_t kHeader = 80;
  std::string bytes = "binary STL written by buoyancy-mesh";  // may not begin with "solid"
  bytes.resize(kHeader, ' ');
  append(static_cast<std::uint32_t>(mesh.triangles.size()), bytes);
  for (const Triangle& face : mesh.triangles) {
    const Vec3 a = mesh.vertex(face[0]);
    const Vec3 normal = (mesh.vertex(face[1]) - a).cross(mesh.vertex(face[2]) - a);
    append(normal.stableNormalized().cast<float>().eval(), bytes);
    for (const std::int32_t v : face) append(mesh.vertex(v).cast<float>().eval(), bytes);
    append(std::uint16_t{0}, bytes);
  }
  return bytes;
}

std::string to_ply(const TriangleMesh& mesh) {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\ncomment written by buoyancy-mesh\n"
      "element vertex " +
      std::to_string(mesh.vertex_count()) +
      "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
      std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    for (const double coordinate : {mesh.x[v], mesh.y[v], mesh.z[v]}) append(coordinate, bytes);
  }
  for (const Triangle& face : mesh.triangles) {
    append(std::uint8_t{3}, bytes);
    for (const std::int32_t v : face) append(v, bytes);
  }
  return bytes;
}

std::string to_obj(const TriangleMesh& mesh) {
  std::string text = "# written by buoyancy-mesh\n";
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    text += "v " + format_shortest(mesh.x[v]) + ' ' + format_shortest(mesh.y[v]) + ' ' +
            format_shortest(mesh.z[v]) + '\n';
  }
  for (const Triangle& face : mesh.triangles) {
    text += 'f';
    for (const std::int32_t v : face) text += ' ' + std::to_string(v + 1);
    text += '\n';
  }
  return text;
}

}  // namespace

std::optional<ExportFormat> export_format(const std::filesystem::path& path) {
  switch (format_from_path(path).value_or(MeshFormat::kFbx)) {
    case MeshFormat::kStl:
      return ExportFormat::kStl;
    case MeshFormat::kPly:
      return ExportFormat::kPly;
    case MeshFormat::kObj:
      return ExportFormat::kObj;
    default:
      return std::nullopt;
  }
}

std::string export_mesh(const TriangleMesh& mesh, ExportFormat format) {
  switch (format) {
    case ExportFormat::kStl:
      return to_stl(mesh);
    case ExportFormat::kPly:
      return to_ply(mesh);
    case ExportFormat::kObj:
      return to_obj(mesh);
  }
  return {};
}

TriangleMesh as_imported(TriangleMesh mesh) {
  for (std::vector<double>* coordinates : {&mesh.x, &mesh.y, &mesh.z}) {
    for (double& coordinate : *coordinates) coordinate = static_cast<double>(static_cast<float>(coordinate));
  }
  return mesh;
}

}  // namespace buoyancy
