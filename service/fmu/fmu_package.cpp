#include "service/fmu/fmu_package.h"

#include <algorithm>
#include <map>
#include <utility>

#include <minizip/zip.h>
#include <zlib.h>

#include "base/format.h"
#include "base/text_file.h"
#include "base/xml_text.h"
#include "cli/pose_options.h"
#include "geometry/mesh_export.h"
#include "scene/body_flotation.h"
#include "scene/scene_fingerprint.h"
#include "scene/scene_report.h"
#include "scene/scene_text.h"
#include "service/fmu/embedded_files.h"

namespace buoyancy::service {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLicenses = R"(

The shared library also contains parts of Eigen (MPL 2.0), Highway (Apache 2.0), toml++ (MIT), tl::expected (CC0),
JSON for Modern C++ (MIT), Boost (Boost Software License 1.0), xxHash (BSD 2-clause) and of GCC's C++ library (GPL 3
with the GCC Runtime Library Exception).
)";

// Gives every file of a scene a name of its own in the resources of the FMU.
class ResourceNames {
 public:
  explicit ResourceNames(fs::path directory) : directory_(std::move(directory)) {}

  // name: as the scene has it.
  std::string add(const std::string& name, bool is_mesh) {
    const fs::path file = (directory_ / name).lexically_normal();
    if (const auto known = names_.find(file); known != names_.end()) return known->second;
    const std::string stem = fmu::to_identifier(file.stem().string());
    const char* const extension = is_mesh ? ".ply" : ".csv";
    std::string resource = stem + extension;
    for (int n = 2; is_taken(resource); ++n)
      resource = format_text("{}_{}{}", stem, std::int64_t{n}, extension);
    names_.emplace(file, resource);
    return resource;
  }
  const std::map<fs::path, std::string>& names() const { return names_; }

 private:
  bool is_taken(const std::string& resource) const {
    return std::ranges::any_of(names_, [&](const auto& known) { return known.second == resource; });
  }

  fs::path directory_;
  std::map<fs::path, std::string> names_;
};

// Leaves the bodies in the description that are listed, by id or name.
Expected<void> keep_bodies(const std::vector<std::string>& listed, const Scene& scene,
                           SceneDescription& description) {
  std::vector<std::int32_t> ids;
  for (const std::string& body : listed) {
    const Expected<std::int32_t> id = resolve_body("--body", body, scene);
    if (!id) return make_error(id.error());
    ids.push_back(*id);
  }
  if (!ids.empty()) {
    std::erase_if(description.bodies,
                  [&](const BodyDescription& body) { return std::ranges::find(ids, body.id) == ids.end(); });
  }
  return {};
}

// Returns the meshes and tables that the bodies and the waves need.
Expected<std::vector<FmuFile>> resources_of(const SceneDescription& description,
                                            const std::map<fs::path, std::string>& names) {
  std::map<fs::path, bool> is_needed;
  for (const BodyDescription& body : description.bodies) {
    for_each_mesh(body, [&](const MeshDescription& mesh, auto&&...) {
      if (const auto* file = std::get_if<MeshFile>(&mesh.source)) is_needed[file->path] = true;
    });
  }
  std::vector<FmuFile> files;
  for (const auto& [path, name] : names) {
    const std::string resource = "resources/" + name;
    if (name.ends_with(".csv")) {
      Expected<std::string> table = read_text_file(path, "a file of wave components", 1'000'000'000);
      if (!table) return make_error(std::move(table.error()));
      files.push_back({resource, *std::move(table)});
    } else if (is_needed[path]) {
      const Expected<ImportedMesh> imported = import_mesh(path, description.limits);
      if (!imported) return make_error(imported.error());
      files.push_back({resource, export_mesh(imported->mesh, ExportFormat::kPly)});
    }
  }
  return files;
}

std::string documentation_of(const Scene& scene) {
  const std::vector<FlotationOfBody> flotation = scene_flotation(scene);
  std::string report = scene_report_text(scene, {.motions = true, .flotation = &flotation});
  for (const Warning& warning : scene_warnings(scene)) report += "warning: " + warning.message() + "\n";
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
         escape_xml(scene.name()) + "</title></head>\n<body><pre>\n" + escape_xml(report) +
         "</pre></body></html>\n";
}

}  // namespace

