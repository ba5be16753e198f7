#include "tests/support/build_paths.h"

namespace buoyancy {

std::filesystem::path source_dir() {
  return BUOYANCY_SOURCE_DIR;
}

std::string built_program(std::string_view name) {
  return (std::filesystem::path(BUOYANCY_PROGRAM_DIR) / name).string();
}

std::filesystem::path pictures_dir() {
  return BUOYANCY_PICTURES;
}

}  // namespace buoyancy
