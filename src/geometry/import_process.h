// Internal to mesh import: runs the importer in a child process and returns its result, or the reason for its
// failure: a crash, a timeout or the memory limit.
//
// The child is the program buoyancy-import-mesh (src/importer). It gets no descriptors, environment, signal
// handlers or rights of this process. It ends with its parent. Linux only.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "geometry/import_channel.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

// Returns after at most about limits.import_seconds, when the child has ended. The caller sets
// Error::subject. The memory limit does not apply in builds with AddressSanitizer or ThreadSanitizer, whose
// shadow memory counts as address space.
Expected<StoredMesh> import_in_child_process(const std::filesystem::path& path, MeshFormat format,
                                             const ImportLimits& limits);

}  // namespace buoyancy
