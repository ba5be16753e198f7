#include "scene/subdivision_report.h"

#include <utility>

#include "scene/up_axis.h"

namespace buoyancy {
namespace {

// Returns the facts with which a part, compartment or tank begins. volume: the key of its volume.
Facts section_facts(std::string_view section, const std::string& name, const PreparedMesh& mesh,
                    const Scene& scene, std::string_view volume) {
  Facts facts;
  facts.line(section).say("'{}'", name);
  facts.add("name", name).add("mesh", mesh_index(mesh, scene)).add(volume, mesh.mesh.volume, "{:6} m^3");
  return facts;
}

template <typename Section>
void add_users(const std::vector<Section>& sections, std::string_view section, const Body& body,
               const PreparedMesh& mesh, std::vector<SectionUser>& users) {
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].prepared_mesh == &mesh) users.push_back({body.id, section, i, sections[i].name});
  }
}

}  // namespace

std::size_t mesh_index(const PreparedMesh& mesh, const Scene& scene) {
  std::size_t index = 0;
  while (scene.meshes()[index].get() != &mesh) ++index;
  return index;
}

void add_subdivision(const Body& body, const Scene& scene, Facts& facts) {
  if (body.parts != nullptr) {
    facts.list("parts");
    for (const BodyPart& part : *body.parts) {
      facts.include_in("parts", section_facts("part", part.name, *part.prepared_mesh, scene, "volume"));
    }
  }
  if (body.subdivision == nullptr) return;
  facts.list("compartments");
  for (const BodyCompartment& compartment : body.subdivision->compartments) {
    Facts one = section_facts("compartment", compartment.name, *compartment.prepared_mesh, scene, "volume");
    one.add("permeability", compartment.permeability, "permeability {}");
    one.add("flooded", compartment.flooded, "flooded {}");
    facts.include_in("compartments", std::move(one));
  }
  facts.list("tanks");
  for (const BodyTank& tank : body.subdivision->tanks) {
    Facts one = section_facts("tank", tank.name, *tank.prepared_mesh, scene, "capacity");
    one.add("liquid_volume", tank.liquid_volume, "holds {:6} m^3");
    one.add("fill", tank.liquid_volume / tank.capacity(), "fill {:6}");
    one.add("density", tank.density, "{} kg/m^3");
    one.add("liquid_mass", tank.density * tank.liquid_volume, "{:6} kg");
    if (tank.piston_axis_B) {
      one.say("piston along {}", axis_name(*tank.piston_axis_B)).add("piston_axis", *tank.piston_axis_B);
    }
    facts.include_in("tanks", std::move(one));
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

Json to_json(const SectionUser& user) {
  return {{"body", user.body_id}, {"section", user.section}, {"index", user.index}, {"name", user.name}};
}

}  // namespace buoyancy
