#include "service/fmu/embedded_files.h"

#define BUOYANCY_EMBED(name, path) \
  __asm__(".section .rodata\n" #name "_begin:\n.incbin \"" path "\"\n" #name "_end:\n.byte 0\n.previous")
BUOYANCY_EMBED(buoyancy_fmu_library, BUOYANCY_FMU_LIBRARY);
BUOYANCY_EMBED(buoyancy_license, BUOYANCY_LICENSE);

extern "C" {
extern const char buoyancy_fmu_library_begin[], buoyancy_fmu_library_end[];
extern const char buoyancy_license_begin[], buoyancy_license_end[];
}

namespace buoyancy::service {

std::string_view embedded_fmu_library() {
  return {buoyancy_fmu_library_begin, buoyancy_fmu_library_end};
}

std::string_view embedded_license() {
  return {buoyancy_license_begin, buoyancy_license_end};
}

}  // namespace buoyancy::service
