#include "geometry/inner_faces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "geometry/disjoint_sets.h"
#include "geometry/edge_insertion.h"
#include "geometry/edge_uses.h"
#include "geometry/exact_predicates.h"
#include "geometry/flat_sheets.h"
#include "geometry/hole_caps.h"
#include "geometry/mass_properties.h"
#include "geometry/mesh_topology.h"
#include "geometry/self_intersection.h"
#include "geometry/swept_volume.h"
#include "geometry/winding_number.h"

namespace buoyancy {
namespace {

constexpr int kMaxNeedleRounds = 4;

// A half-plane that begins at an edge.
struct Ray {
  Vec3 through;         // a point of the half-plane, not on the edge
  std::int32_t face;    // -1: none
  bool front_is_ahead;  // the face's front looks to larger angles
  int half = 0;         // from the first ray: 0 its direction, 1 and 3 beside it, 2 opposite
};

// Sorts half-planes by their angle about the line ab, from the first on. Returns false if two coincide.
// stable_sort: unlike sort it stays within the range also if the predicates are not exact (overflow).
bool sort_by_angle(const Vec3& a, const Vec3& b, std::vector<Ray>& rays) {
  const Vec3 reference = rays.front().through;
  for (std::size_t i = 1; i < rays.size(); ++i) {
    const int side = orient_3d(a, b, reference, rays[i].through);
    rays[i].half = side > 0 ? 1 : 3;
    if (side != 0) continue;
    rays[i].half = 2;
    for (int axis = 0; axis < 3; ++axis) {
      const auto flat = [axis](const Vec3& point) { return project_along_axis(axis, point); };
      const int of_reference = orient_2d(flat(a), flat(b), flat(reference));
      if (of_reference == 0) continue;
      if (orient_2d(flat(a), flat(b), flat(rays[i].through)) == of_reference) return false;
      break;
    }
  }
  std::stable_sort(rays.begin(), rays.end(), [&](const Ray& s, const Ray& t) {
    if (s.half != t.half) return s.half < t.half;
    return orient_3d(a, b, s.through, t.through) > 0;
  });
  for (std::size_t i = 1; i < rays.size(); ++i) {
    if (rays[i - 1].half == rays[i].half && orient_3d(a, b, rays[i - 1].through, rays[i].through) == 0)
      return false;
  }
  return true;
}

// The sides of a connected mesh's faces, joined into cells.
class Cells {
 public:
  explicit Cells(const TriangleMesh& mesh) : mesh_(&mesh), sides_(2 * mesh.triangles.size()) {}

  // Returns false if two faces at an edge coincide.
  bool join() {
    bool distinct = true;
    const EdgeUses edges = collect_edge_uses(*mesh_);
    edges.for_each_edge([&](std::int32_t low, std::span<const EdgeUse> uses) {
      if (!distinct) return;
      std::vector<Ray> rays = rays_of(uses);
      distinct = sort_by_angle(mesh_->vertex(low), mesh_->vertex(uses.front().high), rays);
      for (std::size_t i = 0; i < rays.size(); ++i)
        sides_.unite(side_ahead(rays[i]), side_behind(rays[(i + 1) % rays.size()]));
    });
    if (distinct) distinct = find_outside(edges);
    return distinct;
  }

  bool front_is_outside(std::size_t face) { return is_outside(2 * face); }
  bool back_is_outside(std::size_t face) { return is_outside(2 * face + 1); }

 private:
  static std::int32_t front_of(std::int32_t face) { return 2 * face; }
  static std::int32_t back_of(std::int32_t face) { return 2 * face + 1; }
  static std::int32_t side_ahead(const Ray& ray) {
    return ray.front_is_ahead ? front_of(ray.face) : back_of(ray.face);
  }
  static std::int32_t side_behind(const Ray& ray) {
    return ray.front_is_ahead ? back_of(ray.face) : front_of(ray.face);
  }
  bool is_outside(std::size_t side) {
    return sides_.representative(static_cast<std::int32_t>(side)) == outside_;
  }

