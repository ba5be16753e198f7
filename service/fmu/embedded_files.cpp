#include "service/fmu/embedded_files.h"

#define BUOYANCY_EMBED(name, path) \
  __asm__(".section .rodata\n" #name "Begin:\n.incbin \"" path "\"\n" #name "End:\n.byte 0\n.previous")
BUOYANCY_EMBED(kBuoyancyFmuLibrary, BUOYANCY_FMU_LIBRARY);
BUOYANCY_EMBED(kBuoyancyLicense, BUOYANCY_LICENSE);

extern "C" {
extern const char kBuoyancyFmuLibraryBegin[], kBuoyancyFmuLibraryEnd[];
extern const char kBuoyancyLicenseBegin[], kBuoyancyLicenseEnd[];
}

namespace buoyancy::service {

std::string_view embedded_fmu_library() {
  return {kBuoyancyFmuLibraryBegin, kBuoyancyFmuLibraryEnd};
}

std::string_view embedded_license() {
  return {kBuoyancyLicenseBegin, kBuoyancyLicenseEnd};
}

}  // namespace buoyancy::service
