#include "geometry/triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include <Eigen/Geometry>

#include "base/double_double.h"
#include "geometry/exact_predicates.h"

namespace buoyancy {
namespace {

constexpr double kPlanarity = 1e-6;            // relative to a polygon's size
constexpr double kMaxCoordinate = 1e100;       // beyond it, predicates and volumes overflow
constexpr std::size_t kMaxSearched = 16;       // corners of polygons whose extreme splits are searched
constexpr std::int64_t kStepsPerCorner = 300;  // of ear clipping, beside kFirstSteps
constexpr std::int64_t kFirstSteps = 1'000'000;

// Sums doubles exactly and rounds once. The result does not depend on the order of the terms, and negated
// terms give the negated result. Source: J. R. Shewchuk, see exact_predicates.h; the rounding is that of
// Python's math.fsum().
class ExactSum {
 public:
  void add(double value) {
    std::size_t kept = 0;
    for (const double term : terms_) {
      const DoubleDouble sum = two_sum(value, term);
      if (sum.lo != 0.0) terms_[kept++] = sum.lo;
      value = sum.hi;
    }
    terms_.resize(kept);
    terms_.push_back(value);
  }

  double rounded() const {
    std::size_t left = terms_.size();
    double sum = 0.0;
    double rest = 0.0;
    while (left > 0 && rest == 0.0) {
      const DoubleDouble next = two_sum(sum, terms_[--left]);
      sum = next.hi;
      rest = next.lo;
    }
    // A rest of half a unit in the last place was rounded to even, but the next smaller term decides.
    if (left > 0 && (rest < 0.0) == (terms_[left - 1] < 0.0)) {
      const double next = sum + 2.0 * rest;
      if (next - sum == 2.0 * rest) return next;
    }
    return sum;
  }

  void clear() { terms_.clear(); }

 private:
  std::vector<double> terms_;  // non-overlapping, smallest first
};

class ExactVectorSum {
 public:
  void add(const Vec3& value) {
    for (std::size_t axis = 0; axis < 3; ++axis) sums_[axis].add(value[static_cast<Eigen::Index>(axis)]);
  }
  Vec3 rounded() const { return {sums_[0].rounded(), sums_[1].rounded(), sums_[2].rounded()}; }
  void clear() {
    for (ExactSum& sum : sums_) sum.clear();
  }

 private:
  std::array<ExactSum, 3> sums_;
};

// The corners at which a polygon is not strictly convex, in a kd-tree: those that can lie in an ear.
class BlockingCorners {
 public:
  // points: of all corners; corners: those to hold. Both must outlive the object, until the next build().
  void build(const std::vector<Eigen::Vector2d>& points, std::vector<std::int32_t>& corners) {
    points_ = &points;
    corners_ = &corners;
    nodes_.clear();
    leaf_of_.assign(points.size(), -1);
    if (corners.empty()) return;
    add_node(-1, 0, static_cast<std::int32_t>(corners.size()));
    for (std::size_t node = 0; node < nodes_.size(); ++node) divide(static_cast<std::int32_t>(node));
  }

  void remove(std::int32_t corner) {
    std::int32_t node = leaf_of_[index(corner)];
    leaf_of_[index(corner)] = -1;
    for (; node >= 0; node = nodes_[index(node)].parent) --nodes_[index(node)].left_in;
  }

  // Returns a corner in the closed triangle abc (counter-clockwise) that is at the place of none of its
  // corners; -1 if there is none. Subtracts its steps from `steps`.
  std::int32_t find_in(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                       std::int64_t& steps) {
    if (nodes_.empty()) return -1;
    open_.assign(1, 0);
    while (!open_.empty()) {
      const Node& node = nodes_[index(open_.back())];
      open_.pop_back();
      --steps;
      if (node.left_in == 0 || is_beyond(node, a, b) || is_beyond(node, b, c) || is_beyond(node, c, a))
        continue;
      if (node.child >= 0) {
        open_.push_back(node.child);
        open_.push_back(node.child + 1);
        continue;
      }
      for (std::int32_t i = node.first; i < node.end; ++i) {
        const std::int32_t corner = (*corners_)[index(i)];
        if (leaf_of_[index(corner)] < 0) continue;
        --steps;
        const Eigen::Vector2d& point = (*points_)[index(corner)];
        if (orient_2d(a, b, point) >= 0 && orient_2d(b, c, point) >= 0 && orient_2d(c, a, point) >= 0 &&
            point != a && point != b && point != c) {
          return corner;
        }
      }
    }
    return -1;
  }

