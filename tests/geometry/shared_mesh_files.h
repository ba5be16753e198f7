// The directory of shared real meshes: $BUOYANCY_MESHES, or <source root>/../shared/meshes. The meshes are
// not part of the project, since their licences differ; tests that need one are skipped if it is absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/support/build_paths.h"

namespace buoyancy {

inline std::filesystem::path shared_mesh_file(const char* name) {
  const char* directory =
      std::getenv("BUOYANCY_MESHES");  // NOLINT(concurrency-mt-unsafe): never set by the tests
  const std::filesystem::path meshes = directory != nullptr
                                           ? std::filesystem::path(directory)
                                           : source_dir().parent_path() / "shared" / "meshes";
  return meshes / name;
}

// Why a test that needs the file is skipped.
inline std::string missing_shared_mesh(const std::filesystem::path& path) {
  return path.string() + " was not found; set BUOYANCY_MESHES to the directory of the shared meshes, " +
         "which their licences exclude from the project";
}

}  // namespace buoyancy
