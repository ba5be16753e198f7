// Internal to mesh import: runs the importer in a child process and brings back what it made, or why it could
// not: it crashed, went on past its time or asked for more memory than it may have.
//
// The child is forked, not executed: it needs no program file, and closes every descriptor it does not need.
// It ends with its parent. Linux.
#pragma once

#include <filesystem>

#include "base/error.h"
#include "geometry/mesh_format.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

// Returns after at most limits.import_seconds and a moment; the child is gone by then. Error::subject is left
// to the caller. The memory limit does not hold in builds with AddressSanitizer or ThreadSanitizer, whose
// shadow memory is address space too.
Expected<ImportedMesh> import_in_child_process(const std::filesystem::path& path, MeshFormat format,
                                               const ImportLimits& limits);

}  // namespace buoyancy
