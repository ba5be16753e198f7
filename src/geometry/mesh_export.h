// Writes meshes as the bytes of a file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

enum class ExportFormat {
  kStl,  // binary: coordinates in single precision, normals computed from them
  kPly,  // binary, little endian: coordinates in double precision
  kObj,  // text: coordinates with the digits that give the same doubles
};

// Returns the format of the path's extension, ignoring case; nullopt for others than .stl, .ply and .obj.
std::optional<ExportFormat> export_format(const std::filesystem::path& path);

// Returns a file's bytes, with faces and corners in the mesh's order. Requires fewer than 2^32 faces. O(n).
std::string export_mesh(const TriangleMesh& mesh, ExportFormat format);

// Returns the mesh as the importer will read it back: with coordinates rounded to single precision.
TriangleMesh as_imported(TriangleMesh mesh);

}  // namespace buoyancy
