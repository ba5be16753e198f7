// The part of the report of `buoyancyd --check` about parts, compartments and tanks: see scene_report.h.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "scene/scene.h"

namespace buoyancy {

// Lines of a body's section; empty for a body without any.
std::string subdivision_text(const Body& body);
// Adds "parts", "compartments" and "tanks" to the object of a body that has them; "mesh" is an index into the
// scene's meshes.
void add_subdivision(const Body& body, const Scene& scene, nlohmann::ordered_json& json);

// A part, compartment or tank whose mesh is the one asked for.
struct SectionUser {
  std::int32_t body_id = 0;
  std::string_view section;  // "part", "compartment" or "tank"
  std::size_t index = 0;     // among the sections of this kind
  std::string_view name;     // of the scene
};

// In the order of the bodies.
std::vector<SectionUser> section_users_of(const PreparedMesh& mesh, const Scene& scene);
std::string to_text(const SectionUser& user);  // "tank 'ballast 1' of body 2"
nlohmann::ordered_json to_json(const SectionUser& user);

}  // namespace buoyancy
