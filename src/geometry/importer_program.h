// Internal to mesh import: finds the program that reads mesh files, buoyancy-import-mesh (src/importer).
#pragma once

#include <string>

#include "base/error.h"

namespace buoyancy {

// Returns the program's path: the value of $BUOYANCY_IMPORTER if it is set, unless this process has more
// rights than its user. Otherwise libexec/buoyancy below the prefix of the program or shared library that
// contains this code, then below the prefixes of this build and of Debian. A file that others may write, or
// that neither root nor this user nor the owner of this code owns, is passed over. The caller sets
// Error::subject.
Expected<std::string> importer_program();

}  // namespace buoyancy
