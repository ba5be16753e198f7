// Files that are part of the program, as the assembler has included them.
#pragma once

#include <string_view>

namespace buoyancy::service {

std::string_view embedded_fmu_library();  // the shared library of every FMU (src/fmu)
std::string_view embedded_license();      // of this project

}  // namespace buoyancy::service
