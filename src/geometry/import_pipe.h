// Internal to mesh import: transfers the result of a child process through a pipe.
//
// The file being read may corrupt the writer, so the reader trusts nothing: it checks counts against the
// limits before it reserves memory, bounds texts and makes them printable, touches memory only for bytes that
// have arrived, and checks that vertex indices are in range. The caller checks the coordinates.
#pragma once

#include <chrono>
#include <variant>

#include "base/error.h"
#include "geometry/mesh_import.h"

namespace buoyancy {

using ImportDeadline = std::chrono::steady_clock::time_point;

// Returns false if the read end is closed.
bool send_import(int pipe, const Expected<ImportedMesh>& result);

enum class ImportFailure {
  kTimedOut,  // the deadline passed
  kBroken,    // the pipe ended early, or the bytes are neither a valid mesh nor an error
};

// Waits for the complete result until the deadline. Throws std::bad_alloc when this process is out of memory.
std::variant<ImportFailure, Expected<ImportedMesh>> receive_import(int pipe, const ImportLimits& limits,
                                                                   ImportDeadline deadline);

}  // namespace buoyancy
