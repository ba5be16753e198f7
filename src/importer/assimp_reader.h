// Reads a mesh file with assimp in the calling process.
//
// assimp 5 crashes, hangs and allocates without bound on damaged files, so this function runs only in the
// importer's sandbox (cage.h). assimp_reader.cpp is the only file that includes assimp.
#pragma once

#include "base/error.h"
#include "geometry/import_channel.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

// Positions have assimp's single precision; node transforms are applied in double, polygons stay whole, and
// axes are the file's. Only assimp's importers of the format can run, and they read only what `open` opens:
// the file itself and those that it refers to. Throws std::bad_alloc when out of memory. The caller sets
// Error::subject.
Expected<StoredMesh> read_with_assimp(const ImportRequest& request, const OpenFile& open);

}  // namespace buoyancy
