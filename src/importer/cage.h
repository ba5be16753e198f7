// Sandboxes the importer: takes away the rights that it does not need before it reads a mesh file.
#pragma once

#include "geometry/mesh_import.h"

namespace buoyancy {

// Afterwards this process
// - may allocate limits.memory_bytes more, compute for about limits.import_seconds, and write no file and no
//   core dump; it is the first that the kernel ends when memory runs out, and it ends with its parent;
// - is the user and the group 65534 with no other groups, if it was root;
// - can open no file and no socket, start no program and signal no other process: by Landlock for files and
//   TCP ports, and by a filter of system calls, each where the kernel has it (docs/architecture.md).
// A measure that the kernel refuses is left out; the others then hold alone. The memory limit does not apply
// in builds with AddressSanitizer or ThreadSanitizer, whose shadow memory counts as address space.
void enter_cage(const ImportLimits& limits);

}  // namespace buoyancy
