// Internal to mesh import: opens the files that the importer may read. The importer can open none itself; it
// requests them by name (import_channel.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/unique_fd.h"

namespace buoyancy {

// A regular file below a folder, by its name relative to it.
struct FileBelow {
  UniqueFd file;         // not valid if there is none
  bool outside = false;  // the name leads out of the folder: absolute, by "..", or by a symbolic link
};
FileBelow open_below(const std::filesystem::path& folder, const std::string& name);
// Does the same on kernels without openat2. A link that is set while it runs may still lead out.
FileBelow open_below_by_path(const std::filesystem::path& folder, const std::string& name);

class MeshFolder {
 public:
  // Opens the mesh. It may be a symbolic link to anywhere, since the user has named it.
  MeshFolder(const std::filesystem::path& mesh, std::uint64_t max_bytes);

  // Returns a descriptor for reading the mesh itself or a file below its folder; not valid if there is no
  // such regular file of at most max_bytes. The mesh is the same open file each time, so do not move its
  // offset.
  UniqueFd open(const std::string& name);

  // The first name that led out of the folder; empty if none did.
  const std::string& outside() const { return outside_; }

 private:
  std::filesystem::path folder_;
  std::string mesh_name_;
  UniqueFd mesh_;
  std::uint64_t max_bytes_;
  std::string outside_;
};

}  // namespace buoyancy
