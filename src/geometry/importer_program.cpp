#include "geometry/importer_program.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

#include <dlfcn.h>
#include <link.h>
#include <sys/auxv.h>
#include <sys/stat.h>
#include <unistd.h>

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "buoyancy/buoyancy-import-mesh";

// Returns the file that contains this code, with symbolic links resolved; empty if it cannot be found.
fs::path own_file() {
  Dl_info info{};
  void* map = nullptr;
  std::error_code error;
  const bool found =
      ::dladdr1(reinterpret_cast<const void*>(&importer_program), &info, &map, RTLD_DL_LINKMAP) != 0;
  if (found && map != nullptr && *static_cast<const link_map*>(map)->l_name != '\0') {
    return fs::canonical(static_cast<const link_map*>(map)->l_name, error);
  }
  fs::path program = fs::canonical("/proc/self/exe", error);
  if (!error) return program;
  // NOLINTNEXTLINE(performance-no-int-to-ptr): that is how the kernel passes a pointer
  const auto* started_as = reinterpret_cast<const char*>(::getauxval(AT_EXECFN));
  return started_as == nullptr ? fs::path() : fs::canonical(started_as, error);
}

// The places tried are beside the calling program, perhaps in a folder that others can write to, such as
// /tmp.
bool is_trusted(const fs::path& program, std::optional<uid_t> owner) {
  struct stat status {};
  return ::lstat(program.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
         (status.st_mode & S_IWOTH) == 0 && ::access(program.c_str(), X_OK) == 0 &&
         (status.st_uid == 0 || status.st_uid == ::geteuid() || status.st_uid == owner);
}

}  // namespace

Expected<std::string> importer_program() {
  if (const char* chosen = ::secure_getenv("BUOYANCY_IMPORTER"); chosen != nullptr && *chosen != '\0') {
    return chosen;
  }
  std::vector<fs::path> places;
  std::optional<uid_t> owner;
  if (const fs::path file = own_file(); !file.empty()) {
    struct stat status {};
    if (::stat(file.c_str(), &status) == 0) owner = status.st_uid;
    // These lead to the prefix from bin and lib, lib/x86_64-linux-gnu and lib/python3/dist-packages/buoyancy.
    for (const char* prefix : {"..", "../..", "../../../.."}) {
      places.push_back((file.parent_path() / prefix / "libexec" / kProgram).lexically_normal());
    }
  }
  places.push_back(fs::path(BUOYANCY_LIBEXEC_DIR) / kProgram);
  places.push_back(fs::path("/usr/libexec") / kProgram);
  std::string tried;
  for (const fs::path& place : places) {
    if (is_trusted(place, owner)) return place.string();
    tried += (tried.empty() ? "" : ", ") + place.string();
  }
  return make_error({"", "the program that reads mesh files is missing (" + tried + ")",
                     "buoyancy-import-mesh, owned by root or by this user",
                     "it was not installed together with what needs it",
                     "Install the package buoyancy-importer, or set BUOYANCY_IMPORTER to its path"});
}

}  // namespace buoyancy
