#include "geometry/face_winding.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

#include "geometry/edge_uses.h"
#include "geometry/swept_volume.h"

namespace buoyancy {
namespace {

// Disjoint sets whose elements agree or disagree with their representative.
class ParitySets {
 public:
  explicit ParitySets(std::size_t n) : parent_(n), disagrees_(n, 0) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  struct Root {
    std::int32_t element;
    bool disagrees;
  };
  Root find(std::int32_t i) {
    bool disagrees = false;
    while (parent(i) != i) {
      const std::int32_t up = parent(i);
      // Halves the path: i's new parent is its grandparent.
      if (parent(up) != up) {
        disagrees_[static_cast<std::size_t>(i)] ^= disagrees_[static_cast<std::size_t>(up)];
        parent(i) = parent(up);
      }
      disagrees ^= disagrees_[static_cast<std::size_t>(i)] != 0;
      i = parent(i);
    }
    return {i, disagrees};
  }

  // Returns false if this contradicts earlier unions.
  bool unite(std::int32_t i, std::int32_t j, bool disagree) {
    const Root a = find(i);
    const Root b = find(j);
    const bool of_roots = disagree != (a.disagrees != b.disagrees);
    if (a.element == b.element) return !of_roots;
    const std::int32_t child = std::max(a.element, b.element);
    parent(child) = std::min(a.element, b.element);
    disagrees_[static_cast<std::size_t>(child)] = of_roots ? 1 : 0;
    return true;
  }

 private:
  std::int32_t& parent(std::int32_t i) { return parent_[static_cast<std::size_t>(i)]; }

  std::vector<std::int32_t> parent_;
  std::vector<std::uint8_t> disagrees_;  // with the parent
};

// The faces of one surface, under its representative.
struct Surface {
  double agreeing_area = 0.0;
  double other_area = 0.0;
  std::int64_t faces = 0;
  bool one_sided = false;
  bool mixed = false;
  bool meets_another = false;
};

}  // namespace

void make_winding_consistent(TriangleMesh& mesh, RepairReport& report) {
  const std::size_t n = mesh.triangles.size();
  const EdgeUses edges = collect_edge_uses(mesh);
  ParitySets sides(n);
  std::vector<std::int32_t> contradicting;
  std::vector<std::int32_t> at_other_edges;  // faces at edges of more than two faces
  edges.for_each_edge([&](std::int32_t, std::span<const EdgeUse> uses) {
    if (uses.size() > 2) {
      for (const EdgeUse& use : uses) at_other_edges.push_back(use.face);
    }
    if (uses.size() != 2) return;
    if (!sides.unite(uses[0].face, uses[1].face, uses[0].forward == uses[1].forward))
      contradicting.push_back(uses[0].face);
  });

  std::vector<Surface> surfaces(n);
  const auto surface_of = [&](std::int32_t face) -> Surface& {
    return surfaces[static_cast<std::size_t>(sides.find(face).element)];
  };
  for (const std::int32_t face : contradicting) surface_of(face).one_sided = true;
  for (const std::int32_t face : at_other_edges) surface_of(face).meets_another = true;
  for (std::size_t f = 0; f < n; ++f) {
    const auto [root, disagrees] = sides.find(static_cast<std::int32_t>(f));
    Surface& surface = surfaces[static_cast<std::size_t>(root)];
    (disagrees ? surface.other_area : surface.agreeing_area) += area_of_face(mesh, mesh.triangles[f]);
    surface.mixed = surface.mixed || disagrees;
    ++surface.faces;
  }

  RepairStep step;
  step.kind = RepairKind::kTurnFaces;
  for (std::size_t f = 0; f < n; ++f) {
    const auto [root, disagrees] = sides.find(static_cast<std::int32_t>(f));
    const Surface& surface = surfaces[static_cast<std::size_t>(root)];
    const bool others_stay = surface.other_area > surface.agreeing_area;
    if (surface.one_sided || surface.meets_another || !surface.mixed || disagrees == others_stay) continue;
    std::swap(mesh.triangles[f][1], mesh.triangles[f][2]);
    ++step.count;
    step.area += area_of_face(mesh, mesh.triangles[f]);
  }
  if (step.count > 0) report.steps.push_back(step);
  std::int64_t one_sided_faces = 0;
  for (const Surface& surface : surfaces) {
    if (surface.one_sided) one_sided_faces += surface.faces;
  }
  if (one_sided_faces > 0) {
    report.skipped.push_back({RepairKind::kTurnFaces, RepairObstacle::kNotOrientable, one_sided_faces});
  }
}

}  // namespace buoyancy
