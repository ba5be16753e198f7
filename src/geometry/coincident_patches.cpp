#include "geometry/coincident_patches.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/disjoint_sets.h"
#include "geometry/edge_uses.h"
#include "geometry/flatness.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

struct Patch {
  std::vector<std::int32_t> faces;                // ascending
  std::vector<std::pair<std::int32_t, int>> rim;  // edge and net uses; ascending
  bool eligible = true;
};

// Returns the patches by their first faces, each with its rim.
std::vector<Patch> find_patches(const TriangleMesh& mesh, const EdgeTable& table) {
  DisjointSets connected(mesh.triangles.size());
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto uses = table.uses(static_cast<std::int32_t>(e));
    if (uses.size() == 2) connected.unite(uses[0].face, uses[1].face);
  }
  std::vector<Patch> patches;
  std::vector<std::size_t> patch_of_face(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto face = static_cast<std::int32_t>(f);
    const auto first = static_cast<std::size_t>(connected.representative(face));
    if (first == f) patches.emplace_back();
    patch_of_face[f] = first == f ? patches.size() - 1 : patch_of_face[first];
    patches[patch_of_face[f]].faces.push_back(face);
  }
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto uses = table.uses(static_cast<std::int32_t>(e));
    if (uses.size() == 2) continue;
    for (const EdgeUse& use : uses) {
      Patch& patch = patches[patch_of_face[static_cast<std::size_t>(use.face)]];
      // A rim edge that the patch uses twice has no direction.
      const auto edge = static_cast<std::int32_t>(e);
      if (uses.size() == 1 || (!patch.rim.empty() && patch.rim.back().first == edge)) patch.eligible = false;
      patch.rim.emplace_back(edge, use.forward ? 1 : -1);
    }
  }
  return patches;
}

bool same_edges(const Patch& a, const Patch& b) {
  return std::equal(a.rim.begin(), a.rim.end(), b.rim.begin(), b.rim.end(),
                    [](const auto& s, const auto& t) { return s.first == t.first; });
}

bool same_direction(const Patch& a, const Patch& b) {
  return a.rim == b.rim;
}

bool opposite_direction(const Patch& a, const Patch& b) {
  return std::equal(a.rim.begin(), a.rim.end(), b.rim.begin(), b.rim.end(),
                    [](const auto& s, const auto& t) { return s.second == -t.second; });
}

}  // namespace

double unify_coincident_patches(TriangleMesh& mesh, double tolerance) {
  const EdgeTable table(mesh);
  std::vector<Patch> patches = find_patches(mesh, table);
  std::erase_if(patches, [](const Patch& patch) { return !patch.eligible || patch.rim.empty(); });
  std::stable_sort(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
    return std::lexicographical_compare(a.rim.begin(), a.rim.end(), b.rim.begin(), b.rim.end(),
                                        [](const auto& s, const auto& t) { return s.first < t.first; });
  });

  double volume_bound = 0.0;
  std::vector<bool> removed(mesh.triangles.size(), false);
  std::vector<Triangle> added;
  for (std::size_t begin = 0; begin < patches.size();) {
    const Patch& first = patches[begin];
    const double first_distance = distance_from_plane(mesh, first.faces);
    std::size_t end = begin + 1;
    for (; end < patches.size() && same_edges(first, patches[end]); ++end) {
      const Patch& patch = patches[end];
      const bool same = same_direction(first, patch);
      if (patch.faces.size() == 1 || (!same && !opposite_direction(first, patch))) continue;
      const double distance = std::max(first_distance, distance_from_plane(mesh, patch.faces));
      if (!(distance <= tolerance)) continue;
      for (const std::int32_t face : patch.faces) {
        removed[static_cast<std::size_t>(face)] = true;
        volume_bound +=
            2.0 * swept_volume_bound(mesh, mesh.triangles[static_cast<std::size_t>(face)], distance);
      }
      for (const std::int32_t face : first.faces) {
        Triangle copy = mesh.triangles[static_cast<std::size_t>(face)];
        if (!same) std::swap(copy[1], copy[2]);
        added.push_back(copy);
      }
    }
    begin = end;
  }
  std::size_t kept = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!removed[f]) mesh.triangles[kept++] = mesh.triangles[f];
  }
  mesh.triangles.resize(kept);
  mesh.triangles.insert(mesh.triangles.end(), added.begin(), added.end());
  return volume_bound;
}

}  // namespace buoyancy
