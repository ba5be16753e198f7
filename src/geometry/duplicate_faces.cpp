#include "geometry/duplicate_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "geometry/coincident_patches.h"
#include "geometry/disjoint_sets.h"
#include "geometry/edge_uses.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

// All faces with the same three vertices.
struct FaceGroup {
  std::vector<std::int32_t> even, odd;  // faces by the parity of their vertices' order; ascending

  bool has_copies() const { return even.size() > 1 || odd.size() > 1; }
  bool has_opposites() const { return !even.empty() && !odd.empty(); }
  std::int32_t first_face() const {
    if (even.empty() || odd.empty()) return even.empty() ? odd.front() : even.front();
    return std::min(even.front(), odd.front());
  }
};

// Returns the groups of two faces or more, by their first faces.
std::vector<FaceGroup> group_faces(const TriangleMesh& mesh) {
  struct Entry {
    Triangle vertices;  // ascending
    bool odd;
    std::int32_t face;

    bool operator<(const Entry& other) const {
      return std::tie(vertices, face) < std::tie(other.vertices, other.face);
    }
  };
  std::vector<Entry> entries;
  entries.reserve(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& face = mesh.triangles[f];
    const bool odd = (face[0] > face[1]) != ((face[1] > face[2]) != (face[2] > face[0]));
    Triangle vertices = face;
    std::sort(vertices.begin(), vertices.end());
    entries.push_back({vertices, odd, static_cast<std::int32_t>(f)});
  }
  std::sort(entries.begin(), entries.end());
  std::vector<FaceGroup> groups;
  for (std::size_t begin = 0; begin < entries.size();) {
    std::size_t end = begin + 1;
    while (end < entries.size() && entries[end].vertices == entries[begin].vertices) ++end;
    if (end - begin > 1) {
      FaceGroup& group = groups.emplace_back();
      for (; begin < end; ++begin)
        (entries[begin].odd ? group.odd : group.even).push_back(entries[begin].face);
    }
    begin = end;
  }
  std::sort(groups.begin(), groups.end(),
            [](const FaceGroup& a, const FaceGroup& b) { return a.first_face() < b.first_face(); });
  return groups;
}

// Removes the marked faces and reports them, if there are any.
void remove_faces(TriangleMesh& mesh, const std::vector<bool>& removed, RepairKind kind,
                  RepairReport& report) {
  RepairStep step;
  step.kind = kind;
  std::vector<Triangle> kept;
  kept.reserve(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (!removed[f]) {
      kept.push_back(mesh.triangles[f]);
      continue;
    }
    ++step.count;
    step.area += area_of_face(mesh, mesh.triangles[f]);
  }
  if (step.count == 0) return;
  mesh.triangles = std::move(kept);
  report.steps.push_back(step);
}

// Appends all copies but the first.
void add_copies(const std::vector<std::int32_t>& faces, std::vector<std::int32_t>& copies) {
  if (faces.size() > 1) copies.insert(copies.end(), faces.begin() + 1, faces.end());
}

// Returns 1 if the face uses the edge forward, -1 if backward.
int direction_of(const EdgeTable& table, std::int32_t edge, const Triangle& face) {
  const Edge& ends = table.edge(edge);
  for (std::size_t side = 0; side < 3; ++side) {
    if (face[side] == ends[0] && face[(side + 1) % 3] == ends[1]) return 1;
  }
  return -1;
}

void remove_copies(TriangleMesh& mesh, RepairReport& report) {
  std::vector<std::int32_t> copies;
  for (const FaceGroup& group : group_faces(mesh)) {
    add_copies(group.even, copies);
    add_copies(group.odd, copies);
  }
  if (copies.empty()) return;

  const EdgeTable table(mesh);
  std::vector<std::int64_t> net_of_copies(table.size(), 0);
  std::vector<std::int32_t> copy_at_edge(table.size(), -1);  // the first, by position in `copies`
  DisjointSets patches(copies.size());
  for (std::size_t i = 0; i < copies.size(); ++i) {
    for (const std::int32_t e : table.edges_of(copies[i])) {
      const auto edge = static_cast<std::size_t>(e);
      net_of_copies[edge] += direction_of(table, e, mesh.triangles[static_cast<std::size_t>(copies[i])]);
      if (copy_at_edge[edge] < 0) copy_at_edge[edge] = static_cast<std::int32_t>(i);
      patches.unite(copy_at_edge[edge], static_cast<std::int32_t>(i));
    }
  }
  // A patch of copies is needed if the edges at its rim are matched while it is there.
  std::vector<bool> has_rim(copies.size(), false);
  std::vector<bool> has_unmatched_rim(copies.size(), false);
  for (std::size_t edge = 0; edge < table.size(); ++edge) {
    if (copy_at_edge[edge] < 0 || net_of_copies[edge] == 0) continue;
    const auto patch = static_cast<std::size_t>(patches.representative(copy_at_edge[edge]));
    has_rim[patch] = true;
    if (net_uses(table.uses(static_cast<std::int32_t>(edge))) != 0) has_unmatched_rim[patch] = true;
  }
  std::vector<bool> removed(mesh.triangles.size(), false);
  for (std::size_t i = 0; i < copies.size(); ++i) {
    const auto patch = static_cast<std::size_t>(patches.representative(static_cast<std::int32_t>(i)));
    removed[static_cast<std::size_t>(copies[i])] = !has_rim[patch] || has_unmatched_rim[patch];
  }
  remove_faces(mesh, removed, RepairKind::kRemoveDuplicates, report);
}

// Where faces have both copies and opposites, removes opposites in pairs until one kind or one pair is left.
// This changes no edge's net uses.
void cancel_mixed_copies(TriangleMesh& mesh, RepairReport& report) {
  std::vector<bool> removed(mesh.triangles.size(), false);
  for (const FaceGroup& group : group_faces(mesh)) {
    if (!group.has_copies() || !group.has_opposites()) continue;
    std::size_t pairs = std::min(group.even.size(), group.odd.size());
    if (group.even.size() == group.odd.size()) --pairs;
    for (std::size_t i = 0; i < pairs; ++i) {
      removed[static_cast<std::size_t>(group.even[group.even.size() - 1 - i])] = true;
      removed[static_cast<std::size_t>(group.odd[group.odd.size() - 1 - i])] = true;
    }
  }
  remove_faces(mesh, removed, RepairKind::kRemoveOpposites, report);
}

void remove_back_faces(TriangleMesh& mesh, RepairReport& report) {
  std::vector<bool> removed(mesh.triangles.size(), false);
  for (const FaceGroup& group : group_faces(mesh)) {
    if (!group.has_opposites() || group.has_copies()) continue;
    removed[static_cast<std::size_t>(std::max(group.even.front(), group.odd.front()))] = true;
  }
  remove_faces(mesh, removed, RepairKind::kRemoveBackFaces, report);
}

}  // namespace

void remove_duplicate_faces(TriangleMesh& mesh, double tolerance, RepairReport& report) {
  TriangleMesh unified = mesh;
  const double volume_bound = unify_coincident_patches(unified, tolerance);
  const std::size_t steps = report.steps.size();
  remove_copies(unified, report);
  cancel_mixed_copies(unified, report);
  remove_copies(unified, report);
  remove_back_faces(unified, report);
  if (report.steps.size() == steps) return;
  mesh = std::move(unified);
  report.volume_bound += volume_bound;
}

}  // namespace buoyancy
