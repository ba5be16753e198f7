#include "scene/subdivision_report.h"

#include "base/format.h"

namespace buoyancy {
namespace {

using Json = nlohmann::ordered_json;

std::size_t index_of(const PreparedMesh& mesh, const Scene& scene) {
  std::size_t index = 0;
  while (scene.meshes()[index].get() != &mesh) ++index;
  return index;
}

double volume_of(const PreparedMesh& prepared) {
  return prepared.mesh.volume;
}

// Derived numbers are rounded; the JSON report has all digits.
std::string rounded(double value) {
  return format_number(value, 6);
}

// "  tank          'ballast 1', "
std::string label(std::string section, const std::string& name) {
  section.insert(0, 2, ' ');
  section.resize(16, ' ');
  return section + "'" + name + "', ";
}

double fill_of(const BodyTank& tank) {
  return tank.liquid_volume / tank.capacity();
}

template <typename Section>
void add_users(const std::vector<Section>& sections, std::string_view section, const Body& body,
               const PreparedMesh& mesh, std::vector<SectionUser>& users) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].prepared_mesh == &mesh) users.push_back({body.id, section, i, sections[i].name});
  }
}

}  // namespace

std::string subdivision_text(const Body& body) {
  std::string text;
  if (body.parts != nullptr) {
    for (const BodyPart& part : *body.parts) {
      text += label("part", part.name) + rounded(volume_of(*part.prepared_mesh)) + " m^3\n";
    }
  }
  if (body.subdivision == nullptr) return text;
  for (const BodyCompartment& compartment : body.subdivision->compartments) {
    text += label("compartment", compartment.name) + rounded(volume_of(*compartment.prepared_mesh)) +
            " m^3, permeability ";
    text +=
        format_number(compartment.permeability) + ", flooded " + format_number(compartment.flooded) + "\n";
  }
  for (const BodyTank& tank : body.subdivision->tanks) {
    text += label("tank", tank.name) + rounded(tank.capacity()) + " m^3, holds ";
    text += rounded(tank.liquid_volume) + " m^3, fill " + rounded(fill_of(tank)) + ", ";
    text += format_number(tank.density) + " kg/m^3, " + rounded(tank.density * tank.liquid_volume) + " kg\n";
  }
  return text;
}

void add_subdivision(const Body& body, const Scene& scene, Json& json) {
  if (body.parts != nullptr) {
    Json& parts = json["parts"] = Json::array();
    for (const BodyPart& part : *body.parts) {
      parts.push_back({{"name", part.name},
                       {"mesh", index_of(*part.prepared_mesh, scene)},
                       {"volume", volume_of(*part.prepared_mesh)}});
    }
  }
  if (body.subdivision == nullptr) return;
  Json& compartments = json["compartments"] = Json::array();
  for (const BodyCompartment& compartment : body.subdivision->compartments) {
    compartments.push_back({{"name", compartment.name},
                            {"mesh", index_of(*compartment.prepared_mesh, scene)},
                            {"volume", volume_of(*compartment.prepared_mesh)},
                            {"permeability", compartment.permeability},
                            {"flooded", compartment.flooded}});
  }
  Json& tanks = json["tanks"] = Json::array();
  for (const BodyTank& tank : body.subdivision->tanks) {
    tanks.push_back({{"name", tank.name},
                     {"mesh", index_of(*tank.prepared_mesh, scene)},
                     {"capacity", tank.capacity()},
                     {"liquid_volume", tank.liquid_volume},
                     {"fill", fill_of(tank)},
                     {"density", tank.density},
                     {"liquid_mass", tank.density * tank.liquid_volume}});
  }
}

std::vector<SectionUser> section_users_of(const PreparedMesh& mesh, const Scene& scene) {
  std::vector<SectionUser> users;
  for (const Body& body : scene.bodies()) {
    if (body.parts != nullptr) add_users(*body.parts, "part", body, mesh, users);
    if (body.subdivision == nullptr) continue;
    add_users(body.subdivision->compartments, "compartment", body, mesh, users);
    add_users(body.subdivision->tanks, "tank", body, mesh, users);
  }
  return users;
}

std::string to_text(const SectionUser& user) {
  std::string text(user.section);
  text += " '";
  text += user.name;
  return text + "' of body " + std::to_string(user.body_id);
}

Json to_json(const SectionUser& user) {
  return {{"body", user.body_id}, {"section", user.section}, {"index", user.index}, {"name", user.name}};
}

}  // namespace buoyancy
