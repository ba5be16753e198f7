#include "geometry/component_nesting.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "geometry/aabb_tree.h"
#include "geometry/winding_number.h"

namespace buoyancy {
namespace {

constexpr std::size_t kSamplesPerComponent = 8;
constexpr std::int64_t kMaxOverlaps = 50'000'000;  // pairs of boxes, each 10 ns
constexpr std::int64_t kMaxEnclosed = 2'000'000;   // pairs of components, each up to a microsecond

using ComponentLists = std::vector<std::vector<std::int32_t>>;

std::vector<BoundingBox> component_boxes(const TriangleMesh& mesh, const MeshTopology& topology) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const BoundingBox empty{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  std::vector<BoundingBox> boxes(static_cast<std::size_t>(topology.components), empty);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    BoundingBox& box = boxes[static_cast<std::size_t>(topology.component_of_face[f])];
    for (const std::int32_t v : mesh.triangles[f]) {
      box.min_B = box.min_B.cwiseMin(mesh.vertex(v));
      box.max_B = box.max_B.cwiseMax(mesh.vertex(v));
    }
  }
  return boxes;
}

bool contains(const BoundingBox& outer, const BoundingBox& inner) {
  return (outer.min_B.array() <= inner.min_B.array()).all() &&
         (inner.max_B.array() <= outer.max_B.array()).all();
}

// Returns, by component, the components whose boxes contain its own, ascending; nullopt if there are too
// many.
std::optional<ComponentLists> enclosing_boxes(const std::vector<BoundingBox>& boxes) {
  ComponentLists enclosing(boxes.size());
  const auto components = static_cast<std::int64_t>(boxes.size());
  std::int64_t overlaps_left = kMaxOverlaps + 100 * components;
  std::int64_t enclosed_left = kMaxEnclosed + 100 * components;
  const auto add = [&](std::int32_t i, std::int32_t j) {
    const auto a = static_cast<std::size_t>(i);
    const auto b = static_cast<std::size_t>(j);
    const auto enclose = [&](std::size_t inner, std::size_t outer) {
      if (!contains(boxes[outer], boxes[inner])) return;
      enclosing[inner].push_back(static_cast<std::int32_t>(outer));
      --enclosed_left;
    };
    enclose(a, b);
    enclose(b, a);
    return --overlaps_left > 0 && enclosed_left > 0;
  };
  if (!AabbTree(boxes).for_each_overlapping_pair(add)) return std::nullopt;
  for (auto& list : enclosing) std::sort(list.begin(), list.end());
  return enclosing;
}

// Returns up to kSamplesPerComponent face corners, spread over each component's faces and over their corners.
// An inside-out mesh gives the same samples.
ComponentLists sample_vertices(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<std::size_t> corners(static_cast<std::size_t>(topology.components), 0);
  for (const std::int32_t component : topology.component_of_face) {
    corners[static_cast<std::size_t>(component)] += 3;
  }
  std::vector<std::size_t> visited(corners.size(), 0);
  ComponentLists samples(corners.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto component = static_cast<std::size_t>(topology.component_of_face[f]);
    std::size_t stride = (corners[component] + kSamplesPerComponent - 1) / kSamplesPerComponent;
    if (stride % 3 == 0) ++stride;  // otherwise it would always select the same corner
    Triangle face = mesh.triangles[f];
    std::sort(face.begin(), face.end());
    for (const std::int32_t v : face) {
      if (visited[component]++ % stride == 0) samples[component].push_back(v);
    }
  }
  return samples;
}

// Returns the surfaces of the candidates, by component.
std::vector<std::optional<WindingNumber>> candidate_surfaces(const TriangleMesh& mesh,
                                                             const MeshTopology& topology,
                                                             const std::vector<bool>& is_candidate) {
  std::vector<std::vector<Triangle>> faces(is_candidate.size());
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const auto component = static_cast<std::size_t>(topology.component_of_face[f]);
    if (is_candidate[component]) faces[component].push_back(mesh.triangles[f]);
  }
  std::vector<std::optional<WindingNumber>> surfaces(is_candidate.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (is_candidate[i]) surfaces[i].emplace(mesh, std::move(faces[i]));
  }
  return surfaces;
}

}  // namespace

std::optional<std::vector<std::vector<std::int32_t>>> enclosing_components(const TriangleMesh& mesh,
                                                                           const MeshTopology& topology) {
  if (topology.components < 2) return ComponentLists(static_cast<std::size_t>(topology.components));
  std::optional<ComponentLists> enclosing = enclosing_boxes(component_boxes(mesh, topology));
  if (!enclosing) return std::nullopt;
  std::vector<bool> is_candidate(enclosing->size(), false);
  for (const auto& list : *enclosing) {
    for (const std::int32_t outer : list) is_candidate[static_cast<std::size_t>(outer)] = true;
  }
  if (std::find(is_candidate.begin(), is_candidate.end(), true) == is_candidate.end()) return enclosing;

  const std::vector<std::optional<WindingNumber>> surfaces = candidate_surfaces(mesh, topology, is_candidate);
  const ComponentLists samples = sample_vertices(mesh, topology);
  for (std::size_t inner = 0; inner < enclosing->size(); ++inner) {
    const auto is_outside = [&](std::int32_t outer) {
      bool inside = false;
      for (const std::int32_t v : samples[inner]) {
        const auto [winding, touched, faces_met] =
            surfaces[static_cast<std::size_t>(outer)]->about(mesh.vertex(v));
        if (touched) continue;
        if (winding == 0) return true;
        inside = true;
      }
      return !inside;
    };
    std::erase_if((*enclosing)[inner], is_outside);
  }
  return enclosing;
}

}  // namespace buoyancy
