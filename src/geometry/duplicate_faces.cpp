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
#include "geometry/flatness.h"
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

// Forward less backward uses of an edge by one face.
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
  // A patch of copies is needed if its rim is matched with it.
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

// Decides which opposites are needed. A cluster is connected through any edges, a patch through edges at
// which no other faces meet it.
class Opposites {
 public:
  Opposites(const TriangleMesh& mesh, const std::vector<FaceGroup>& pairs, double tolerance)
      : pairs_(&pairs),
        table_(mesh),
        pair_of_face_(mesh.triangles.size(), -1),
        patches_(pairs.size()),
        clusters_(pairs.size()),
        patch_votes_(pairs.size()),
        cluster_votes_(pairs.size()),
        has_neighbours_(pairs.size(), false),
        is_sheet_(pairs.size(), false),
        is_flat_(pairs.size(), false) {
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      pair_of_face_[static_cast<std::size_t>(pairs[i].even.front())] = static_cast<std::int32_t>(i);
      pair_of_face_[static_cast<std::size_t>(pairs[i].odd.front())] = static_cast<std::int32_t>(i);
    }
    for_each_edge([this](const std::vector<std::int32_t>& here, std::size_t others) {
      for (const std::int32_t pair : here) clusters_.unite(here.front(), pair);
      if (here.size() == 2 && others == 0) patches_.unite(here[0], here[1]);
    });
    for_each_edge([this](const std::vector<std::int32_t>& here, std::size_t others) {
      const auto cluster = static_cast<std::size_t>(clusters_.representative(here.front()));
      if (others == 0) {
        if (here.size() == 1) is_sheet_[cluster] = true;
        return;
      }
      has_neighbours_[cluster] = true;
      if (here.size() != 1) return;
      const auto patch = static_cast<std::size_t>(patches_.representative(here.front()));
      for (Votes* votes : {&patch_votes_[patch], &cluster_votes_[cluster]}) {
        (others % 2 == 1 ? votes->one : votes->none) = true;
      }
    });
    std::vector<std::vector<std::int32_t>> of_patch(pairs.size());
    std::vector<std::vector<std::int32_t>> of_cluster(pairs.size());  // of those that may be sheets
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto pair = static_cast<std::int32_t>(i);
      const auto cluster = static_cast<std::size_t>(clusters_.representative(pair));
      of_patch[static_cast<std::size_t>(patches_.representative(pair))].push_back(pairs[i].even.front());
      if (is_sheet_[cluster] && !has_neighbours_[cluster])
        of_cluster[cluster].push_back(pairs[i].even.front());
    }
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      is_flat_[i] = !of_patch[i].empty() && distance_from_plane(mesh, of_patch[i]) <= tolerance;
      is_sheet_[i] = !of_cluster[i].empty() && distance_from_plane(mesh, of_cluster[i]) <= tolerance;
    }
  }

  // A flat sheet with an open rim, not connected to other faces.
  bool is_sheet(std::size_t pair) {
    return is_sheet_[static_cast<std::size_t>(clusters_.representative(static_cast<std::int32_t>(pair)))];
  }

  bool one_stays(std::size_t pair) {
    const auto i = static_cast<std::int32_t>(pair);
    const auto cluster = static_cast<std::size_t>(clusters_.representative(i));
    if (!has_neighbours_[cluster]) return !is_sheet_[cluster];
    const auto patch = static_cast<std::size_t>(patches_.representative(i));
    if (!is_flat_[patch]) return true;
    Votes votes = patch_votes_[patch];
    if (!votes.one && !votes.none) votes = cluster_votes_[cluster];
    return votes.one;
  }

 private:
  // Whether one or none of two opposites is needed somewhere at the rim.
  struct Votes {
    bool one = false;
    bool none = false;
  };

  // Calls visit(pairs, number of other faces) for each edge with pairs.
  template <typename Visit>
  void for_each_edge(const Visit& visit) {
    std::vector<std::int32_t> here;
    for (std::size_t e = 0; e < table_.size(); ++e) {
      here.clear();
      const auto uses = table_.uses(static_cast<std::int32_t>(e));
      for (const EdgeUse& use : uses) {
        const std::int32_t pair = pair_of_face_[static_cast<std::size_t>(use.face)];
        if (pair >= 0 && (*pairs_)[static_cast<std::size_t>(pair)].even.front() == use.face)
          here.push_back(pair);
      }
      if (!here.empty()) visit(here, uses.size() - 2 * here.size());
    }
  }

  const std::vector<FaceGroup>* pairs_;
  EdgeTable table_;
  std::vector<std::int32_t> pair_of_face_;  // -1: none
  DisjointSets patches_, clusters_;
  std::vector<Votes> patch_votes_, cluster_votes_;  // by representative
  std::vector<bool> has_neighbours_, is_sheet_;     // by representative of a cluster
  std::vector<bool> is_flat_;                       // by representative of a patch
};

// Of faces with both copies and opposites, removes opposites in pairs, which changes no edge's net uses,
// until no copies or one pair is left.
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

void remove_opposites(TriangleMesh& mesh, double tolerance, RepairReport& report) {
  std::vector<FaceGroup> pairs = group_faces(mesh);
  std::erase_if(pairs, [](const FaceGroup& group) { return !group.has_opposites() || group.has_copies(); });
  if (pairs.empty()) return;
  Opposites opposites(mesh, pairs, tolerance);
  std::size_t sheets = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) sheets += opposites.is_sheet(i) ? 1 : 0;
  if (2 * sheets == mesh.triangles.size()) return;
  std::vector<bool> backs(mesh.triangles.size(), false);
  std::vector<bool> both(mesh.triangles.size(), false);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto even = static_cast<std::size_t>(pairs[i].even.front());
    const auto odd = static_cast<std::size_t>(pairs[i].odd.front());
    if (opposites.one_stays(i)) {
      backs[std::max(even, odd)] = true;
    } else {
      both[even] = true;
      both[odd] = true;
    }
  }
  std::vector<bool> backs_of_rest;  // `backs` without the faces that `both` removes
  for (std::size_t f = 0; f < both.size(); ++f) {
    if (!both[f]) backs_of_rest.push_back(backs[f]);
  }
  remove_faces(mesh, both, RepairKind::kRemoveOpposites, report);
  remove_faces(mesh, backs_of_rest, RepairKind::kRemoveBackFaces, report);
}

}  // namespace

void remove_duplicate_faces(TriangleMesh& mesh, double tolerance, RepairReport& report) {
  TriangleMesh unified = mesh;
  const double volume_bound = unify_coincident_patches(unified, tolerance);
  const std::size_t steps = report.steps.size();
  remove_copies(unified, report);
  cancel_mixed_copies(unified, report);
  remove_copies(unified, report);
  remove_opposites(unified, tolerance, report);
  if (report.steps.size() == steps) return;
  mesh = std::move(unified);
  report.volume_bound += volume_bound;
}

}  // namespace buoyancy
