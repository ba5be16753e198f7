#include "geometry/component_nesting.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "geometry/aabb_tree.h"
#include "geometry/exact_predicates.h"

namespace buoyancy {
namespace {

constexpr std::size_t kSamplesPerComponent = 8;

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

// Returns, by component, the components whose boxes contain its own, ascending.
ComponentLists enclosing_boxes(const std::vector<BoundingBox>& boxes) {
  ComponentLists enclosing(boxes.size());
  AabbTree(boxes).for_each_overlapping_pair([&](std::int32_t i, std::int32_t j) {
    const auto a = static_cast<std::size_t>(i);
    const auto b = static_cast<std::size_t>(j);
    if (contains(boxes[b], boxes[a])) enclosing[a].push_back(j);
    if (contains(boxes[a], boxes[b])) enclosing[b].push_back(i);
  });
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

// Returns the side of the directed line uv on which the point lies in the projection along x. The point is
// perturbed by (e, e^2) for a vanishing e > 0, so that it lies on no line and a ray meets faces, never edges.
// The result is 0 only if the projections of u and v coincide.
int perturbed_side(const Vec3& u, const Vec3& v, const Vec3& point) {
  const int side =
      orient_2d(project_along_axis(0, u), project_along_axis(0, v), project_along_axis(0, point));
  if (side != 0) return side;
  if (u.z() != v.z()) return v.z() < u.z() ? 1 : -1;
  if (u.y() != v.y()) return v.y() > u.y() ? 1 : -1;
  return 0;
}

struct Crossing {
  int direction = 0;     // of the ray from the point along +x: 1 outward, -1 inward, 0 no crossing
  bool touches = false;  // the point lies on the face
};

Crossing cross(const TriangleMesh& mesh, const Triangle& face, const Vec3& point) {
  const Vec3 a = mesh.vertex(face[0]);
  const Vec3 b = mesh.vertex(face[1]);
  const Vec3 c = mesh.vertex(face[2]);
  const int side = perturbed_side(a, b, point);
  if (side == 0 || perturbed_side(b, c, point) != side || perturbed_side(c, a, point) != side) return {};
  const int in_front = orient_3d(a, b, c, point);
  if (in_front == 0) return {0, true};
  return {in_front == side ? 0 : side, false};
}

// Casts rays along +x against the faces of the candidate outer components.
class RayCaster {
 public:
  RayCaster(const TriangleMesh& mesh, const MeshTopology& topology, const std::vector<bool>& is_candidate)
      : mesh_(mesh),
        topology_(topology),
        faces_(faces_of(topology, is_candidate)),
        tree_(boxes_of(mesh, faces_)),
        winding_(is_candidate.size(), 0),
        touched_(is_candidate.size(), false) {}

  // Sets winding(i) and touched(i) for the point.
  void cast(const Vec3& point) {
    for (const std::size_t component : changed_components_) {
      winding_[component] = 0;
      touched_[component] = false;
    }
    changed_components_.clear();
    const auto meets_ray = [&point](const BoundingBox& box) {
      return box.max_B.x() >= point.x() && box.min_B.y() <= point.y() && point.y() <= box.max_B.y() &&
             box.min_B.z() <= point.z() && point.z() <= box.max_B.z();
    };
    tree_.for_each(meets_ray, [this, &point](std::int32_t item) {
      const auto face = static_cast<std::size_t>(faces_[static_cast<std::size_t>(item)]);
      const auto component = static_cast<std::size_t>(topology_.component_of_face[face]);
      const Crossing crossing = cross(mesh_, mesh_.triangles[face], point);
      if (crossing.direction != 0 || crossing.touches) changed_components_.push_back(component);
      winding_[component] += crossing.direction;
      if (crossing.touches) touched_[component] = true;
    });
  }

  int winding(std::int32_t component) const { return winding_[static_cast<std::size_t>(component)]; }
  bool touched(std::int32_t component) const { return touched_[static_cast<std::size_t>(component)]; }

 private:
  static std::vector<std::int32_t> faces_of(const MeshTopology& topology,
                                            const std::vector<bool>& is_candidate) {
    std::vector<std::int32_t> faces;
    for (std::size_t f = 0; f < topology.component_of_face.size(); ++f) {
      if (is_candidate[static_cast<std::size_t>(topology.component_of_face[f])]) {
        faces.push_back(static_cast<std::int32_t>(f));
      }
    }
    return faces;
  }

  static std::vector<BoundingBox> boxes_of(const TriangleMesh& mesh, const std::vector<std::int32_t>& faces) {
    std::vector<BoundingBox> boxes;
    boxes.reserve(faces.size());
    for (const std::int32_t f : faces) {
      boxes.push_back(box_of_face(mesh, mesh.triangles[static_cast<std::size_t>(f)]));
    }
    return boxes;
  }

  const TriangleMesh& mesh_;
  const MeshTopology& topology_;
  std::vector<std::int32_t> faces_;
  AabbTree tree_;
  std::vector<int> winding_;                     // by component
  std::vector<bool> touched_;                    // by component
  std::vector<std::size_t> changed_components_;  // components whose entries above are set
};

}  // namespace

std::vector<std::vector<std::int32_t>> enclosing_components(const TriangleMesh& mesh,
                                                            const MeshTopology& topology) {
  ComponentLists enclosing = enclosing_boxes(component_boxes(mesh, topology));
  std::vector<bool> is_candidate(enclosing.size(), false);
  for (const auto& list : enclosing) {
    for (const std::int32_t outer : list) is_candidate[static_cast<std::size_t>(outer)] = true;
  }
  if (std::find(is_candidate.begin(), is_candidate.end(), true) == is_candidate.end()) return enclosing;

  RayCaster caster(mesh, topology, is_candidate);
  const ComponentLists samples = sample_vertices(mesh, topology);
  for (std::size_t inner = 0; inner < enclosing.size(); ++inner) {
    auto& candidates = enclosing[inner];
    if (candidates.empty()) continue;
    std::vector<std::size_t> inside(candidates.size(), 0);
    std::vector<std::size_t> outside(candidates.size(), 0);
    for (const std::int32_t v : samples[inner]) {
      caster.cast(mesh.vertex(v));
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (caster.touched(candidates[i])) continue;
        ++(caster.winding(candidates[i]) != 0 ? inside : outside)[i];
      }
    }
    std::vector<std::int32_t> confirmed;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      if (inside[i] > 0 && outside[i] == 0) confirmed.push_back(candidates[i]);
    }
    candidates = std::move(confirmed);
  }
  return enclosing;
}

}  // namespace buoyancy
