// Internal to mesh import: a file read by assimp in this very process, whatever assimp does to it.
//
// assimp 5 crashes, hangs and allocates without bound on damaged files, so this runs in a child process of
// its own (import_process.h) and nowhere else. assimp_reader.cpp is the only file that includes assimp.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

// Positions are single precision, as assimp holds them; node transforms are applied in double. Only the
// importers of `format` can be reached, and only regular files of at most limits.mesh_bytes are opened, the
// file itself or others that it names. Throws std::bad_alloc where memory ends; Error::subject is left to the
// caller.
Expected<ImportedMesh> read_with_assimp(const std::filesystem::path& path, MeshFormat format,
                                        const ImportLimits& limits);

}  // namespace buoyancy
