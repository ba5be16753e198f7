#include "geometry/volume_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <vector>

#include "geometry/aabb_tree.h"
#include "geometry/common_volume.h"
#include "geometry/disjoint_sets.h"

namespace buoyancy {
namespace {

using Corner = std::array<double, 3>;
using Face = std::array<Corner, 3>;

// Returns the faces of a mesh by their coordinates, each from its smallest corner on, sorted.
std::vector<Face> sorted_faces(const TriangleMesh& mesh) {
  std::vector<Face> faces;
  faces.reserve(mesh.triangles.size());
  for (const Triangle& triangle : mesh.triangles) {
    Face face;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 corner = mesh.vertex(triangle[i]);
      face[i] = {corner.x(), corner.y(), corner.z()};
    }
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    faces.push_back(face);
  }
  std::sort(faces.begin(), faces.end());
  return faces;
}

// Returns the faces of either mesh that the other lacks.
std::vector<Face> different_faces(const TriangleMesh& a, const TriangleMesh& b) {
  const std::vector<Face> of_a = sorted_faces(a);
  const std::vector<Face> of_b = sorted_faces(b);
  std::vector<Face> different;
  std::set_symmetric_difference(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(),
                                std::back_inserter(different));
  return different;
}

BoundingBox common_hull(const BoundingBox& a, const BoundingBox& b) {
  return {a.min_B.cwiseMin(b.min_B), a.max_B.cwiseMax(b.max_B)};
}

// Merges the boxes of each set.
std::vector<BoundingBox> merged(const std::vector<BoundingBox>& boxes, DisjointSets& sets) {
  std::vector<BoundingBox> result;
  std::map<std::int32_t, std::size_t> place_of;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const auto [entry, is_new] =
        place_of.emplace(sets.representative(static_cast<std::int32_t>(i)), result.size());
    if (is_new) {
      result.push_back(boxes[i]);
    } else {
      result[entry->second] = common_hull(result[entry->second], boxes[i]);
    }
  }
  return result;
}

// Returns disjoint boxes outside which both meshes have the same winding numbers. Their difference is the
// winding number of the faces in which the meshes differ, those of one mesh reversed. Such faces form closed
// surfaces, one for each set connected by corners. The boxes of such sets are merged first, since their faces
// may overlap each other in all pairs.
std::vector<BoundingBox> boxes_of_difference(const TriangleMesh& a, const TriangleMesh& b) {
  std::vector<BoundingBox> boxes;
  std::map<Corner, std::int32_t> first_face_at;
  const std::vector<Face> faces = different_faces(a, b);
  DisjointSets connected(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const auto index = static_cast<std::int32_t>(i);
    BoundingBox box{Vec3::Constant(std::numeric_limits<double>::infinity()),
                    Vec3::Constant(-std::numeric_limits<double>::infinity())};
    for (const Corner& corner : faces[i]) {
      const Vec3 point(corner[0], corner[1], corner[2]);
      box = common_hull(box, {point, point});
      connected.unite(index, first_face_at.emplace(corner, index).first->second);
    }
    boxes.push_back(box);
  }
  boxes = merged(boxes, connected);
  for (std::size_t before = 0; before != boxes.size();) {
    before = boxes.size();
    DisjointSets overlapping(before);
    AabbTree(boxes).for_each_overlapping_pair([&](std::int32_t i, std::int32_t j) {
      overlapping.unite(i, j);
      return true;
    });
    boxes = merged(boxes, overlapping);
  }
  return boxes;
}

// A mesh whose part in a column is found without a visit to all its triangles.
class IndexedMesh {
 public:
  explicit IndexedMesh(const TriangleMesh& mesh) : mesh_(mesh), tree_(boxes_of_faces(mesh, mesh.triangles)) {}

  // Returns the triangles that lines along an axis through the box meet, and perhaps more.
  TriangleMesh part_along(Eigen::Index axis, const BoundingBox& box) const {
    TriangleMesh part;
    std::map<std::int32_t, std::int32_t> index_of;
    tree_.for_each([&](const BoundingBox& faces) { return meets_across(axis, box, faces); },
                   [&](std::int32_t i) {
                     Triangle triangle = mesh_.triangles[static_cast<std::size_t>(i)];
                     for (std::int32_t& corner : triangle) {
                       const auto [entry, is_new] = index_of.emplace(corner, 0);
                       if (is_new) entry->second = part.add_vertex(mesh_.vertex(corner));
                       corner = entry->second;
                     }
                     part.triangles.push_back(triangle);
                   });
    return part;
  }

 private:
  static bool meets_across(Eigen::Index axis, const BoundingBox& a, const BoundingBox& b) {
    for (const Eigen::Index i : {(axis + 1) % 3, (axis + 2) % 3}) {
      if (a.min_B[i] > b.max_B[i] || b.min_B[i] > a.max_B[i]) return false;
    }
    return true;
  }

  const TriangleMesh& mesh_;
  AabbTree tree_;
};

// The places lie opposite each other in pairs, so that terms that are linear over a column cancel. They are
// spread evenly in each direction, and none puts the axis on an edge of a mesh with round coordinates.
constexpr std::array<std::array<double, 2>, 6> kPlacesOfAxis{{{0.4147, 0.7497},
                                                              {0.5853, 0.2503},
                                                              {0.0813, 0.4171},
                                                              {0.9187, 0.5829},
                                                              {0.2519, 0.0851},
                                                              {0.7481, 0.9149}}};
// An edge along the columns may move by this without passing one of these places. [widths of a column]
constexpr double kUnseenWidth = 0.1;
constexpr std::size_t kPlaces = kPlacesOfAxis.size();

