// Internal to mesh import: the result of a child process, through a pipe.
//
// The writer may be broken by the file it reads, so the reader believes nothing: counts against limits before
// memory is set aside for them, texts bounded and made printable, memory touched only for bytes that came,
// vertex indices within the vertices. Coordinates may be anything: the caller checks them.
#pragma once

#include <chrono>
#include <variant>

#include "base/error.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

using ImportDeadline = std::chrono::steady_clock::time_point;

// False if the other end has gone.
bool send_import(int pipe, const Expected<ImportedMesh>& result);

enum class ImportFailure {
  kTimedOut,  // the deadline passed first
  kBroken,    // the pipe ended early, or what came is no mesh and no error
};

// Waits for the whole result until the deadline. Throws std::bad_alloc where this process's memory ends.
std::variant<ImportFailure, Expected<ImportedMesh>> receive_import(int pipe, const ImportLimits& limits,
                                                                   ImportDeadline deadline);

}  // namespace buoyancy
