// The mesh file formats that are accepted, told by extension; and what a file's first bytes look like.
//
// The extension decides which importer runs. The content is only looked at to explain a failure: "the content
// looks like PLY" is worth more to a person than an importer's complaint about line 1.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace buoyancy {

enum class MeshFormat { kObj, kStl, kPly, kOff, kCollada, kGltf, kFbx, k3ds };

// "Wavefront OBJ", "STL", "PLY", "OFF", "Collada", "glTF", "FBX", "3DS".
std::string_view to_string(MeshFormat format);

// By the path's last extension, upper or lower case; nothing for an extension that is not accepted.
std::optional<MeshFormat> format_from_path(const std::filesystem::path& path);

// The path's last extension in lower case, with its dot.
std::string lowercase_extension(const std::filesystem::path& path);

// ".obj, .stl, .ply, .off, .dae, .gltf, .glb, .fbx, .3ds", for messages.
std::string accepted_extensions();

// What a file is by its first bytes, as far as they say so.
struct SniffedFormat {
  std::string_view name;       // "PLY", "a zip archive (3MF, ZAE and others)"
  std::string_view extension;  // ".ply"; empty if it is none of the accepted formats
};

std::optional<SniffedFormat> sniff_format(std::string_view first_bytes);

}  // namespace buoyancy
