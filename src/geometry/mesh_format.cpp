#include "geometry/mesh_format.h"

#include <algorithm>
#include <array>

namespace buoyancy {
namespace {

struct AcceptedExtension {
  std::string_view extension;
  MeshFormat format;
};

constexpr std::array kAccepted{
    AcceptedExtension{".obj", MeshFormat::kObj},     AcceptedExtension{".stl", MeshFormat::kStl},
    AcceptedExtension{".ply", MeshFormat::kPly},     AcceptedExtension{".off", MeshFormat::kOff},
    AcceptedExtension{".dae", MeshFormat::kCollada}, AcceptedExtension{".gltf", MeshFormat::kGltf},
    AcceptedExtension{".glb", MeshFormat::kGltf},    AcceptedExtension{".fbx", MeshFormat::kFbx},
    AcceptedExtension{".3ds", MeshFormat::k3ds},     AcceptedExtension{".gdf", MeshFormat::kWamit},
    AcceptedExtension{".dat", MeshFormat::kNemoh},
};

}  // namespace

std::string_view to_string(MeshFormat format) {
  switch (format) {
    case MeshFormat::kObj:
      return "Wavefront OBJ";
    case MeshFormat::kStl:
      return "STL";
    case MeshFormat::kPly:
      return "PLY";
    case MeshFormat::kOff:
      return "OFF";
    case MeshFormat::kCollada:
      return "Collada";
    case MeshFormat::kGltf:
      return "glTF";
    case MeshFormat::kFbx:
      return "FBX";
    case MeshFormat::k3ds:
      return "3DS";
    case MeshFormat::kWamit:
      return "WAMIT GDF";
    case MeshFormat::kNemoh:
      return "Nemoh";
  }
  return "";
}

std::string lowercase_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');  // std::tolower depends on the locale
  }
  return extension;
}

std::optional<MeshFormat> format_from_path(const std::filesystem::path& path) {
  const std::string extension = lowercase_extension(path);
  for (const AcceptedExtension& accepted : kAccepted) {
    if (extension == accepted.extension) return accepted.format;
  }
  return std::nullopt;
}

std::string accepted_extensions() {
  std::string list;
  for (const AcceptedExtension& accepted : kAccepted) {
    if (!list.empty()) list += ", ";
    list += accepted.extension;
  }
  return list;
}

std::string export_hint(std::string_view extension) {
  struct Hint {
    std::string_view extension;
    std::string_view text;
  };
  constexpr std::string_view kTessellate =
      "It holds exact surfaces: tessellate it, in FreeCAD by Mesh > Create Mesh from Shape, or by "
      "gmsh -2 -format stl";
  constexpr std::string_view kFreeShip =
      "It is a model of FREE!ship or DELFTship: tessellate it there, by exporting it as .obj or .stl";
  constexpr std::string_view k3mf =
      "The importer's reading of 3MF cannot be trusted: open it in the slicer or mesh editor that wrote it "
      "and export it as .stl, whose unit is then millimetres (scale = 0.001)";
  constexpr std::string_view kZae = "It is a zip archive around a .dae file: unzip it and give that file";
  static constexpr std::array kHints{
      Hint{".step", kTessellate}, Hint{".stp", kTessellate},  Hint{".iges", kTessellate},
      Hint{".igs", kTessellate},  Hint{".brep", kTessellate}, Hint{".3dm", kTessellate},
      Hint{".fbm", kFreeShip},    Hint{".3mf", k3mf},         Hint{".zae", kZae},
  };
  for (const Hint& hint : kHints) {
    if (hint.extension == extension) return std::string(hint.text);
  }
  return "Export it as one of these, for instance binary .stl or .ply";
}

std::optional<SniffedFormat> sniff_format(std::string_view first_bytes) {
  struct Signature {
    std::string_view bytes;
    SniffedFormat format;
  };
  static constexpr std::array kSignatures{
      Signature{"ply\n", {"PLY", ".ply"}},
      Signature{"ply\r", {"PLY", ".ply"}},
      Signature{"OFF\n", {"OFF", ".off"}},
      Signature{"OFF\r", {"OFF", ".off"}},
      Signature{"OFF ", {"OFF", ".off"}},
      Signature{"COFF", {"OFF", ".off"}},
      Signature{"NOFF", {"OFF", ".off"}},
      Signature{"solid", {"ASCII STL", ".stl"}},
      Signature{"glTF", {"binary glTF (GLB)", ".glb"}},
      Signature{"Kaydara FBX Binary", {"FBX", ".fbx"}},
      Signature{"; FBX", {"FBX", ".fbx"}},
      Signature{"MM", {"3DS", ".3ds"}},
      Signature{"PK\x03\x04", {"a zip archive (3MF, ZAE and others)", ""}},
      Signature{"BLENDER", {"Blender", ""}},
      Signature{"xof ", {"DirectX X", ""}},
      Signature{"ISO-10303-21", {"STEP", ""}},
      Signature{"\x1f\x8b", {"gzip-compressed", ""}},
      Signature{"version https://git-lfs", {kGitLfsPointer, ""}},
      Signature{"<!DOCTYPE html", {"an HTML page", ""}},
      Signature{"<html", {"an HTML page", ""}},
  };
  for (const Signature& signature : kSignatures) {
    if (first_bytes.substr(0, signature.bytes.size()) == signature.bytes) return signature.format;
  }
  if (first_bytes.find("<COLLADA") != std::string_view::npos) return SniffedFormat{"Collada", ".dae"};
  const std::size_t text_start = first_bytes.find_first_not_of(" \t\r\n");
  if (text_start != std::string_view::npos && first_bytes[text_start] == '{') {
    return SniffedFormat{"JSON (glTF)", ".gltf"};
  }
  const std::string lines = std::string(first_bytes).insert(0, 1, '\n');
  if (lines.find("\nv ") != std::string::npos || lines.find("\nmtllib ") != std::string::npos) {
    return SniffedFormat{"Wavefront OBJ", ".obj"};
  }
  return std::nullopt;
}

}  // namespace buoyancy
