// The accepted mesh file formats, identified by extension, and format sniffing by a file's first bytes.
//
// The extension decides which importer runs. The content serves only to explain a failure: "the content looks
// like PLY" is more useful than an importer's error about line 1.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace buoyancy {

enum class MeshFormat { kObj, kStl, kPly, kOff, kCollada, kGltf, kFbx, k3ds, kWamit, kNemoh };

// "Wavefront OBJ", "STL", "PLY", "OFF", "Collada", "glTF", "FBX", "3DS", "WAMIT GDF", "Nemoh".
std::string_view to_string(MeshFormat format);

// Returns the format of the path's last extension, ignoring case; nullopt if the extension is not accepted.
std::optional<MeshFormat> format_from_path(const std::filesystem::path& path);

// Returns the path's last extension in lower case, with its dot.
std::string lowercase_extension(const std::filesystem::path& path);

// Returns ".obj, .stl, .ply, .off, .dae, .gltf, .glb, .fbx, .3ds, .gdf, .dat", for messages.
std::string accepted_extensions();

// Returns how to convert a file with this extension (in lower case), which is not accepted, to one that is.
std::string export_hint(std::string_view extension);

// The format that a file's first bytes indicate.
struct SniffedFormat {
  std::string_view name;       // "PLY", "a zip archive (3MF, ZAE and others)"
  std::string_view extension;  // ".ply"; empty if the format is not accepted
};

// SniffedFormat::name of a text file that stands for one that Git LFS has not fetched.
inline constexpr std::string_view kGitLfsPointer = "a Git LFS pointer, not the file itself";

// Returns nullopt if the first bytes match no known format.
std::optional<SniffedFormat> sniff_format(std::string_view first_bytes);

}  // namespace buoyancy
