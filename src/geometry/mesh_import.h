// Reads a mesh file into triangles, safely for files that crash the importer.
//
// A sandboxed program reads files, with limits on memory and time (src/importer): a file on which it crashes,
// hangs or exhausts memory gives an Error that names the file, and a file may refer only to files in its own
// folder and below. The geometry is not edited: polygons are read whole and split into triangles that keep
// every corner (triangulation.h), node transforms are applied in double, and the winding of mirrored nodes is
// reversed so that normals keep pointing outward; points and lines are left out and counted. Vertices are
// returned as stored: unwelded, in assimp's single precision, or in double from panel files. Formats, by
// extension: OBJ, STL, PLY, OFF, DAE, glTF and GLB, FBX, 3DS; panels: GDF (WAMIT), DAT (Nemoh). If a file's
// content does not match its extension, the error names both.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "geometry/triangle_mesh.h"
#include "geometry/triangulation.h"

namespace buoyancy {

struct ImportLimits {
  std::uint64_t mesh_bytes = 2'000'000'000;     // file size [bytes]
  std::uint64_t vertices = 200'000'000;         // as stored in the file, after instancing
  std::uint64_t faces = 100'000'000;            // triangles after splitting polygons
  double import_seconds = 120.0;                // wall-clock time of the child process [s], > 0
  std::uint64_t memory_bytes = 16'000'000'000;  // address space that the child may allocate [bytes]
};

// Metadata of the file, for the report.
struct MeshSource {
  std::string format;                   // "Collada", "PLY", ...
  std::string up_axis;                  // up direction in the file: "z", "-y" (FBX) or "not stated"
  std::string note;                     // how the importer changed axes and units; may be empty
  std::int64_t nodes = 0;               // nodes with triangles, including instances
  std::int64_t ignored_primitives = 0;  // points and lines
  PolygonSplit polygons{};              // how polygons were split; in the file's unit until prepare_mesh()
};

struct ImportedMesh {
  TriangleMesh mesh;
  MeshSource source;
};

// The function starts a child process and waits for its end. Complexity: time and memory are linear in the
// file's size, for an undamaged file.
//
// Errors: no such file; not a regular file; empty or too large; format unknown or not accepted; unreadable;
// importer missing, crashed, timed out or out of memory; more vertices or faces than the limits; no
// triangles; non-finite vertices.
Expected<ImportedMesh> import_mesh(const std::filesystem::path& path, const ImportLimits& limits = {});

}  // namespace buoyancy