  std::vector<Ray> rays_of(std::span<const EdgeUse> uses) const {
    std::vector<Ray> rays;
    for (const EdgeUse& use : uses) rays.push_back({mesh_->vertex(use.third), use.face, use.forward});
    return rays;
  }

  // Returns the lexicographically last vertex by x, y and z.
  std::int32_t extreme_vertex() const {
    std::int32_t last = mesh_->triangles.front()[0];
    const auto key = [this](std::int32_t v) {
      const Vec3 point = mesh_->vertex(v);
      return std::tuple(point.x(), point.y(), point.z());
    };
    for (const Triangle& face : mesh_->triangles) {
      for (const std::int32_t v : face) {
        if (key(v) > key(last)) last = v;
      }
    }
    return last;
  }

  // Sets the cell of the outside; returns false if it is not found. Seen from above, all edges at the extreme
  // vertex lie within half a turn, and no face lies to the right of the outermost one, the topmost if several
  // coincide.
  bool find_outside(const EdgeUses& edges) {
    const std::int32_t v = extreme_vertex();
    const Vec3 apex = mesh_->vertex(v);
    const auto above = [](const Vec3& point) { return project_along_axis(2, point); };
    std::int32_t outermost = -1;
    for (const Triangle& face : mesh_->triangles) {
      if (std::find(face.begin(), face.end(), v) == face.end()) continue;
      for (const std::int32_t w : face) {
        const Vec3 end = mesh_->vertex(w);
        if (w == v || w == outermost || above(end) == above(apex)) continue;
        if (outermost < 0) {
          outermost = w;
          continue;
        }
        const Vec3 so_far = mesh_->vertex(outermost);
        int turn = orient_2d(above(apex), above(so_far), above(end));
        if (turn == 0) {
          // Seen from above, both have the same direction: the steeper one is above the other.
          const Eigen::Index across = so_far.x() != apex.x() ? 0 : 1;
          turn = orient_2d({apex(across), apex.z()}, {so_far(across), so_far.z()}, {end(across), end.z()});
        }
        if (turn < 0) outermost = w;
      }
    }
    if (outermost < 0) return false;
    const Vec3 end = mesh_->vertex(outermost);
    const Vec3 along = end - apex;
    const Vec3 outside_point = apex + Vec3(along.y(), -along.x(), 0.0);
    if (orient_2d(above(apex), above(end), above(outside_point)) >= 0) return false;

    const std::int32_t low = std::min(v, outermost);
    const std::int32_t high = std::max(v, outermost);
    bool found = false;
    edges.for_each_edge([&](std::int32_t edge_low, std::span<const EdgeUse> uses) {
      if (edge_low != low || uses.front().high != high) return;
      std::vector<Ray> rays = rays_of(uses);
      rays.push_back({outside_point, -1, false});
      if (!sort_by_angle(mesh_->vertex(low), mesh_->vertex(high), rays)) return;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        if (rays[i].face >= 0) continue;
        outside_ = sides_.representative(side_ahead(rays[(i + rays.size() - 1) % rays.size()]));
        found = true;
      }
    });
    return found;
  }

