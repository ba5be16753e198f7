// The part of the report of `buoyancyd --check` about parts, compartments and tanks: see scene_report.h.
#pragma once

#include <string_view>
#include <vector>

#include "base/facts.h"
#include "scene/scene.h"

namespace buoyancy {

// Returns the index of a mesh among the scene's meshes.
std::size_t mesh_index(const PreparedMesh& mesh, const Scene& scene);

// Adds "parts", "compartments" and "tanks" to a body that has them, with a line for each; "mesh" is an index
// into the scene's meshes.
void add_subdivision(const Body& body, const Scene& scene, Facts& facts);

// A part, compartment or tank that uses a certain mesh.
struct SectionUser {
  std::int32_t body_id = 0;
  std::string_view section;  // "part", "compartment" or "tank"
  std::size_t index = 0;     // among the sections of this kind
  std::string_view name;     // of the scene
};

// Returns what uses the mesh, in the order of the bodies.
std::vector<SectionUser> section_users_of(const PreparedMesh& mesh, const Scene& scene);
Json to_json(const SectionUser& user);

}  // namespace buoyancy
