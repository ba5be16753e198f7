#include "scene/scene_fingerprint.h"

#include <bit>
#include <map>
#include <string_view>
#include <vector>

// Inlined, since users of the installed libraries would have to link the xxHash library otherwise.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "scene/toml_table.h"

namespace buoyancy {
namespace {

class Hash {
 public:
  Hash() { XXH3_64bits_reset(&state_); }

  // Numbers are preceded by their count, so that one array cannot pass into the next.
  template <typename Number>
  void add(const std::vector<Number>& numbers) {
    add(static_cast<std::uint64_t>(numbers.size()));
    XXH3_64bits_update(&state_, numbers.data(), numbers.size() * sizeof(Number));
  }
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    XXH3_64bits_update(&state_, text.data(), text.size());
  }
  void add(std::uint64_t number) { XXH3_64bits_update(&state_, &number, sizeof number); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }

  std::uint64_t digest() const { return XXH3_64bits_digest(&state_); }

 private:
  XXH3_state_t state_{};
};

void add_node(Hash& hash, const toml::node& node);

// Leaves out [body.client], and the names of files, whose content counts.
void add_table(Hash& hash, const toml::table& table) {
  for (const auto& [key, value] : table) {  // sorted
    if (key == "client" || key == "mesh" || key == "file") continue;
    hash.add(key.str());
    add_node(hash, value);
  }
  hash.add(std::string_view());
}

void add_node(Hash& hash, const toml::node& node) {
  if (const toml::table* const table = node.as_table()) return add_table(hash, *table);
  if (const toml::array* const array = node.as_array()) {
    hash.add(static_cast<std::uint64_t>(array->size()));
    for (const toml::node& element : *array) add_node(hash, element);
  } else if (const auto number = node.value<double>()) {
    hash.add(*number);
  } else if (const auto text = node.value<std::string_view>()) {
    hash.add(*text);
  } else if (const auto flag = node.value<bool>()) {
    hash.add(std::uint64_t{*flag});
  }
}

}  // namespace

std::uint64_t fingerprint_of(const toml::table& scene_file) {
  Hash hash;
  add_table(hash, scene_file);
  return hash.digest();
}

std::int64_t scene_fingerprint(const Scene& scene) {
  Hash hash;
  hash.add(scene.text_fingerprint());
  std::map<const PreparedMesh*, std::uint64_t> places;
  for (const std::unique_ptr<PreparedMesh>& prepared : scene.meshes()) {
    places.emplace(prepared.get(), places.size());
    const HydrostaticMesh& mesh = prepared->mesh;
    for (const double coordinate : mesh.center_B) hash.add(coordinate);
    for (const std::vector<double>* axis : {&mesh.surface.x, &mesh.surface.y, &mesh.surface.z})
      hash.add(*axis);
    hash.add(mesh.surface.triangles);
    hash.add(mesh.boundary_vertices);
  }
  for (const Body& body : scene.bodies()) hash.add(places.at(body.prepared_mesh));
  if (scene.sea() != nullptr) {
    for (const WaveComponent& component : scene.sea()->components()) {
      for (const double number :
           {component.amplitude, component.angular_frequency, component.direction, component.phase}) {
        hash.add(number);
      }
    }
  }
  return static_cast<std::int64_t>(hash.digest());
}

}  // namespace buoyancy