// The axis whose sums agree best counts more by this factor than one whose sums are far apart.
constexpr double kMaxWeight = 900.0;

// Splits boxes into some 64 in all, so that each part of a curved layer is summed along a suitable axis.
std::vector<BoundingBox> split(const std::vector<BoundingBox>& boxes) {
  const int parts = boxes.empty() ? 1 : static_cast<int>(std::cbrt(64.5 / static_cast<double>(boxes.size())));
  if (parts <= 1) return boxes;
  std::vector<BoundingBox> result;
  for (const BoundingBox& box : boxes) {
    const auto corner = [&](int i, int j, int k) {
      const Vec3 share = Vec3(i, j, k) / parts;
      return Vec3(box.min_B + share.cwiseProduct(box.max_B - box.min_B));
    };
    for (int i = 0; i < parts; ++i) {
      for (int j = 0; j < parts; ++j) {
        for (int k = 0; k < parts; ++k) result.push_back({corner(i, j, k), corner(i + 1, j + 1, k + 1)});
      }
    }
  }
  return result;
}

int columns_per_direction(std::size_t boxes) {
  return static_cast<int>(std::clamp(256.0 / std::sqrt(static_cast<double>(boxes)), 16.0, 256.0));
}

// The sums of columns along one axis, for each place of their axes.
struct AxisSums {
  std::array<double, kPlaces> at{};  // [m^3]
  double mean = 0.0;                 // [m^3]
  double spread = 0.0;               // [m^3], with the rounding
  double rounding = 0.0;             // [m^3]
};

AxisSums sums_along(Eigen::Index axis, const BoundingBox& box, const IndexedMesh& a, const IndexedMesh& b,
                    int columns) {
  const TriangleMesh part_a = a.part_along(axis, box);
  const TriangleMesh part_b = b.part_along(axis, box);
  AxisSums sums;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    const ColumnSum sum = volume_inside_one({&part_a, Vec3::Zero()}, {&part_b, Vec3::Zero()}, box,
                                            {axis, columns, kPlacesOfAxis[i]});
    sums.at[i] = sum.volume;
    sums.mean += sum.volume / kPlaces;
    sums.rounding = std::max(sums.rounding, sum.rounding);
  }
  const auto [low, high] = std::minmax_element(sums.at.begin(), sums.at.end());
  sums.spread = *high - *low + sums.rounding;
  return sums;
}

// Two axes contradict each other if their means differ by more than their spreads: columns along one of them
// miss what is thinner than they are, wherever their axes lie. Then the spread of both is raised to that
// difference. Returns the largest such difference [m^3].
double widen_contradictions(std::array<AxisSums, 3>& sums) {
  const std::array<AxisSums, 3> given = sums;
  double largest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double gap = std::abs(given[i].mean - given[j].mean);
    if (gap <= given[i].spread + given[j].spread) continue;
    for (const std::size_t k : {i, j}) sums[k].spread = std::max(sums[k].spread, gap);
    largest = std::max(largest, gap);
  }
  return largest;
}

struct BoxSum {
  double volume = 0.0;      // [m^3]
  double spread = 0.0;      // [m^3]
  double systematic = 0.0;  // [m^3], errors that may have the same sign in all boxes
};

// Returns the mean over the axes, with weights that favour those whose sums agree.
BoxSum difference_in(const BoundingBox& box, const IndexedMesh& a, const IndexedMesh& b, int columns) {
  std::array<AxisSums, 3> sums;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    sums[static_cast<std::size_t>(axis)] = sums_along(axis, box, a, b, columns);
  }
  BoxSum result;
  const double given = std::max({sums[0].spread, sums[1].spread, sums[2].spread});
  result.systematic = widen_contradictions(sums);
  const double largest = std::max({sums[0].spread, sums[1].spread, sums[2].spread});
  std::array<double, 3> weights{1.0, 1.0, 1.0};
  if (largest > 0.0) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = sums[axis].spread / largest;
      weights[axis] = 1.0 / std::max(share * share, 1.0 / kMaxWeight);
    }
  }
  const double total_weight = weights[0] + weights[1] + weights[2];
  std::array<double, kPlaces> at{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double weight = weights[axis] / total_weight;
    for (std::size_t i = 0; i < kPlaces; ++i) at[i] += weight * sums[axis].at[i];
    result.volume += weight * sums[axis].mean;
    result.systematic += weight * sums[axis].rounding;
  }
  // This is at most the largest spread of the sums, which is rounding alone for faces along the axes.
  result.systematic += std::min(given, kUnseenWidth / columns * result.volume);
  const auto [low, high] = std::minmax_element(at.begin(), at.end());
  result.spread = *high - *low;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.spread += weights[axis] / total_weight * std::abs(sums[axis].mean - result.volume);
  }
  return result;
}

}  // namespace

VolumeDifference symmetric_difference(const TriangleMesh& a, const TriangleMesh& b) {
  const std::vector<BoundingBox> boxes = split(boxes_of_difference(a, b));
  const IndexedMesh indexed_a(a);
  const IndexedMesh indexed_b(b);
  VolumeDifference total;
  double squares = 0.0;
  for (const BoundingBox& box : boxes) {
    const BoxSum here = difference_in(box, indexed_a, indexed_b, columns_per_direction(boxes.size()));
    total.value += here.volume;
    squares += here.spread * here.spread;
    total.error += here.systematic;
  }
  total.error += std::sqrt(squares);
  return total;
}

}  // namespace buoyancy
