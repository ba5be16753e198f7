#include "geometry/mesh_import.h"

#include <cerrno>
#include <cmath>
#include <fstream>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/format.h"
#include "geometry/import_channel.h"
#include "geometry/import_process.h"
#include "geometry/mesh_format.h"
#include "geometry/ply_header.h"

namespace buoyancy {
namespace {

namespace fs = std::filesystem;

std::string_view to_string(fs::file_type type) {
  switch (type) {
    case fs::file_type::directory:
      return "a directory";
    case fs::file_type::fifo:
      return "a named pipe";
    case fs::file_type::socket:
      return "a socket";
    case fs::file_type::character:
    case fs::file_type::block:
      return "a device";
    default:
      return "not a regular file";
  }
}

// Detects faults in a PLY header that the importer misreports or on which it does not terminate.
std::optional<Error> check_ply_header(std::ifstream& file) {
  const std::optional<PlyHeader> header = read_ply_header(file);
  if (!header) {
    return Error{"", "a PLY header without its 'end_header' line", "a complete PLY file",
                 "the file is cut short or damaged", "Open it in a mesh editor and export it again"};
  }
  if (const std::uint64_t strips = header->count_of("tristrips"); strips > 0) {
    return Error{"", "a PLY file of triangle strips (element tristrips " + std::to_string(strips) + ")",
                 "polygons (element face), since strips are not supported",
                 "a mesh from a scanner or an archive that stores strips to save space",
                 "Open it in MeshLab and export it as PLY or STL, which converts the strips to triangles"};
  }
  const std::string counts = "(element vertex " + std::to_string(header->count_of("vertex")) +
                             ", element face " + std::to_string(header->count_of("face")) + ")";
  if (header->count_of("face") == 0) {
    return Error{"", "no triangles: a PLY header that declares no faces " + counts,
                 "a mesh of triangles or polygons", "a point cloud, curves, or an empty export",
                 "Export the surface as polygons"};
  }
  if (!header->data_follows) {
    return Error{"", "only a PLY header " + counts + " and nothing after it", "a complete PLY file",
                 "an incomplete export or download", "Export or download it again"};
  }
  return std::nullopt;
}

// Returns "white space" or "zero bytes" if the file holds nothing else.
std::optional<std::string_view> blank_content(std::ifstream& file) {
  file.clear();
  file.seekg(0);
  const bool zeros = file.peek() == 0;
  const std::string_view blank = zeros ? std::string_view("\0", 1) : std::string_view(" \t\r\n\v\f");
  for (std::string part(65'536, ' ');
       file.read(part.data(), static_cast<std::streamsize>(part.size())) || file.gcount() > 0;) {
    const std::string_view bytes(part.data(), static_cast<std::size_t>(file.gcount()));
    if (bytes.find_first_not_of(blank) != std::string_view::npos) return std::nullopt;
  }
  return zeros ? "zero bytes" : "white space";
}

struct AcceptedFile {
  MeshFormat format = MeshFormat::kObj;
  std::optional<SniffedFormat> content;
};

// Makes all checks that need no importer.
Expected<AcceptedFile> check_file(const fs::path& path, const ImportLimits& limits) {
  const std::string mesh_file = "a mesh file (" + accepted_extensions() + ")";
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    return make_error({"", "no such file", mesh_file,
                       "the name is misspelt, or relative to another directory",
                       "The absolute path is " + fs::absolute(path, error).string()});
  }
  if (status.type() == fs::file_type::none) {
    return make_error({"", "cannot be accessed: " + error.message(), mesh_file,
                       "this user may not search a directory of its path", "Check the permissions"});
  }
  if (status.type() != fs::file_type::regular) {
    return make_error({"", "is " + std::string(to_string(status.type())), mesh_file,
                       "the path does not name the mesh file", "Give the path of the mesh file itself"});
  }

  const std::optional<MeshFormat> format = format_from_path(path);
  if (!format) {
    const std::string extension = path.extension().string();
    return make_error({"",
                       extension.empty() ? "a file name without an extension"
                                         : "format '" + extension + "' is not accepted",
                       "one of " + accepted_extensions(), "the mesh was saved in another format",
                       export_hint(lowercase_extension(path))});
  }

  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error) return make_error({"", "its size cannot be determined: " + error.message(), mesh_file, "", ""});
  if (bytes == 0) {
    return make_error({"", "the file is empty (0 bytes)", mesh_file, "an incomplete export or download",
                       "Export or download it again"});
  }
  if (bytes > limits.mesh_bytes) {
    return make_error({"", std::to_string(bytes) + " bytes",
                       "at most " + std::to_string(limits.mesh_bytes) + " (limit 'mesh_bytes')",
                       "the mesh is finer than this service is configured for",
                       "Simplify the mesh, or raise 'mesh_bytes' under [limits]"});
  }

  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string first_bytes(512, '\0');
  file.read(first_bytes.data(), static_cast<std::streamsize>(first_bytes.size()));
  if (file.gcount() <= 0) {
    return make_error({"", "cannot be read: " + std::generic_category().message(errno), "a readable file",
                       "its permissions, or an error of the medium", "Make it readable for this user"});
  }
  first_bytes.resize(static_cast<std::size_t>(file.gcount()));
  if (const auto blank = blank_content(file)) {
    return make_error({"", "nothing but " + std::string(*blank) + " (" + std::to_string(bytes) + " bytes)",
                       mesh_file, "an incomplete export or download", "Export or download it again"});
  }
  const std::optional<SniffedFormat> content = sniff_format(first_bytes);
  if (content && content->extension == ".ply" && *format == MeshFormat::kPly) {
    if (std::optional<Error> fault = check_ply_header(file)) return make_error(*std::move(fault));
  }
  return AcceptedFile{*format, content};
}

// Replaces cause and hint of the error if the content does not match the extension.
Error explained_by_content(Error error, const AcceptedFile& file, const std::string& extension) {
  if (!file.content || file.content->extension == extension) return error;
  if (file.content->name == kGitLfsPointer) {
    error.cause = "the content is " + std::string(kGitLfsPointer);
    error.hint = "Run git lfs pull in its repository";
    return error;
  }
  error.cause = "the content looks like " + std::string(file.content->name) + ", which does not match " +
                "the extension " + extension;
  error.hint = file.content->extension.empty()
                   ? "Export the mesh as one of " + accepted_extensions()
                   : "If it is, give it the extension " + std::string(file.content->extension);
  return error;
}

std::string coordinates(const TriangleMesh& mesh, std::size_t vertex) {
  std::string text = "(";
  text += format_vector({mesh.x[vertex], mesh.y[vertex], mesh.z[vertex]}, 6);
  return text + ")";
}

std::optional<Error> check_coordinates(const TriangleMesh& mesh) {
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) {
    if (!std::isfinite(mesh.x[v]) || !std::isfinite(mesh.y[v]) || !std::isfinite(mesh.z[v])) {
      return Error{"",
                   "vertex " + std::to_string(v) + " of " + std::to_string(mesh.vertex_count()) + " is " +
                       coordinates(mesh, v),
                   "finite coordinates", "a broken export, or numbers beyond single precision (3.4e38)",
                   "Export the mesh again"};
    }
  }
  return std::nullopt;
}