  const TriangleMesh* mesh_;
  DisjointSets sides_;
  std::int32_t outside_ = -1;
};

enum class Fate : std::uint8_t { kStays, kTurned, kInner, kSheet };

struct Verdict {
  std::vector<Fate> fates;  // by face; empty: the component stays as it is, because of the obstacle
  RepairObstacle obstacle = RepairObstacle::kLeak;
};

// Returns the faces with this fate, grouped by their connection through edges.
std::vector<FaceList> connected_faces(const TriangleMesh& mesh, const std::vector<Fate>& fates, Fate fate) {
  DisjointSets connected(mesh.triangles.size());
  collect_edge_uses(mesh).for_each_edge([&](std::int32_t, std::span<const EdgeUse> uses) {
    std::int32_t first = -1;
    for (const EdgeUse& use : uses) {
      if (fates[static_cast<std::size_t>(use.face)] != fate) continue;
      if (first < 0) first = use.face;
      connected.unite(first, use.face);
    }
  });
  std::vector<FaceList> lists;
  std::vector<std::size_t> list_of(mesh.triangles.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    if (fates[f] != fate) continue;
    const auto first = static_cast<std::size_t>(connected.representative(static_cast<std::int32_t>(f)));
    if (first == f) lists.emplace_back();
    list_of[f] = first == f ? lists.size() - 1 : list_of[first];
    lists[list_of[f]].push_back(static_cast<std::int32_t>(f));
  }
  return lists;
}

// Returns whether a sheet is a fin rather than a wall with a hole, through which the outside reaches its
// back. The free edges of a fin run around most of it, from where it is attached; those of a hole close, or
// cut off a corner.
bool is_fin(const TriangleMesh& mesh, const FaceList& sheet, const std::vector<Edge>& boundary) {
  std::vector<Edge> free;
  double area = 0.0;
  for (const std::int32_t f : sheet) {
    const Triangle& face = mesh.triangles[static_cast<std::size_t>(f)];
    area += area_of_face(mesh, face);
    for (std::size_t side = 0; side < 3; ++side) {
      const Edge edge{face[side], face[(side + 1) % 3]};
      if (std::binary_search(boundary.begin(), boundary.end(), edge)) free.push_back(edge);
    }
  }
  if (has_closed_loop(free)) return false;
  std::int64_t work_left = kCapWork;
  return measure_hole(mesh, {free, {}}, work_left).area >= 0.5 * area;
}

// Returns an obstacle unless all faces to be removed lie inside the skin, or outside it if they are sheets.
std::optional<RepairObstacle> misplaced_face(const TriangleMesh& mesh, const std::vector<Fate>& fates,
                                             const std::vector<Triangle>& skin) {
  std::int64_t faces_left = 50'000'000 + 1'000 * static_cast<std::int64_t>(fates.size());
  const WindingNumber winding_number(mesh, skin);
  for (std::size_t f = 0; f < fates.size(); ++f) {
    if (fates[f] != Fate::kInner && fates[f] != Fate::kSheet) continue;
    const auto [a, b, c] = mesh.triangles[f];
    const WindingNumber::Position position =
        winding_number.about((mesh.vertex(a) + mesh.vertex(b) + mesh.vertex(c)) / 3.0);
    if (!position.touched && (position.winding != 0) != (fates[f] == Fate::kInner))
      return RepairObstacle::kLeak;
    faces_left -= position.faces_met;
    if (faces_left < 0) return RepairObstacle::kTooMany;
  }
  return std::nullopt;
}

Verdict judge(const TriangleMesh& mesh, double tolerance) {
  for (const Triangle& face : mesh.triangles) {
    if (collinear(mesh.vertex(face[0]), mesh.vertex(face[1]), mesh.vertex(face[2])))
      return {{}, RepairObstacle::kSelfIntersection};
  }
  bool cut_off = false;
  if (count_intersecting_pairs(mesh, &cut_off) > 0) return {{}, RepairObstacle::kSelfIntersection};
  if (cut_off) return {{}, RepairObstacle::kTooMany};
  Cells cells(mesh);
  if (!cells.join()) return {{}, RepairObstacle::kSelfIntersection};

  Verdict verdict;
  std::vector<Fate>& fates = verdict.fates;
  fates.resize(mesh.triangles.size(), Fate::kStays);
  double front_area = 0.0;  // of faces with the outside on their front
  double back_area = 0.0;
  for (std::size_t f = 0; f < fates.size(); ++f) {
    const bool front = cells.front_is_outside(f);
    const bool back = cells.back_is_outside(f);
    if (front == back) {
      fates[f] = front ? Fate::kSheet : Fate::kInner;
      continue;
    }
    fates[f] = front ? Fate::kStays : Fate::kTurned;
    (front ? front_area : back_area) += area_of_face(mesh, mesh.triangles[f]);
  }
  TriangleMesh skin{mesh.x, mesh.y, mesh.z, {}};
  for (std::size_t f = 0; f < fates.size(); ++f) {
    if (fates[f] != Fate::kStays && fates[f] != Fate::kTurned) continue;
    if (back_area > front_area) fates[f] = fates[f] == Fate::kStays ? Fate::kTurned : Fate::kStays;
    skin.triangles.push_back(mesh.triangles[f]);
    if (fates[f] == Fate::kTurned) std::swap(skin.triangles.back()[1], skin.triangles.back()[2]);
  }
  if (skin.triangles.empty() || !mesh_topology(skin).counts.all_matched()) return {{}, RepairObstacle::kLeak};
  const std::vector<FaceList> sheets = connected_faces(mesh, fates, Fate::kSheet);
  const std::vector<bool> left_out =
      sheets_to_leave_out(mesh, sheets, tolerance, std::abs(mass_properties(skin).volume));
  std::vector<Edge> boundary = mesh_topology(mesh).boundary;
  std::sort(boundary.begin(), boundary.end());
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    if (!left_out[i] || !is_fin(mesh, sheets[i], boundary)) return {{}, RepairObstacle::kLeak};
  }
  if (const auto obstacle = misplaced_face(mesh, fates, skin.triangles)) return {{}, *obstacle};
  return verdict;
}

