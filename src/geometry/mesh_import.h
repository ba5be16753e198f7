// Reads a mesh file into triangles, whatever the file does to the importer.
//
// assimp runs in a child process with limits on memory and time: a file that crashes it, hangs it or eats
// memory becomes an Error that names the file. Nothing edits geometry: polygons are split into triangles,
// node transforms are applied in double, the winding of mirrored nodes is turned so that outside stays
// outside; points and lines are left out and counted. Vertices come out as stored, unwelded, in the single
// precision that assimp reads them with. The formats: OBJ, STL, PLY, OFF, DAE, glTF and GLB, FBX, 3DS, told
// by extension; a failure is explained by the content where the two disagree.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/error.h"
#include "geometry/triangle_mesh.h"

namespace buoyancy {

struct ImportLimits {
  std::uint64_t mesh_bytes = 2'000'000'000;     // size of the file
  std::uint64_t vertices = 200'000'000;         // as stored in the file, after instancing
  std::uint64_t faces = 100'000'000;            // triangles after splitting polygons
  double import_seconds = 120.0;                // wall clock of the child process, > 0
  std::uint64_t memory_bytes = 16'000'000'000;  // address space the child may add to what the process has
};

// What the file said of itself, for the report.
struct MeshSource {
  std::string format;         // "Collada", "PLY", ...
  std::string up_axis;        // "y", "z", "x" or "not stated"; the axis of the file's own up direction
  std::string note;           // what the importer did to axes and units, in words; may be empty
  std::int64_t nodes = 0;     // nodes that carry triangles, instances counted
  std::int64_t left_out = 0;  // primitives that are no triangles: points and lines
};

struct ImportedMesh {
  TriangleMesh mesh;
  MeshSource source;
};

// Forks, so it is best called before a program starts its threads. Time and memory: linear in the file's
// size, for a file that is not damaged.
//
// Errors: no such file, not a regular file, empty, too large, format unknown or not accepted, unreadable,
// crashed or timed out or out of memory, more vertices or faces than the limits, no triangles, non-finite
// vertices.
Expected<ImportedMesh> import_mesh(const std::filesystem::path& path, const ImportLimits& limits = {});

}  // namespace buoyancy
