// Reads binary STL files, which many large meshes are, in a third of the time that assimp needs.
#pragma once

#include <optional>

#include "base/error.h"
#include "geometry/import_channel.h"

namespace buoyancy {

// Reads request.name with the result of read_with_assimp(). Returns nullopt, for assimp to read it, if the
// file is not exactly as long as the number of triangles in it says, or has none, or a coordinate is not
// finite. The caller sets
// Error::subject.
std::optional<Expected<StoredMesh>> read_binary_stl(const ImportRequest& request, const OpenFile& open);

}  // namespace buoyancy