// Marks the components with an unmatched edge of two faces or more.
std::vector<bool> faulty_components(const MeshTopology& topology, const EdgeTable& table) {
  std::vector<bool> faulty(static_cast<std::size_t>(topology.components), false);
  for (std::size_t e = 0; e < table.size(); ++e) {
    const auto uses = table.uses(static_cast<std::int32_t>(e));
    if (uses.size() < 2 || net_uses(uses) == 0) continue;
    faulty[static_cast<std::size_t>(
        topology.component_of_face[static_cast<std::size_t>(uses.front().face)])] = true;
  }
  return faulty;
}

// Returns the faces of each faulty component.
std::vector<FaceList> faulty_faces(const TriangleMesh& mesh) {
  const MeshTopology topology = mesh_topology(mesh);
  if (topology.misoriented.empty() && topology.non_manifold.empty()) return {};
  const std::vector<bool> faulty = faulty_components(topology, EdgeTable(mesh));
  std::vector<FaceList> faces(faulty.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto component = static_cast<std::size_t>(topology.component_of_face[f]);
    if (faulty[component]) faces[component].push_back(static_cast<std::int32_t>(f));
  }
  std::erase_if(faces, [](const FaceList& list) { return list.empty(); });
  return faces;
}

// Inserts the middle corner of each face of zero area into its longest side, so that the face vanishes.
bool remove_needles(TriangleMesh& mesh, const std::vector<FaceList>& components) {
  std::vector<EdgeInsertion> insertions;
  for (const FaceList& component : components) {
    for (const std::int32_t f : component) {
      const Triangle& face = mesh.triangles[static_cast<std::size_t>(f)];
      if (!collinear(mesh.vertex(face[0]), mesh.vertex(face[1]), mesh.vertex(face[2]))) continue;
      std::size_t longest = 0;
      const auto length = [&](std::size_t side) {
        return (mesh.vertex(face[(side + 1) % 3]) - mesh.vertex(face[side])).norm();
      };
      for (std::size_t side = 1; side < 3; ++side) {
        if (length(side) > length(longest)) longest = side;
      }
      const std::int32_t from = face[longest];
      const std::int32_t to = face[(longest + 1) % 3];
      const std::int32_t middle = face[(longest + 2) % 3];
      const Edge edge{std::min(from, to), std::max(from, to)};
      const double along = (mesh.vertex(middle) - mesh.vertex(edge[0])).norm() / length(longest);
      insertions.push_back({edge, along, middle, 0.0});
    }
  }
  if (insertions.empty()) return false;
  std::sort(insertions.begin(), insertions.end());
  const auto same = [](const EdgeInsertion& a, const EdgeInsertion& b) {
    return a.edge == b.edge && a.vertex == b.vertex;
  };
  insertions.erase(std::unique(insertions.begin(), insertions.end(), same), insertions.end());
  mesh = split_edges(mesh, insertions).mesh;
  return true;
}