 private:
  struct Node {
    Eigen::Vector2d min, max;
    std::int32_t parent = -1;
    std::int32_t child = -1;  // the first of two; -1: a leaf
    std::int32_t first = 0;   // range of corners
    std::int32_t end = 0;
    std::int32_t left_in = 0;  // corners that have not been removed
  };

  static std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

  // Returns whether the whole box lies to the right of the line from a to b.
  static bool is_beyond(const Node& node, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    const Eigen::Vector2d leftmost(b.y() > a.y() ? node.min.x() : node.max.x(),
                                   b.x() > a.x() ? node.max.y() : node.min.y());
    return orient_2d(a, b, leftmost) < 0;
  }

  void add_node(std::int32_t parent, std::int32_t first, std::int32_t end) {
    Node node;
    node.parent = parent;
    node.first = first;
    node.end = end;
    node.left_in = end - first;
    node.min = node.max = (*points_)[index((*corners_)[index(first)])];
    for (std::int32_t i = first; i < end; ++i) {
      const std::int32_t corner = (*corners_)[index(i)];
      node.min = node.min.cwiseMin((*points_)[index(corner)]);
      node.max = node.max.cwiseMax((*points_)[index(corner)]);
      leaf_of_[index(corner)] = static_cast<std::int32_t>(nodes_.size());
    }
    nodes_.push_back(node);
  }

  void divide(std::int32_t i) {
    constexpr std::int32_t kLeafSize = 8;
    const Node node = nodes_[index(i)];
    if (node.end - node.first <= kLeafSize) return;
    const Eigen::Index axis = node.max.x() - node.min.x() >= node.max.y() - node.min.y() ? 0 : 1;
    const std::int32_t middle = node.first + (node.end - node.first) / 2;
    std::nth_element(corners_->begin() + node.first, corners_->begin() + middle, corners_->begin() + node.end,
                     [this, axis](std::int32_t left, std::int32_t right) {
                       return (*points_)[index(left)][axis] < (*points_)[index(right)][axis];
                     });
    nodes_[index(i)].child = static_cast<std::int32_t>(nodes_.size());
    add_node(i, node.first, middle);
    add_node(i, middle, node.end);
  }

  const std::vector<Eigen::Vector2d>* points_ = nullptr;
  std::vector<std::int32_t>* corners_ = nullptr;
  std::vector<Node> nodes_;
  std::vector<std::int32_t> leaf_of_;  // by corner; -1: not held
  std::vector<std::int32_t> open_;
};

// Cuts ears off a polygon. Corners are numbered from 0.
class EarClipping {
 public:
  // places: of the corners. area_vector: not zero, its largest component along `axis`.
  // Returns the triangles, three corners each; valid until the next call.
  const std::vector<Triangle>& split(const std::vector<Vec3>& places, const Vec3& area_vector, int axis) {
    places_ = &places;
    project(area_vector[axis] < 0.0, axis);
    const auto count = static_cast<std::int32_t>(places.size());
    triangles_.clear();
    waiting_.clear();
    first_waiting_.assign(places.size(), -1);
    version_.assign(places.size(), 0);
    previous_.resize(places.size());
    next_.resize(places.size());
    is_convex_.assign(places.size(), false);
    candidates_ = {};
    for (std::int32_t i = 0; i < count; ++i) {
      previous_[index(i)] = i == 0 ? count - 1 : i - 1;
      next_[index(i)] = i + 1 == count ? 0 : i + 1;
    }
    blocking_list_.clear();
    for (std::int32_t i = 0; i < count; ++i) {
      is_convex_[index(i)] = turn_at(i) > 0;
      if (is_convex_[index(i)]) {
        add_candidate(i);
      } else {
        blocking_list_.push_back(i);
      }
    }
    blocking_.build(points_, blocking_list_);
    cut_ears(count);
    return triangles_;
  }

