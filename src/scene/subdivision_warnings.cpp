#include "scene/subdivision_warnings.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "base/format.h"
#include "geometry/common_volume.h"

namespace buoyancy {
namespace {

OffsetMesh surface_of(const PreparedMesh& prepared) {
  return {&prepared.mesh.surface, prepared.mesh.center_B};
}

// The volumes of pairs of meshes, each computed once.
class PairVolumes {
 public:
  double common(const PreparedMesh& a, const PreparedMesh& b) {
    return find_or_compute(common_, a, b, common_volume);
  }
  double outside(const PreparedMesh& inner, const PreparedMesh& outer) {
    return find_or_compute(outside_, inner, outer, volume_outside);
  }

 private:
  using Pair = std::pair<const PreparedMesh*, const PreparedMesh*>;

  template <typename Compute>
  static double find_or_compute(std::map<Pair, double>& known, const PreparedMesh& a, const PreparedMesh& b,
                                const Compute& compute) {
    const auto [entry, is_new] = known.emplace(Pair{&a, &b}, 0.0);
    if (is_new) entry->second = compute(surface_of(a), surface_of(b));
    return entry->second;
  }

  std::map<Pair, double> common_, outside_;
};

bool is_reported(double volume, const PreparedMesh& a, const PreparedMesh& b) {
  return volume > kReportedVolumeShare * std::min(a.mesh.volume, b.mesh.volume);
}

// "0.125 m^3 (12.5 %)", of the volume of a mesh.
std::string volume_text(double volume, const PreparedMesh& of) {
  return format_number(volume, 3) + " m^3 (" + format_number(100.0 * volume / of.mesh.volume, 3) + " %)";
}

// A compartment or a tank.
struct Space {
  std::string name;  // "compartment 'engine room'"
  const PreparedMesh* prepared = nullptr;
};

std::vector<Space> spaces_of(const Subdivision& subdivision) {
  std::vector<Space> spaces;
  for (const BodyCompartment& compartment : subdivision.compartments) {
    spaces.push_back({"compartment '" + compartment.name + "'", compartment.prepared_mesh});
  }
  for (const BodyTank& tank : subdivision.tanks) {
    spaces.push_back({"tank '" + tank.name + "'", tank.prepared_mesh});
  }
  return spaces;
}

void add_part_warnings(const std::string& body, const std::vector<BodyPart>& parts, PairVolumes& volumes,
                       std::vector<Warning>& warnings) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (std::size_t j = i + 1; j < parts.size(); ++j) {
      const PreparedMesh& a = *parts[i].prepared_mesh;
      const PreparedMesh& b = *parts[j].prepared_mesh;
      const double common = volumes.common(a, b);
      if (!is_reported(common, a, b)) continue;
      const PreparedMesh& smaller = a.mesh.volume < b.mesh.volume ? a : b;
      warnings.push_back({body + ", parts '" + parts[i].name + "' and '" + parts[j].name + "'",
                          "overlap by " + volume_text(common, smaller),
                          "parts that share no volume: it displaces water twice",
                          "a position or a scale, or meshes that run into each other",
                          "Move the parts apart, or merge them where the meshes are made"});
    }
  }
}

void add_space_warnings(const std::string& body, const std::vector<Space>& spaces, const PreparedMesh& hull,
                        PairVolumes& volumes, std::vector<Warning>& warnings) {
  for (std::size_t i = 0; i < spaces.size(); ++i) {
    const PreparedMesh& space = *spaces[i].prepared;
    const double outside = volumes.outside(space, hull);
    if (is_reported(outside, space, hull)) {
      warnings.push_back({body + ", " + spaces[i].name, volume_text(outside, space) + " outside the hull",
                          "a compartment or tank inside the body's mesh",
                          "its position, orientation or scale, or a mesh of the outside of the plating",
                          "Move it, or cut it to the hull where the mesh is made"});
    }
    for (std::size_t j = i + 1; j < spaces.size(); ++j) {
      const PreparedMesh& other = *spaces[j].prepared;
      const double common = volumes.common(space, other);
      if (!is_reported(common, space, other)) continue;
      const PreparedMesh& smaller = space.mesh.volume < other.mesh.volume ? space : other;
      warnings.push_back({body + ", " + spaces[i].name + " and " + spaces[j].name,
                          "overlap by " + volume_text(common, smaller),
                          "spaces that share no volume: it counts twice",
                          "a position or a scale, or a tank inside a compartment",
                          "Move them apart, or cut one out of the other where the meshes are made"});
    }
  }
}

}  // namespace

std::vector<Warning> subdivision_warnings(const Scene& scene) {
  std::vector<Warning> warnings;
  PairVolumes volumes;
  for (const Body& body : scene.bodies()) {
    const std::string name = scene.name() + ": body " + std::to_string(body.id);
    if (body.parts != nullptr) add_part_warnings(name, *body.parts, volumes, warnings);
    if (body.subdivision != nullptr) {
      add_space_warnings(name, spaces_of(*body.subdivision), *body.prepared_mesh, volumes, warnings);
    }
  }
  return warnings;
}

}  // namespace buoyancy
