// Mesh files for tests: the same closed tetrahedron in each accepted format.
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/temp_dir.h"

namespace buoyancy {

template <typename T>
void append_bytes(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

// The tetrahedron with corners 0, x, y, z: volume 1/6, four faces.
namespace tetrahedron {

inline const std::vector<std::vector<float>> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline const std::vector<std::vector<std::uint16_t>> kFaces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

inline std::string obj() {
  return "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

inline std::string off() {
  return "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

inline std::string ply_header(std::string_view encoding, std::string_view vertices = "4",
                              std::string_view faces = "4") {
  return "ply\nformat " + std::string(encoding) + " 1.0\nelement vertex " + std::string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::string(faces) +
         "\nproperty list uchar int vertex_indices\n";
}

inline std::string ascii_ply() {
  return ply_header("ascii") + "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
}

inline std::string binary_ply() {
  std::string bytes = ply_header("binary_little_endian") + "end_header\n";
  for (const auto& corner : kCorners) {
    for (const float coordinate : corner) append_bytes(bytes, coordinate);
  }
  for (const auto& face : kFaces) {
    append_bytes(bytes, std::uint8_t{3});
    for (const std::uint16_t i : face) append_bytes(bytes, std::int32_t{i});
  }
  return bytes;
}

inline std::string ascii_stl() {
  std::string text = "solid tetrahedron\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint16_t i : face) {
      text += "vertex";
      for (const float coordinate : kCorners[i]) text += coordinate == 0.0F ? " 0" : " 1";
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid tetrahedron\n";
}

inline std::string binary_stl() {
  std::string bytes(80, '\0');
  append_bytes(bytes, static_cast<std::uint32_t>(kFaces.size()));
  for (const auto& face : kFaces) {
    for (int i = 0; i < 3; ++i) append_bytes(bytes, 0.0F);
    for (const std::uint16_t i : face) {
      for (const float coordinate : kCorners[i]) append_bytes(bytes, coordinate);
    }
    append_bytes(bytes, std::uint16_t{0});
  }
  return bytes;
}

// `asset`: the content of <asset>; `nodes`: the nodes of the scene, which may instance "#mesh".
inline std::string collada(std::string_view asset = "", std::string_view nodes = "") {
  const std::string node =
      nodes.empty() ? R"(<node id="node"><instance_geometry url="#mesh"/></node>)" : std::string(nodes);
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         std::string(asset) + R"(</asset>
<library_geometries><geometry id="mesh"><mesh>
<source id="positions"><float_array id="array" count="12">0 0 0 1 0 0 0 1 0 0 0 1</float_array>
<technique_common><accessor source="#array" count="4" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="vertices"><input semantic="POSITION" source="#positions"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#vertices" offset="0"/>
<p>0 2 1 0 1 3 0 3 2 1 2 3</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene">)" +
         node + R"(</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
)";
}

// Returns the buffer of gltf(): 48 bytes of corners and 24 bytes of faces.
inline std::string gltf_buffer() {
  std::string bytes;
  for (const auto& corner : kCorners) {
    for (const float coordinate : corner) append_bytes(bytes, coordinate);
  }
  for (const auto& face : kFaces) {
    for (const std::uint16_t i : face) append_bytes(bytes, i);
  }
  return bytes;
}

// `nodes`: the JSON array; its first node is the scene's root. `buffer`: the JSON member that refers to the
// bytes; empty for a GLB file's own buffer.
inline std::string gltf(std::string_view nodes = R"([{"mesh":0}])",
                        std::string_view buffer = R"("uri":"tetrahedron.bin",)") {
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":)" + std::string(nodes) +
         R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],"buffers":[{)" +
         std::string(buffer) +
         R"("byteLength":72}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)"
         R"({"buffer":0,"byteOffset":48,"byteLength":24}],"accessors":[)"
         R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1,1,1]},)"
         R"({"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}]})";
}