 private:
  struct Candidate {
    double diagonal;  // squared length
    std::int32_t corner;
    std::int32_t version;

    bool operator<(const Candidate& other) const {  // the last is cut first
      return diagonal != other.diagonal ? diagonal > other.diagonal : corner > other.corner;
    }
  };
  struct Waiting {
    std::int32_t corner;
    std::int32_t next;
  };

  static std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

  // Projects the corners without rounding, such that they run counter-clockwise.
  void project(bool is_seen_from_behind, int axis) {
    points_.clear();
    for (const Vec3& place : *places_) {
      const Eigen::Vector2d point = project_along_axis(axis, place);
      points_.emplace_back(is_seen_from_behind ? Eigen::Vector2d(point.y(), point.x()) : point);
    }
  }

  int turn_at(std::int32_t corner) const {
    return orient_2d(points_[index(previous_[index(corner)])], points_[index(corner)],
                     points_[index(next_[index(corner)])]);
  }

  void add_candidate(std::int32_t corner) {
    const Vec3 diagonal =
        (*places_)[index(next_[index(corner)])] - (*places_)[index(previous_[index(corner)])];
    candidates_.push({diagonal.squaredNorm(), corner, version_[index(corner)]});
  }

  void cut_ears(std::int32_t count) {
    std::int64_t steps = kFirstSteps + kStepsPerCorner * count;
    std::int32_t some_corner = 0;
    while (count > 3 && !candidates_.empty() && steps > 0) {
      const Candidate candidate = candidates_.top();
      candidates_.pop();
      const std::int32_t ear = candidate.corner;
      if (candidate.version != version_[index(ear)]) continue;
      const std::int32_t before = previous_[index(ear)];
      const std::int32_t after = next_[index(ear)];
      const std::int32_t blocker =
          blocking_.find_in(points_[index(before)], points_[index(ear)], points_[index(after)], steps);
      if (blocker >= 0) {
        wait_for(blocker, ear);
        continue;
      }
      triangles_.push_back({before, ear, after});
      ++version_[index(ear)];
      next_[index(before)] = after;
      previous_[index(after)] = before;
      some_corner = before;
      --count;
      update(before);
      update(after);
    }
    if (count == static_cast<std::int32_t>(places_->size())) some_corner = 0;
    add_fan(some_corner, count);
  }

  // Lets `corner` be a candidate again once `blocker` has become strictly convex.
  void wait_for(std::int32_t blocker, std::int32_t corner) {
    waiting_.push_back({corner, first_waiting_[index(blocker)]});
    first_waiting_[index(blocker)] = static_cast<std::int32_t>(waiting_.size()) - 1;
  }

  void update(std::int32_t corner) {
    ++version_[index(corner)];
    if (turn_at(corner) <= 0) return;
    if (!is_convex_[index(corner)]) {
      is_convex_[index(corner)] = true;
      blocking_.remove(corner);
      for (std::int32_t i = first_waiting_[index(corner)]; i >= 0; i = waiting_[index(i)].next) {
        if (previous_[index(next_[index(waiting_[index(i)].corner)])] == waiting_[index(i)].corner) {
          add_candidate(waiting_[index(i)].corner);
        }
      }
    }
    add_candidate(corner);
  }

  void add_fan(std::int32_t apex, std::int32_t count) {
    std::int32_t corner = next_[index(apex)];
    for (; count > 2; --count) {
      triangles_.push_back({apex, corner, next_[index(corner)]});
      corner = next_[index(corner)];
    }
  }