// Non-planar polygons give more triangles than the importer has counted.
std::optional<Error> check_triangles(const TriangleMesh& mesh, const ImportLimits& limits) {
  if (mesh.triangles.size() <= limits.faces) return std::nullopt;
  return Error{"", std::to_string(mesh.triangles.size()) + " triangles after splitting polygons",
               "at most " + std::to_string(limits.faces) + " (limit 'faces')",
               "the mesh is finer than this service is configured for",
               "Simplify the mesh, or raise 'faces' under [limits]"};
}

Expected<ImportedMesh> split_polygons(StoredMesh stored, const ImportLimits& limits) {
  if (std::optional<Error> error = check_coordinates(stored.mesh)) return make_error(*std::move(error));
  if (stored.polygons.size() > 0) {
    stored.source.polygons = triangulate(stored.polygons, stored.mesh);
    if (std::optional<Error> error = check_triangles(stored.mesh, limits))
      return make_error(*std::move(error));
  }
  return ImportedMesh{std::move(stored.mesh), std::move(stored.source)};
}

Expected<ImportedMesh> import_without_subject(const fs::path& path, const ImportLimits& limits) {
  const Expected<AcceptedFile> file = check_file(path, limits);
  if (!file) return make_error(file.error());
  Expected<StoredMesh> stored = import_in_child_process(path, file->format, limits);
  Expected<ImportedMesh> imported = stored ? split_polygons(*std::move(stored), limits)
                                           : Expected<ImportedMesh>(make_error(std::move(stored.error())));
  if (!imported) return make_error(explained_by_content(imported.error(), *file, lowercase_extension(path)));
  return imported;
}

}  // namespace

Expected<ImportedMesh> import_mesh(const fs::path& path, const ImportLimits& limits) try {
  Expected<ImportedMesh> imported = import_without_subject(path, limits);
  if (!imported) imported.error().subject = path.string();
  return imported;
} catch (const std::bad_alloc&) {
  return make_error({path.string(), "the mesh does not fit into this process's memory", "a smaller mesh",
                     "the mesh is finer than this machine can hold", "Simplify the mesh"});
}

}  // namespace buoyancy
