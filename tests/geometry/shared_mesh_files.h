// The directory of real meshes beside the project: $BUOYANCY_MESHES, or <source root>/../shared/meshes. They
// are not part of the project (their licences differ), so tests that want one are skipped where it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace buoyancy {

inline std::filesystem::path shared_mesh_file(const char* name) {
  const char* directory = std::getenv("BUOYANCY_MESHES");  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const std::filesystem::path meshes =
      directory != nullptr ? std::filesystem::path(directory)
                           : std::filesystem::path(BUOYANCY_SOURCE_DIR).parent_path() / "shared" / "meshes";
  return meshes / name;
}

}  // namespace buoyancy