  const std::vector<Vec3>* places_ = nullptr;
  std::vector<Eigen::Vector2d> points_;
  std::vector<std::int32_t> previous_, next_;
  std::vector<bool> is_convex_;        // strictly; stays true once it is
  std::vector<std::int32_t> version_;  // of a corner as a candidate: raised when its neighbours change
  std::priority_queue<Candidate> candidates_;
  std::vector<std::int32_t> blocking_list_;
  BlockingCorners blocking_;
  std::vector<Waiting> waiting_;  // linked lists of corners, by the corner that blocks them
  std::vector<std::int32_t> first_waiting_;
  std::vector<Triangle> triangles_;
};

class Triangulation {
 public:
  Triangulation(TriangleMesh& mesh, AddCenters centers) : mesh_(mesh), centers_(centers) {}

  void add(std::span<const std::int32_t> polygon) {
    if (polygon.size() == 3) {
      mesh_.triangles.push_back({polygon[0], polygon[1], polygon[2]});
      return;
    }
    ++split_.polygons;
    read(polygon);
    if (corners_.size() < 3) {  // encloses nothing: welding drops it, and counts it
      mesh_.triangles.push_back({polygon[0], polygon[1], polygon[2]});
    } else if (corners_.size() == 3) {
      mesh_.triangles.push_back({corners_[0], corners_[1], corners_[2]});
    } else if (!is_in_range_) {
      add_fan();
    } else {
      add_polygon();
    }
  }

  const PolygonSplit& split() const { return split_; }

 private:
  // Reads the corners, but none at the same place as the one before.
  void read(std::span<const std::int32_t> polygon) {
    corners_.clear();
    places_.clear();
    is_in_range_ = true;
    for (const std::int32_t corner : polygon) {
      const Vec3 place = mesh_.vertex(corner);
      if (!places_.empty() && places_.back() == place) continue;
      is_in_range_ = is_in_range_ && place.cwiseAbs().maxCoeff() < kMaxCoordinate;
      corners_.push_back(corner);
      places_.push_back(place);
    }
    while (places_.size() > 1 && places_.back() == places_.front()) {
      corners_.pop_back();
      places_.pop_back();
    }
  }

  void add_polygon() {
    measure();
    if (half_thickness_ > kPlanarity * size_) {
      ++split_.non_planar;
      split_.largest_distance = std::max(split_.largest_distance, half_thickness_);
      split_.split_volume += volume_between_splits();
      constexpr std::size_t kMaxVertexCount = std::numeric_limits<std::int32_t>::max();
      if (centers_ == AddCenters::kYes && (!has_area_ || mean_sees_all_corners()) &&
          mesh_.vertex_count() < kMaxVertexCount) {
        add_fan_around_mean();
        return;
      }
    }
    if (!has_area_) {
      add_fan();
      return;
    }
    for (const Triangle& ear : ears_.split(places_, area_vector_, axis_)) {
      mesh_.triangles.push_back({corner(ear[0]), corner(ear[1]), corner(ear[2])});
    }
  }

  std::int32_t corner(std::int32_t i) const { return corners_[static_cast<std::size_t>(i)]; }
  const Vec3& after(std::size_t i) const { return from_mean_[i + 1 == from_mean_.size() ? 0 : i + 1]; }

  // All sums are exact before they are rounded, so that they do not depend on the corner that comes first.
  void measure() {
    sum_.clear();
    BoundingBox box{places_.front(), places_.front()};
    for (const Vec3& place : places_) {
      sum_.add(place);
      box = {box.min_B.cwiseMin(place), box.max_B.cwiseMax(place)};
    }
    size_ = box.diagonal();
    mean_ = sum_.rounded() / static_cast<double>(places_.size());
    from_mean_.clear();
    for (const Vec3& place : places_) from_mean_.emplace_back(place - mean_);
    sum_.clear();
    for (std::size_t i = 0; i < from_mean_.size(); ++i) sum_.add(from_mean_[i].cross(after(i)));
    area_vector_ = 0.5 * sum_.rounded();
    area_vector_.cwiseAbs().maxCoeff(&axis_);
    constexpr double kAreaRounding = 1e-13;
    has_area_ = area_vector_.norm() > kAreaRounding * size_ * size_;
    const Vec3 normal = has_area_ ? area_vector_.normalized() : normal_of_extent();
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (const Vec3& place : from_mean_) {
      lowest = std::min(lowest, normal.dot(place));
      highest = std::max(highest, normal.dot(place));
    }
    half_thickness_ = 0.5 * (highest - lowest);
  }

