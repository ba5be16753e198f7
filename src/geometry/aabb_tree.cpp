#include "geometry/aabb_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace buoyancy {
namespace {

constexpr std::int32_t kItemsPerLeaf = 4;

BoundingBox empty_box() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
}

}  // namespace

AabbTree::AabbTree(std::vector<BoundingBox> boxes) : boxes_(std::move(boxes)), items_(boxes_.size()) {
  std::iota(items_.begin(), items_.end(), 0);
  if (items_.empty()) return;
  nodes_.reserve(boxes_.size());
  build(0, static_cast<std::int32_t>(items_.size()));
  std::vector<BoundingBox> sorted;
  sorted.reserve(boxes_.size());
  for (const std::int32_t i : items_) sorted.push_back(boxes_[static_cast<std::size_t>(i)]);
  boxes_ = std::move(sorted);
}

void AabbTree::build(std::int32_t begin, std::int32_t end) {
  BoundingBox box = empty_box();
  BoundingBox centers = empty_box();  // bounds of min + max, twice the box centre
  for (std::int32_t i = begin; i < end; ++i) {
    const BoundingBox& item_box = boxes_[static_cast<std::size_t>(item(i))];
    box.min_B = box.min_B.cwiseMin(item_box.min_B);
    box.max_B = box.max_B.cwiseMax(item_box.max_B);
    const Vec3 center = item_box.min_B + item_box.max_B;
    centers.min_B = centers.min_B.cwiseMin(center);
    centers.max_B = centers.max_B.cwiseMax(center);
  }
  const std::size_t here = nodes_.size();
  nodes_.push_back({box, begin, end, kLeaf});
  if (end - begin <= kItemsPerLeaf) return;

  Eigen::Index axis = 0;
  (centers.max_B - centers.min_B).maxCoeff(&axis);
  const auto before = [this, axis](std::int32_t i, std::int32_t j) {
    const BoundingBox& a = boxes_[static_cast<std::size_t>(i)];
    const BoundingBox& b = boxes_[static_cast<std::size_t>(j)];
    return std::pair(a.min_B(axis) + a.max_B(axis), i) < std::pair(b.min_B(axis) + b.max_B(axis), j);
  };
  const std::int32_t middle = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, before);
  build(begin, middle);
  nodes_[here].right = static_cast<std::int32_t>(nodes_.size());
  build(middle, end);
}

BoundingBox box_of_face(const TriangleMesh& mesh, const Triangle& face) {
  const Vec3 a = mesh.vertex(face[0]);
  const Vec3 b = mesh.vertex(face[1]);
  const Vec3 c = mesh.vertex(face[2]);
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

std::vector<BoundingBox> boxes_of_faces(const TriangleMesh& mesh, const std::vector<Triangle>& faces) {
  std::vector<BoundingBox> boxes;
  boxes.reserve(faces.size());
  for (const Triangle& face : faces) boxes.push_back(box_of_face(mesh, face));
  return boxes;
}

}  // namespace buoyancy