inline std::string glb() {
  std::string json = gltf(R"([{"mesh":0}])", "");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string buffer = gltf_buffer();
  std::string bytes = "glTF";
  append_bytes(bytes, std::uint32_t{2});
  append_bytes(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  append_bytes(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append_bytes(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

inline std::string chunk_3ds(std::uint16_t id, const std::string& content) {
  std::string bytes;
  append_bytes(bytes, id);
  append_bytes(bytes, static_cast<std::uint32_t>(content.size() + 6));
  return bytes + content;
}

inline std::string file_3ds() {
  std::string corners;
  append_bytes(corners, static_cast<std::uint16_t>(kCorners.size()));
  for (const auto& corner : kCorners) {
    for (const float coordinate : corner) append_bytes(corners, coordinate);
  }
  std::string faces;
  append_bytes(faces, static_cast<std::uint16_t>(kFaces.size()));
  for (const auto& face : kFaces) {
    for (const std::uint16_t i : face) append_bytes(faces, i);
    append_bytes(faces, std::uint16_t{7});
  }
  const std::string mesh = chunk_3ds(0x4100, chunk_3ds(0x4110, corners) + chunk_3ds(0x4120, faces));
  const std::string object = chunk_3ds(0x4000, std::string("tetra\0", 6) + mesh);
  return chunk_3ds(0x4D4D, chunk_3ds(0x3D3D, object));
}

// `settings`: lines of GlobalSettings' Properties70.
inline std::string fbx(std::string_view settings = "") {
  return R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
)" + std::string(settings) +
         R"(	}
}
Objects:  {
	Geometry: 1000, "Geometry::", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,1,0,0,0,1,0,0,0,1
		}
		PolygonVertexIndex: *12 {
			a: 0,2,-2,0,1,-4,0,3,-3,1,2,-4
		}
		GeometryVersion: 124
	}
	Model: 2000, "Model::tetrahedron", "Mesh" {
		Version: 232
	}
}
Connections:  {
	C: "OO",2000,0
	C: "OO",1000,2000
}
)";
}

// A panel mesh for WAMIT: triangles are panels whose last two corners are the same.
inline std::string gdf(std::string_view header = "1 9.80665 ULEN GRAV\n0 0 ISX ISY\n") {
  std::string text = "a tetrahedron\n" + std::string(header) + "4\n";
  for (const auto& face : kFaces) {
    for (const std::size_t i : {0U, 1U, 2U, 2U}) {
      for (const float coordinate : kCorners[face[i]]) text += coordinate == 0.0F ? " 0.0" : " 1.0";
      text += "\n";
    }
  }
  return text;
}

inline std::string nemoh() {
  return "2 0\n1 0. 0. 0.\n2 1. 0. 0.\n3 0. 1. 0.\n4 0. 0. 1.\n0 0. 0. 0.\n"
         "1 3 2 2\n1 2 4 1\n1 4 3 3\n2 3 4 4\n0 0 0 0\n";
}

}  // namespace tetrahedron

struct NamedContent {
  std::string name;
  std::string content;
};

// Returns a file for each accepted extension, in ASCII and binary if the format has both.
inline std::vector<NamedContent> tetrahedron_files() {
  using namespace tetrahedron;  // NOLINT(google-build-using-namespace)
  return {{"tetrahedron.obj", obj()},      {"ascii.ply", ascii_ply()},   {"binary.ply", binary_ply()},
          {"ascii.stl", ascii_stl()},      {"binary.stl", binary_stl()}, {"tetrahedron.off", off()},
          {"tetrahedron.dae", collada()},  {"tetrahedron.gltf", gltf()}, {"tetrahedron.glb", glb()},
          {"tetrahedron.3ds", file_3ds()}, {"tetrahedron.fbx", fbx()},   {"tetrahedron.gdf", gdf()},
          {"tetrahedron.dat", nemoh()}};
}

}  // namespace buoyancy
