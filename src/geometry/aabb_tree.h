// A binary tree of axis-aligned bounding boxes over a set of boxes, for queries that need not visit all
// boxes.
//
// Construction splits at the median along the axis on which the box centres spread most: O(n log n), depth
// log2(n). The order of visits depends on the boxes alone.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/triangle_mesh.h"

namespace buoyancy {

class AabbTree {
 public:
  explicit AabbTree(std::vector<BoundingBox> boxes);

  // Calls visit(i) for every box i for which meets(box) is true. meets must be monotonic: true for every box
  // that contains a box for which it is true.
  template <typename Meets, typename Visit>
  void for_each(const Meets& meets, Visit&& visit) const {
    if (!nodes_.empty()) descend(0, meets, visit);
  }

  // Calls visit(i, j) once for every pair of boxes that share a point, until visit returns false. Returns
  // false in that case. Complexity: O(n log n) plus the pairs, of which there are n^2 / 2 if all boxes
  // overlap.
  template <typename Visit>
  bool for_each_overlapping_pair(Visit&& visit) const {
    return nodes_.empty() || pairs_within(0, visit);
  }

 private:
  struct Node {
    BoundingBox box;
    std::int32_t begin, end;  // range of items_
    std::int32_t right;       // right child, or kLeaf; the left child follows its parent
  };
  static constexpr std::int32_t kLeaf = -1;

  static bool overlap(const BoundingBox& a, const BoundingBox& b) {
    return a.min_B.x() <= b.max_B.x() && b.min_B.x() <= a.max_B.x() && a.min_B.y() <= b.max_B.y() &&
           b.min_B.y() <= a.max_B.y() && a.min_B.z() <= b.max_B.z() && b.min_B.z() <= a.max_B.z();
  }

  const Node& node(std::int32_t i) const { return nodes_[static_cast<std::size_t>(i)]; }
  std::int32_t item(std::int32_t i) const { return items_[static_cast<std::size_t>(i)]; }
  const BoundingBox& box_of_item(std::int32_t i) const { return boxes_[static_cast<std::size_t>(i)]; }

  void build(std::int32_t begin, std::int32_t end);

  template <typename Meets, typename Visit>
  void descend(std::int32_t n, const Meets& meets, Visit& visit) const {
    const Node& here = node(n);
    if (!meets(here.box)) return;
    if (here.right != kLeaf) {
      descend(n + 1, meets, visit);
      descend(here.right, meets, visit);
      return;
    }
    for (std::int32_t i = here.begin; i < here.end; ++i) {
      if (meets(box_of_item(i))) visit(item(i));
    }
  }

  template <typename Visit>
  bool pairs_within(std::int32_t n, Visit& visit) const {
    const Node& here = node(n);
    if (here.right != kLeaf) {
      return pairs_within(n + 1, visit) && pairs_within(here.right, visit) &&
             pairs_between(n + 1, here.right, visit);
    }
    for (std::int32_t i = here.begin; i < here.end; ++i) {
      for (std::int32_t j = i + 1; j < here.end; ++j) {
        if (!visit_if_overlapping(i, j, visit)) return false;
      }
    }
    return true;
  }

  template <typename Visit>
  bool pairs_between(std::int32_t a, std::int32_t b, Visit& visit) const {
    const Node& left = node(a);
    const Node& right = node(b);
    if (!overlap(left.box, right.box)) return true;
    const bool left_is_larger = left.end - left.begin > right.end - right.begin;
    if (left.right != kLeaf && (left_is_larger || right.right == kLeaf)) {
      return pairs_between(a + 1, b, visit) && pairs_between(left.right, b, visit);
    }
    if (right.right != kLeaf) {
      return pairs_between(a, b + 1, visit) && pairs_between(a, right.right, visit);
    }
    for (std::int32_t i = left.begin; i < left.end; ++i) {
      for (std::int32_t j = right.begin; j < right.end; ++j) {
        if (!visit_if_overlapping(i, j, visit)) return false;
      }
    }
    return true;
  }

  template <typename Visit>
  bool visit_if_overlapping(std::int32_t i, std::int32_t j, Visit& visit) const {
    return !overlap(box_of_item(i), box_of_item(j)) || visit(item(i), item(j));
  }

  std::vector<BoundingBox> boxes_;   // in the order of items_
  std::vector<std::int32_t> items_;  // indices of the given boxes, grouped by leaf
  std::vector<Node> nodes_;
};

BoundingBox box_of_face(const TriangleMesh& mesh, const Triangle& face);

// Returns the bounding boxes of `faces`, in their order.
std::vector<BoundingBox> boxes_of_faces(const TriangleMesh& mesh, const std::vector<Triangle>& faces);

}  // namespace buoyancy
