// Versions and names of the C interface.
#include "c/buoyancy.h"
#include "messages/request.h"

const char* buoyancy_version(void) {
  return BUOYANCY_VERSION;
}

int32_t buoyancy_version_number(void) {
  return 10000 * BUOYANCY_VERSION_MAJOR + 100 * BUOYANCY_VERSION_MINOR + BUOYANCY_VERSION_PATCH;
}

const char* buoyancy_error_name(buoyancy_error error) {
  switch (error) {
    case BUOYANCY_OK:
      return "OK";
    case BUOYANCY_ERROR_INVALID_ARGUMENT:
      return "INVALID_ARGUMENT";
    case BUOYANCY_ERROR_HANDLE:
      return "HANDLE";
    case BUOYANCY_ERROR_FILE:
      return "FILE";
    case BUOYANCY_ERROR_MESH:
      return "MESH";
    case BUOYANCY_ERROR_SCENE:
      return "SCENE";
    case BUOYANCY_ERROR_MEMORY:
      return "MEMORY";
    case BUOYANCY_ERROR_INTERNAL:
      return "INTERNAL";
    default:
      return "UNKNOWN_ERROR";
  }
}

const char* buoyancy_status_name(int32_t status) {
  return to_string(static_cast<buoyancy::BodyStatus>(status));
}