Expected<FmuContent> fmu_content(const fs::path& scene_file, const std::string& identifier,
                                 const std::vector<std::string>& bodies) {
  constexpr std::uintmax_t kMaxSceneBytes = 1'000'000'000;
  const Expected<std::string> text = read_text_file(scene_file, "a scene file (TOML)", kMaxSceneBytes);
  if (!text) return make_error(text.error());
  const fs::path directory = scene_file.parent_path();
  Expected<SceneDescription> description = parse_scene(*text, scene_file.string(), directory);
  if (!description) return make_error(description.error());
  if (description->sea_messages != SeaMessages::kNone) {
    return make_error({scene_file.string(), to_string(description->sea_messages),
                       "the wave systems themselves", "an FMU receives no messages",
                       "List the systems, or leave waves out"});
  }
  Expected<Scene> scene = Scene::prepare(*description);
  if (!scene) return make_error(std::move(scene.error()));
  if (!bodies.empty()) {
    if (const Expected<void> kept = keep_bodies(bodies, *scene, *description); !kept) {
      return make_error(kept.error());
    }
    scene = Scene::prepare(*description);
    if (!scene) return make_error(std::move(scene.error()));
  }
  ResourceNames names(directory);
  std::string renamed = rename_files(
      *text, [&names](const std::string& name, bool is_mesh) { return names.add(name, is_mesh); });
  Expected<std::vector<FmuFile>> files = resources_of(*description, names.names());
  if (!files) return make_error(std::move(files.error()));
  std::array<char, 17> fingerprint{};
  std::snprintf(fingerprint.data(), fingerprint.size(), "%016llx",
                static_cast<unsigned long long>(scene_fingerprint(*scene)));
  std::string token = format_text("buoyancy-{}-{}", BUOYANCY_VERSION, fingerprint.data());
  std::string list;
  for (const Body& body : scene->bodies()) {
    token += format_text("-{}", std::int64_t{body.id});
    list += std::to_string(body.id) + "\n";
  }
  files->push_back({std::string("resources/") + fmu::kSceneFile, std::move(renamed)});
  files->push_back({std::string("resources/") + fmu::kInstantiationFile, token + "\n" + list});
  files->push_back({"documentation/index.html", documentation_of(*scene)});
  files->push_back({"documentation/licenses/license.txt", std::string(embedded_license()) + kLicenses});
  fmu::ModelDescription model{.name = scene_file.stem().string(),
                              .identifier = identifier,
                              .token = std::move(token),
                              .tool = "buoyancy-fmu " BUOYANCY_VERSION};
  model.has_derivatives = std::ranges::any_of(
      scene->bodies(), [&](const Body& body) { return fmu::has_derivatives(*scene, body); });
  return FmuContent{std::move(model), fmu::VariableTable(*scene), *std::move(files)};
}

std::vector<FmuFile> fmu_files(const FmuContent& content, fmu::FmiVersion version) {
  const std::string platform = version == fmu::FmiVersion::k2 ? "linux64" : BUOYANCY_FMI3_PLATFORM;
  std::vector<FmuFile> files{
      {"modelDescription.xml", to_xml(content.model, content.table, version)},
      {"binaries/" + platform + "/" + content.model.identifier + ".so", std::string(embedded_fmu_library())}};
  files.insert(files.end(), content.files.begin(), content.files.end());
  return files;
}

Expected<void> write_archive(const fs::path& path, const std::vector<FmuFile>& files) {
  const std::string part = path.string() + ".part";
  constexpr std::uint64_t kMaxUnsigned32 = 0xFFFFFFFF;
  zipFile archive = ::zipOpen64(part.c_str(), APPEND_STATUS_CREATE);
  bool written = archive != nullptr;
  for (const FmuFile& file : files) {
    if (!written) break;
    zip_fileinfo info{};
    info.dosDate = 0x00210000;  // 1980-01-01, the first that there is
    written = ::zipOpenNewFileInZip64(archive, file.path.c_str(), &info, nullptr, 0, nullptr, 0, nullptr,
                                      Z_DEFLATED, Z_DEFAULT_COMPRESSION,
                                      file.bytes.size() >= kMaxUnsigned32 ? 1 : 0) == ZIP_OK;
    constexpr std::size_t kBlock = std::size_t{1} << 30U;
    for (std::size_t at = 0; written && at < file.bytes.size(); at += kBlock) {
      const std::size_t size = std::min(kBlock, file.bytes.size() - at);
      written = ::zipWriteInFileInZip(archive, file.bytes.data() + at, static_cast<unsigned>(size)) == ZIP_OK;
    }
    written = written && ::zipCloseFileInZip(archive) == ZIP_OK;
  }
  if (archive != nullptr) written = (::zipClose(archive, nullptr) == ZIP_OK) && written;
  std::error_code error;
  if (written) fs::rename(part, path, error);
  if (written && !error) return {};
  fs::remove(part, error);
  return make_error({path.string(), "cannot be written", "a file that can be written", "",
                     "Check its folder, and the space on the disk"});
}

}  // namespace buoyancy::service
