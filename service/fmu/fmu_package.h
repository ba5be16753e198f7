// Packs a scene into an FMU: the files that an FMU consists of, and the archive that they make.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "fmu/model_description.h"
#include "fmu/variables.h"

namespace buoyancy::service {

struct FmuFile {
  std::string path;  // within the FMU, "resources/scene.toml"
  std::string bytes;
};

// What an FMU is made of, in both versions of the standard.
struct FmuContent {
  fmu::ModelDescription model;
  fmu::VariableTable table;
  std::vector<FmuFile> files;  // resources and documentation
};

// Reads a scene and its meshes. identifier: of the model. bodies: id or name of each body that the FMU has;
// empty: all. Errors: those of Scene::load(), a body that the scene lacks, and waves that come in messages.
Expected<FmuContent> fmu_content(const std::filesystem::path& scene, const std::string& identifier,
                                 const std::vector<std::string>& bodies);

// Returns all files of the FMU, with the model description and the shared library of this version.
std::vector<FmuFile> fmu_files(const FmuContent& content, fmu::FmiVersion version);

// Writes a ZIP archive; equal files make equal bytes. It appears under its name when it is complete.
Expected<void> write_archive(const std::filesystem::path& path, const std::vector<FmuFile>& files);

}  // namespace buoyancy::service