  // Returns the unit normal of the plane through the mean, the corner farthest from it and the corner
  // farthest from the line through both; zero if all lie on a line. It serves polygons without area vector.
  Vec3 normal_of_extent() const {
    const Vec3 along = *std::max_element(
        from_mean_.begin(), from_mean_.end(),
        [](const Vec3& left, const Vec3& right) { return left.squaredNorm() < right.squaredNorm(); });
    Vec3 across = Vec3::Zero();
    for (const Vec3& place : from_mean_) {
      const Vec3 candidate = along.cross(place);
      if (candidate.squaredNorm() > across.squaredNorm()) across = candidate;
    }
    if (!(across.norm() > kPlanarity * size_ * along.norm())) return Vec3::Zero();
    return across.normalized();
  }

  // Returns whether, in projection, all triangles of the fan around the mean face the same way as the
  // polygon.
  bool mean_sees_all_corners() const {
    const int front = area_vector_[axis_] > 0.0 ? 1 : -1;
    const Eigen::Vector2d mean = project_along_axis(axis_, mean_);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Vec3& next = places_[i + 1 == places_.size() ? 0 : i + 1];
      if (orient_2d(mean, project_along_axis(axis_, places_[i]), project_along_axis(axis_, next)) * front <
          0) {
        return false;
      }
    }
    return true;
  }

  void add_fan_around_mean() {
    const std::int32_t center = mesh_.add_vertex(mean_);
    ++split_.centers;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      mesh_.triangles.push_back({corners_[i], corners_[i + 1 == corners_.size() ? 0 : i + 1], center});
    }
  }

  void add_fan() {
    for (std::size_t i = 1; i + 1 < corners_.size(); ++i) {
      mesh_.triangles.push_back({corners_[0], corners_[i], corners_[i + 1]});
    }
  }

  // Uses dynamic programming over the chains from corner i to corner j, each closed by a diagonal.
  double volume_between_splits() const {
    const std::size_t count = from_mean_.size();
    if (count > kMaxSearched) return area_vector_.norm() * 2.0 * half_thickness_;
    std::array<std::array<double, kMaxSearched>, kMaxSearched> largest{};
    std::array<std::array<double, kMaxSearched>, kMaxSearched> smallest{};
    for (std::size_t length = 2; length < count; ++length) {
      for (std::size_t i = 0; i + length < count; ++i) {
        const std::size_t j = i + length;
        largest[i][j] = -std::numeric_limits<double>::infinity();
        smallest[i][j] = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < j; ++k) {
          const double volume = from_mean_[i].dot(from_mean_[k].cross(from_mean_[j])) / 6.0;
          largest[i][j] = std::max(largest[i][j], largest[i][k] + largest[k][j] + volume);
          smallest[i][j] = std::min(smallest[i][j], smallest[i][k] + smallest[k][j] + volume);
        }
      }
    }
    return largest[0][count - 1] - smallest[0][count - 1];
  }

  TriangleMesh& mesh_;
  AddCenters centers_;
  PolygonSplit split_;
  EarClipping ears_;
  ExactVectorSum sum_;
  // Of the current polygon:
  std::vector<std::int32_t> corners_;
  std::vector<Vec3> places_, from_mean_;
  bool is_in_range_ = true;
  double size_ = 0.0;
  double half_thickness_ = 0.0;
  Vec3 mean_ = Vec3::Zero();
  Vec3 area_vector_ = Vec3::Zero();
  int axis_ = 0;  // of the area vector's largest component
  bool has_area_ = false;
};

}  // namespace

PolygonSplit triangulate(const Polygons& polygons, TriangleMesh& mesh, AddCenters centers) {
  Triangulation triangulation(mesh, centers);
  for (std::size_t i = 0; i < polygons.size(); ++i) triangulation.add(polygons[i]);
  return triangulation.split();
}

}  // namespace buoyancy
