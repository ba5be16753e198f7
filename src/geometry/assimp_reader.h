// Internal to mesh import: reads a file with assimp in the calling process.
//
// assimp 5 crashes, hangs and allocates without bound on damaged files, so this function runs only in a child
// process (import_process.h). assimp_reader.cpp is the only file that includes assimp.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

// Positions have assimp's single precision; node transforms are applied in double. Only the importers of
// `format` are reachable. Only regular files of at most limits.mesh_bytes are opened: the file itself and
// those that it refers to. Throws std::bad_alloc when out of memory. The caller sets Error::subject.
Expected<ImportedMesh> read_with_assimp(const std::filesystem::path& path, MeshFormat format,
                                        const ImportLimits& limits);

}  // namespace buoyancy
