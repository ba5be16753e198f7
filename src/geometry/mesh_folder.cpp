#include "geometry/mesh_folder.h"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

// A pipe then opens without waiting for a writer, and no terminal becomes the controlling terminal.
constexpr int kOpenFlags = O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY;

bool is_file_of_at_most(int file, std::uint64_t bytes) {
  struct stat status {};
  return ::fstat(file, &status) == 0 && S_ISREG(status.st_mode) && std::cmp_less_equal(status.st_size, bytes);
}

}  // namespace

FileBelow open_below(const fs::path& folder, const std::string& name) {
  const UniqueFd below(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!below.valid()) return {};
  open_how how{};
  how.flags = kOpenFlags;
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS;
  UniqueFd file(static_cast<int>(::syscall(SYS_openat2, below.value(), name.c_str(), &how, sizeof(how))));
  if (file.valid()) return {std::move(file), false};
  // Old kernels do not have openat2, and old container engines forbid calls that they do not know.
  if (errno == ENOSYS || errno == EPERM) return open_below_by_path(folder, name);
  return {UniqueFd(), errno == EXDEV};
}

FileBelow open_below_by_path(const fs::path& folder, const std::string& name) {
  std::error_code error;
  const fs::path resolved_folder = fs::canonical(folder, error);
  if (error) return {};
  const fs::path resolved = fs::canonical(folder / name, error);
  const auto [folder_end, rest] =
      std::mismatch(resolved_folder.begin(), resolved_folder.end(), resolved.begin(), resolved.end());
  const bool outside = fs::path(name).is_absolute() || (!error && folder_end != resolved_folder.end());
  if (error || outside) return {UniqueFd(), outside};
  return {UniqueFd(::open(resolved.c_str(), kOpenFlags | O_NOFOLLOW)), false};
}

MeshFolder::MeshFolder(const fs::path& mesh, std::uint64_t max_bytes)
    : folder_(mesh.has_parent_path() ? mesh.parent_path() : "."),
      mesh_name_(mesh.filename().string()),
      mesh_(::open(mesh.c_str(), kOpenFlags)),
      max_bytes_(max_bytes) {}

UniqueFd MeshFolder::open(const std::string& name) {
  FileBelow found;
  if (name == mesh_name_) {
    found.file = UniqueFd(::fcntl(mesh_.value(), F_DUPFD_CLOEXEC, 0));
  } else {
    found = open_below(folder_, name);
  }
  if (found.outside && outside_.empty()) outside_ = name;
  if (!found.file.valid() || !is_file_of_at_most(found.file.value(), max_bytes_)) return {};
  return std::move(found.file);
}

}  // namespace buoyancy