// Returns the faces as a mesh with vertices of its own, in the same order.
TriangleMesh extract(const TriangleMesh& mesh, const FaceList& faces) {
  std::vector<std::int32_t> vertices;
  for (const std::int32_t f : faces) {
    const Triangle& face = mesh.triangles[static_cast<std::size_t>(f)];
    vertices.insert(vertices.end(), face.begin(), face.end());
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  TriangleMesh part;
  for (const std::int32_t v : vertices) part.add_vertex(mesh.vertex(v));
  for (const std::int32_t f : faces) {
    Triangle face = mesh.triangles[static_cast<std::size_t>(f)];
    for (std::int32_t& v : face) {
      v = static_cast<std::int32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
    }
    part.triangles.push_back(face);
  }
  return part;
}

// Adds to the report's entry for this obstacle.
void add_skipped(RepairObstacle obstacle, std::int64_t faces, RepairReport& report) {
  for (SkippedRepair& skipped : report.skipped) {
    if (skipped.kind != RepairKind::kRemoveInnerFaces || skipped.obstacle != obstacle) continue;
    skipped.faces += faces;
    return;
  }
  report.skipped.push_back({RepairKind::kRemoveInnerFaces, obstacle, faces});
}

}  // namespace

void remove_inner_faces(TriangleMesh& mesh, double tolerance, RepairReport& report) {
  std::vector<FaceList> components = faulty_faces(mesh);
  if (components.empty()) return;
  TriangleMesh repaired = mesh;
  for (int round = 0; round < kMaxNeedleRounds && remove_needles(repaired, components); ++round)
    components = faulty_faces(repaired);

  std::vector<Fate> fates(repaired.triangles.size(), Fate::kStays);
  std::erase_if(report.skipped, [](const SkippedRepair& earlier) {
    return earlier.kind == RepairKind::kRemoveInnerFaces;  // of an earlier round
  });
  for (const FaceList& component : components) {
    const Verdict verdict = judge(extract(repaired, component), tolerance);
    if (verdict.fates.empty()) {
      add_skipped(verdict.obstacle, static_cast<std::int64_t>(component.size()), report);
      continue;
    }
    for (std::size_t i = 0; i < component.size(); ++i)
      fates[static_cast<std::size_t>(component[i])] = verdict.fates[i];
  }

  RepairStep turned;
  turned.kind = RepairKind::kTurnFaces;
  RepairStep inner;
  inner.kind = RepairKind::kRemoveInnerFaces;
  RepairStep sheets;
  sheets.kind = RepairKind::kRemoveSheets;
  std::vector<Triangle> kept;
  for (std::size_t f = 0; f < fates.size(); ++f) {
    Triangle face = repaired.triangles[f];
    RepairStep& step = fates[f] == Fate::kInner ? inner : fates[f] == Fate::kSheet ? sheets : turned;
    if (fates[f] != Fate::kStays) {
      ++step.count;
      step.area += area_of_face(repaired, face);
    }
    if (fates[f] == Fate::kInner || fates[f] == Fate::kSheet) continue;
    if (fates[f] == Fate::kTurned) std::swap(face[1], face[2]);
    kept.push_back(face);
  }
  if (turned.count + inner.count + sheets.count == 0) return;
  mesh = std::move(repaired);
  mesh.triangles = std::move(kept);
  for (const RepairStep& step : {turned, inner, sheets}) {
    if (step.count > 0) report.steps.push_back(step);
  }
}

}  // namespace buoyancy
